//! Reading of numbers and points, with the limit of their formulas.

use crate::diagnostic::{Diagnostic, Place};
use crate::document::node::{Node, Value};
use crate::document::yaml::MAX_VALUES;
use crate::document::{Written, WrittenNumber, WrittenPoint};
use crate::expression::{Expression, ExpressionError};

use super::Reader;

impl Reader {
    /// Reads an expression. Reports a mistake and returns a placeholder.
    pub(in crate::document) fn number(&mut self, node: &Node) -> WrittenNumber {
        let expression = match &node.value {
            Value::Number(value) => Expression::number(*value),
            Value::Text(text) => self.formula(text, &node.place).unwrap_or_else(|error| {
                if self.is_mended(node) {
                    return Expression::unknown();
                }
                let place = node.within(error.range.clone());
                self.diagnostics.push(error.at(&place));
                Expression::unknown()
            }),
            _ => {
                self.mismatch(
                    node,
                    "a number",
                    "a number or an expression such as 1/3 or sqrt(3)/6",
                );
                Expression::unknown()
            }
        };
        let expression = if self.is_mended(node) && expression.as_call().is_some() {
            // The diagnostic for the comma covers a misplaced distribution.
            Expression::unknown()
        } else {
            expression
        };
        for warning in expression.warnings() {
            let place = node.within(warning.range.clone());
            let mut diagnostic = Diagnostic::warning(warning.message).at(&place);
            if let Some(hint) = warning.hint {
                diagnostic = diagnostic.hint(hint);
            }
            self.diagnostics.push(diagnostic);
        }
        Written {
            value: expression,
            place: node.place.clone(),
        }
    }

    /// Parses a formula at a place. Operations of formulas count as values of the file: where these are too many, which is
    /// reported once, formulas are not parsed.
    pub(in crate::document) fn formula(
        &mut self,
        text: &str,
        place: &Place,
    ) -> Result<Expression, ExpressionError> {
        if self.has_room(place) {
            let formula = Expression::parse(text)?;
            self.values += formula.operations();
            if self.has_room(place) {
                return Ok(formula);
            }
        }
        Ok(Expression::unknown())
    }

    /// Returns whether the values of the file and the operations of its formulas are not too many, which is reported once.
    fn has_room(&mut self, place: &Place) -> bool {
        let has_room = self.values <= MAX_VALUES;
        if !has_room && !std::mem::replace(&mut self.is_full, true) {
            self.error_with_hint(
                place,
                "with the operations of its formulas, the file holds more than 250,000 values",
                "write numbers in place of formulas, as in 0.25 for 1/4",
            );
        }
        has_room
    }

    /// Reads a list of exactly two numbers; in space, of two or three.
    pub(in crate::document) fn point(&mut self, node: &Node) -> WrittenPoint {
        let hint = "a point is written [x, y]";
        let mut point = WrittenPoint::unknown(&node.place);
        if let Some(complex) = self.complex(node) {
            return complex;
        }
        let Value::Sequence(entries) = &node.value else {
            self.mismatch(node, "a point", hint);
            return point;
        };
        if let [entry] = entries.as_slice()
            && let Value::Text(text) = &entry.value
            && let Some(at) = text.find(';')
        {
            let place = entry.within(at..at + 1);
            self.error_with_hint(&place, "';' does not belong in a point", hint);
            return point;
        }
        for (index, entry) in entries.iter().enumerate() {
            let number = self.number(entry);
            match index {
                0 => point.x = number,
                1 => point.y = number,
                2 if self.is_in_space => point.z = Some(Box::new(number)),
                _ => {}
            }
        }
        let count = entries.len();
        if count == 2 || (count == 3 && self.is_in_space) {
            return point;
        }
        if !entries.iter().any(|entry| self.is_mended(entry)) {
            let s = if count == 1 { "" } else { "s" };
            let few = if self.is_in_space { "three" } else { "two" };
            let message = format!("a point has {few} coordinates, this one has {count} number{s}");
            let hint = match count {
                _ if self.is_in_space => "a point in space is written [x, y, z]",
                3 if self.may_lie_in_space => {
                    "the file lies in the plane: a point is written [x, y], decimals with a point: 0.5; `space: 3` \
                     puts it into space"
                }
                3 => {
                    "the file lies in the plane: a point is written [x, y], decimals with a point: 0.5"
                }
                4.. => "a point is written [x, y], decimals with a point: 0.5",
                _ => hint,
            };
            self.error_with_hint(&node.place, message, hint);
        }
        WrittenPoint::unknown(&node.place)
    }

    /// Reads a formula of complex numbers, such as `s^2` or `1/(2 - i)`; `None` if the value is none. Points in space are lists.
    pub(in crate::document) fn complex(&mut self, node: &Node) -> Option<WrittenPoint> {
        let Value::Text(text) = &node.value else {
            return None;
        };
        if self.is_in_space {
            return Some(self.no_coordinates(node, text));
        }
        /// Number of parts of formulas that are copied in the time in which an operation is read.
        const COPIES: usize = 8;
        let place = node.place.clone();
        let mut work = 0;
        let parts = { self.formula(text, &place) }
            .map_err(|error| error.hint("a point is written [x, y], or as a formula, (1 + i)/2"))
            .and_then(|formula| formula.complex_parts(&mut work));
        // Parts that are written out are as many operations as those that are read.
        let operations = { parts.iter().flatten() }.map(Expression::operations);
        self.values += operations.sum::<usize>().max(work / COPIES);
        let parts = match parts {
            _ if !self.has_room(&place) => return Some(WrittenPoint::unknown(&place)),
            Ok(parts) => parts,
            Err(error) => {
                let within = node.within(error.range.clone());
                self.diagnostics.push(error.at(&within));
                return Some(WrittenPoint::unknown(&place));
            }
        };
        let [x, y] = parts.map(|value| Written {
            value,
            place: place.clone(),
        });
        Some(WrittenPoint {
            x,
            y,
            z: None,
            place,
        })
    }

    /// Reads a point, in the plane also as a real number: x stands for [x, 0].
    pub(in crate::document) fn complex_number(&mut self, node: &Node) -> WrittenPoint {
        if !matches!(node.value, Value::Number(_)) {
            return self.point(node);
        }
        if self.is_in_space {
            return self.no_coordinates(node, node.place.text());
        }
        let mut point = WrittenPoint::unknown(&node.place);
        point.x = self.number(node);
        point.y.value = Expression::number(0.0);
        point
    }

    /// Reports what stands in place of a point in space.
    fn no_coordinates(&mut self, node: &Node, text: &str) -> WrittenPoint {
        let message = format!("'{text}' is no list of coordinates, and this lies in space");
        self.error_with_hint(&node.place, message, "write [x, y, z]");
        WrittenPoint::unknown(&node.place)
    }

    /// Reads a list of two numbers, or a number, which counts twice.
    pub(in crate::document) fn pair(&mut self, node: &Node) -> [WrittenNumber; 2] {
        if let Value::Sequence(_) = &node.value {
            let point = self.point(node);
            return [point.x, point.y];
        }
        let number = self.number(node);
        [number.clone(), number]
    }
}
