//! Where rule files and components are found: the user's folders, then the embedded library.
//!
//! A library folder holds `rules`, `ifs`, `instancing`, `lsystems`, `initiators`, `generators` and `base_elements`, each with YAML
//! files; rules may also lie in the folder itself. The folder `schema` is for editors only.

mod file;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use include_dir::{Dir, File, include_dir};

use crate::diagnostic::{Diagnostic, Place, Source, did_you_mean};
use crate::model::Kind;

pub use file::{cannot_be_read, open_file};

static EMBEDDED: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/library");

/// What a library file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shelf {
    /// A production rule.
    Rules,
    /// An iterated function system.
    Ifs,
    /// A structure of objects that instance each other.
    Instancing,
    /// An L-system.
    LSystems,
    /// An initiator.
    Initiators,
    /// A generator.
    Generators,
    /// A base element.
    BaseElements,
}

impl Shelf {
    /// The shelf of a kind of files that can be grown.
    #[must_use]
    pub fn of(kind: Kind) -> Self {
        match kind {
            Kind::Rule => Self::Rules,
            Kind::Ifs => Self::Ifs,
            Kind::Instancing => Self::Instancing,
            Kind::LSystem => Self::LSystems,
        }
    }

    /// The shelves of what can be grown, in the order in which names are looked up.
    #[must_use]
    pub fn grown() -> [Self; Kind::ALL.len()] {
        Kind::ALL.map(Self::of)
    }

    /// The shelves of components, in the order in which names are looked up.
    pub const COMPONENTS: [Self; 3] = [Self::Initiators, Self::Generators, Self::BaseElements];

    /// All shelves, in the order in which they are listed.
    pub const ALL: [Self; 7] = [
        Self::Rules,
        Self::Ifs,
        Self::Instancing,
        Self::LSystems,
        Self::Initiators,
        Self::Generators,
        Self::BaseElements,
    ];

    /// The folder's name.
    #[must_use]
    pub fn folder(self) -> &'static str {
        match self {
            Self::Rules => "rules",
            Self::Ifs => "ifs",
            Self::Instancing => "instancing",
            Self::LSystems => "lsystems",
            Self::Initiators => "initiators",
            Self::Generators => "generators",
            Self::BaseElements => "base_elements",
        }
    }

    /// What one of its files is called: `rule`, `initiator`, `generator` or `base_element`.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Rules => "rule",
            Self::Ifs => "ifs",
            Self::Instancing => "instancing",
            Self::LSystems => "lsystem",
            Self::Initiators => "initiator",
            Self::Generators => "generator",
            Self::BaseElements => "base_element",
        }
    }

    /// The same, to be read in a sentence.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            Self::Ifs => "system",
            Self::Instancing => "structure",
            Self::LSystems => "L-system",
            Self::BaseElements => "base element",
            other => other.kind(),
        }
    }

    /// The first line of its files in the embedded library: editors find their schema by it.
    #[must_use]
    pub fn modeline(self) -> String {
        format!(
            "# yaml-language-server: $schema=../schema/{}.json",
            self.kind()
        )
    }
}

/// A file of the library.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its name, without extension.
    pub name: String,
    /// What it holds.
    pub shelf: Shelf,
    /// Where it lies; `None` if it is embedded.
    pub path: Option<PathBuf>,
}

impl Entry {
    /// Why a component is not what a rule is.
    fn refusal(&self) -> Diagnostic {
        let Self { name, shelf, .. } = self;
        let (noun, kind, folder) = (shelf.noun(), shelf.kind(), shelf.folder());
        let article = if noun.starts_with('i') { "an" } else { "a" };
        let message =
            format!("'{name}' is {article} {noun}: a component of rules, and none itself");
        Diagnostic::error(message).hint(format!(
            "a rule uses it as `{kind}: {name}`; `kfrac show {folder}/{name}` draws it, `kfrac cat \
             {folder}/{name}` prints it"
        ))
    }
}

/// The places in which rules and components are looked for, the first one first.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    folders: Vec<PathBuf>,
}

impl Catalogue {
    /// The embedded library alone.
    #[must_use]
    pub fn embedded() -> Self {
        Self::default()
    }

    /// Folders, in this order, before the embedded library.
    #[must_use]
    pub fn with_folders(folders: Vec<PathBuf>) -> Self {
        Self { folders }
    }

    /// A rule by path or by name: a file that exists wins.
    ///
    /// # Errors
    ///
    /// If there is no such rule, or it cannot be read.
    pub fn rule(&self, argument: impl AsRef<Path>) -> Result<Arc<Source>, Diagnostic> {
        let path = argument.as_ref();
        let name = path.to_string_lossy();
        match fs::metadata(path) {
            Ok(metadata) if !metadata.is_dir() => return read_file(path),
            Ok(_) if self.candidates(&Shelf::grown(), &name).is_empty() => {
                return Err(Diagnostic::error(format!(
                    "'{name}' is a folder, not a rule file"
                )));
            }
            // A link that leads nowhere is the file that is meant.
            Err(error) if path.is_symlink() => {
                return Err(cannot_be_read(path, &error));
            }
            _ => {}
        }
        if let Some(component) = self.component_named(path) {
            return Err(component.refusal());
        }
        if let Some((shelf, name)) = on_shelf(&Shelf::grown(), &name) {
            return self.named(&[shelf], name);
        }
        let looks_like_path = name.contains(['/', '\\']);
        if looks_like_path && let Err(error) = fs::metadata(path) {
            return Err(cannot_be_read(path, &error));
        }
        self.named(&Shelf::grown(), &name)
    }

    /// The component of a name that no file and nothing has that can be grown, or of one that names
    /// its folder too: `generators/koch` is the generator, where `koch` is the rule.
    #[must_use]
    pub fn component_named(&self, argument: impl AsRef<Path>) -> Option<Entry> {
        let path = argument.as_ref();
        let name = path.to_string_lossy();
        if fs::metadata(path).is_ok_and(|metadata| !metadata.is_dir()) {
            return None;
        }
        let candidates = match on_shelf(&Shelf::COMPONENTS, &name) {
            Some((shelf, name)) => self.candidates(&[shelf], name),
            None if !self.candidates(&Shelf::grown(), &name).is_empty() => return None,
            None => self.candidates(&Shelf::COMPONENTS, &name),
        };
        candidates.into_iter().next()
    }

    /// The rule that the last one of a chain extends: a file beside it or by path, or a rule by name.
    ///
    /// A name passes over the files of the chain, so that a rule can extend the one that it hides.
    pub(crate) fn parent(
        &self,
        name: &str,
        chain: &[Arc<Source>],
    ) -> Result<Arc<Source>, Diagnostic> {
        let is_path = without_extension(name) != name || name.contains(['/', '\\']);
        if is_path {
            let folder = chain.last().and_then(|rule| rule.path().parent());
            let beside = folder.unwrap_or(Path::new("")).join(name);
            if beside.is_file() {
                return read_file(&beside);
            }
        }
        // A rule that is read must not wait for what a pipe or a terminal says.
        let special = |file: fs::Metadata| !file.is_file() && !file.is_dir();
        if fs::metadata(name).is_ok_and(special) {
            return Err(Diagnostic::error(format!("'{name}' is no regular file")));
        }
        let first = self.rule(name)?;
        if is_path {
            return Ok(first);
        }
        if !chain.iter().any(|rule| is_same_file(rule, &first)) {
            return Ok(first);
        }
        for entry in self.candidates(&Shelf::grown(), name) {
            let next = self.open(&entry)?;
            if !chain.iter().any(|rule| is_same_file(rule, &next)) {
                return Ok(next);
            }
        }
        Ok(first)
    }

    /// A file of data, from the folder of the file that names it.
    pub(crate) fn data(&self, name: &str, named: &Place) -> Result<Arc<Source>, Diagnostic> {
        let folder = named.source().path().parent();
        let path = folder.unwrap_or(Path::new("")).join(name);
        // What is read must not wait for what a pipe or a terminal says.
        if path.is_file() {
            return read_file(&path);
        }
        Err(
            Diagnostic::error(format!("there is no file '{}'", path.display()))
                .hint("a list of points, or a file of two columns in the folder of this one"),
        )
    }

    /// A rule or component by name.
    ///
    /// # Errors
    ///
    /// If there is none of this name, or it cannot be read.
    pub fn component(&self, shelf: Shelf, name: &str) -> Result<Arc<Source>, Diagnostic> {
        self.named(&[shelf], name)
    }

    /// What has a name on one of some shelves.
    fn named(&self, shelves: &[Shelf], name: &str) -> Result<Arc<Source>, Diagnostic> {
        let Some(entry) = self.candidates(shelves, name).into_iter().next() else {
            // A name that ends as those of files do is that of a file.
            let is_file = shelves.len() > 1 && Path::new(name).extension().is_some();
            let message = if is_file {
                format!("there is no file '{name}', and no rule of this name in the library")
            } else {
                format!("there is no {} '{name}' in the library", shelves[0].noun())
            };
            let mut error = Diagnostic::error(message);
            let names: Vec<_> = self
                .entries()
                .into_iter()
                .filter(|entry| shelves.contains(&entry.shelf))
                .collect();
            let names = names.iter().map(|entry| entry.name.as_str());
            error = error.hint(
                did_you_mean(without_extension(name), names)
                    .unwrap_or_else(|| "`kfrac list` shows what there is".into()),
            );
            return Err(error);
        };
        self.open(&entry)
    }

    /// The text of an entry.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub fn open(&self, entry: &Entry) -> Result<Arc<Source>, Diagnostic> {
        if let Some(path) = &entry.path {
            return read_file(path);
        }
        let name = format!("{}/{}.yaml", entry.shelf.folder(), entry.name);
        let bytes = embedded(entry.shelf)
            .find(|file| file.path().as_os_str() == name.as_str())
            .map_or(&[][..], |file| file.contents());
        Source::read(format!("library/{name}"), bytes.to_vec())
    }

    /// All files of a name on some shelves; the first hides the others.
    fn candidates(&self, shelves: &[Shelf], name: &str) -> Vec<Entry> {
        let name = without_extension(name);
        let is_name = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
        if name.is_empty() || name.starts_with('.') || !name.chars().all(is_name) {
            return Vec::new();
        }
        let entry = |shelf, path| Entry {
            name: name.into(),
            shelf,
            path,
        };
        let mut found = Vec::new();
        for folder in &self.folders {
            let own = shelves.contains(&Shelf::Rules).then_some(Shelf::Rules);
            let own = own.map(|shelf| (shelf, folder.clone()));
            let shelved = shelves
                .iter()
                .map(|shelf| (*shelf, folder.join(shelf.folder())));
            for (shelf, folder) in shelved.chain(own) {
                let files = EXTENSIONS.map(|extension| folder.join(format!("{name}{extension}")));
                let files = files.into_iter().filter(|path| path.is_file());
                found.extend(files.map(|path| entry(shelf, Some(path))));
            }
        }
        for &shelf in shelves {
            let embedded = EMBEDDED.get_file(format!("{}/{name}.yaml", shelf.folder()));
            found.extend(embedded.map(|_| entry(shelf, None)));
        }
        found
    }

    /// Everything in the library, by shelf and name; what comes first hides what comes later.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        let mut entries = BTreeMap::new();
        for shelf in Shelf::ALL {
            for file in embedded(shelf) {
                add(&mut entries, shelf, file.path(), None);
            }
            for folder in self.folders.iter().rev() {
                let own = (shelf == Shelf::Rules).then(|| folder.clone());
                for folder in own.into_iter().chain([folder.join(shelf.folder())]) {
                    let files = fs::read_dir(folder).into_iter().flatten().flatten();
                    let files = files.map(|file| file.path()).filter(|path| path.is_file());
                    let mut files: Vec<_> = files.collect();
                    // Backwards, so that of two extensions the first is added last and stays.
                    files.sort_by(|a, b| b.cmp(a));
                    for path in files {
                        add(&mut entries, shelf, &path, Some(&path));
                    }
                }
            }
        }
        entries.into_values().collect()
    }
}

/// The shelf, of some, and the name in `FOLDER/NAME`.
fn on_shelf<'n>(shelves: &[Shelf], name: &'n str) -> Option<(Shelf, &'n str)> {
    let (folder, name) = name.split_once('/')?;
    let shelf = shelves.iter().find(|shelf| shelf.folder() == folder)?;
    Some((*shelf, name))
}

/// The embedded files of a shelf.
fn embedded(shelf: Shelf) -> impl Iterator<Item = &'static File<'static>> {
    EMBEDDED
        .get_dir(shelf.folder())
        .into_iter()
        .flat_map(Dir::files)
}

fn add(
    entries: &mut BTreeMap<(Shelf, String), Entry>,
    shelf: Shelf,
    file: &Path,
    path: Option<&PathBuf>,
) {
    let Some(file) = file.file_name().and_then(|file| file.to_str()) else {
        return;
    };
    let name = without_extension(file);
    if name != file && !name.is_empty() && !name.starts_with('.') {
        let entry = Entry {
            name: name.into(),
            shelf,
            path: path.cloned(),
        };
        entries.insert((shelf, name.into()), entry);
    }
}

/// What the names of library files end in; the first comes before the second.
const EXTENSIONS: [&str; 2] = [".yaml", ".yml"];

fn without_extension(name: &str) -> &str {
    let stems = EXTENSIONS.map(|extension| name.strip_suffix(extension));
    stems.into_iter().flatten().next().unwrap_or(name)
}

/// Whether two texts come from one file, by whatever paths.
pub(crate) fn is_same_file(a: &Source, b: &Source) -> bool {
    let file = |source: &Source| fs::canonicalize(source.path()).ok();
    a.text() == b.text() && (a.name() == b.name() || file(a).is_some() && file(a) == file(b))
}

fn read_file(path: &Path) -> Result<Arc<Source>, Diagnostic> {
    use std::io::Read;
    // One byte more than is allowed tells a file that is too large without reading all of it.
    let most = u64::try_from(Source::MOST_BYTES).unwrap_or(u64::MAX) + 1;
    let mut bytes = Vec::new();
    let read = open_file(path)?.take(most).read_to_end(&mut bytes);
    read.map_err(|error| cannot_be_read(path, &error))?;
    Source::read_file(path, bytes)
}
