//! Palettes on the command line: by name, as a list of colours, and from files.

use std::ffi::OsStr;
use std::fs;
use std::io::Read;
use std::path::Path;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};

use crate::diagnostic::did_you_mean;
use crate::import::{PaletteFormat, of_picture, read_palette};
use crate::style::{Colour, Named, Palette};

use super::input;

/// Limit of the size of a file with a palette, and of a picture, in bytes.
const MAX_BYTES: u64 = 1 << 22;
const MAX_PICTURE_BYTES: u64 = 1 << 29;

/// Number of colours of a picture that become a palette.
const OF_PICTURE: usize = 8;

/// Parser of palettes: a name, colours separated by commas, or a file. The names are completed by shells.
#[derive(Clone)]
pub(super) struct PaletteParser;

impl TypedValueParser for PaletteParser {
    type Value = Palette;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<Palette, clap::Error> {
        let parser = StringValueParser::new().try_map(|text| parse(&text));
        parser.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Palette::names().map(PossibleValue::new)))
    }
}

fn parse(text: &str) -> Result<Palette, String> {
    if let Ok(palette) = Palette::named(text) {
        return Ok(palette);
    }
    let extension = Path::new(text).extension().and_then(OsStr::to_str);
    if let Some(format) = extension.and_then(PaletteFormat::from_name) {
        let bytes = read(text, MAX_BYTES)?;
        let read = read_palette(&String::from_utf8_lossy(&bytes), format);
        return read.map_err(|error| format!("'{text}', {error}"));
    }
    let colours = split(text).map(|part| Colour::parse(part.trim()).ok_or(part));
    match colours.collect::<Result<Vec<_>, _>>() {
        Ok(colours) => Ok(Palette::of_colours("", &colours)),
        Err(part) if part.len() < text.len() => Err(format!("'{part}' is no colour")),
        Err(_) => {
            let hint = did_you_mean(text, Palette::names());
            let hint = hint.map_or_else(String::new, |hint| format!(" ({hint})"));
            Err(format!(
                "there is no palette of this name{hint}; colours are separated by commas, as in '#fff,teal,#013', and \
                 files end in .map, .gpl, .ugr or .cpt"
            ))
        }
    }
}

/// Returns the palette of a picture.
pub(super) fn from_picture(path: &str) -> Result<Palette, String> {
    let bytes = read(path, MAX_PICTURE_BYTES)?;
    of_picture(&bytes, OF_PICTURE).map_err(|error| format!("'{path}': {error}"))
}

/// Reads an input file of limited size.
fn read(path: &str, limit: u64) -> Result<Vec<u8>, String> {
    let path = Path::new(path);
    let failed = |error: std::io::Error| format!("'{}' cannot be read: {error}", path.display());
    let file = fs::File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > limit {
        let path = path.display();
        return Err(format!("'{path}' has more than {limit} bytes"));
    }
    input::note(path);
    Ok(bytes)
}

/// Splits a list at its commas, but not within parentheses.
fn split(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_i32;
    text.split(move |c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth <= 0
    })
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn palettes_are_names_and_lists() {
        assert_eq!(parse("magma").unwrap().to_string(), "magma");
        let list = parse("#fff, rgb(255, 0, 0),black,#00ff0080").unwrap();
        assert_eq!(list.to_string(), "#ffffff,#ff0000,#000000,#00ff0080");
        assert_eq!(parse(&list.to_string()).unwrap(), list);
        assert_eq!(parse("teal").unwrap().colours().len(), 2);
        for (text, expected) in [
            ("magna", "did you mean 'magma'?"),
            ("#fff,blurple", "'blurple' is no colour"),
            ("missing.gpl", "cannot be read"),
            ("", "no palette of this name"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
