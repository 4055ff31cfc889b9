//! Warnings of unused parameters, most of which are misspelt.

use std::collections::HashSet;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::document::{MetadataDocument, ParameterDocument};
use crate::expression::PARTS;

/// Maximum number of parameters for which a similar name is searched.
const MAX_COMPARED: usize = 100;

/// Returns warnings of the parameters in a file that none of its expressions uses. Parameters of its
/// parents and components are excluded, because other files may use them.
pub(super) fn parameters(
    metadata: &MetadataDocument,
    used: &HashSet<String>,
) -> impl Iterator<Item = Diagnostic> {
    let is_used = |parameter: &&ParameterDocument| match &parameter.whole {
        None => used.contains(&parameter.name.value),
        Some(whole) => ["", PARTS[0], PARTS[1]]
            .iter()
            .any(|part| used.contains(&format!("{}{part}", whole.value))),
    };
    let (used, unused): (Vec<_>, Vec<_>) = metadata.params.iter().partition(is_used);
    let source = metadata.place.source();
    // A complex parameter is reported once, by its real part.
    let is_second =
        |it: &&ParameterDocument| it.whole.is_some() && it.name.value.ends_with(PARTS[1]);
    let unused = unused
        .into_iter()
        .filter(move |it| !is_second(it))
        .map(ParameterDocument::called)
        .filter(|name| Arc::ptr_eq(name.place.source(), source));
    unused.enumerate().map(move |(number, name)| {
        let known = used.iter().map(|it| it.called().value.as_str());
        let meant = did_you_mean(&name.value, known.filter(|_| number < MAX_COMPARED));
        let hint = meant.unwrap_or_else(|| "leave it out, or use it in an expression".into());
        let message = format!("nothing uses the parameter '{}'", name.value);
        Diagnostic::warning(message).at(&name.place).hint(hint)
    })
}
