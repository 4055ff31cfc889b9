//! Limits of random functions: points of ghost figures, which a hand drags.

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep, find};
use crate::expression::Expression;

use super::act::below;
use super::names::{Basis, Names};
use super::nice;
use super::scene::Panel;
use super::solve::{Unknown, solve};

/// A drawn point where all random functions have their least values, or their largest ones.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Limit {
    /// 0 for the least values, 1 for the largest ones.
    pub(super) side: usize,
    pub(super) point: usize,
    pub(super) at: [f64; 2],
}

/// Random functions of a generator, with the place where they are written.
#[derive(Clone, Debug)]
pub(super) struct Functions {
    pub(super) node: Node,
    pub(super) at: Vec<PathStep>,
}

impl Functions {
    /// Returns the names with the values of a side.
    pub(super) fn names(&self, names: &Names, side: usize) -> Names {
        let part = if side == 0 { 0.0 } else { 1.0 };
        names.with_drawn(Some(&self.node), part)
    }

    /// Returns the limits of the drawn points of a panel, whose points are written below a root.
    pub(super) fn limits(&self, panel: &Panel, names: &Names, root: &Node) -> Vec<Limit> {
        let sides = [0, 1].map(|side| (side, self.names(names, side)));
        let points = panel.points.iter().enumerate();
        let drawn = points.filter(|(_, point)| point.basis == Basis::Drawn);
        let at = |(index, point): (usize, &super::scene::Point)| {
            let node = find(root, point.written.first()?)?;
            Some(sides.each_ref().map(|(side, names)| {
                let at = names.point(node)?.0;
                Some(Limit {
                    side: *side,
                    point: index,
                    at,
                })
            }))
        };
        drawn.filter_map(at).flatten().flatten().collect()
    }

    /// Returns the edits of the numbers in the random functions for which a point of a side lies at a place, and their new
    /// texts. `None` if no such number moves it.
    pub(super) fn dragged(
        &self,
        names: &Names,
        point: &Node,
        side: usize,
        to: [f64; 2],
        pixel: f64,
    ) -> Option<(Vec<Edit>, String)> {
        let Value::Mapping(entries) = &self.node.value else {
            return None;
        };
        let functions: Vec<Function> = { entries.iter() }
            .filter_map(|(key, node)| Function::of(&key.name, node, names, side))
            .collect();
        let unknowns: Vec<_> = functions.iter().map(|it| it.unknown.clone()).collect();
        let names = self.names(names, side);
        let place = |values: &[f64]| {
            let values = unknowns.iter().zip(values);
            let names = names.with(values.map(|(it, value)| (it.name.as_str(), *value)));
            names.point(point).map(|(place, _)| place)
        };
        let found = solve(&unknowns, to, &place)?;
        let changed = functions.iter().zip(found);
        let changed = changed.filter(|(it, value)| *value != it.unknown.value);
        let texts: Vec<_> = changed
            .map(|(it, value)| (it.unknown.name.clone(), it.text(value, pixel)))
            .collect();
        let edits = { texts.iter() }
            .map(|(name, text)| Edit::set(below(&self.at, name.as_str()), text.clone()));
        let badge = texts.iter().map(|(name, text)| format!("{name}: {text}"));
        Some((edits.collect(), badge.collect::<Vec<_>>().join(", ")))
    }
}

/// A random function with a number that is its limit.
struct Function {
    /// Name and value of what is drawn.
    unknown: Unknown,
    text: String,
    /// Bytes of the number in the text.
    range: std::ops::Range<usize>,
    /// Mean from which the number is a deviation; `None` if it is the limit itself.
    mean: Option<f64>,
}

impl Function {
    fn of(name: &str, node: &Node, names: &Names, side: usize) -> Option<Self> {
        let text = node.written()?.to_owned();
        let expression = Expression::parse(&text).ok()?;
        let (function, arguments) = expression.as_call()?;
        let (index, mean) = match function {
            "uniform" => (side, None),
            "normal" => (1, Some(names.evaluate(arguments.first()?)?)),
            _ => return None,
        };
        let argument = arguments.get(index)?;
        let number = names.evaluate(argument)?;
        let value = match mean {
            Some(mean) if side == 0 => mean - number,
            Some(mean) => mean + number,
            None => number,
        };
        // The least value stays below the largest one, and both on their side of a mean.
        let other = match mean {
            Some(mean) => mean,
            None => names.evaluate(arguments.get(1 - side)?)?,
        };
        let [min, max] = match side {
            0 => [f64::NEG_INFINITY, other.max(value)],
            _ => [other.min(value), f64::INFINITY],
        };
        // A formula is no number that can be replaced.
        argument.names().is_empty().then(|| Self {
            unknown: Unknown {
                name: name.to_owned(),
                value,
                min,
                max,
            },
            range: argument.range(),
            text,
            mean,
        })
    }

    /// Returns the function whose limit is a value.
    fn text(&self, value: f64, pixel: f64) -> String {
        let number = self.mean.map_or(value, |mean| (value - mean).abs());
        let mut text = self.text.clone();
        text.replace_range(self.range.clone(), &nice::decimals(number, pixel));
        text
    }
}
