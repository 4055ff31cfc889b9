//! Numbers of steps on the command line.

use std::fmt;

use crate::fractal::{Goal, proposed_steps, steps_of_graph};
use crate::geometry::Frame3;
use crate::graph::Graph;

use super::rule::Loaded;
use super::{Failure, number};

/// Reads a number of steps.
pub(super) fn parse(text: &str) -> Result<u32, String> {
    number::whole("a number of steps", 0..=Goal::MAX_STEPS)(text)
}

/// Largest number of approximants on a sheet by default.
pub(super) const MAX_CELLS: u32 = 12;

/// Several numbers of steps, at least one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Several(Vec<u32>);

impl Several {
    /// Returns all numbers from 0 to `last`.
    pub(super) fn up_to(last: u32) -> Self {
        Self((0..=last).collect())
    }

    pub(super) fn as_slice(&self) -> &[u32] {
        &self.0
    }

    pub(super) fn largest(&self) -> u32 {
        self.0.iter().copied().max().unwrap_or_default()
    }
}

/// Formats the numbers in the notation of the command line.
impl fmt::Display for Several {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let follow = |pair: &[u32]| pair[1] == pair[0] + 1;
        if let (Some(first), Some(last)) = (self.0.first(), self.0.last())
            && self.0.windows(2).all(follow)
        {
            return write!(f, "{first}..{last}");
        }
        let all: Vec<_> = self.0.iter().map(u32::to_string).collect();
        f.write_str(&all.join(","))
    }
}

/// Parses several numbers of steps: `0..6` is 0 to 6, both included, and `0,2,4` is a list.
pub(super) fn parse_several(text: &str) -> Result<Several, String> {
    const MOST: usize = 10_000;
    let wrong = || "write 0..6, or a list such as 0,2,4".to_owned();
    let mut all = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once("..").unwrap_or((part, part));
        let (first, last) = (parse(first.trim())?, parse(last.trim())?);
        if first > last {
            return Err(wrong());
        }
        if (last - first) as usize >= MOST - all.len().min(MOST) {
            return Err(format!("a sheet has no more than {MOST} pictures"));
        }
        all.extend(first..=last);
    }
    Ok(Several(all))
}

/// Returns the number of steps that was given, or else the [proposed one](proposed_steps).
pub(super) fn choose(asked: Option<u32>, loaded: &Loaded) -> Result<u32, Failure> {
    match asked {
        Some(steps) => Ok(steps),
        None => proposed_steps(&loaded.model, |steps| loaded.graph(steps))
            .map_err(|error| loaded.failure(&error)),
    }
}

/// Returns the number of steps of a set in space that was given, or else the proposed one.
pub(super) fn choose_in_space(asked: Option<u32>, loaded: &Loaded, graph: &Graph<Frame3>) -> u32 {
    asked.unwrap_or_else(|| steps_of_graph(&loaded.model, graph))
}
