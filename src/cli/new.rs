//! `kfrac new`: writes a commented file to begin with.

use std::path::{Path, PathBuf};

use clap::ValueHint;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::kind::Kind;

use super::{Failure, help, output, text};

/// Writes a commented file to begin with: a rule, a system, a structure or an L-system
///
/// A file that exists is never replaced.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// File to write, or - for standard output
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: PathBuf,
    /// Kind of the fractal
    #[arg(long, value_name = "KIND", default_value = "rule", value_parser = kind())]
    kind: Kind,
    /// Number of dimensions
    #[arg(long, value_name = "DIMENSIONS", default_value = "2", value_parser = ["2", "3"])]
    space: String,
}

const MORE: &str = "\
Examples:
  kfrac new tree.yaml
      Writes a production rule, with comments and a parameter
  kfrac new coral.yaml --kind ifs --space 3
      Writes an iterated function system in space
";

/// Returns a parser for the names of kinds.
fn kind() -> impl TypedValueParser<Value = Kind> {
    let names = Kind::ALL.map(Kind::name);
    PossibleValuesParser::new(names).try_map(|name| Kind::named(&name).ok_or("unknown"))
}

/// Returns a commented file to begin with, whose comments call it by a path, and whose title is made of a name.
pub(crate) fn content(kind: Kind, is_in_space: bool, path: &str, name: &str) -> String {
    let template = match (kind, is_in_space) {
        (Kind::Rule, false) => include_str!("new/rule.yaml"),
        (Kind::Rule, true) => include_str!("new/rule-in-space.yaml"),
        (Kind::Ifs, false) => include_str!("new/ifs.yaml"),
        (Kind::Ifs, true) => include_str!("new/ifs-in-space.yaml"),
        (Kind::Instancing, false) => include_str!("new/instancing.yaml"),
        (Kind::Instancing, true) => include_str!("new/instancing-in-space.yaml"),
        (Kind::LSystem, false) => include_str!("new/lsystem.yaml"),
        (Kind::LSystem, true) => include_str!("new/lsystem-in-space.yaml"),
    };
    // A name may contain either word.
    let title = title(name);
    let parts = template
        .split("FILE")
        .map(|part| part.replace("TITLE", &title));
    let parts: Vec<String> = parts.collect();
    parts.join(&path.replace(char::is_control, " "))
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { file, kind, space } = arguments;
    let is_file = file != Path::new("-");
    if is_file && file.exists() {
        let message = format!(
            "'{}' exists, and is kept: name another file",
            file.display()
        );
        return Err(Failure::Usage(message));
    }
    let stem = file.file_stem().filter(|_| is_file);
    let name = stem.map_or("my-fractal".into(), |stem| stem.to_string_lossy());
    let path = if is_file {
        file.to_string_lossy()
    } else {
        "FILE".into()
    };
    let content = content(*kind, space == "3", &path, &name);
    if !is_file {
        return Ok(output::print(&content)?);
    }
    output::write(file, true, |out, _| {
        std::io::Write::write_all(out, content.as_bytes())
            .map_err(|error| output::failed(error, file))
    })?;
    let file = file.display();
    text::print_message(&format!(
        "{file}: {}; `kfrac grow {file}` draws it",
        kind.full_name()
    ));
    Ok(())
}

/// Returns the title of a fractal that is called by a file's name, as a text in quotes.
fn title(name: &str) -> String {
    let words = name.replace(['-', '_', '"', '\\'], " ");
    let mut letters = words.trim().chars().filter(|letter| !letter.is_control());
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    let title: String = first.chain(letters).collect();
    format!("\"{title}\"")
}
