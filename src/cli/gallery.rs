//! Pictures of the library's entries, and the page that `kfrac list --html` writes.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use crate::catalogue::{Catalogue, LibraryFile, Shelf};
use crate::diagnostic::Source;
use crate::output_file::OutputFile;
use crate::parallel;
use crate::render::PngEncoding;

use super::component::Component;
use super::held::Held;
use super::list::ListRow;
use super::{Failure, grow, output, readable, text};

/// Side of a picture of the page, in pixels.
const SIDE: u32 = 256;

/// Largest number of bytes of a picture.
const MAX_BYTES: usize = 16 << 20;

/// Style of the page, in light and dark.
const STYLE: &str = "\
:root { --ground: #f3f1ec; --panel: #fbfaf7; --ink: #1e2528; --quiet: #5d676b; --line: #d9d5cc; --accent: #1b6763 }
@media (prefers-color-scheme: dark) { :root { --ground: #14181a; --panel: #1c2123; --ink: #e9e6df; --quiet: #a2abae; --line: #343b3e; --accent: #7cc8be } }
* { box-sizing: border-box }
body { margin: 0 auto; max-width: 1280px; padding: 24px; background: var(--ground); color: var(--ink); font: 14px/1.5 system-ui, sans-serif }
nav { display: flex; flex-wrap: wrap; gap: 6px 16px; margin-bottom: 8px }
a { color: var(--accent) }
h1 { font-size: 24px; margin: 0 0 8px }
h2 { font-size: 18px; margin: 32px 0 12px }
ul { list-style: none; margin: 0; padding: 0; display: grid; grid-template-columns: repeat(auto-fill, minmax(176px, 1fr)); gap: 14px }
li { background: var(--panel); border: 1px solid var(--line); border-radius: 10px; overflow: hidden; padding-bottom: 10px }
img { display: block; width: 100%; aspect-ratio: 1; object-fit: contain; padding: 10px; background: #fff; margin-bottom: 8px }
h3, p { margin: 0; padding: 0 12px; overflow-wrap: anywhere }
h3 { font-size: 14px }
p { font-size: 12.5px; color: var(--quiet) }
code { font-family: ui-monospace, monospace; color: var(--ink) }
";

/// Returns the source by which an entry is shown: of a component, that of a rule that uses it.
pub(crate) fn shown(
    file: &LibraryFile,
    catalogue: &Catalogue,
) -> Result<Arc<Source>, crate::diagnostic::Diagnostics> {
    let source = catalogue.open(file)?;
    Ok(match Shelf::COMPONENTS.contains(&file.shelf) {
        true => Component::of(file.clone(), source).in_a_rule(),
        false => source,
    })
}

/// Returns the options of `grow` for the small picture of an entry.
pub(crate) fn options(shelf: Shelf) -> Vec<String> {
    let steps = match shelf {
        Shelf::Fractals(_) => None,
        Shelf::Initiators => Some("--steps=0"),
        Shelf::Generators | Shelf::BaseElements => Some("--steps=1"),
    };
    let all = ["--threads=1", "--max-elements=3000000"].into_iter();
    steps.into_iter().chain(all).map(str::to_owned).collect()
}

/// Returns the picture of an entry, as a PNG.
fn picture(file: &LibraryFile, catalogue: &Catalogue) -> Result<Vec<u8>, Failure> {
    let source = shown(file, catalogue)?;
    let held = Arc::new(Held::new(MAX_BYTES, PngEncoding::default()));
    let mut arguments = vec![file.name.clone()];
    arguments.extend(options(file.shelf));
    arguments.extend([
        format!("--size={SIDE}x{SIDE}"),
        "--format=png".into(),
        "--output=-".into(),
    ]);
    grow::hold(&arguments, &source, catalogue, Arc::clone(&held))?;
    Ok(held.take().bytes)
}

/// Writes the page and its pictures into a folder. An entry without a picture, because its file has mistakes, is listed
/// without one.
pub(super) fn write(
    folder: &Path,
    entries: &[(LibraryFile, ListRow)],
    catalogue: &Catalogue,
) -> Result<(), Failure> {
    output::make_folder(folder)?;
    let threads = parallel::all_cores().get();
    let pictures = parallel::map(entries, threads, |_, (file, _)| {
        let name = format!("{}-{}.png", file.shelf.folder(), file.name);
        match picture(file, catalogue) {
            Ok(bytes) => write_file(&folder.join(&name), &bytes).map(|()| Some(name)),
            Err(_) => Ok(None),
        }
    });
    let pictures: Vec<Option<String>> = pictures.into_iter().collect::<Result<_, Failure>>()?;
    let missing = { entries.iter().zip(&pictures) }
        .filter(|(_, picture)| picture.is_none())
        .map(|((file, _), _)| file.name.as_str());
    for name in missing {
        text::print_message(&format!(
            "note: {name} has no picture: `kfrac grow {name}` reports why"
        ));
    }
    let path = folder.join("index.html");
    write_file(&path, page(entries, &pictures).as_bytes())?;
    let count =
        readable::counted(&(entries.len() as u64).into(), "entry").replace("entrys", "entries");
    text::print_message(&format!("{}: {count}", path.display()));
    Ok(())
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |error: std::io::Error| output::failed(error, path);
    let mut file = OutputFile::create(path).map_err(anyhow::Error::new)?;
    std::io::Write::write_all(&mut file, bytes).map_err(failed)?;
    Ok(file.finish().map_err(anyhow::Error::new)?)
}

/// Returns the page. It loads nothing but the pictures beside it.
fn page(entries: &[(LibraryFile, ListRow)], pictures: &[Option<String>]) -> String {
    let mut shelves = String::new();
    let mut links = String::new();
    for shelf in Shelf::all() {
        let all: Vec<_> = { entries.iter().zip(pictures) }
            .filter(|((file, _), _)| file.shelf == shelf)
            .collect();
        if all.is_empty() {
            continue;
        }
        let (id, name) = (shelf.folder(), shelf.folder().replace('_', " "));
        let _ = writeln!(links, "<a href=\"#{id}\">{name} ({})</a>", all.len());
        let _ = writeln!(shelves, "<h2 id=\"{id}\">{name}</h2>\n<ul>");
        for ((file, row), picture) in all {
            item(&mut shelves, file, row, picture.as_deref());
        }
        shelves.push_str("</ul>\n");
    }
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>The library of kfrac</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>The library of kfrac</h1>\n\
         <nav aria-label=\"Kinds\">\n{links}</nav>\n<main>\n{shelves}</main>\n</body>\n</html>\n"
    )
}

fn item(page: &mut String, file: &LibraryFile, row: &ListRow, picture: Option<&str>) {
    let title = escaped(row.title.as_deref().unwrap_or(&row.name));
    page.push_str("<li>");
    if let Some(picture) = picture {
        let picture = escaped(picture);
        let _ = write!(
            page,
            "<img src=\"{picture}\" alt=\"{title}\" width=\"{SIDE}\" height=\"{SIDE}\" loading=\"lazy\">"
        );
    }
    let verb = match file.shelf {
        Shelf::Fractals(_) => "grow",
        _ => "show",
    };
    let name = escaped(&file.name);
    let _ = write!(
        page,
        "<h3>{title}</h3>\n<p><code>kfrac {verb} {name}</code></p>"
    );
    if !row.tags.is_empty() {
        let _ = write!(page, "\n<p>{}</p>", escaped(&row.tags.join(", ")));
    }
    if let Some(source) = &row.source {
        let _ = write!(page, "\n<p>{}</p>", escaped(source));
    }
    page.push_str("</li>\n");
}

/// Escapes text for HTML, in attributes too.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}
