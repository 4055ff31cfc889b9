//! Runs of `kfrac grow` in one process.

use std::sync::{Arc, Mutex, PoisonError};

use crate::catalogue::Catalogue;
use crate::document::Document;

use super::super::Failure;
use super::super::held::{self, Held};
use super::Arguments;
use super::plan::Plan;

/// Runs of the command with many arguments for one rule, which is read once.
pub(in crate::cli) struct Runs<'a> {
    document: Arc<Document>,
    catalogue: &'a Catalogue,
    parser: Mutex<held::Parser<Arguments>>,
}

impl<'a> Runs<'a> {
    pub(in crate::cli) fn new(document: Arc<Document>, catalogue: &'a Catalogue) -> Self {
        Self {
            document,
            catalogue,
            parser: Mutex::new(held::Parser::new("grow")),
        }
    }

    /// Runs the command as [`hold`](super::hold) does.
    pub(in crate::cli) fn hold(
        &self,
        arguments: &[String],
        held: Arc<Held>,
    ) -> Result<(), Failure> {
        let mut arguments = {
            let mut parser = self.parser.lock().unwrap_or_else(PoisonError::into_inner);
            parser.parse(arguments)?
        };
        arguments.growth.held = Some(held);
        let plan = Plan::of(&arguments)?;
        let document = Arc::clone(&self.document);
        let loaded = arguments.resolve(document, self.catalogue, true)?;
        arguments.grow(&plan, loaded).map(|_| ())
    }
}
