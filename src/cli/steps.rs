//! How many steps a rule is grown where nobody says.

use super::Failure;
use super::rule::Loaded;

/// Numbers of steps beyond this are refused.
const MOST_STEPS: u32 = 1_000_000;

/// Reads a number of steps.
pub(super) fn parse(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(steps) if steps <= MOST_STEPS => Ok(steps),
        _ => Err(format!(
            "a number of steps is a whole number from 0 to {MOST_STEPS}"
        )),
    }
}

/// The number of steps that was asked for, or that the rule proposes, or else the deepest one, up
/// to 12, that has no more than 20,000 elements; 6 where that is not known.
pub(super) fn choose(asked: Option<u32>, loaded: &Loaded) -> Result<u32, Failure> {
    const DEEPEST: u32 = 12;
    if let Some(steps) = asked.or(loaded.rule.steps()) {
        return Ok(steps);
    }
    let graph = loaded.compile(DEEPEST)?;
    if graph.forecast().is_none() {
        return Ok(DEEPEST / 2);
    }
    Ok(match graph.check_size(DEEPEST, 20_000) {
        Ok(_) => DEEPEST,
        Err(error) => error.deepest.unwrap_or(0),
    })
}
