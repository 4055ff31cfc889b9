//! The part of the plane or of space that a film shows, and its size.

use std::path::Path;

use crate::figure::sheet::CellView;
use crate::geometry::{Bounds, DVec2, DVec3};
use crate::render::{Canvas, Size, Unit};

use super::super::rule::Loaded;
use super::super::{Failure, output};
use super::Arguments;
use super::frames::{Frames, Purpose};

/// Largest number of pixels of a frame.
const MAX_PIXELS: u64 = 1 << 25;

/// Long side of the pictures by which a part of space is found, in pixels.
const SMALL: u32 = 96;

/// Completes the arguments of frames by the part that they show and by their size, which is returned.
pub(super) fn fit(
    arguments: &Arguments,
    loaded: &Loaded,
    frames: &mut Frames<'_>,
    path: &Path,
) -> Result<[u32; 2], Failure> {
    if arguments.size.unit != Unit::Pixel {
        return Err(Failure::Usage(
            "the frames of a film are sized in pixels".into(),
        ));
    }
    let size = arguments.size.size;
    let is_free = !arguments.others.gives("view") && arguments.zoom.is_none();
    let fits_all = arguments.fit == CellView::All && is_free;
    if loaded.model.is_in_space() {
        let size = match size {
            Size::Exactly(width, height) => [width, height],
            Size::Long(side) => [side, (3 * side / 4).max(1)],
        };
        check(size)?;
        if fits_all && !arguments.others.gives("look-at") {
            fit_in_space(frames, size)?;
        }
        return Ok(sized(frames, size));
    }
    if !fits_all {
        let size = match size {
            Size::Exactly(width, height) => [width, height],
            Size::Long(side) => {
                let mut size = [side; 2];
                // A zoom has the shape of the whole.
                let first = &mut frames.arguments[0];
                let kept = first.clone();
                first.retain(|it| {
                    !["--zoom=", "--at=", "--turn="]
                        .iter()
                        .any(|name| it.starts_with(name))
                });
                frames.draw(
                    [0],
                    Purpose::Survey,
                    &[format!("--size={side}")],
                    |_, done| {
                        size = done.size;
                        Ok(())
                    },
                )?;
                frames.arguments[0] = kept;
                size
            }
        };
        check(size)?;
        return Ok(sized(frames, size));
    }
    let long = match size {
        Size::Exactly(width, height) => width.max(height),
        Size::Long(side) => side,
    };
    let mut all = Bounds::EMPTY;
    let numbers = 0..frames.arguments.len();
    frames.draw(
        numbers,
        Purpose::Survey,
        &[format!("--size={long}")],
        |_, done| {
            if let Some([x, y, width, height]) = done.window {
                let corner = DVec2::new(x, y);
                all.add_all(&Bounds::new(corner, corner + DVec2::new(width, height)));
            }
            Ok(())
        },
    )?;
    let canvas =
        Canvas::fit(&all, size, 0.0).map_err(|error| output::explain(error.into(), path))?;
    check(canvas.size())?;
    let window = canvas.window().map(|it| it.to_string()).join(",");
    for frame in &mut frames.arguments {
        frame.retain(|it| !it.starts_with("--margin="));
        frame.extend([format!("--view={window}"), "--margin=0".into()]);
    }
    Ok(sized(frames, canvas.size()))
}

/// Gives all frames of a set in space one middle and one scale.
fn fit_in_space(frames: &mut Frames<'_>, [width, height]: [u32; 2]) -> Result<(), Failure> {
    let shrink = f64::from(SMALL) / f64::from(width.max(height));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "smaller than before"
    )]
    let [across, down] =
        [width, height].map(|side| (f64::from(side) * shrink).ceil().max(1.0) as u32);
    let small = format!("--size={across}x{down}");
    let numbers = 0..frames.arguments.len();
    // Margins in pixels are larger shares of small pictures.
    let own = frames.arguments.clone();
    for frame in &mut frames.arguments {
        frame.retain(|it| !it.starts_with("--margin="));
        frame.push("--margin=0".into());
    }
    // Frames in which nothing is visible have no middle.
    let mut middles = Vec::new();
    frames.draw(
        numbers.clone(),
        Purpose::Survey,
        std::slice::from_ref(&small),
        |_, done| {
            middles.push(done.sight.as_ref().map(|sight| sight.middle));
            Ok(())
        },
    )?;
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let middle = {
        let seen = middles.iter().flatten();
        seen.clone().copied().sum::<DVec3>() / seen.count().max(1) as f64
    };
    let middle = middle.to_array().map(|it| it.to_string()).join(",");
    let middle = format!("--look-at={middle}");
    let widths = |zoom: &[String]| -> Result<Vec<f64>, Failure> {
        let mut widths = Vec::new();
        let numbers = numbers.clone();
        let own = [
            std::slice::from_ref(&small),
            std::slice::from_ref(&middle),
            zoom,
        ]
        .concat();
        frames.draw(numbers, Purpose::Survey, &own, |number, done| {
            let sight = done.sight.as_ref().filter(|_| middles[number].is_some());
            widths.push(sight.map_or(0.0, |sight| sight.across[0].length()));
            Ok(())
        })?;
        Ok(widths)
    };
    // Without a magnification, everything about the middle is seen; magnifications are relative to the own picture of a frame.
    let most = widths(&[])?.into_iter().fold(0.0, f64::max);
    let widths = widths(&["--zoom=1".into()])?;
    frames.arguments = own;
    for (frame, width) in frames.arguments.iter_mut().zip(widths) {
        frame.push(middle.clone());
        if width > 0.0 {
            frame.push(format!(
                "--zoom={}",
                super::super::family::plain(width / most)
            ));
        }
    }
    Ok(())
}

/// Gives all frames a size.
fn sized(frames: &mut Frames<'_>, size: [u32; 2]) -> [u32; 2] {
    let [width, height] = size;
    for frame in &mut frames.arguments {
        frame.push(format!("--size={width}x{height}"));
    }
    size
}

fn check([width, height]: [u32; 2]) -> Result<(), Failure> {
    match u64::from(width) * u64::from(height) <= MAX_PIXELS {
        true => Ok(()),
        false => Err(Failure::Usage(format!(
            "a frame of {width} x {height} pixels is larger than the {MAX_PIXELS} pixels that a film may have"
        ))),
    }
}
