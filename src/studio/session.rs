//! The session: what the page shows, and what a reload finds again.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use crate::catalogue::{Catalogue, read_file};
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::kind::Kind;
use crate::output_file::OutputFile;

use super::StudioOptions;
use super::answer::Refusal;
use super::design::{self, Act, Hand, Scene};
use super::drawing::Wholes;
use super::files::{Roots, is_rule};
use super::good::{Checked, Good, Reader};
use super::history::{History, Settings};
use super::look::Look;
use super::numbers::Numbers;
use super::problems::Problem;
use super::shots::Pace;
use super::sight::Sight;
use super::underlay::Underlay;
use super::vary::Variant;
use super::view::View;

/// State of a studio.
#[derive(Debug)]
pub(super) struct Session {
    pub(super) catalogue: Catalogue,
    pub(super) roots: Roots,
    /// Name of the rule on the command line, and of its source in messages.
    pub(super) name: String,
    source_name: String,
    /// File of the rule; `None` for a copy that is not saved.
    path: Option<PathBuf>,
    history: History,
    /// Text while a hand drags, which is no entry of the history yet.
    draft: Option<Arc<str>>,
    /// State before a hand dragged.
    kept: Option<(Good, Look)>,
    pub(super) hand: Hand,
    /// Number of changes of the text.
    pub(super) revision: u64,
    /// Text of the file when it was last read or written.
    saved: Option<Arc<str>>,
    /// Text that another program has written while this one was not saved.
    theirs: Option<Arc<str>>,
    pub(super) look: Look,
    /// The last text without mistakes.
    good: Option<Good>,
    problems: Vec<Problem>,
    /// Part of the plane that the last picture showed.
    pub(super) window: Option<[f64; 4]>,
    /// Part of space that it showed.
    pub(super) sight: Option<Sight>,
    pub(super) numbers: Option<(Key, Arc<Numbers>)>,
    pub(super) pace: Pace,
    pub(super) wholes: Arc<Wholes>,
    pub(super) variants: Vec<Variant>,
    /// Picture under the figures of the design.
    pub(super) underlay: Option<Underlay>,
}

/// Revision of the text and settings, on which forecast and dimension depend.
pub(super) type Key = (u64, Vec<String>);

impl Session {
    /// Opens a rule.
    pub(super) fn open(options: StudioOptions) -> Result<Self, Diagnostics> {
        let StudioOptions {
            rule,
            catalogue,
            library,
            settings,
            seed,
            ..
        } = options;
        let rule = rule.unwrap_or_else(|| "pythagoras".into());
        let source = catalogue.rule(&rule)?;
        let path = rule.is_file().then(|| rule.clone());
        let folder = path.as_deref().and_then(Path::parent);
        let folder = folder.filter(|folder| *folder != Path::new(""));
        let start = folder.unwrap_or(Path::new("."));
        let start = start.canonicalize().map_err(|error| {
            Diagnostic::error(format!("the folder '{}': {error}", start.display()))
        })?;
        let text: Arc<str> = match &path {
            // As it is on the disk, with its byte order mark.
            Some(path) => read_text(path)?,
            None => source.text().into(),
        };
        let set = settings.iter().filter_map(|it| it.split_once('='));
        let set = set.map(|(name, value)| (name.to_owned(), value.to_owned()));
        let look = Look {
            seed,
            set: set.collect(),
            ..Look::default()
        };
        let mut session = Self {
            catalogue,
            roots: Roots { start, library },
            name: rule.to_string_lossy().into_owned(),
            source_name: source.name().to_owned(),
            saved: path.is_some().then(|| Arc::clone(&text)),
            path,
            history: History::new(Arc::clone(&text)),
            draft: None,
            kept: None,
            hand: Hand::default(),
            revision: 0,
            theirs: None,
            look,
            good: None,
            problems: Vec::new(),
            window: None,
            sight: None,
            numbers: None,
            pace: Pace::default(),
            wholes: Arc::default(),
            variants: Vec::new(),
            underlay: None,
        };
        let checked = session.reader().check(text);
        session.take(checked);
        Ok(session)
    }

    /// Returns the reader of texts of this rule, which works without the session.
    pub(super) fn reader(&self) -> Reader {
        Reader {
            catalogue: self.catalogue.clone(),
            name: self.source_name.clone(),
        }
    }

    fn take(&mut self, checked: Checked) {
        self.revision += 1;
        self.problems = checked.problems;
        if let Some(good) = checked.good {
            let known = |name: &str| {
                good.parameters
                    .iter()
                    .any(|it| it.name == name || it.whole.as_deref() == Some(name))
            };
            self.look.set.retain(|name, _| known(name));
            self.look.film.retain(known);
            self.good = Some(Good {
                revision: self.revision,
                ..good
            });
            self.wholes.forget();
        }
    }

    /// Returns the text.
    pub(super) fn text(&self) -> &Arc<str> {
        self.draft.as_ref().unwrap_or_else(|| self.history.text())
    }

    /// Returns the text before a hand dragged.
    pub(super) fn kept_text(&self) -> &Arc<str> {
        self.history.text()
    }

    /// Returns the state before a hand dragged.
    pub(super) fn kept(&self) -> Result<(&Good, &Look), Refusal> {
        let kept = self.kept.as_ref().map(|(good, look)| (good, look));
        kept.map_or_else(|| Ok((self.good()?, &self.look)), Ok)
    }

    /// Keeps what there is, before a hand drags.
    pub(super) fn keep(&mut self) -> Result<(), Refusal> {
        self.kept = Some((self.good()?.clone(), self.look.clone()));
        Ok(())
    }

    /// Shows a text while a hand drags.
    pub(super) fn show_draft(&mut self, checked: Checked) {
        self.draft = Some(Arc::clone(&checked.text));
        self.take(checked);
    }

    /// Makes the text of a hand that has dragged an entry of the history.
    pub(super) fn keep_draft(&mut self) {
        let kept = self.kept.take();
        if let Some(draft) = self.draft.take()
            && self.history.push(draft)
            && let Some((_, look)) = kept
        {
            self.note_written(look.set);
        }
    }

    /// Notes which of the values that were set before the present text was added are not set any more.
    pub(super) fn note_written(&mut self, mut before: Settings) {
        before.retain(|name, _| !self.look.set.contains_key(name));
        self.history.note_written(before);
    }

    /// Goes back to the text before a hand dragged.
    pub(super) fn drop_draft(&mut self) {
        self.hand.let_go();
        let kept = self.kept.take();
        if self.draft.take().is_some() {
            let checked = self.reader().check(Arc::clone(self.history.text()));
            self.take(checked);
            self.look = kept.map_or_else(|| self.look.clone(), |(_, look)| look);
        }
    }

    /// Returns the handles of the design.
    pub(super) fn scene(&self) -> Result<Scene, Refusal> {
        let good = self.good()?;
        if good.revision != self.revision {
            let message = "the text has mistakes: there is nothing to take hold of";
            return Err(Refusal::wrong(message));
        }
        let mut scene = design::scene(good, &self.look, self.hand.view);
        if let Some(underlay) = self.underlay.as_ref().filter(|_| !good.is_in_space) {
            scene.lay(underlay.frame());
        }
        Ok(scene)
    }

    /// Changes the text by a gesture.
    pub(super) fn act(&mut self, act: &Act) -> Result<(), Refusal> {
        self.drop_draft();
        let text = Arc::clone(self.text());
        // Only a text without mistakes has handles.
        self.scene()?;
        let checked = design::acted(
            &self.reader(),
            (self.good()?, &self.look, self.hand.view),
            &text,
            act,
        )?;
        self.set_text(checked, self.revision)
    }

    /// Replaces the text; `revision` is the one on which the change is based.
    ///
    /// A text that another program has saved in the meantime is in conflict with it. Any other change is an error.
    pub(super) fn set_text(&mut self, checked: Checked, revision: u64) -> Result<(), Refusal> {
        if revision != self.revision {
            if !self.is_saved() {
                return Err(Refusal::conflict("the text has changed in the meantime"));
            }
            if self.saved.as_ref() != Some(&checked.text) {
                self.theirs = self.saved.take();
            }
        }
        self.drop_draft();
        if self.history.push(Arc::clone(&checked.text)) {
            self.take(checked);
        }
        Ok(())
    }

    /// Goes back or forth in the history; returns whether there is such a text.
    pub(super) fn travel(&mut self, is_back: bool) -> bool {
        self.drop_draft();
        let set = &mut self.look.set;
        if is_back {
            let Some(values) = self.history.undo() else {
                return false;
            };
            for (name, value) in values {
                set.entry(name.clone()).or_insert_with(|| value.clone());
            }
        } else {
            let Some(values) = self.history.redo() else {
                return false;
            };
            set.retain(|name, _| !values.contains_key(name));
        }
        let checked = self.reader().check(Arc::clone(self.history.text()));
        self.take(checked);
        true
    }

    /// Opens a text as a copy that is not saved.
    pub(super) fn copy(&mut self, name: &str, source: &Arc<Source>) {
        self.drop_draft();
        self.name = name.to_owned();
        self.source_name = source.name().to_owned();
        self.path = None;
        self.saved = None;
        self.theirs = None;
        self.window = None;
        self.sight = None;
        self.look = Look::default();
        self.good = None;
        let text: Arc<str> = source.text().into();
        let checked = self.reader().check(Arc::clone(&text));
        self.history.push(text);
        self.take(checked);
    }

    /// Returns the files whose changes matter.
    pub(super) fn watched(&self) -> Vec<PathBuf> {
        self.path.iter().cloned().collect()
    }

    /// Reads the file again, after another program may have changed it; returns whether the page has to know.
    pub(super) fn reread(&mut self) -> bool {
        let Some(theirs) = self.path.as_deref().and_then(|path| read_text(path).ok()) else {
            return false;
        };
        if self.saved.as_ref() == Some(&theirs) {
            return self.theirs.take().is_some();
        }
        self.drop_draft();
        if self.is_saved() || theirs == *self.text() {
            self.saved = Some(Arc::clone(&theirs));
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
        self.saved = Some(Arc::clone(&theirs));
        if takes_theirs && self.history.push(Arc::clone(&theirs)) {
            let checked = self.reader().check(theirs);
            self.take(checked);
        }
    }

    fn is_saved(&self) -> bool {
        self.saved.as_deref() == Some(&**self.text())
    }

    /// Writes the text: to its own file, or to another one.
    pub(super) fn save(&mut self, to: Option<&str>, replaces: bool) -> Result<PathBuf, Refusal> {
        let own = self.path.clone();
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
            if self.saved.as_ref() != Some(&on_disk) {
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
        self.saved = Some(Arc::clone(self.text()));
        self.theirs = None;
        if !is_own {
            self.name = self.relative(&path);
            self.source_name = path.display().to_string();
            self.path = Some(path.clone());
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

    /// Returns the kind of the last good text.
    pub(super) fn kind(&self) -> Kind {
        self.good.as_ref().map_or(Kind::Rule, |good| good.kind)
    }

    /// Returns the last good text; an error if there has been none yet.
    pub(super) fn good(&self) -> Result<&Good, Refusal> {
        { self.good.as_ref() }
            .ok_or_else(|| Refusal::wrong("there is nothing to draw: the text has mistakes"))
    }

    /// Returns the revision of the last good text.
    pub(super) fn good_revision(&self) -> u64 {
        self.good.as_ref().map_or(0, |good| good.revision)
    }

    /// Returns the magnification of the picture.
    pub(super) fn factor(&self) -> f64 {
        match &self.good {
            Some(good) if good.is_in_space => super::sight::zoom(&self.look),
            _ => self.look.view.as_ref().map_or(1.0, View::factor),
        }
    }

    /// Returns what the page shows besides pictures and numbers.
    pub(super) fn state(&self) -> Value {
        let good = self.good.as_ref();
        json!({
            "revision": self.revision,
            "name": self.name,
            "path": self.path,
            "start": self.roots.start,
            "library": self.roots.library,
            "isSaved": self.is_saved(),
            "text": &**self.text(),
            "theirs": self.theirs.as_deref(),
            "canUndo": self.history.can_undo(),
            "canRedo": self.history.can_redo(),
            "problems": self.problems,
            "isGood": good.is_some_and(|good| good.revision == self.revision),
            "hasGood": good.is_some(),
            "kind": good.map(|good| good.kind.full_name()),
            "isInSpace": good.is_some_and(|good| good.is_in_space),
            "isSystem": good.is_some_and(|good| good.kind == Kind::Ifs),
            "about": good.map(|good| &good.about),
            "style": good.map(|good| &good.style),
            "parameters": good.map(|good| &good.parameters),
            "look": self.look,
            "factor": self.factor(),
            "isLimit": good.is_some_and(Good::is_limit),
            "design": self.scene().ok(),
            "hand": self.hand.state(),
            "underlay": self.underlay.as_ref().map(Underlay::state),
        })
    }
}

/// Reads a file as text, byte for byte.
fn read_text(path: &Path) -> Result<Arc<str>, Diagnostic> {
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
