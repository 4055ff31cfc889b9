//! Variation: members near the present one, from which a click takes one.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::random::{Pcg, mix};

use super::good::ParameterState;

/// Share by which a number changes at most.
const SHARE: f64 = 0.05;

/// Largest number of numbers in a text that change.
const MOST: usize = 400;

/// Keys whose values are no geometry.
const FIXED: [&str; 23] = [
    "title",
    "about",
    "source",
    "tags",
    "params",
    "steps",
    "symmetry",
    "style",
    "view",
    "dimension",
    "hausdorff_dimension",
    "kind",
    "space",
    "extends",
    "select",
    "use",
    "weights",
    "weight",
    "random",
    "direction",
    "camera",
    "name",
    "seed",
];

/// Member near the present one.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Variant {
    #[serde(skip)]
    pub(super) text: Arc<str>,
    pub(super) set: BTreeMap<String, String>,
    /// Changes in words.
    pub(super) changes: Vec<String>,
}

/// Returns a number from -1 to 1.
fn swing(stream: &mut Pcg) -> f64 {
    2.0 * stream.unit() - 1.0
}

/// Returns a member near the present one: parameters move by a share of their range, and numbers of the geometry that
/// are no ends or flags by a share of themselves. Returns `None` if there is nothing to change.
pub(super) fn variant(
    source: &Arc<Source>,
    parameters: &[ParameterState],
    set: &BTreeMap<String, String>,
    seed: u64,
) -> Option<Variant> {
    let mut stream = Pcg::new(mix(seed), mix(!seed));
    let mut changes = Vec::new();
    let mut own = set.clone();
    vary_parameters(parameters, &mut own, &mut stream, &mut changes);
    let mut text = source.text().to_owned();
    if parameters.is_empty() {
        let mut places = Vec::new();
        add_numbers(&Node::parse(source).ok()?, source, &mut places);
        places.sort_by_key(|(range, _)| range.start);
        places.dedup_by_key(|(range, _)| range.start);
        // From the end, so that places before stay where they are.
        for (range, value) in places.into_iter().rev().take(MOST) {
            let new = rounded(value * (1.0 + SHARE * swing(&mut stream)));
            text.replace_range(range, &new.to_string());
            changes.push(format!("{value} → {new}"));
        }
    }
    (!changes.is_empty()).then(|| Variant {
        text: text.into(),
        set: own,
        changes,
    })
}

fn vary_parameters(
    parameters: &[ParameterState],
    set: &mut BTreeMap<String, String>,
    stream: &mut Pcg,
    changes: &mut Vec<String>,
) {
    let mut wholes: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for parameter in parameters {
        let now = value_of(parameter, set);
        let range = parameter.min.zip(parameter.max).map(|(min, max)| max - min);
        let most = range.unwrap_or_else(|| now.abs().max(0.2)) * SHARE;
        // Whole numbers change by one at least, if they change.
        let step = match parameter.is_integer {
            true => (most.max(1.0) * swing(stream)).round(),
            false => most * swing(stream),
        };
        let [min, max] = [
            parameter.min.unwrap_or(f64::MIN),
            parameter.max.unwrap_or(f64::MAX),
        ];
        let new = rounded((now + step).clamp(min, max));
        match &parameter.whole {
            Some(whole) => wholes.entry(whole).or_default().push(new),
            None => {
                changes.push(format!("{} {now} → {new}", parameter.name));
                set.insert(parameter.name.clone(), new.to_string());
            }
        }
    }
    for (name, parts) in wholes {
        let value = format!(
            "[{}]",
            parts
                .iter()
                .map(f64::to_string)
                .collect::<Vec<_>>()
                .join(",")
        );
        changes.push(format!("{name} → {value}"));
        set.insert(name.to_owned(), value);
    }
}

/// Returns the value of a parameter: as set, if that is a number, or that of the file.
pub(super) fn value_of(parameter: &ParameterState, set: &BTreeMap<String, String>) -> f64 {
    if let Some(whole) = &parameter.whole {
        let parts = set
            .get(whole)
            .map(|it| it.trim_matches(['[', ']']).split(',').collect::<Vec<_>>());
        let at = usize::from(parameter.name.ends_with(".im"));
        let part = parts.and_then(|parts| parts.get(at)?.trim().parse().ok());
        return part.unwrap_or(parameter.value);
    }
    { set.get(&parameter.name) }
        .and_then(|it| it.parse().ok())
        .unwrap_or(parameter.value)
}

/// Adds the places of the numbers of the geometry: those that are no whole numbers, which count and name.
fn add_numbers(node: &Node, source: &Arc<Source>, places: &mut Vec<(std::ops::Range<usize>, f64)>) {
    match &node.value {
        Value::Number(value)
            if value.fract() != 0.0 && Arc::ptr_eq(node.place.source(), source) =>
        {
            places.push((node.place.range(), *value));
        }
        Value::Text(text) if Arc::ptr_eq(node.place.source(), source) => {
            if let Some(value) = quotient(text) {
                places.push((node.place.range(), value));
            }
        }
        Value::Sequence(nodes) => nodes
            .iter()
            .for_each(|node| add_numbers(node, source, places)),
        Value::Mapping(entries) => {
            for (key, node) in entries {
                if !FIXED.contains(&key.name.as_str()) {
                    add_numbers(node, source, places);
                }
            }
        }
        _ => {}
    }
}

/// Returns the value of an expression of constants, as `1/3` or `sqrt(3)/6`, that is written plain.
fn quotient(text: &str) -> Option<f64> {
    let value = crate::cli::family::value(text).ok()?;
    (value.is_finite() && value.fract() != 0.0).then_some(value)
}

/// Rounds to four digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fractal;
    use crate::catalogue::Catalogue;

    #[test]
    fn numbers_of_the_geometry_change_a_little() {
        let text = "title: Koch 0.5\ninitiator: segment\ngenerator: [[0, 0], [1/3, 0], [0.5, sqrt(3)/6], [2/3, 0], [1, 0]]\n";
        let source = Source::new("koch.yaml", text);
        let found = variant(&source, &[], &BTreeMap::new(), 7).unwrap();
        assert_eq!(found.changes.len(), 4, "{found:?}");
        assert!(
            found
                .text
                .starts_with("title: Koch 0.5\ninitiator: segment\ngenerator: [[0, 0], [")
        );
        assert!(found.text.ends_with(", [1, 0]]\n") && *found.text != *text);
        let varied =
            Fractal::read(&Source::new("v", &*found.text), &Catalogue::embedded()).unwrap();
        let dimension = varied.dimension().unwrap().value;
        assert!((dimension - 1.26).abs() < 0.2 && dimension != 4.0_f64.ln() / 3.0_f64.ln());
        assert_eq!(
            found.text,
            variant(&source, &[], &BTreeMap::new(), 7).unwrap().text
        );
    }
}
