//! Light on pixels: relief, from the depths of neighbouring pixels, and occlusion.

use tiny_skia::Pixmap;

use crate::geometry::DVec3;
use crate::parallel::for_each;

use super::SpaceOptions;
use super::camera::CameraError;
use super::depth_map::DepthMap;
use super::occlusion::Occlusion;
use super::shade;

/// Multiplies the colours of a picture by the intensities of the light on its pixels, which depend on their depths.
pub(super) fn light(
    pixmap: &mut Pixmap,
    depths: &DepthMap,
    space: &SpaceOptions,
    threads: usize,
) -> Result<(), CameraError> {
    if space.shade.unwrap_or_default().has_relief() {
        let towards = space.camera.rotation()? * space.light.towards();
        dim(pixmap, threads, |x, y| {
            space.light.intensity(normal(depths, x, y).dot(towards))
        });
    }
    if space.occlusion {
        let occlusion = Occlusion::new(depths);
        dim(pixmap, threads, |x, y| occlusion.openness(x, y));
    }
    Ok(())
}

/// Multiplies the colours of a picture by the intensities of its pixels.
fn dim(pixmap: &mut Pixmap, threads: usize, intensity: impl Fn(usize, usize) -> f64 + Sync) {
    let width = pixmap.width() as usize;
    let rows = pixmap.pixels_mut().chunks_mut(width.max(1)).enumerate();
    for_each(rows, threads, |(y, row)| {
        for (x, pixel) in row.iter_mut().enumerate() {
            if pixel.alpha() > 0 {
                let [red, green, blue, alpha] = shade::parts(*pixel);
                let intensity = intensity(x, y);
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
