//! Embeds the library: a table of its files, by which the crate is built anew if one of them changes, and the page
//! of the documentation that lists their names.

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
    for file in &files {
        // The table stays valid when the folder of the crate is moved.
        let path = format!(r#"concat!(env!("CARGO_MANIFEST_DIR"), "/library/", {file:?})"#);
        writeln!(table, "({file:?}, include_str!({path})),").map_err(io::Error::other)?;
    }
    let out = env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?;
    let out = Path::new(&out);
    fs::write(out.join("library.rs"), table + "]")?;
    fs::write(out.join("names.md"), names(&files)?)
}

/// Returns the page of the documentation that lists names and titles, in a table for every folder.
fn names(files: &[String]) -> io::Result<String> {
    let mut page = String::new();
    let mut last = "";
    for file in files {
        let Some((folder, name)) = file.split_once('/') else {
            continue;
        };
        if folder != last {
            let heading = folder.replace('_', " ");
            page += &format!("\n## Library: {heading}\n\n| name | title |\n|---|---|\n");
            last = folder;
        }
        let text = fs::read_to_string(Path::new("library").join(file))?;
        let mut titles = text.lines().filter_map(|line| line.strip_prefix("title:"));
        let title = titles.next().unwrap_or_default().trim();
        page += &format!("| `{}` | {title} |\n", name.trim_end_matches(".yaml"));
    }
    Ok(page)
}
