//! The session: what the page shows, and what a reload finds again.

use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::kind::Kind;

use super::StudioOptions;
use super::answer::Refusal;
use super::design::{self, Act, Hand, Scene};
use super::drawing::Wholes;
use super::files::Roots;
use super::good::{Checked, Good, Reader};
use super::history::{History, Left, Settings};
use super::look::Look;
use super::numbers::Numbers;
use super::origin::{Origin, read_text};
use super::problems::Problem;
use super::server::Seen;
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
    pub(super) origin: Origin,
    pub(super) history: History,
    /// Text while a hand drags, which is no entry of the history yet.
    draft: Option<Arc<str>>,
    /// State before a hand dragged.
    kept: Option<(Good, Look)>,
    pub(super) hand: Hand,
    /// Number of changes of the text.
    pub(super) revision: u64,
    /// Revision with which the present file was opened.
    pub(super) file: u64,
    /// Text that another program has written while this one was not saved.
    pub(super) theirs: Option<Arc<str>>,
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
    /// Members near a revision of the text.
    pub(super) variants: (u64, Vec<Variant>),
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
            origin: Origin {
                name: rule.to_string_lossy().into_owned(),
                source_name: source.name().to_owned(),
                saved: path.is_some().then(|| Arc::clone(&text)),
                path,
            },
            history: History::new(Arc::clone(&text)),
            draft: None,
            kept: None,
            hand: Hand::default(),
            revision: 0,
            file: 0,
            theirs: None,
            look,
            good: None,
            problems: Vec::new(),
            window: None,
            sight: None,
            numbers: None,
            pace: Pace::default(),
            wholes: Arc::default(),
            variants: Default::default(),
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
            name: self.origin.source_name.clone(),
        }
    }

    /// Shows a text that has been read.
    pub(super) fn take(&mut self, checked: Checked) {
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
            if revision < self.file || !self.is_saved() {
                return Err(Refusal::changed());
            }
            if self.origin.saved.as_ref() != Some(&checked.text) {
                self.theirs = self.origin.saved.take();
            }
        }
        self.drop_draft();
        if self.history.push(Arc::clone(&checked.text)) {
            self.take(checked);
        }
        Ok(())
    }

    /// Goes back or forth in the history; returns whether there is such a text.
    ///
    /// A text of another file has that file, and its look.
    pub(super) fn travel(&mut self, is_back: bool) -> bool {
        self.drop_draft();
        let Some(is_other) = self.step(is_back) else {
            return false;
        };
        let checked = self.reader().check(Arc::clone(self.history.text()));
        if is_other {
            self.forget_file();
        }
        self.take(checked);
        if is_other {
            // Another program may have changed the file meanwhile. The text is that of the history in any case.
            self.compare(false);
        }
        true
    }

    /// Goes back or forth by a text that is not read yet; returns whether it is one of another file, if there is a text.
    fn step(&mut self, is_back: bool) -> Option<bool> {
        let change = match is_back {
            true => self.history.undo(),
            false => self.history.redo(),
        }?;
        if let Some(left) = &mut change.left {
            std::mem::swap(&mut left.origin, &mut self.origin);
            std::mem::swap(&mut left.look, &mut self.look);
            return Some(true);
        }
        if is_back {
            for (name, value) in &change.written {
                let value = || value.clone();
                self.look.set.entry(name.clone()).or_insert_with(value);
            }
        } else {
            let is_set = |name: &String, _: &mut String| !change.written.contains_key(name);
            self.look.set.retain(is_set);
        }
        Some(false)
    }

    /// Opens a text as a copy that is not saved.
    pub(super) fn copy(&mut self, name: &str, source: &Arc<Source>) {
        self.drop_draft();
        // A copy that a fit opens, unasked, must not end the texts of a file to which redo leads.
        if self.history.leads_to_another() {
            while self.step(false).is_some() {}
        }
        self.forget_file();
        let text: Arc<str> = source.text().into();
        let origin = Origin {
            name: name.to_owned(),
            source_name: source.name().to_owned(),
            path: None,
            saved: None,
        };
        let left = Left {
            origin: std::mem::replace(&mut self.origin, origin),
            look: std::mem::take(&mut self.look),
        };
        let checked = self.reader().check(Arc::clone(&text));
        self.history.open(text, left);
        self.take(checked);
    }

    /// Forgets what depends on the file that is left. The next revision is the first one of another file.
    fn forget_file(&mut self) {
        self.file = self.revision + 1;
        self.theirs = None;
        self.window = None;
        self.sight = None;
        self.good = None;
    }

    /// Refuses a request about another file than the present one.
    pub(super) fn check_file(&self, seen: Seen) -> Result<(), Refusal> {
        match seen.0.is_none_or(|file| file == self.file) {
            true => Ok(()),
            false => Err(Refusal::changed()),
        }
    }

    /// Returns a member near the present text.
    pub(super) fn variant(&self, number: usize) -> Result<&Variant, Refusal> {
        let (revision, variants) = &self.variants;
        if *revision != self.revision {
            return Err(Refusal::changed());
        }
        let none = || Refusal::wrong("there is no such member");
        variants.get(number).ok_or_else(none)
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
            "file": self.file,
            "name": self.origin.name,
            "path": self.origin.path,
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
