//! Components on the command line, in place of those of a rule: the libraries of initiators, generators and base
//! elements combined without a file.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use crate::diagnostic::Source;

use super::{Failure, redrawn};

/// Components in place of those of a rule.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Components")]
pub(super) struct ExchangedComponents {
    /// Initiator in place of that of the rule: a component of the library, or a file
    #[arg(long, value_name = "NAME")]
    initiator: Option<String>,
    /// Generator in place of those of the rule: a component of the library, or a file
    #[arg(long, value_name = "NAME")]
    generator: Option<String>,
    /// Base element in place of that of the rule: a component of the library, or a file
    #[arg(long, value_name = "NAME")]
    base_element: Option<String>,
}

impl ExchangedComponents {
    /// Returns the text of a rule that extends `rule` by the components; `None` if there are none.
    pub(super) fn exchanged(&self, rule: &Path) -> Result<Option<Arc<Source>>, Failure> {
        let given = [
            ("initiator", &self.initiator),
            ("generator", &self.generator),
            ("base_element", &self.base_element),
        ];
        let given = given.map(|(key, name)| name.as_ref().map(|name| (key, name)));
        let given: Vec<_> = given.into_iter().flatten().collect();
        let Some((key, _)) = given.first() else {
            return Ok(None);
        };
        if rule == Path::new("-") || redrawn::format(rule).is_some() {
            let option = key.replace('_', "-");
            let message = format!(
                "--{option} exchanges a component of a rule file, or of a rule in the library"
            );
            return Err(Failure::Usage(message));
        }
        let quoted = |text: &str| serde_json::Value::from(text).to_string();
        let mut text = format!("extends: {}\n", quoted(&rule.to_string_lossy()));
        for (key, name) in given {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{key}: {}", quoted(name));
        }
        Ok(Some(Source::read("<command line>", text.into_bytes())?))
    }
}
