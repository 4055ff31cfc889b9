//! Zooms without end: the map of an address' period, whose ratio and turn a film takes out.

use crate::geometry::{DAffine2, DVec2, Frame2};
use crate::graph::{Graph, Instance, Replacement};
use crate::zoom::Address;

use super::super::Failure;
use super::super::rule::Loaded;
use super::Arguments;

/// One period of a zoom.
pub(super) struct Period {
    /// Decimal logarithms of the magnification at the start and at the end.
    pub(super) digits: [f64; 2],
    /// Degrees by which the picture is turned meanwhile.
    pub(super) turn: f64,
    /// Number of steps.
    pub(super) steps: f64,
}

/// Least magnification at the start: the ends of the set are out of sight.
const LEAST_DIGITS: f64 = 1.5;

/// Returns the period of the address at which a zoom aims.
pub(super) fn period(arguments: &Arguments, loaded: &Loaded) -> Result<Period, Failure> {
    let wrong = |message: &str| Failure::Usage(message.into());
    let at = arguments.others.value("at");
    let at = at.ok_or_else(|| wrong("--zoom loop needs --at with a period, as in '0.(1)'"))?;
    let Ok(Address::Path { first, repeated }) = at.parse() else {
        return Err(wrong(
            "--zoom loop repeats the period of an address, as in '0.(1)'; a point has none",
        ));
    };
    if loaded.model.is_in_space() {
        return Err(wrong("--zoom loop is for sets of the plane"));
    }
    // A mirrored period is taken twice.
    let path: Vec<u32> = [first.as_slice(), &repeated, &repeated, &repeated].concat();
    let graph = loaded.compile_limit(u32::try_from(path.len()).unwrap_or(u32::MAX));
    let graph = graph.map_err(|error| loaded.failure(&error))?;
    let frames = nested(&graph, &path).ok_or_else(|| {
        wrong("--zoom loop needs replacements that are equal at every step, without random draws, and an address of its elements")
    })?;
    let start = first.len() + repeated.len() - 1;
    let map = |periods: usize| {
        affine(&frames[start + periods * repeated.len()]) * affine(&frames[start]).inverse()
    };
    let is_mirrored = map(1).matrix2.determinant() < 0.0;
    let once = if is_mirrored { 2 } else { 1 };
    let map = map(once);
    let [across, up] = [map.matrix2.x_axis, map.matrix2.y_axis];
    let is_similarity = (across.length() - up.length()).abs() < 1e-9 * across.length()
        && across.dot(up).abs() < 1e-9 * across.length_squared();
    let ratio = across.length();
    if !is_similarity || !(1e-12..1.0).contains(&ratio) {
        return Err(wrong(
            "--zoom loop needs a period that is a similarity smaller than 1",
        ));
    }
    let digits = -libm::log10(ratio);
    let before = (LEAST_DIGITS / digits).ceil() * digits;
    #[expect(clippy::cast_precision_loss, reason = "addresses are short")]
    let steps = (once * repeated.len()) as f64;
    Ok(Period {
        digits: [before, before + digits],
        turn: -libm::atan2(across.y, across.x).to_degrees(),
        steps,
    })
}

/// Returns the frames of the nested elements of an address; `None` if they are not fixed.
fn nested(graph: &Graph, path: &[u32]) -> Option<Vec<Frame2>> {
    let steps = u32::try_from(path.len()).ok()?;
    let (first, further) = path.split_first()?;
    let at = |instances: &[Instance], position: u32| {
        instances.iter().find(|it| it.position == position).cloned()
    };
    let mut instance = at(&graph.initiator(steps).instances, *first)?;
    let mut frames = vec![instance.frame];
    for position in further {
        let Replacement::Fixed(successor) = &graph.objects()[instance.object].replacement else {
            return None;
        };
        instance = at(&successor.body.instances, *position)?;
        frames.push(frames.last()?.compose(&instance.frame));
    }
    Some(frames)
}

/// Returns the map of a frame.
fn affine(frame: &Frame2) -> DAffine2 {
    let [origin, right, up] = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|point| frame.apply(point));
    DAffine2::from_cols(right - origin, up - origin, origin)
}
