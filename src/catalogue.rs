//! Lookup of library files by name or path: in the user's folders first, then in the embedded library.
//!
//! A library folder has the subfolders `rules`, `ifs`, `instancing`, `lsystems`, `initiators`,
//! `generators` and `base_elements`, which hold YAML files; rules may also lie in the folder itself.
//! The folder `schema` of the embedded library is for editors only.
//!
//! The embedded library has the following files.
#![doc = include_str!(concat!(env!("OUT_DIR"), "/names.md"))]

mod description;
mod file;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place, Source, did_you_mean};
use crate::kind::Kind;

pub use file::{cannot_be_read, open_file};

/// The embedded library: files with their paths in it, sorted by path.
const EMBEDDED: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/library.rs"));

/// Category of a library file: the folder in which it lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Shelf {
    /// Complete fractals of a kind.
    Fractals(Kind),
    /// Initiators.
    Initiators,
    /// Generators.
    Generators,
    /// Base elements.
    BaseElements,
}

impl Shelf {
    /// Production rules.
    pub const RULES: Self = Self::Fractals(Kind::Rule);
    /// Iterated function systems.
    pub const IFS: Self = Self::Fractals(Kind::Ifs);
    /// Instancing structures.
    pub const INSTANCING: Self = Self::Fractals(Kind::Instancing);
    /// L-systems.
    pub const LSYSTEMS: Self = Self::Fractals(Kind::LSystem);

    /// Returns the shelves of complete fractals, in the order of lookup.
    #[must_use]
    pub fn grown() -> [Self; Kind::ALL.len()] {
        Kind::ALL.map(Self::Fractals)
    }

    /// The shelves of components, in the order of lookup.
    pub const COMPONENTS: [Self; 3] = [Self::Initiators, Self::Generators, Self::BaseElements];

    /// Returns all shelves, in the order in which they are listed.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::grown().into_iter().chain(Self::COMPONENTS)
    }

    /// Returns the name of the folder.
    #[must_use]
    pub fn folder(self) -> &'static str {
        match self {
            Self::Fractals(kind) => kind.folder(),
            Self::Initiators => "initiators",
            Self::Generators => "generators",
            Self::BaseElements => "base_elements",
        }
    }

    /// Returns the keyword for the content of a file, such as `rule`, `lsystem` or `base_element`. For
    /// components it is the key of a rule that names one.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Fractals(kind) => kind.name(),
            Self::Initiators => "initiator",
            Self::Generators => "generator",
            Self::BaseElements => "base_element",
        }
    }

    /// Returns the noun for the content of a file, for use in messages.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            Self::Fractals(kind) => kind.noun(),
            Self::BaseElements => "base element",
            other => other.kind(),
        }
    }

    /// Returns the first line of the files of this shelf in the embedded library, by which editors find
    /// their schema.
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
pub struct LibraryFile {
    /// Name of the file, without its extension.
    pub name: String,
    /// Shelf on which the file lies.
    pub shelf: Shelf,
    /// Path of the file; `None` if it is embedded.
    pub path: Option<PathBuf>,
}

impl LibraryFile {
    /// Returns the error for a component that is used as a rule.
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

/// The folders that are searched, in order, before the embedded library.
#[derive(Clone, Debug, Default)]
pub struct Catalogue {
    folders: Vec<PathBuf>,
}

impl Catalogue {
    /// Creates a catalogue of the embedded library alone.
    #[must_use]
    pub fn embedded() -> Self {
        Self::default()
    }

    /// Creates a catalogue that searches the folders, in this order, before the embedded library.
    #[must_use]
    pub fn with_folders(folders: Vec<PathBuf>) -> Self {
        Self { folders }
    }

    /// Returns the folder that is searched first, which need not exist.
    #[cfg(feature = "studio")]
    pub(crate) fn first_folder(&self) -> Option<&Path> {
        self.folders.first().map(PathBuf::as_path)
    }

    /// Reads a complete fractal by path or by name. An existing file takes precedence over a name in
    /// the library.
    ///
    /// # Errors
    ///
    /// Returns an error if the argument is neither a file nor a name in the library, if it names a
    /// component, or if the file cannot be read.
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
            // A dangling link is the file that the user meant.
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

    /// Returns the component that an argument refers to: by a name, if neither a file nor a complete
    /// fractal has that name, or by folder and name, if no such file exists. For example,
    /// `generators/koch` is a generator, while `koch` is a rule.
    #[must_use]
    pub fn component_named(&self, argument: impl AsRef<Path>) -> Option<LibraryFile> {
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

    /// Reads the file that the last file of `chain` extends: a file relative to that file's folder or
    /// to the current folder, or a library file by name.
    ///
    /// A name is resolved to the first file that is not in `chain`, so that a rule can extend the rule
    /// that it hides.
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
        // Reading a rule must not block on a pipe or a terminal.
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

    /// Reads a data file, relative to the folder of the file that contains `named`.
    pub(crate) fn data(&self, name: &str, named: &Place) -> Result<Arc<Source>, Diagnostic> {
        let folder = named.source().path().parent();
        let path = folder.unwrap_or(Path::new("")).join(name);
        // Reading data must not block on a pipe or a terminal.
        if path.is_file() {
            return read_file(&path);
        }
        Err(
            Diagnostic::error(format!("there is no file '{}'", path.display()))
                .hint("a list of points, or a file of two columns in the folder of this one"),
        )
    }

    /// Reads the bytes of a file, at most `most`, relative to the folder of the file that contains `named`.
    pub(crate) fn bytes(
        &self,
        name: &str,
        named: &Place,
        most: u64,
    ) -> Result<(PathBuf, Vec<u8>), Diagnostic> {
        let folder = named.source().path().parent();
        let path = folder.unwrap_or(Path::new("")).join(name);
        // Reading data must not block on a pipe or a terminal.
        if !path.is_file() {
            let message = format!("there is no file '{}'", path.display());
            let hint = "the name of a file, relative to the folder of this one";
            return Err(Diagnostic::error(message).hint(hint));
        }
        let size = fs::metadata(&path).map_err(|error| cannot_be_read(&path, &error))?;
        if size.len() > most {
            let (size, most) = (size.len() >> 20, most >> 20);
            let message = format!(
                "'{}' has {size} MiB, and at most {most} are read",
                path.display()
            );
            return Err(Diagnostic::error(message));
        }
        let bytes = fs::read(&path).map_err(|error| cannot_be_read(&path, &error))?;
        Ok((path, bytes))
    }

    /// Reads a library file by name.
    ///
    /// # Errors
    ///
    /// Returns an error if the shelf has no file of this name, or if the file cannot be read.
    pub fn component(&self, shelf: Shelf, name: &str) -> Result<Arc<Source>, Diagnostic> {
        self.named(&[shelf], name)
    }

    /// Reads the first file of the given name on the given shelves.
    pub(crate) fn named(&self, shelves: &[Shelf], name: &str) -> Result<Arc<Source>, Diagnostic> {
        let Some(entry) = self.candidates(shelves, name).into_iter().next() else {
            // A name with an extension was probably meant as a file.
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

    /// Reads the text of an entry.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read.
    pub fn open(&self, entry: &LibraryFile) -> Result<Arc<Source>, Diagnostic> {
        if let Some(path) = &entry.path {
            return read_file(path);
        }
        let text = embedded(entry.shelf, &entry.name).unwrap_or_default();
        let (folder, name) = (entry.shelf.folder(), &entry.name);
        Ok(Source::new(format!("library/{folder}/{name}.yaml"), text))
    }

    /// Returns all files of the given name on the given shelves, in the order of lookup: the first
    /// hides the others.
    fn candidates(&self, shelves: &[Shelf], name: &str) -> Vec<LibraryFile> {
        let name = without_extension(name);
        let is_name = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
        if name.is_empty() || name.starts_with('.') || !name.chars().all(is_name) {
            return Vec::new();
        }
        let entry = |shelf, path| LibraryFile {
            name: name.into(),
            shelf,
            path,
        };
        let mut found = Vec::new();
        for folder in &self.folders {
            let own = shelves.contains(&Shelf::RULES).then_some(Shelf::RULES);
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
            found.extend(embedded(shelf, name).map(|_| entry(shelf, None)));
        }
        found
    }

    /// Returns the visible files of the library, sorted by shelf and name. A file hides those of the
    /// same shelf and name in later folders.
    #[must_use]
    pub fn entries(&self) -> Vec<LibraryFile> {
        let mut entries = BTreeMap::new();
        for shelf in Shelf::all() {
            for (path, _) in EMBEDDED {
                if let Some((_, name)) = on_shelf(&[shelf], path) {
                    add(&mut entries, shelf, Path::new(name), None);
                }
            }
            for folder in self.folders.iter().rev() {
                let own = (shelf == Shelf::RULES).then(|| folder.clone());
                for folder in own.into_iter().chain([folder.join(shelf.folder())]) {
                    let files = fs::read_dir(folder).into_iter().flatten().flatten();
                    let files = files.map(|file| file.path()).filter(|path| path.is_file());
                    let mut files: Vec<_> = files.collect();
                    // In descending order, so that of two extensions the first one is inserted last and
                    // kept.
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

/// Splits `FOLDER/NAME` into one of the given shelves and a name.
fn on_shelf<'n>(shelves: &[Shelf], name: &'n str) -> Option<(Shelf, &'n str)> {
    let (folder, name) = name.split_once('/')?;
    let shelf = shelves.iter().find(|shelf| shelf.folder() == folder)?;
    Some((*shelf, name))
}

/// Returns the text of an embedded file.
fn embedded(shelf: Shelf, name: &str) -> Option<&'static str> {
    let path = format!("{}/{name}.yaml", shelf.folder());
    let place = EMBEDDED.binary_search_by_key(&path.as_str(), |(path, _)| path);
    place.ok().map(|place| EMBEDDED[place].1)
}

fn add(
    entries: &mut BTreeMap<(Shelf, String), LibraryFile>,
    shelf: Shelf,
    file: &Path,
    path: Option<&PathBuf>,
) {
    let Some(file) = file.file_name().and_then(|file| file.to_str()) else {
        return;
    };
    let name = without_extension(file);
    if name != file && !name.is_empty() && !name.starts_with('.') {
        let entry = LibraryFile {
            name: name.into(),
            shelf,
            path: path.cloned(),
        };
        entries.insert((shelf, name.into()), entry);
    }
}

/// Extensions of library files, in order of precedence.
const EXTENSIONS: [&str; 2] = [".yaml", ".yml"];

fn without_extension(name: &str) -> &str {
    let stems = EXTENSIONS.map(|extension| name.strip_suffix(extension));
    stems.into_iter().flatten().next().unwrap_or(name)
}

/// Returns whether two texts were read from one file, even if by different paths.
pub(crate) fn is_same_file(a: &Source, b: &Source) -> bool {
    let file = |source: &Source| fs::canonicalize(source.path()).ok();
    a.text() == b.text() && (a.name() == b.name() || file(a).is_some() && file(a) == file(b))
}

pub(crate) fn read_file(path: &Path) -> Result<Arc<Source>, Diagnostic> {
    use std::io::Read;
    // One byte more than the limit suffices to detect a file that is too large.
    let most = u64::try_from(Source::MAX_BYTES).unwrap_or(u64::MAX) + 1;
    let mut bytes = Vec::new();
    let read = open_file(path)?.take(most).read_to_end(&mut bytes);
    read.map_err(|error| cannot_be_read(path, &error))?;
    Source::read_file(path, bytes)
}
