//! The file of a text: how it is read and written, and what other programs write into it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::catalogue::read_file;
use crate::diagnostic::Diagnostic;
use crate::output_file::OutputFile;

use super::answer::Refusal;
use super::design;
use super::files::is_rule;
use super::session::Session;

/// Where a text comes from.
#[derive(Debug)]
pub(super) struct Origin {
    /// Name of the rule on the command line.
    pub(super) name: String,
    /// Name of the source in messages.
    pub(super) source_name: String,
    /// File of the rule; `None` for a copy that is not saved.
    pub(super) path: Option<PathBuf>,
    /// Text of the file when it was last read or written.
    pub(super) saved: Option<Arc<str>>,
}

impl Session {
    /// Returns the files whose changes matter.
    pub(super) fn watched(&self) -> Vec<PathBuf> {
        self.origin.path.iter().cloned().collect()
    }

    /// Reads the file again, after another program has changed it; returns whether the page has to know.
    pub(super) fn reread(&mut self) -> bool {
        // A text that is taken unasked ends what redo leads to, which must not be another file.
        let takes = !self.history.leads_to_another();
        self.compare(takes)
    }

    /// Compares the file with the text: in place of one that is saved, `takes` the text of another program, which is in
    /// conflict otherwise. Returns whether the page has to know.
    pub(super) fn compare(&mut self, takes: bool) -> bool {
        let Some(theirs) = self
            .origin
            .path
            .as_deref()
            .and_then(|path| read_text(path).ok())
        else {
            return false;
        };
        if self.origin.saved.as_ref() == Some(&theirs) {
            return self.theirs.take().is_some();
        }
        self.drop_draft();
        if theirs == *self.text() || takes && self.is_saved() {
            self.origin.saved = Some(Arc::clone(&theirs));
            self.theirs = None;
            if self.history.push(Arc::clone(&theirs)) {
                let checked = self.reader().check(theirs);
                self.take(checked);
            }
            return true;
        }
        let is_new = self.theirs.as_ref() != Some(&theirs);
        self.theirs = Some(theirs);
        is_new
    }

    /// Settles a conflict: takes the text of the other program, or keeps the own one.
    pub(super) fn settle(&mut self, takes_theirs: bool) {
        let Some(theirs) = self.theirs.take() else {
            return;
        };
        self.origin.saved = Some(Arc::clone(&theirs));
        if takes_theirs && self.history.push(Arc::clone(&theirs)) {
            let checked = self.reader().check(theirs);
            self.take(checked);
        }
    }

    /// Returns whether the file has this text.
    pub(super) fn is_saved(&self) -> bool {
        self.origin.saved.as_deref() == Some(&**self.text())
    }

    /// Writes the text: to its own file, or to another one.
    pub(super) fn save(&mut self, to: Option<&str>, replaces: bool) -> Result<PathBuf, Refusal> {
        let own = self.origin.path.clone();
        let asked = to.map(PathBuf::from).or_else(|| own.clone());
        let asked = asked.ok_or_else(|| Refusal::wrong("the copy has no file yet: give a name"))?;
        if !is_rule(&asked) {
            return Err(Refusal::wrong("a rule is saved as a .yaml, .yml or .json"));
        }
        // The own path is relative to the folder in which the program was started.
        let full = match to {
            None => std::path::absolute(&asked).unwrap_or(asked),
            Some(_) => asked,
        };
        let path = self.roots.allowed(&full)?;
        let is_own = own.is_some_and(|own| is_same(&own, &path));
        if is_own && !replaces && path.exists() {
            let Ok(on_disk) = read_text(&path) else {
                return Err(Refusal::conflict(
                    "another program has changed the file, which is no text of a rule now: save this one under another name",
                ));
            };
            if self.origin.saved.as_ref() != Some(&on_disk) {
                self.theirs = Some(on_disk);
                return Err(Refusal::conflict(
                    "another program has changed the file: take its text, or save this one under another name",
                ));
            }
        }
        if !is_own && !replaces && path.exists() {
            return Err(Refusal::conflict(format!("'{}' exists", path.display())));
        }
        write(&path, self.text())?;
        self.origin.saved = Some(Arc::clone(self.text()));
        self.theirs = None;
        if !is_own {
            self.origin.name = self.relative(&path);
            self.origin.source_name = path.display().to_string();
            self.origin.path = Some(path.clone());
            let checked = self.reader().check(Arc::clone(self.text()));
            self.take(checked);
        }
        Ok(path)
    }

    /// Saves a component of the rule in the library of the person, under a new name.
    pub(super) fn save_component(&self, panel: &str, name: &str) -> Result<(), Refusal> {
        let is_plain = |it: char| it.is_alphanumeric() || it == '-' || it == '_';
        if name.is_empty() || !name.chars().all(is_plain) {
            let message = "the name of a component consists of letters, digits, '-' and '_'";
            return Err(Refusal::wrong(message));
        }
        let new = design::component(&self.reader(), self.good()?, &self.look, panel, name)?;
        let path = self.roots.in_library(&format!("{name}.yaml"), new.shelf)?;
        if path.exists() {
            return Err(Refusal::conflict(format!("'{}' exists", path.display())));
        }
        write(&path, &new.text)
    }

    /// Returns a path from the folder in which the program was started, where it leads there.
    fn relative(&self, path: &Path) -> String {
        let here = std::env::current_dir().and_then(|here| here.canonicalize());
        let from_here = here
            .ok()
            .and_then(|here| path.strip_prefix(here).ok().map(PathBuf::from));
        from_here
            .unwrap_or_else(|| path.into())
            .display()
            .to_string()
    }
}

/// Reads a file as text, byte for byte.
pub(super) fn read_text(path: &Path) -> Result<Arc<str>, Diagnostic> {
    // Its mistakes are those of reading any rule.
    read_file(path)?;
    let bytes =
        std::fs::read(path).map_err(|error| crate::catalogue::cannot_be_read(path, &error))?;
    let text = String::from_utf8(bytes);
    Ok(text
        .map_err(|_| Diagnostic::error(format!("'{}' is no text", path.display())))?
        .into())
}

fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// Writes a file, all of it or nothing.
fn write(path: &Path, text: &str) -> Result<(), Refusal> {
    let mut file = OutputFile::create(path)?;
    let written = std::io::Write::write_all(&mut file, text.as_bytes());
    written.map_err(|error| Refusal::wrong(error.to_string()))?;
    file.finish()?;
    Ok(())
}
