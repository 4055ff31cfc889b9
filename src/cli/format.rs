//! Formats of output files: as requested, or from the extension.

use std::path::Path;

use crate::style::Named;

use super::Failure;

/// Returns the requested format, or that of the extension of the path, or the first one.
pub(super) fn choose<F: Named>(asked: Option<F>, output: Option<&Path>) -> Result<F, Failure> {
    let extension = output
        .filter(|path| *path != Path::new("-"))
        .and_then(Path::extension);
    let (Some(extension), None) = (extension, asked) else {
        return Ok(asked.unwrap_or(F::NAMES[0].1));
    };
    let extension = extension.to_string_lossy().to_lowercase();
    F::from_name(&extension).ok_or_else(|| {
        let known: Vec<_> = F::NAMES
            .iter()
            .map(|(name, _)| format!(".{name}"))
            .collect();
        let known = match known.split_last() {
            Some((last, others)) if !others.is_empty() => {
                format!("{} and {last} are", others.join(", "))
            }
            _ => format!("{} is", known.concat()),
        };
        Failure::Usage(format!(
            "the format '.{extension}' is not known here: {known} (or use --format)"
        ))
    })
}
