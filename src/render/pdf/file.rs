//! Objects and cross-reference table of a PDF file.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::render::options::Labels;

/// Approximate number of bytes of a piece of content. It does not depend on the number of threads, nor does
/// the file.
const PIECE: usize = 1 << 18;

/// Piece of a page's content, with its compressed form.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) text: Vec<u8>,
    packed: Vec<u8>,
}

impl Piece {
    pub(super) fn is_full(&self) -> bool {
        self.text.len() >= PIECE
    }

    /// Compresses the piece.
    pub(super) fn pack(&mut self) {
        self.packed.clear();
        let mut encoder = ZlibEncoder::new(&mut self.packed, Compression::fast());
        // Writing to memory does not fail.
        let _ = encoder.write_all(&self.text);
        let _ = encoder.finish();
    }
}

/// Object number of the catalogue. Pieces of content follow the objects that exist once.
const CATALOG: usize = 1;
const PAGES: usize = 2;
const PAGE: usize = 3;
const INFO: usize = 4;
const PIECES: usize = 5;

/// Writer of a file of objects, with their offsets.
pub(super) struct File<W> {
    out: W,
    length: u64,
    /// Offsets of the pieces of content.
    pieces: Vec<u64>,
}

impl<W: Write> File<W> {
    pub(super) fn begin(out: W) -> io::Result<Self> {
        let mut file = Self {
            out,
            length: 0,
            pieces: Vec::new(),
        };
        // Bytes beyond ASCII mark the file as binary.
        file.write(b"%PDF-1.6\n%\xC2\xB5\xC2\xB6\n")?;
        Ok(file)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.length += bytes.len() as u64;
        // Offsets have ten digits.
        if self.length > 9_999_999_999 {
            return Err(io::Error::other("a PDF has no room for more than 10 GB"));
        }
        self.out.write_all(bytes)
    }

    /// Writes a piece of the page's content.
    pub(super) fn piece(&mut self, piece: &mut Piece) -> io::Result<()> {
        let number = PIECES + self.pieces.len();
        self.pieces.push(self.length);
        let length = piece.packed.len();
        let head = format!("{number} 0 obj\n<</Length {length}/Filter/FlateDecode>>\nstream\n");
        self.write(head.as_bytes())?;
        self.write(&piece.packed)?;
        self.write(b"\nendstream\nendobj\n")
    }

    /// Ends the file: writes the page, the metadata and the cross-reference table.
    pub(super) fn finish(mut self, page: &str, labels: &Labels) -> io::Result<()> {
        let mut places = Vec::new();
        let pieces = PIECES..PIECES + self.pieces.len();
        let contents: Vec<_> = pieces.map(|number| format!("{number} 0 R")).collect();
        let info = [
            ("Title", labels.title.as_str()),
            ("Subject", &labels.description),
            ("Creator", concat!("kfrac ", env!("CARGO_PKG_VERSION"))),
            ("Provenance", &labels.provenance),
        ];
        let given = info.into_iter().filter(|(_, text)| !text.is_empty());
        let objects = [
            (CATALOG, format!("/Type/Catalog/Pages {PAGES} 0 R")),
            (PAGES, format!("/Type/Pages/Kids[{PAGE} 0 R]/Count 1")),
            (
                PAGE,
                format!(
                    "/Type/Page/Parent {PAGES} 0 R{page}/Contents[{}]",
                    contents.join(" ")
                ),
            ),
            (
                INFO,
                given
                    .map(|(key, text)| format!("/{key}{}", string(text)))
                    .collect(),
            ),
        ];
        for (number, entries) in objects {
            places.push(self.length);
            self.write(format!("{number} 0 obj\n<<{entries}>>\nendobj\n").as_bytes())?;
        }
        places.extend(std::mem::take(&mut self.pieces));
        let (count, start) = (places.len() + 1, self.length);
        self.write(format!("xref\n0 {count}\n0000000000 65535 f \n").as_bytes())?;
        for place in places {
            self.write(format!("{place:010} 00000 n \n").as_bytes())?;
        }
        let trailer = format!("<</Size {count}/Root {CATALOG} 0 R/Info {INFO} 0 R>>");
        self.write(format!("trailer\n{trailer}\nstartxref\n{start}\n%%EOF\n").as_bytes())
    }
}

/// Formats a number with up to 8 decimals, without trailing zeros.
pub(super) fn real(value: f64) -> String {
    let text = format!("{value:.8}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// Formats a text string: literally if it is ASCII, otherwise as UTF-16.
fn string(text: &str) -> String {
    let is_plain = |c: char| c == '\n' || c == '\t' || (' '..='~').contains(&c);
    let text = text.replace('\r', "");
    if text.chars().all(is_plain) {
        let escaped = text.replace('\\', "\\\\");
        return format!("({})", escaped.replace('(', "\\(").replace(')', "\\)"));
    }
    let units = text.encode_utf16().map(|unit| format!("{unit:04X}"));
    format!("<FEFF{}>", units.collect::<String>())
}
