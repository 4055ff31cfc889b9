//! Parameters.

use crate::document::{ParameterDocument, RuleDocument, Setting};
use crate::expression::is_reserved;

use super::super::{Moment, Parameter};
use super::{Resolver, is_name};

impl Resolver {
    /// The parameters, which expressions see from here on.
    pub(super) fn parameters(
        &mut self,
        document: &RuleDocument,
        settings: &[Setting],
    ) -> Vec<Parameter> {
        // A value may be computed from the parameters before it.
        if !document.complete {
            self.constants.accept_any_name();
        }
        let mut parameters: Vec<Parameter> = Vec::new();
        for written in &document.params {
            self.check_name(written);
            let name = &written.name.value;
            let set = settings.iter().rfind(|setting| setting.name == *name);
            let parameter = self.parameter(written, set);
            match parameter.value {
                Some(value) => self.constants.constant(name, value),
                None => self.constants.unknown_value(name),
            }
            parameters.push(Parameter {
                name: name.clone(),
                value: parameter.value.unwrap_or(f64::NAN),
                min: parameter.min,
                max: parameter.max,
                about: written.about.clone(),
            });
        }
        parameters
    }

    fn check_name(&mut self, written: &ParameterDocument) {
        let (name, place) = (&written.name.value, &written.name.place);
        if !is_name(name) {
            let message = format!("'{name}' cannot be a parameter's name");
            let hint = "a name has letters, digits and _, and begins with a letter";
            self.error_with_hint(place, message, hint);
        } else if is_reserved(name) || Moment::NAMES.contains(&name.as_str()) {
            let message = format!("'{name}' has a meaning of its own in expressions");
            self.error_with_hint(place, message, "give the parameter another name");
        }
    }

    fn parameter(&mut self, written: &ParameterDocument, set: Option<&Setting>) -> Values {
        let name = &written.name.value;
        let default = self.constant(&written.value);
        let mut limit = |number: &Option<_>| number.as_ref().and_then(|n| self.constant(n));
        let (min, max) = (limit(&written.min), limit(&written.max));
        let value = set.map(|setting| setting.value).or(default);
        if let (Some(low), Some(high), Some(number)) = (min, max, &written.min)
            && low > high
        {
            let message =
                format!("the limits of '{name}' are upside down: min {low} is above max {high}");
            self.error_with_hint(&number.place, message, format!("min: {high}, max: {low}"));
        } else if let Some(value) = value {
            let beyond = match (min, max) {
                (Some(low), _) if value < low => Some(("below its least", low)),
                (_, Some(high)) if value > high => Some(("above its largest", high)),
                _ => None,
            };
            let at = set.map_or(&written.value.place, |_| &written.name.place);
            if let Some((where_to, limit)) = beyond {
                self.error(at, format!("'{name}' is {value}, {where_to} value {limit}"));
            }
        }
        Values { value, min, max }
    }
}

/// What can be told of a parameter.
struct Values {
    value: Option<f64>,
    min: Option<f64>,
    max: Option<f64>,
}
