//! Folder of a pyramid of tiles. It is filled under a name of its own, and gets its final name when all levels are complete.
//!
//! Several processes can fill it at once. Each leaves a file for every level in which its part is done, with numbers; the one
//! that finds the last part done finishes the folder. Tiles and these files appear whole, so that work that was interrupted
//! goes on where it ended.

use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::ops::AddAssign;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow};
use serde::{Deserialize, Serialize};

use crate::output_file::OutputFile;

use super::super::super::shard::Shard;
use super::super::super::{Failure, output};
use super::levels::Tile;

/// File that describes the tiles of a folder.
const DESCRIPTION: &str = "pyramid.json";

/// Folder of tiles.
pub(super) struct TileFolder {
    /// Final name.
    whole: PathBuf,
    /// Name until it is complete.
    part: PathBuf,
    /// Contents of the description.
    description: String,
}

/// Numbers of tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Tally {
    /// Number of tiles that are written.
    pub(super) written: u64,
    /// Number of tiles that show nothing.
    pub(super) empty: u64,
    /// Number of bytes of the tiles.
    pub(super) bytes: u64,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.written += other.written;
        self.empty += other.empty;
        self.bytes += other.bytes;
    }
}

impl TileFolder {
    /// Returns the folder `NAME_files`, with its description.
    pub(super) fn new(folder: &Path, name: &str, description: String) -> Self {
        Self {
            whole: folder.join(format!("{name}_files")),
            part: folder.join(format!("{name}_files.part")),
            description,
        }
    }

    /// Begins the folder, or goes on with it; `false` if it is complete. A folder with other contents is refused.
    pub(super) fn begin(&self) -> Result<bool, Failure> {
        if self.is_whole()? {
            return Ok(false);
        }
        if self.whole.exists() && !self.whole.join(DESCRIPTION).is_file() {
            let message = "is no folder of tiles of kfrac: remove it, or choose another folder";
            return Err(anyhow!("'{}' {message}", self.whole.display()).into());
        }
        match read(&self.part.join(DESCRIPTION))? {
            Some(found) if found == self.description => Ok(true),
            Some(_) => {
                let message =
                    "holds a part of other tiles: remove it, or repeat the options that began it";
                Err(anyhow!("'{}' {message}", self.part.display()).into())
            }
            None => {
                output::make_folder(&self.part)?;
                let path = self.part.join(DESCRIPTION);
                write_file(&path, self.description.as_bytes())?;
                Ok(true)
            }
        }
    }

    /// Returns whether the folder is complete, with these contents.
    fn is_whole(&self) -> Result<bool, Failure> {
        let found = read(&self.whole.join(DESCRIPTION))?;
        Ok(found.is_some_and(|found| found == self.description))
    }

    /// Returns the name under which the folder is filled.
    pub(super) fn unfinished(&self) -> &Path {
        &self.part
    }

    /// Returns the path of a tile.
    pub(super) fn tile(&self, tile: Tile) -> PathBuf {
        let Tile { level, column, row } = tile;
        self.level(level).join(format!("{column}_{row}.png"))
    }

    fn level(&self, level: u32) -> PathBuf {
        self.part.join(level.to_string())
    }

    /// Creates the folder of a level.
    pub(super) fn make_level(&self, level: u32) -> Result<(), Failure> {
        Ok(output::make_folder(&self.level(level))?)
    }

    /// Returns the size of a tile that has been written.
    pub(super) fn written(&self, tile: Tile) -> Option<u64> {
        let bytes = fs::metadata(self.tile(tile)).ok()?.len();
        (bytes > 0).then_some(bytes)
    }

    fn marker(&self, level: u32, Shard { number, count }: Shard) -> PathBuf {
        self.level(level).join(format!("{number}-of-{count}.json"))
    }

    /// Returns the numbers of a part of a level that is done.
    pub(super) fn done(&self, level: u32, shard: Shard) -> Result<Option<Tally>, Failure> {
        let text = read(&self.marker(level, shard))?;
        Ok(text.and_then(|text| serde_json::from_str(&text).ok()))
    }

    /// Notes that a part of a level is done.
    pub(super) fn note(&self, level: u32, shard: Shard, tally: &Tally) -> Result<(), Failure> {
        let text = serde_json::to_string(tally).map_err(anyhow::Error::new)?;
        write_file(&self.marker(level, shard), text.as_bytes())
    }

    /// Returns the numbers of a level if all of its parts, of whatever number, are done; the files that say so join
    /// `markers`.
    fn level_done(&self, level: u32, markers: &mut Vec<PathBuf>) -> Result<Option<Tally>, Failure> {
        let folder = self.level(level);
        let mut counts = Vec::new();
        for entry in entries(&folder)? {
            let name = entry.to_string_lossy().into_owned();
            let parts = name
                .strip_suffix(".json")
                .and_then(|it| it.split_once("-of-"));
            if let Some((_, count)) = parts
                && let Ok(count) = count.parse::<u32>()
            {
                counts.push(count);
                markers.push(folder.join(&name));
            }
        }
        counts.sort_unstable();
        let found = counts
            .chunk_by(|a, b| a == b)
            .find(|same| same.len() as u64 == u64::from(same[0]));
        let Some(&[count, ..]) = found else {
            return Ok(None);
        };
        let mut all = Tally::default();
        for number in 1..=count {
            match self.done(level, Shard { number, count })? {
                Some(tally) => all += tally,
                None => return Ok(None),
            }
        }
        Ok(Some(all))
    }

    /// Gives the folder its final name if all levels up to `deepest` are complete, and returns their numbers. A folder that
    /// has the name is replaced.
    pub(super) fn finish(&self, deepest: u32) -> Result<Option<Tally>, Failure> {
        let mut all = Tally::default();
        let mut markers = Vec::new();
        for level in 0..=deepest {
            match self.level_done(level, &mut markers)? {
                Some(tally) => all += tally,
                None => return Ok(None),
            }
        }
        let finished = self.rename(&markers);
        // Another process may have finished the folder meanwhile.
        if finished.is_err() && self.is_whole()? {
            return Ok(Some(all));
        }
        finished.with_context(|| format!("'{}' cannot be written", self.whole.display()))?;
        Ok(Some(all))
    }

    fn rename(&self, markers: &[PathBuf]) -> io::Result<()> {
        let old = self.whole.with_extension("old");
        if old.exists() {
            fs::remove_dir_all(&old)?;
        }
        for marker in markers {
            fs::remove_file(marker)?;
        }
        if self.whole.exists() {
            fs::rename(&self.whole, &old)?;
        }
        fs::rename(&self.part, &self.whole)?;
        if old.exists() {
            fs::remove_dir_all(&old)?;
        }
        Ok(())
    }
}

/// Writes a file that appears whole.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.write_all(bytes)
        .map_err(|error| output::failed(error, path))?;
    Ok(file.finish()?)
}

/// Returns the text of a file, if it exists.
fn read(path: &Path) -> Result<Option<String>, Failure> {
    match fs::read_to_string(path) {
        Ok(text) => Ok(Some(text)),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(None)
        }
        Err(error) => {
            let message = format!("'{}' cannot be read", path.display());
            Err(anyhow::Error::new(error).context(message).into())
        }
    }
}

/// Returns the names in a folder, if it exists.
fn entries(folder: &Path) -> Result<Vec<std::ffi::OsString>, Failure> {
    match fs::read_dir(folder) {
        Ok(found) => Ok(found.flatten().map(|entry| entry.file_name()).collect()),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => {
            let message = format!("'{}' cannot be read", folder.display());
            Err(anyhow::Error::new(error).context(message).into())
        }
    }
}
