//! Light SVGs, which browsers show at once: the default where the depth of growth is not given.

use std::io::{self, Write};

use super::readable::{bytes, grouped};
use crate::graph::Graph;
use crate::grow::WalkError;
use crate::render::RenderError;

use super::Failure;
use crate::fractal::Goal;

/// Largest number of elements of a light SVG, or of all approximants of a sheet together.
pub(super) const MAX_ELEMENTS: u64 = 50_000;

/// Largest size of a light SVG in bytes.
const MAX_BYTES: u64 = 2_000_000;

/// Details in pixels, in ascending order, of which the first that is light enough is taken.
const DETAILS: [f64; 36] = [
    0.5, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0,
    30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 120.0, 150.0, 200.0, 250.0, 300.0, 400.0, 500.0, 600.0,
    800.0, 1000.0, 1200.0, 1500.0,
];

/// File in memory that may not exceed the size of a light SVG.
#[derive(Default)]
pub(super) struct Draft {
    pub(super) bytes: Vec<u8>,
    is_too_long: bool,
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.bytes.len() + bytes.len()) as u64 > MAX_BYTES {
            self.is_too_long = true;
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes a file that must be light; returns `None` if it has too many elements or bytes.
///
/// `write` must grow no more than [`MAX_ELEMENTS`] and returns their number.
pub(super) fn draft<T>(
    write: impl FnOnce(&mut Draft) -> Result<(T, u64), RenderError>,
) -> Result<Option<(T, Draft)>, RenderError> {
    let mut draft = Draft::default();
    match write(&mut draft) {
        Ok((written, elements)) => {
            Ok((elements <= MAX_ELEMENTS && !draft.is_too_long).then_some((written, draft)))
        }
        Err(_) if draft.is_too_long => Ok(None),
        Err(RenderError::Walk(WalkError::TooManyElements { .. } | WalkError::TooLong { .. })) => {
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// Returns the goal itself if its picture is light, or else the nearest lighter one: a coarser detail where
/// elements differ in length or only a part is shown, or fewer steps. Where colours are by steps
/// (`by_steps`), it is fewer steps if the goal gives their number. Returns `None` if not even the initiator
/// is light.
pub(super) fn nearest<T>(
    goal: Goal,
    graph: &Graph,
    is_part: bool,
    by_steps: bool,
    mut draft: impl FnMut(Goal) -> Result<Option<T>, Failure>,
) -> Result<Option<(Goal, T)>, Failure> {
    if let Some(drafted) = draft(goal)? {
        return Ok(Some((goal, drafted)));
    }
    // Lighter goals that cannot be drawn are skipped.
    let mut attempt = |goal: Goal| {
        let drafted = draft(goal).ok().flatten();
        Ok(drafted.map(|drafted| (goal, drafted)))
    };
    let is_even = graph.even_lengths().is_some();
    let by_steps = by_steps && matches!(goal, Goal::Steps(_, None));
    let has_no_detail = graph.counts_index() || graph.is_time_indexed();
    if !has_no_detail && (is_part || !(is_even || by_steps)) {
        let finer = DETAILS.partition_point(|&pixels| !goal.is_finer_than(pixels));
        let coarser = &DETAILS[finer..];
        let drafted = first_that_is_light(coarser.len(), |number| {
            attempt(goal.with_detail(coarser[number]))
        })?;
        if drafted.is_some() {
            return Ok(drafted);
        }
    }
    let too_large = graph.check_size(goal.steps(), MAX_ELEMENTS).err();
    let deepest = too_large.filter(|_| !is_part).map(|error| error.deepest);
    let fewer = match deepest {
        Some(deepest) => deepest.map_or(0, |deepest| deepest + 1).min(goal.steps()),
        None => goal.steps(),
    };
    first_that_is_light(fewer as usize, |number| {
        let steps = (0..fewer).nth_back(number).unwrap_or(0);
        attempt(Goal::Steps(steps, None))
    })
}

/// Returns the first draft that is light enough, of drafts that become lighter and lighter, by bisection.
pub(super) fn first_that_is_light<T>(
    count: usize,
    mut draft: impl FnMut(usize) -> Result<Option<T>, Failure>,
) -> Result<Option<T>, Failure> {
    let (mut heavy, mut light) = (0, count);
    let mut lightest = None;
    // Most pictures are light as they are.
    let mut middle = 0;
    while heavy < light {
        match draft(middle)? {
            Some(drafted) => {
                lightest = Some(drafted);
                light = middle;
            }
            None => heavy = middle + 1,
        }
        middle = heavy + light.saturating_sub(heavy) / 2;
    }
    Ok(lightest)
}

/// Returns a note about the lighter picture that is drawn, with the option for the heavier one.
pub(super) fn note(drawn: &str, more: &str) -> String {
    format!(
        "note: {drawn}, to limit the SVG to {} elements and {}; {more}",
        grouped(&MAX_ELEMENTS.into()),
        bytes(MAX_BYTES),
    )
}

impl Goal {
    /// Returns whether the goal replaces elements that are smaller than `pixels`.
    fn is_finer_than(self, pixels: f64) -> bool {
        match self {
            Self::Steps(_, None) => true,
            Self::Steps(_, Some(own)) | Self::Detail(own) => own < pixels,
        }
    }

    fn with_detail(self, pixels: f64) -> Self {
        match self {
            Self::Steps(steps, _) => Self::Steps(steps, Some(pixels)),
            Self::Detail(_) => Self::Detail(pixels),
        }
    }

    /// Returns a note about the lighter goal that is drawn instead.
    pub(super) fn note_of_lighter(self, lighter: Self) -> String {
        let drawn = match (self, lighter) {
            (Self::Steps(own, _), Self::Steps(steps, None)) => {
                format!("step {steps} is drawn instead of {own}")
            }
            (_, Self::Steps(steps, None)) => format!("step {steps} is drawn"),
            (_, Self::Steps(_, Some(pixels)) | Self::Detail(pixels)) => {
                format!("elements below {pixels} pixels are not replaced")
            }
        };
        let more = match self {
            Self::Steps(steps, _) => format!("--steps {steps} draws the whole step"),
            Self::Detail(pixels) => format!("--detail {pixels} draws everything that is visible"),
        };
        note(&drawn, &format!("{more}, as does a .png"))
    }
}
