//! Folders that files may be written to, and the files in them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::catalogue::Shelf;

use super::answer::Refusal;

/// Folders below which files may be written.
#[derive(Clone, Debug)]
pub(super) struct Roots {
    /// Folder of the rule, or the one in which the program was started.
    pub(super) start: PathBuf,
    /// Library of the person, which need not exist.
    pub(super) library: Option<PathBuf>,
}

impl Roots {
    /// Returns the path of a file that may be written. A relative path starts from the start folder.
    ///
    /// Links are followed before the folders are compared, that of the file itself included.
    pub(super) fn allowed(&self, path: &Path) -> Result<PathBuf, Refusal> {
        let name = path.file_name();
        let Some(name) = name.filter(|name| !name.to_string_lossy().starts_with('.')) else {
            return Err(Refusal::wrong(
                "a file has a name, which does not begin with a full stop",
            ));
        };
        let path = self.start.join(path);
        let folder = path.parent().unwrap_or(&self.start);
        let Ok(folder) = fs::canonicalize(folder) else {
            return Err(Refusal::wrong(format!(
                "there is no folder '{}'",
                folder.display()
            )));
        };
        let path = folder.join(name);
        let real = match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_dir() => {
                return Err(Refusal::wrong(format!("'{}' is a folder", path.display())));
            }
            Ok(_) => fs::canonicalize(&path).ok(),
            Err(_) => Some(path.clone()),
        };
        match real {
            Some(real) if self.hold(&real) && (!real.exists() || real.is_file()) => Ok(path),
            _ => Err(Refusal::forbidden(format!(
                "'{}' lies outside of {}",
                path.display(),
                self.described()
            ))),
        }
    }

    /// Returns the path of a new file in the library, in the folder of its shelf, which is made if it is missing.
    pub(super) fn in_library(&self, name: &str, shelf: Shelf) -> Result<PathBuf, Refusal> {
        let Some(library) = &self.library else {
            return Err(Refusal::wrong("there is no folder for a library"));
        };
        let folder = library.join(shelf.folder());
        let made = fs::create_dir_all(&folder);
        made.map_err(|error| Refusal::wrong(format!("'{}': {error}", folder.display())))?;
        self.allowed(&folder.join(name))
    }

    fn hold(&self, path: &Path) -> bool {
        let folders = [Some(&self.start), self.library.as_ref()];
        let mut real = folders
            .into_iter()
            .flatten()
            .filter_map(|it| fs::canonicalize(it).ok());
        real.any(|folder| path.starts_with(folder))
    }

    fn described(&self) -> String {
        let library = self.library.as_ref();
        let library = library.map(|it| format!(" and of the library '{}'", it.display()));
        format!("'{}'{}", self.start.display(), library.unwrap_or_default())
    }
}

/// Returns whether a name is that of a rule file.
pub(super) fn is_rule(path: &Path) -> bool {
    let extension = path.extension().and_then(|it| it.to_str());
    matches!(extension, Some("yaml" | "yml" | "json"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_outside_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let start = folder.path().join("start");
        fs::create_dir_all(start.join("inner")).unwrap();
        fs::write(folder.path().join("other.yaml"), "").unwrap();
        let roots = Roots {
            start: start.clone(),
            library: None,
        };
        for inside in ["a.yaml", "inner/b.yaml", "inner/../c.yaml"] {
            assert!(roots.allowed(Path::new(inside)).is_ok(), "{inside}");
        }
        let away = folder.path().join("other.yaml");
        for outside in [
            "../other.yaml",
            "inner/../../new.yaml",
            "/etc/kfrac.yaml",
            away.to_str().unwrap(),
            "..",
            "",
            ".hidden",
            "inner",
            "none/a.yaml",
        ] {
            assert!(roots.allowed(Path::new(outside)).is_err(), "{outside}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_outside_are_refused() {
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().unwrap();
        let start = folder.path().join("start");
        fs::create_dir(&start).unwrap();
        fs::write(folder.path().join("other"), "").unwrap();
        symlink(folder.path(), start.join("up")).unwrap();
        symlink(folder.path().join("other"), start.join("file.yaml")).unwrap();
        symlink(folder.path().join("none"), start.join("new.yaml")).unwrap();
        symlink(start.join("own.yaml"), start.join("fine.yaml")).unwrap();
        let roots = Roots {
            start: start.clone(),
            library: None,
        };
        for outside in ["up/x.yaml", "file.yaml", "new.yaml"] {
            assert!(roots.allowed(Path::new(outside)).is_err(), "{outside}");
        }
        fs::write(start.join("own.yaml"), "").unwrap();
        assert!(roots.allowed(Path::new("fine.yaml")).is_ok());
    }
}
