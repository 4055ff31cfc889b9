//! Parameters that nothing uses: most are misspelt.

use std::collections::HashSet;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::document::HeadingDocument;

/// More parameters than this are not compared with others.
const MOST_COMPARED: usize = 100;

/// Warns of the parameters in a file that none of its expressions uses; not of those of its
/// parents and components, which other files may use.
pub(super) fn parameters(
    heading: &HeadingDocument,
    used: &HashSet<String>,
) -> impl Iterator<Item = Diagnostic> {
    let names = heading.params.iter().map(|parameter| &parameter.name);
    let (used, unused): (Vec<_>, Vec<_>) = names.partition(|name| used.contains(&name.value));
    let source = heading.place.source();
    let unused = unused
        .into_iter()
        .filter(|name| Arc::ptr_eq(name.place.source(), source));
    unused.enumerate().map(move |(number, name)| {
        let known = used.iter().map(|name| name.value.as_str());
        let meant = did_you_mean(&name.value, known.filter(|_| number < MOST_COMPARED));
        let hint = meant.unwrap_or_else(|| "leave it out, or use it in an expression".into());
        let message = format!("nothing uses the parameter '{}'", name.value);
        Diagnostic::warning(message).at(&name.place).hint(hint)
    })
}
