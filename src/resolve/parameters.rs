//! Resolution of parameters.

use std::collections::{BTreeMap, BTreeSet};

use crate::document::{MetadataDocument, ParameterDocument, Setting, Written, WrittenNumber};
use crate::expression::{PARTS, Program, Scope, is_name, is_reserved};
use crate::metadata::Parameter;
use crate::rule::ElementContext;

use super::Resolver;

impl<K> Resolver<K> {
    /// Resolves the parameters and adds them to the scope of expressions. Returns them with their values as
    /// written, which are in the order of dependence.
    pub(super) fn parameters(
        &mut self,
        document: &MetadataDocument,
        settings: &[Setting],
    ) -> (Vec<Parameter>, Vec<Program>) {
        if !document.complete {
            self.constants.accept_any_name();
        }
        let count = document.params.len();
        let mut parameters: Vec<Option<Parameter>> = vec![None; count];
        let (order, cyclic) = order(&document.params);
        for &index in &cyclic {
            let ParameterDocument { name, value, .. } = &document.params[index];
            let message = format!("the value of '{}' depends on itself", name.value);
            self.error(&value.place, message);
            self.constants.unknown_value(&name.value);
        }
        let mut numbers = Vec::new();
        for index in order {
            let written = &document.params[index];
            self.check_name(written);
            let name = &written.name.value;
            let set = settings.iter().rfind(|setting| setting.name == *name);
            let parameter = self.parameter(written, set);
            match parameter.value {
                Some(value) => self.constants.parameter(name, value, numbers.len()),
                None => self.constants.unknown_value(name),
            }
            numbers.push(parameter.written);
            parameters[index] = Some(Parameter {
                name: name.clone(),
                value: parameter.value.unwrap_or(f64::NAN),
                min: parameter.min,
                max: parameter.max,
                about: written.about.clone(),
            });
        }
        (parameters.into_iter().flatten().collect(), numbers)
    }

    fn check_name(&mut self, written: &ParameterDocument) {
        // The name of a complex parameter is checked with its real part.
        if written.whole.is_some() && written.name.value.ends_with(PARTS[1]) {
            return;
        }
        let Written { value: name, place } = written.called();
        if !is_name(name) {
            let message = format!("'{name}' cannot be a parameter's name");
            let hint = "a name has letters, digits and _, and begins with a letter";
            self.error_with_hint(place, message, hint);
        } else if is_reserved(name) || ElementContext::NAMES.contains(&name.as_str()) {
            let message = format!("'{name}' has a meaning of its own in expressions");
            self.error_with_hint(place, message, "give the parameter another name");
        }
    }

    fn parameter(&mut self, written: &ParameterDocument, set: Option<&Setting>) -> Values {
        let name = &written.name.value;
        let default = self.constant_program(&written.value);
        let as_set = |setting: &Setting| match &setting.written {
            Some(written) => written.compile(&Scope::new()).ok(),
            None => Some(Program::constant(setting.value)),
        };
        let mut limit = |number: &Option<_>| number.as_ref().and_then(|n| self.constant(n));
        let (min, max) = (limit(&written.min), limit(&written.max));
        let mut value = (set.map(|setting| setting.value)).or(default.as_constant());
        // A refused value is unknown, so that values computed from it are not reported.
        if let (Some(low), Some(high), Some(number)) = (min, max, &written.min)
            && low > high
        {
            let message =
                format!("the limits of '{name}' are upside down: min {low} is above max {high}");
            self.error_with_hint(&number.place, message, format!("min: {high}, max: {low}"));
            value = None;
        } else if let Some(given) = value {
            let beyond = match (min, max) {
                (Some(low), _) if given < low => Some(("below its least", low)),
                (_, Some(high)) if given > high => Some(("above its largest", high)),
                _ => None,
            };
            let allowed = match (min, max) {
                (Some(low), Some(high)) => format!("from {low} to {high}"),
                (Some(low), None) => format!("at least {low}"),
                (None, high) => format!("at most {}", high.unwrap_or(f64::INFINITY)),
            };
            let at = set.map_or(&written.value.place, |set| {
                set.place.as_ref().unwrap_or(&written.name.place)
            });
            if let Some((where_to, limit)) = beyond {
                let message = format!("'{name}' is {given}, {where_to} value {limit}");
                self.error_with_hint(at, message, allowed);
                value = None;
            }
        }
        Values {
            value,
            written: set.and_then(as_set).unwrap_or(default),
            min,
            max,
        }
    }
}

/// Returns the indices of the parameters in an order in which each follows those that its value and
/// limits depend on, and the indices of those that depend on themselves.
pub(super) fn order(params: &[ParameterDocument]) -> (Vec<usize>, Vec<usize>) {
    let names = params.iter().enumerate();
    let numbers: BTreeMap<&str, usize> = names
        .map(|(index, param)| (param.name.value.as_str(), index))
        .collect();
    let mut waits_for = vec![0; params.len()];
    let mut needed_by = vec![Vec::new(); params.len()];
    let mut needs = vec![Vec::new(); params.len()];
    for (index, param) in params.iter().enumerate() {
        let numbers_of = |number: &WrittenNumber| -> Vec<usize> {
            // A formula of complex numbers needs both parts.
            let names = { number.value.names().into_iter() }
                .flat_map(|(name, _)| ["", PARTS[0], PARTS[1]].map(|part| format!("{name}{part}")));
            names
                .filter_map(|name| numbers.get(name.as_str()).copied())
                .collect()
        };
        let written = [Some(&param.value), param.min.as_ref(), param.max.as_ref()];
        for needed in written.into_iter().flatten().flat_map(numbers_of) {
            waits_for[index] += 1;
            needed_by[needed].push(index);
            needs[index].push(needed);
        }
    }
    let mut ready: BTreeSet<usize> = (0..params.len())
        .filter(|&index| waits_for[index] == 0)
        .collect();
    let mut order = Vec::new();
    while let Some(index) = ready.pop_first() {
        order.push(index);
        for &waiting in &needed_by[index] {
            waits_for[waiting] -= 1;
            if waits_for[waiting] == 0 {
                ready.insert(waiting);
            }
        }
    }
    let waiting = |index: usize| waits_for[index] > 0;
    let mut left: BTreeSet<usize> = (0..params.len()).filter(|&index| waiting(index)).collect();
    // Parameters that only depend on a cycle do not lie on it: nothing on it depends on them.
    let mut needed: Vec<usize> = needed_by
        .iter()
        .map(|others| others.iter().filter(|&&other| waiting(other)).count())
        .collect();
    let mut outside: Vec<usize> = left
        .iter()
        .copied()
        .filter(|&index| needed[index] == 0)
        .collect();
    let mut peeled = Vec::new();
    while let Some(index) = outside.pop() {
        left.remove(&index);
        peeled.push(index);
        for &other in needs[index].iter().filter(|&&other| waiting(other)) {
            needed[other] -= 1;
            if needed[other] == 0 {
                outside.push(other);
            }
        }
    }
    // A parameter was removed after those that depend on it.
    order.extend(peeled.into_iter().rev());
    (order, left.into_iter().collect())
}

/// Values of a parameter, as far as they are known.
struct Values {
    value: Option<f64>,
    written: Program,
    min: Option<f64>,
    max: Option<f64>,
}
