//! Embeds the library: a table of its files, by which the crate is built anew if one of them changes.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=library");
    let mut files = Vec::new();
    for folder in fs::read_dir("library")? {
        let folder = folder?;
        if folder.file_type()?.is_dir() {
            for file in fs::read_dir(folder.path())? {
                let (folder, file) = (folder.file_name(), file?.file_name());
                files.push(format!("{}/{}", folder.display(), file.display()));
            }
        }
    }
    files.retain(|file| file.ends_with(".yaml"));
    files.sort();
    let mut table = String::from("&[\n");
    for file in files {
        // The table stays valid when the folder of the crate is moved.
        let path = format!(r#"concat!(env!("CARGO_MANIFEST_DIR"), "/library/", {file:?})"#);
        writeln!(table, "({file:?}, include_str!({path})),").map_err(io::Error::other)?;
    }
    let out = env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?;
    fs::write(Path::new(&out).join("library.rs"), table + "]")
}
