//! Recognition of what `kfrac dim` is given: a rule, a picture or a table.

use std::path::Path;

use crate::import::Raster;

/// Kind of an input file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InputKind {
    Rule,
    Picture,
    Table,
    Ply,
}

impl InputKind {
    /// Recognises a file by its first bytes, or else by its name: the first line of a table has a comma and
    /// is no YAML.
    pub(super) fn of(path: &Path, head: &[u8]) -> Self {
        let extension = path
            .extension()
            .map(|it| it.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            _ if Raster::is_picture(head) => Self::Picture,
            _ if head.starts_with(b"ply\n") || head.starts_with(b"ply\r\n") => Self::Ply,
            Some("ply") => Self::Ply,
            Some("png" | "jpg" | "jpeg" | "pbm" | "pgm" | "ppm" | "pnm") => Self::Picture,
            Some("csv" | "txt") => Self::Table,
            Some("yaml" | "yml" | "json") => Self::Rule,
            _ => {
                let lines = head.split(|&byte| byte == b'\n');
                let first = lines
                    .map(<[u8]>::trim_ascii)
                    .find(|line| !line.is_empty() && !line.starts_with(b"#"));
                let is_row = first.is_some_and(|line| {
                    line.contains(&b',') && !line.iter().any(|byte| b":{[".contains(byte))
                });
                if is_row { Self::Table } else { Self::Rule }
            }
        }
    }
}
