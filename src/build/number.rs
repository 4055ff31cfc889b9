//! Numbers and points as builder arguments.

use crate::document::node::Value;
use crate::geometry::DVec2;

use super::written;

/// A number: a value, or an expression as text.
#[derive(Clone, Debug)]
pub struct NumberText(pub(crate) Value);

impl From<f64> for NumberText {
    fn from(value: f64) -> Self {
        // YAML's notation for non-finite numbers, which the expression reader refuses.
        Self(if value.is_nan() {
            Value::Text(".nan".into())
        } else if value.is_infinite() {
            Value::Text(if value > 0.0 { ".inf" } else { "-.inf" }.into())
        } else {
            // Points are compared as written, and -0.0 + 0.0 is 0.0.
            Value::Number(value + 0.0)
        })
    }
}

impl From<i32> for NumberText {
    fn from(value: i32) -> Self {
        Self::from(f64::from(value))
    }
}

impl From<&str> for NumberText {
    fn from(expression: &str) -> Self {
        Self(Value::Text(expression.into()))
    }
}

impl From<String> for NumberText {
    fn from(expression: String) -> Self {
        Self(Value::Text(expression))
    }
}

/// A point: x to the right and y upwards.
#[derive(Clone, Debug)]
pub struct PointText(pub(crate) Value);

impl<X: Into<NumberText>, Y: Into<NumberText>> From<(X, Y)> for PointText {
    fn from((x, y): (X, Y)) -> Self {
        Self(written::sequence([x.into().0, y.into().0]))
    }
}

impl<N: Into<NumberText>> From<[N; 2]> for PointText {
    fn from([x, y]: [N; 2]) -> Self {
        Self::from((x, y))
    }
}

impl From<DVec2> for PointText {
    fn from(point: DVec2) -> Self {
        Self::from((point.x, point.y))
    }
}
