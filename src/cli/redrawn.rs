//! Pictures that are grown again: one that kfrac drew holds its rule, and the command that draws it.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Source};
use crate::render::Format;
use crate::style::Named;

use super::Failure;

/// Formats of pictures that hold their rule.
const FORMATS: [Format; 3] = [Format::Png, Format::Svg, Format::Pdf];

/// Limit of the bytes in which a text is looked for: each character of a rule takes up to four.
const MAX_BYTES: u64 = 4 * Source::MAX_BYTES as u64 + (1 << 20);

/// Returns the format of a path that has the extension of a picture.
pub(super) fn format(path: &Path) -> Option<Format> {
    let extension = path.extension()?.to_str()?.to_lowercase();
    FORMATS
        .into_iter()
        .find(|format| format.name() == extension)
}

/// Returns the rule that a picture holds; `None` if no picture exists at the path.
pub(super) fn source(path: &Path) -> Option<Result<Arc<Source>, Diagnostic>> {
    let format = format(path).filter(|_| path.is_file())?;
    Some(text(path, format).and_then(|text| Source::read_file(path, text.into_bytes())))
}

/// Returns the text that a picture holds: lines with the program, the command and the parameters, and the rule.
fn text(path: &Path, format: Format) -> Result<String, Diagnostic> {
    let name = path.display();
    let found = match format {
        Format::Png => of_png(path),
        Format::Svg => of_svg(path),
        _ => of_pdf(path),
    };
    match found {
        Ok(Some(text)) if text.starts_with("# kfrac ") => Ok(text),
        Ok(_) => Err(Diagnostic::error(format!("'{name}' holds no rule")).hint(
            "pictures hold the rule that they were drawn from if kfrac drew them and nothing changed them since",
        )),
        Err(error) => Err(Diagnostic::error(format!("'{name}' cannot be read: {error}"))),
    }
}

/// Returns the text of a PNG, whose pixels are not read.
pub(super) fn of_png(path: &Path) -> io::Result<Option<String>> {
    let file = BufReader::new(File::open(path)?);
    let reader = png::Decoder::new(file).read_info();
    let reader = reader.map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
    let texts = &reader.info().utf8_text;
    let comment = texts.iter().find(|text| text.keyword == "Comment");
    Ok(comment.and_then(|text| text.get_text().ok()))
}

/// Returns the text of an SVG, which stands before its paths.
fn of_svg(path: &Path) -> io::Result<Option<String>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MAX_BYTES).read_to_end(&mut bytes)?;
    let text = String::from_utf8_lossy(&bytes);
    let inner = || {
        let (_, rest) = text.split_once("<metadata>\n")?;
        let (inner, _) = rest.split_once("</metadata>")?;
        let inner = inner.replace("&lt;", "<").replace("&gt;", ">");
        Some(inner.replace("&amp;", "&"))
    };
    Ok(inner())
}

/// Returns the text of a PDF, which stands after its contents.
fn of_pdf(path: &Path) -> io::Result<Option<String>> {
    const KEY: &[u8] = b"/Provenance";
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(MAX_BYTES)))?;
    let mut bytes = Vec::new();
    file.take(MAX_BYTES).read_to_end(&mut bytes)?;
    let found = bytes.windows(KEY.len()).rposition(|window| window == KEY);
    let string = found.map(|at| &bytes[at + KEY.len()..]);
    Ok(string.and_then(|string| match string.split_first()? {
        (b'(', rest) => literal(rest),
        (b'<', rest) => utf_16(rest),
        _ => None,
    }))
}

/// Reads a literal string of a PDF.
fn literal(bytes: &[u8]) -> Option<String> {
    let mut text = Vec::new();
    let mut bytes = bytes.iter();
    loop {
        match bytes.next()? {
            b')' => return String::from_utf8(text).ok(),
            b'\\' => text.push(*bytes.next()?),
            byte => text.push(*byte),
        }
    }
}

/// Reads a string of hexadecimal UTF-16 with its mark.
fn utf_16(bytes: &[u8]) -> Option<String> {
    let digits = bytes.split(|byte| *byte == b'>').next()?;
    let digits = std::str::from_utf8(digits).ok()?.as_bytes();
    let units = digits.chunks_exact(4).map(|unit| {
        let unit = std::str::from_utf8(unit).ok()?;
        u16::from_str_radix(unit, 16).ok()
    });
    let units: Vec<u16> = units.collect::<Option<_>>()?;
    String::from_utf16(units.strip_prefix(&[0xfeff])?).ok()
}

/// Returns the command line that grows what a picture holds: `given`, with the options of the picture before those that are
/// given, and the picture's format. `None` unless the rule is a picture.
///
/// `settings` are the names of the parameters that are set, `ends` states whether steps or a detail are given, and
/// `has_output` whether a file or a format is.
pub(super) fn command(
    rule: &Path,
    given: &[OsString],
    settings: &[String],
    ends: bool,
    has_output: bool,
) -> Option<Result<Vec<OsString>, Failure>> {
    let format = format(rule).filter(|_| rule.is_file())?;
    Some(text(rule, format).map_err(Failure::from).and_then(|text| {
        let line = text.lines().nth(1).and_then(|line| line.strip_prefix("# kfrac "));
        let mut words = line.and_then(words).unwrap_or_default().into_iter();
        let subcommand = words.next().unwrap_or_default();
        if subcommand != "grow" {
            return Err(Failure::Usage(format!(
                "{} was drawn by kfrac {subcommand}, and only pictures of kfrac grow are grown again",
                rule.display()
            )));
        }
        let is_kept = |word: &String| {
            let set = word.strip_prefix("--set=").and_then(|set| set.split('=').next());
            let is_set = set.is_some_and(|name| settings.iter().any(|own| own == name));
            let is_end = word.starts_with("--steps=") || word.starts_with("--detail=");
            !(is_set || is_end && ends || word.starts_with("--format="))
        };
        // The first word after the subcommand is the rule.
        let recorded = words.skip(1).filter(is_kept).map(OsString::from);
        let at = given.iter().position(|word| word == "grow").map_or(given.len(), |at| at + 1);
        let (before, after) = given.split_at(at);
        let mut all = before.to_vec();
        all.extend(recorded);
        if !has_output {
            all.push(format!("--format={}", format.name()).into());
        }
        all.extend_from_slice(after);
        Ok(all)
    }))
}

/// Returns the words of a command line as [`quoted`](super::labels::quoted) writes them; `None` if a quote has no end.
fn words(line: &str) -> Option<Vec<String>> {
    let mut words = vec![String::new()];
    let mut characters = line.chars();
    while let Some(character) = characters.next() {
        let word = words.last_mut()?;
        match character {
            ' ' => words.push(String::new()),
            '\'' => loop {
                match characters.next()? {
                    '\'' => break,
                    inner => word.push(inner),
                }
            },
            '\\' => word.push(characters.next()?),
            '$' if characters.as_str().starts_with('\'') => {
                characters.next();
                loop {
                    match characters.next()? {
                        '\'' => break,
                        '\\' => match characters.next()? {
                            'u' => {
                                let digits: String = characters.by_ref().take(4).collect();
                                word.push(char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?);
                            }
                            escaped => word.push(escaped),
                        },
                        inner => word.push(inner),
                    }
                }
            }
            plain => word.push(plain),
        }
    }
    Some(words)
}

#[cfg(test)]
mod tests {
    use super::super::labels::quoted;
    use super::words;

    #[test]
    fn quoted_words_are_read_back() {
        let all = [
            "grow",
            "a b",
            "it's",
            "--set=x=1",
            "tab\there's",
            "",
            "ü'$\\",
            "'",
        ];
        let line: Vec<String> = all.iter().map(|word| quoted(word)).collect();
        assert_eq!(words(&line.join(" ")).unwrap(), all);
        assert_eq!(words("a 'b"), None);
    }
}
