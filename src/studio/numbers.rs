//! Forecast and dimension: what `kfrac info` reports, to the steps that a slider has.

use serde::Serialize;
use serde_json::Value;

use crate::cli::{info, readable};

use super::answer::Refusal;
use super::drawing::Shot;

/// Largest number of elements that are grown without a detail: what one core draws in a few seconds.
pub(super) const BUDGET: u64 = 20_000_000;

/// Numbers of a set.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Numbers {
    /// Number of steps that is drawn unless another is given.
    pub(super) proposed: u32,
    /// Steps from 0; empty if their sizes are not known before they are grown.
    pub(super) steps: Vec<Step>,
    /// Number of steps up to which a slider goes.
    pub(super) last: u32,
    /// Lines on the dimension.
    pub(super) dimension: Vec<String>,
    /// Whether draws are random.
    pub(super) is_random: bool,
    /// Factor from the mean length of elements to that of the next step.
    #[serde(skip)]
    pub(super) shrinks: Option<f64>,
}

/// Size of a step.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Step {
    elements: String,
    /// Number of elements, if it is below 2⁶⁴.
    #[serde(skip)]
    count: Option<u64>,
    /// Whether it is grown.
    pub(super) fits: bool,
    bytes: Option<String>,
    seconds: Option<String>,
}

impl Numbers {
    /// Computes the numbers of a set.
    pub(super) fn of(shot: &Shot) -> Result<Self, Refusal> {
        let mut arguments = vec![shot.rule.clone()];
        let settings = shot.look.iter().filter(|it| it.starts_with("--set="));
        arguments.extend(settings.cloned());
        let described = info::hold(&arguments, &shot.source, &shot.catalogue, BUDGET)?;
        let info::Described {
            json,
            lines,
            proposed,
        } = described;
        let row = |key: &str| json.get(key).and_then(Value::as_array).cloned();
        let elements = row("elements").unwrap_or_default();
        let at = |all: &Option<Vec<Value>>, step: usize| {
            all.as_ref()
                .and_then(|all| all.get(step))
                .and_then(Value::as_f64)
        };
        let (bytes, seconds, length) = (row("svg_bytes"), row("seconds"), row("length"));
        // Sets in space are drawn to the pixel, whatever the number of elements.
        let is_in_space = json.get("space").and_then(Value::as_u64) == Some(3);
        let count = |step: usize| {
            let text = elements.get(step).map(Value::to_string).unwrap_or_default();
            text.trim_matches('"').to_owned()
        };
        let steps: Vec<_> = (0..elements.len())
            .map(|step| Step {
                elements: grouped(&count(step)),
                count: count(step).parse().ok(),
                fits: is_in_space || { count(step).parse() }
                    .is_ok_and(|count: u64| count <= BUDGET),
                bytes: at(&bytes, step).map(readable::rough_bytes),
                seconds: at(&seconds, step).map(readable::duration),
            })
            .collect();
        let mean = |step: usize| Some(at(&length, step)? / count(step).parse::<f64>().ok()?);
        let now = usize::try_from(proposed)
            .unwrap_or(usize::MAX)
            .min(elements.len().saturating_sub(2));
        let shrinks = mean(now).zip(mean(now + 1)).map(|(now, next)| next / now);
        Ok(Self {
            proposed,
            last: u32::try_from(steps.len().saturating_sub(1))
                .unwrap_or(0)
                .max(proposed.max(12) * u32::from(steps.is_empty())),
            steps,
            dimension: lines,
            is_random: json.get("random").and_then(Value::as_bool).unwrap_or(false),
            shrinks: shrinks.filter(|factor| *factor > 0.05 && *factor < 0.999),
        })
    }

    /// Returns whether a step is grown.
    pub(super) fn fits(&self, step: u32) -> bool {
        let known = usize::try_from(step)
            .ok()
            .and_then(|step| self.steps.get(step));
        match known {
            Some(step) => step.fits,
            // Beyond the slider, sizes only grow.
            None => self.steps.last().is_none_or(|last| last.fits),
        }
    }

    /// Returns the last of the steps up to one that has at most `most` elements, where their numbers are known.
    pub(super) fn deepest(&self, step: u32, most: u64) -> u32 {
        let known = usize::try_from(step)
            .ok()
            .and_then(|step| self.steps.get(..=step));
        let Some(known) = known else {
            return step;
        };
        let fits = |step: &Step| step.count.is_some_and(|count| count <= most);
        let last = known.iter().rposition(fits);
        last.and_then(|last| u32::try_from(last).ok())
            .unwrap_or(step)
    }

    /// Returns the size of a step in words.
    pub(super) fn described(&self, step: u32) -> String {
        let known = usize::try_from(step)
            .ok()
            .and_then(|step| self.steps.get(step));
        known.map_or("too many elements".into(), |it| {
            format!("{} elements", it.elements)
        })
    }

    /// Returns the number of further steps that a magnification calls for.
    pub(super) fn further(&self, factor: f64) -> Option<u32> {
        let further = libm::log(factor.max(1.0)) / -libm::log(self.shrinks?);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "below 10,000"
        )]
        Some(further.clamp(0.0, 10_000.0) as u32)
    }
}

/// Groups the digits of a number; a long one is abbreviated to its magnitude.
fn grouped(digits: &str) -> String {
    if digits.len() > 15 {
        return format!(
            "{}.{} × 10^{}",
            &digits[..1],
            &digits[1..3],
            digits.len() - 1
        );
    }
    let groups: Vec<_> = digits
        .as_bytes()
        .rchunks(3)
        .rev()
        .map(String::from_utf8_lossy)
        .collect();
    groups.join(",")
}
