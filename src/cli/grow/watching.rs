//! `--watch` and `--open`: output that follows its files, in the program that shows it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context;

use crate::catalogue::Catalogue;

use super::super::watch::Watch;
use super::super::{Failure, report};
use super::Arguments;
use super::plan::Plan;

/// Writes the output whenever a file of the rule changes. Mistakes are reported, and the output stays as it is.
pub(super) fn run(
    arguments: &Arguments,
    plan: &Plan,
    catalogue: &Catalogue,
) -> Result<(), Failure> {
    let rule = &arguments.rule.rule;
    if !rule.is_file() {
        let message = format!("--watch follows a file, and '{}' is none", rule.display());
        return Err(Failure::Usage(message));
    }
    let mut watch = Watch::new().context("files cannot be watched")?;
    let mut files = vec![rule.clone()];
    let mut is_open = !arguments.open;
    loop {
        let mut found = Vec::new();
        let written = arguments.run_once(plan, catalogue, &mut found);
        if !found.is_empty() {
            files = found;
        }
        let all = files.iter().chain([rule]).map(PathBuf::as_path);
        watch.set(all).context("files cannot be watched")?;
        match written {
            Ok(path) if !is_open => {
                open(&path)?;
                is_open = true;
            }
            Ok(_) => {}
            Err(failure @ Failure::Usage(_)) => return Err(failure),
            Err(failure) => {
                report(&failure);
            }
        }
        while !watch.wait(Duration::from_secs(86_400)) {}
    }
}

/// Opens a file in the program that the system has for it.
pub(super) fn open(path: &Path) -> Result<(), Failure> {
    let opened = open::that_detached(path);
    Ok(opened.with_context(|| format!("'{}' cannot be opened", path.display()))?)
}
