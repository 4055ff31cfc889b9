//! Values of numbers as written, with what they depend on.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::expression::{Expression, PARTS, Scope};
use crate::geometry::DVec3;
use crate::rule::ElementContext;

use super::super::good::ParameterState;
use super::space::View;

/// Dependence of a number; the later ones include those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Basis {
    /// Nothing: constants only.
    Numbers,
    /// Parameters of the rule.
    Parameters,
    /// Drawn variables, or the element that is replaced.
    Drawn,
}

/// Names with values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    values: BTreeMap<String, f64>,
    drawn: BTreeSet<String>,
    /// View of a figure in space; `None` in the plane.
    view: Option<View>,
}

impl Names {
    /// Returns the parameters of a rule, with the values that are set.
    pub(crate) fn of(parameters: &[ParameterState], set: &BTreeMap<String, String>) -> Self {
        let mut names = Self::default();
        for parameter in parameters {
            let value = super::super::vary::value_of(parameter, set);
            names.values.insert(parameter.name.clone(), value);
        }
        for (number, name) in ElementContext::NAMES.iter().enumerate() {
            names.draw(name, if number == 0 { 1.0 } else { 0.0 });
        }
        names
    }

    /// Returns the names for points in space as they are seen.
    pub(super) fn seen(self, view: View) -> Self {
        Self {
            view: Some(view),
            ..self
        }
    }

    pub(super) fn is_in_space(&self) -> bool {
        self.view.is_some()
    }

    /// Returns the view of space; in the plane, that from the front.
    pub(super) fn view(&self) -> View {
        self.view.unwrap_or_default()
    }

    fn draw(&mut self, name: &str, value: f64) {
        self.values.insert(name.to_owned(), value);
        self.drawn.insert(name.to_owned());
    }

    /// Returns these names and the drawn variables of a generator: `part` is 0 for their least values, 1 for their
    /// largest ones, and 1/2 for their means.
    pub(super) fn with_drawn(&self, random: Option<&Node>, part: f64) -> Self {
        let mut names = self.clone();
        if let Some(Value::Mapping(entries)) = random.map(|random| &random.value) {
            for (key, node) in entries {
                let value = names.drawn_value(node, part).unwrap_or(0.0);
                names.draw(&key.name, value);
            }
        }
        names
    }

    fn drawn_value(&self, node: &Node, part: f64) -> Option<f64> {
        let expression = Expression::parse(node.written()?).ok()?;
        let Some((name, arguments)) = expression.as_call() else {
            return self.evaluate(&expression);
        };
        let at = |index: usize| self.evaluate(arguments.get(index)?);
        match name {
            "uniform" => Some(at(0)? + (at(1)? - at(0)?) * part),
            "normal" => Some(at(0)? + at(1)? * (2.0 * part - 1.0)),
            _ => at(0),
        }
    }

    pub(super) fn evaluate(&self, expression: &Expression) -> Option<f64> {
        let mut scope = Scope::new();
        for (name, value) in &self.values {
            scope.constant(name, *value);
        }
        expression.compile(&scope).ok()?.as_constant()
    }

    /// Returns the value of a number.
    pub(crate) fn value(&self, node: &Node) -> Option<(f64, Basis)> {
        match &node.value {
            Value::Number(value) => Some((*value, Basis::Numbers)),
            Value::Text(text) => {
                let expression = Expression::parse(text).ok()?;
                let basis = self.basis(&expression);
                Some((self.evaluate(&expression)?, basis))
            }
            _ => None,
        }
    }

    fn basis(&self, expression: &Expression) -> Basis {
        let is_parameter = |name: &str| {
            let has = |end: &str| self.values.contains_key(&format!("{name}{end}"));
            has("") || has(PARTS[0])
        };
        let names = expression.names();
        let bases = names
            .iter()
            .map(|(name, _)| match self.drawn.contains(*name) {
                true => Basis::Drawn,
                false if is_parameter(name) => Basis::Parameters,
                false => Basis::Numbers,
            });
        bases.max().unwrap_or(Basis::Numbers)
    }

    /// Returns the value of a point: a list of two numbers, or a real or complex number.
    pub(crate) fn point(&self, node: &Node) -> Option<([f64; 2], Basis)> {
        match &node.value {
            Value::Sequence(parts) => {
                let dimensions = if self.is_in_space() { 2..=3 } else { 2..=2 };
                if !dimensions.contains(&parts.len()) {
                    return None;
                }
                let [right, up, _] = self.view().axes();
                let shown = |axis: usize| match parts.get(axis) {
                    Some(part) => self.value(part),
                    None => Some((0.0, Basis::Numbers)),
                };
                let ((x, one), (y, other)) = (shown(right)?, shown(up)?);
                Some(([x, y], one.max(other)))
            }
            Value::Number(value) => Some(([*value, 0.0], Basis::Numbers)),
            Value::Text(text) => {
                let formula = Expression::parse(text).ok()?;
                let [x, y] = formula.complex_parts(&mut 0).ok()?;
                let value = [self.evaluate(&x)?, self.evaluate(&y)?];
                Some((value, self.basis(&formula)))
            }
            _ => None,
        }
    }

    /// Returns the value of a point or a vector in space. One of two numbers lies in z = 0.
    pub(super) fn vector(&self, node: &Node) -> Option<(DVec3, Basis)> {
        let Value::Sequence(parts) = &node.value else {
            return None;
        };
        let mut vector = DVec3::ZERO;
        let mut basis = Basis::Numbers;
        if !(2..=3).contains(&parts.len()) {
            return None;
        }
        for (axis, part) in parts.iter().enumerate() {
            let (value, own) = self.value(part)?;
            vector[axis] = value;
            basis = basis.max(own);
        }
        Some((vector, basis))
    }

    /// Returns the names with other values of some.
    pub(super) fn with<'a>(&self, others: impl Iterator<Item = (&'a str, f64)>) -> Self {
        let mut names = self.clone();
        names
            .values
            .extend(others.map(|(name, value)| (name.to_owned(), value)));
        names
    }
}
