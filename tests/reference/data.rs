//! The facts of the reference, from `rules.json`. They were computed independently of kfrac from exact
//! expressions, and are given as doubles.

use std::collections::BTreeMap;
use std::sync::Arc;

use kfrac::document::Setting;
use kfrac::graph::Graph;
use kfrac::rule::Rule;
use serde::Deserialize;

use super::common;

/// The whole reference.
#[derive(Deserialize)]
pub(crate) struct Reference {
    /// Sequences of turns, by name.
    pub(crate) turns: BTreeMap<String, Vec<u8>>,
    pub(crate) rules: Vec<Entry>,
}

/// A rule of the reference.
#[derive(Deserialize)]
pub(crate) struct Entry {
    pub(crate) id: String,
    /// Name of the library's rule.
    rule: String,
    /// Parameters to set.
    set: BTreeMap<String, f64>,
    pub(crate) connected: bool,
    /// Whether the initiator is closed.
    pub(crate) closed: bool,
    /// Whether element i takes generator (i − 1) mod m; otherwise there is one generator.
    pub(crate) by_index: bool,
    pub(crate) dimension: Option<f64>,
    pub(crate) base_element: Polygon,
    pub(crate) initiator: Vec<Listed>,
    pub(crate) generators: Vec<Vec<Listed>>,
    pub(crate) per_step: Vec<Step>,
    /// Counts for n = 0, 1, …, where the geometry is not fixed.
    pub(crate) counts: Option<Counts>,
}

#[derive(Deserialize)]
pub(crate) struct Polygon {
    pub(crate) closed: bool,
    pub(crate) points: Vec<[f64; 2]>,
}

/// An element as listed: from x, from y, to x, to y, direction, whether it is fertile (0 or 1), and part (0
/// if it does not seed, k for the k-th seed part).
#[derive(Clone, Copy, Deserialize)]
pub(crate) struct Listed(
    pub(crate) f64,
    pub(crate) f64,
    pub(crate) f64,
    pub(crate) f64,
    pub(crate) u8,
    u8,
    pub(crate) u8,
);

impl Listed {
    pub(crate) fn is_fertile(&self) -> bool {
        self.5 == 1
    }
}

/// Facts about approximant n.
#[derive(Deserialize)]
pub(crate) struct Step {
    pub(crate) n: u32,
    pub(crate) elements: u64,
    pub(crate) fertile: u64,
    pub(crate) fractals: Option<u64>,
    pub(crate) length: f64,
    /// Bounds of the elements' end points: least x and y, largest x and y.
    pub(crate) bbox: [f64; 4],
    /// Bounds of the base elements where they differ.
    pub(crate) base_bbox: Option<[f64; 4]>,
}

#[derive(Deserialize)]
pub(crate) struct Counts {
    pub(crate) fractals: Vec<u64>,
    pub(crate) fertile: Vec<u64>,
    pub(crate) infertile: Vec<u64>,
}

impl Entry {
    /// Returns the name of the library's rule.
    pub(crate) fn rule_name(&self) -> &str {
        &self.rule
    }

    /// Returns the library's rule, with the parameters set.
    pub(crate) fn rule(&self) -> Arc<Rule> {
        let settings = self.set.iter().map(|(name, &value)| Setting {
            name: name.clone(),
            value,
            written: None,
            place: None,
        });
        common::resolved(&common::document(&self.rule), &settings.collect::<Vec<_>>())
    }

    /// Returns the rule's graph for a number of steps.
    pub(crate) fn graph(&self, steps: u32) -> Graph {
        common::compiled(&self.rule(), steps)
    }

    /// Returns whether positions depend on draws, so that the reference fixes the counts only.
    pub(crate) fn is_random(&self) -> bool {
        self.rule().is_random()
    }
}

/// Reads the reference.
pub(crate) fn reference() -> Reference {
    serde_json::from_str(include_str!("rules.json")).unwrap()
}
