//! Source texts and source spans.

use std::path::{Path, PathBuf};

use super::{Arc, Diagnostic, Range, fmt};

/// A text and the name that messages use for it.
pub struct Source {
    name: String,
    /// The name as a path: exact for a file whose path is not valid UTF-8.
    path: PathBuf,
    text: String,
    /// Byte offset of the start of each line.
    line_starts: Vec<usize>,
}

impl Source {
    /// Maximum size of a file in bytes: 4 MiB.
    pub const MAX_BYTES: usize = 4 << 20;

    /// Creates a source from a name and a text. A leading byte order mark is removed from the text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        let name = name.into();
        let path = PathBuf::from(&name);
        Self::with_path(name, path, text.into())
    }

    fn with_path(name: String, path: PathBuf, mut text: String) -> Arc<Self> {
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        let bytes = text.as_bytes();
        // Line ends as in YAML: "\n", "\r\n" or "\r".
        let ends_line = |i: usize| match bytes[i] {
            b'\n' => true,
            b'\r' => bytes.get(i + 1) != Some(&b'\n'),
            _ => false,
        };
        let line_starts =
            std::iter::once(0).chain((0..bytes.len()).filter(|&i| ends_line(i)).map(|i| i + 1));
        let line_starts = line_starts.collect();
        Arc::new(Self {
            name,
            path,
            text,
            line_starts,
        })
    }

    /// Creates a source from the bytes of a file.
    ///
    /// # Errors
    ///
    /// Returns an error if there are more than 4 MiB, if there is a NUL byte or a byte order mark of
    /// UTF-16, or if the bytes are not valid UTF-8.
    pub fn read(name: impl Into<String>, bytes: Vec<u8>) -> Result<Arc<Self>, Diagnostic> {
        let name = name.into();
        let path = PathBuf::from(&name);
        Self::read_as(name, path, bytes)
    }

    /// Creates a source from the bytes of the file at `path`, as [`Source::read`] does.
    pub(crate) fn read_file(path: &Path, bytes: Vec<u8>) -> Result<Arc<Self>, Diagnostic> {
        Self::read_as(path.display().to_string(), path.to_path_buf(), bytes)
    }

    fn read_as(name: String, path: PathBuf, bytes: Vec<u8>) -> Result<Arc<Self>, Diagnostic> {
        if bytes.len() > Self::MAX_BYTES {
            return Err(Self::too_large(&name));
        }
        let not_text = Diagnostic::error(format!("'{name}' is not a text file"));
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            return Err(not_text.hint("it seems to be UTF-16: save it as UTF-8"));
        }
        if bytes.contains(&0) {
            return Err(not_text);
        }
        String::from_utf8(bytes)
            .map(|text| Self::with_path(name, path, text))
            .map_err(|error| {
                let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
                let line = valid.split(|&byte| byte == b'\n').count();
                not_text.hint(format!("line {line} is not UTF-8: save the file as UTF-8"))
            })
    }

    fn too_large(name: &str) -> Diagnostic {
        Diagnostic::error(format!("'{name}' is larger than 4 MiB"))
    }

    /// Returns an error if the text is longer than [`Source::MAX_BYTES`].
    pub(crate) fn check_size(&self) -> Result<(), Diagnostic> {
        if self.text.len() > Self::MAX_BYTES {
            Err(Self::too_large(&self.name))
        } else {
            Ok(())
        }
    }

    /// Returns the name that messages use for the text, such as the path of its file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the name as a path. A text that is not a file has such a path as well.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the line and the column of a byte offset, both counted from 1; columns count characters.
    #[must_use]
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = char_boundary(&self.text, offset);
        let line = self.line_of(offset);
        (
            line + 1,
            self.text[self.line_starts[line]..offset].chars().count() + 1,
        )
    }

    /// Returns whether both sources have the same name and text.
    pub(super) fn is(&self, other: &Self) -> bool {
        std::ptr::eq(self, other) || (self.name == other.name && self.text == other.text)
    }

    /// Returns the line that contains a byte offset, counted from 0.
    pub(super) fn line_of(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset) - 1
    }

    /// Returns the byte range of a line (counted from 0), without its line end.
    #[cfg(feature = "snippets")]
    pub(super) fn line_range(&self, line: usize) -> Range<usize> {
        let start = self.line_starts[line];
        let end = self
            .line_starts
            .get(line + 1)
            .copied()
            .unwrap_or(self.text.len());
        let text = self.text[start..end].trim_end_matches(['\r', '\n']);
        start..start + text.len()
    }
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Source({}, {} bytes)", self.name, self.text.len())
    }
}

/// Returns the largest character boundary that is not greater than `offset`.
pub(super) fn char_boundary(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

/// A source span: a byte range of a source that lies inside the text and starts and ends on character
/// boundaries.
#[derive(Clone)]
pub struct Place {
    source: Arc<Source>,
    start: usize,
    end: usize,
}

impl Place {
    /// Creates the span of the bytes `range`. Bounds beyond the end of the text or inside a character
    /// are rounded down to a character boundary; a reversed range becomes empty.
    #[must_use]
    pub fn new(source: &Arc<Source>, range: Range<usize>) -> Self {
        let start = char_boundary(&source.text, range.start);
        let end = char_boundary(&source.text, range.end).max(start);
        Self {
            source: Arc::clone(source),
            start,
            end,
        }
    }

    /// Returns the source of the span.
    #[must_use]
    pub fn source(&self) -> &Arc<Source> {
        &self.source
    }

    /// Returns the byte range of the span in the text of the source.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }

    /// Returns the line in which the span starts, counted from 1.
    #[must_use]
    pub fn line(&self) -> usize {
        self.source.line_of(self.start) + 1
    }

    /// Returns the column at which the span starts, counted from 1 in characters.
    #[must_use]
    pub fn column(&self) -> usize {
        self.source.line_column(self.start).1
    }

    /// Returns the text of the span.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.source.text[self.range()]
    }

    /// Returns the span of the bytes `range` of this span's own text, clipped to this span: the place
    /// of a mistake inside a scalar.
    #[must_use]
    pub fn within(&self, range: Range<usize>) -> Self {
        let offset = |byte: usize| self.start.saturating_add(byte).min(self.end);
        Self::new(&self.source, offset(range.start)..offset(range.end))
    }

    /// Returns the first line of the span, which identifies a mapping that lacks a key.
    pub(crate) fn first_line(&self) -> Self {
        let end = self.text().find(['\n', '\r']);
        self.within(0..end.unwrap_or(usize::MAX))
    }
}

impl PartialEq for Place {
    fn eq(&self, other: &Self) -> bool {
        self.range() == other.range() && self.source.is(&other.source)
    }
}

impl fmt::Debug for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.source.line_column(self.start);
        write!(
            f,
            "{}:{line}:{column}+{}",
            self.source.name,
            self.end - self.start
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{Place, Source};

    #[test]
    fn columns_are_characters_and_a_byte_order_mark_is_none() {
        let source = Source::new("a", "\u{feff}äß: x\r\ny: z\rw\n");
        assert_eq!(source.text(), "äß: x\r\ny: z\rw\n");
        assert_eq!(source.line_column(0), (1, 1));
        assert_eq!(source.line_column(6), (1, 5));
        assert_eq!(source.line_column(9), (2, 1));
        assert_eq!(source.line_column(14), (3, 1));
        assert_eq!(source.line_column(16), (4, 1));
        assert_eq!(source.line_column(usize::MAX), (4, 1));
        assert_eq!(source.line_column(1), (1, 1));
        assert_eq!(Source::new("a", "").line_column(0), (1, 1));
    }

    #[test]
    fn places_stay_inside_the_text_and_between_characters() {
        let source = Source::new("a", "äö: cos(ü)");
        let place = Place::new(&source, 6..99);
        assert_eq!(place.text(), "cos(ü)");
        assert_eq!((place.line(), place.column()), (1, 5));
        assert_eq!(place.within(4..5).text(), "");
        assert_eq!(place.within(4..6).text(), "ü");
        assert_eq!(place.within(6..usize::MAX).text(), ")");
        assert_eq!(place.within(50..60).range(), 13..13);
        let (start, end) = (5, 2);
        assert_eq!(Place::new(&source, start..end).text(), "");
        assert_eq!(format!("{place:?}"), "a:1:5+7");
        assert_eq!(place, Place::new(&Source::new("a", "äö: cos(ü)"), 6..13));
    }

    #[test]
    fn what_is_no_text_is_refused() {
        let message = |bytes: &[u8]| {
            let error = Source::read("a.yaml", bytes.to_vec()).expect_err("no text");
            (
                error.message().to_owned(),
                error.hint_text().map(str::to_owned),
            )
        };
        let not_text = "'a.yaml' is not a text file".to_owned();
        assert_eq!(message(b"\x89PNG\0"), (not_text.clone(), None));
        let hint = "line 2 is not UTF-8: save the file as UTF-8".to_owned();
        assert_eq!(message(b"a: b\nc: \xe4\n"), (not_text.clone(), Some(hint)));
        let hint = "it seems to be UTF-16: save it as UTF-8".to_owned();
        assert_eq!(message(b"\xff\xfea\0"), (not_text, Some(hint)));
        let large = vec![b'a'; (4 << 20) + 1];
        assert_eq!(message(&large).0, "'a.yaml' is larger than 4 MiB");
        assert!(Source::read("a.yaml", large[1..].to_vec()).is_ok());
    }
}
