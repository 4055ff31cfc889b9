//! Light on pixels: relief, from the depths of neighbouring pixels, shadows and occlusion.

use tiny_skia::Pixmap;

use crate::geometry::DVec3;
use crate::parallel::for_each;
use crate::style::CameraError;

use super::SpaceOptions;
use super::depth_map::DepthMap;
use super::occlusion::Occlusion;
use super::shade;
use super::shadows::Shadows;

/// Multiplies the colours of a picture by the intensities of the light on its pixels, which depend on their depths. Elements
/// that have faces are lit already.
pub(super) fn light(
    pixmap: &mut Pixmap,
    depths: &DepthMap,
    shadows: Option<&Shadows>,
    has_faces: bool,
    space: &SpaceOptions,
    threads: usize,
) -> Result<(), CameraError> {
    let shade = space.shade.unwrap_or_default();
    let towards = space.camera.rotation()? * space.light.towards();
    if shade.has_relief(has_faces) {
        dim(pixmap, threads, |x, y| {
            space.light.intensity(normal(depths, x, y).dot(towards))
        });
    }
    if let Some(shadows) = shadows {
        let is_lit = shade.has_relief(has_faces) || shade.lights_faces();
        dim(pixmap, threads, |x, y| {
            let Some(point) = depths.point(x, y) else {
                return 1.0;
            };
            let cosine = normal(depths, x, y).dot(towards);
            let reach = shadows.reach(point, cosine);
            // Of a surface without light on it, the whole colour is in the light.
            let full = if is_lit { cosine } else { 1.0 };
            let light = space.light.intensity(full);
            match light > 0.0 {
                true => space.light.intensity(full * reach) / light,
                false => 1.0,
            }
        });
    }
    if space.occlusion {
        let occlusion = Occlusion::new(depths);
        dim_rows(pixmap, threads, |y| {
            occlusion.row(y).into_iter().map(f64::from)
        });
    }
    Ok(())
}

/// Multiplies the colours of a picture by the intensities of its pixels.
fn dim(pixmap: &mut Pixmap, threads: usize, intensity: impl Fn(usize, usize) -> f64 + Sync) {
    let intensity = &intensity;
    dim_rows(pixmap, threads, |y| {
        (0..usize::MAX).map(move |x| intensity(x, y))
    });
}

/// Multiplies the colours of a picture by the intensities of its pixels, which are given row by row.
fn dim_rows<I: Iterator<Item = f64>>(
    pixmap: &mut Pixmap,
    threads: usize,
    intensities: impl Fn(usize) -> I + Sync,
) {
    let width = pixmap.width() as usize;
    let rows = pixmap.pixels_mut().chunks_mut(width.max(1)).enumerate();
    for_each(rows, threads, |(y, row)| {
        for (pixel, intensity) in row.iter_mut().zip(intensities(y)) {
            if pixel.alpha() > 0 {
                let [red, green, blue, alpha] = shade::parts(*pixel);
                let lit = [red, green, blue].map(|part| part * intensity);
                *pixel = shade::premultiplied([lit[0], lit[1], lit[2], alpha]);
            }
        }
    });
}

/// Returns the normal at a pixel. Of the two neighbours on an axis, the one of the more similar depth counts: the
/// other may lie beyond an edge.
fn normal(depths: &DepthMap, x: usize, y: usize) -> DVec3 {
    let Some(own) = depths.point(x, y) else {
        return DVec3::Z;
    };
    let along = |after: Option<DVec3>, before: Option<DVec3>| {
        let (after, before) = (after.map(|it| it - own), before.map(|it| own - it));
        match (after, before) {
            (Some(a), Some(b)) if a.z.abs() <= b.z.abs() => Some(a),
            (a, None) => a,
            (_, b) => b,
        }
    };
    let right = along(
        depths.point(x + 1, y),
        x.checked_sub(1).and_then(|x| depths.point(x, y)),
    );
    let up = along(
        y.checked_sub(1).and_then(|y| depths.point(x, y)),
        depths.point(x, y + 1),
    );
    match (right, up) {
        (Some(right), Some(up)) => right.cross(up).normalize_or(DVec3::Z),
        _ => DVec3::Z,
    }
}
