//! Archives for WebDataset.

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use super::{Archive, Entry};

/// Archive of three files for each picture.
pub(super) struct Files(tar::Builder<Vec<u8>>);

impl Files {
    pub(super) fn new() -> Self {
        Self(tar::Builder::new(Vec::new()))
    }
}

impl Archive for Files {
    fn add(&mut self, entry: Entry) -> anyhow::Result<()> {
        let key = format!("{:05}_{:06}", entry.category, entry.instance);
        let category = entry.category.to_string();
        let files = [
            ("png", entry.png.as_slice()),
            ("cls", category.as_bytes()),
            ("json", entry.label.as_bytes()),
        ];
        for (extension, bytes) in files {
            let mut header = tar::Header::new_ustar();
            header.set_size(bytes.len() as u64);
            header.set_mode(0o644);
            header.set_mtime(0);
            header.set_entry_type(tar::EntryType::Regular);
            self.0
                .append_data(&mut header, format!("{key}.{extension}"), bytes)?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> anyhow::Result<Vec<u8>> {
        Ok(self.0.into_inner()?)
    }
}

/// Returns the pictures of an archive.
pub(super) fn pictures(path: &Path) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut archive = tar::Archive::new(BufReader::new(File::open(path)?));
    let mut pictures = Vec::new();
    for entry in archive.entries()? {
        let mut entry = entry?;
        if entry.path()?.extension().is_some_and(|it| it == "png") {
            let mut png = Vec::new();
            entry.read_to_end(&mut png)?;
            pictures.push(png);
        }
    }
    Ok(pictures)
}
