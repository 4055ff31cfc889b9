//! Vertices of PLY files (Turk 1994): text, and binary in either order of bytes.

use std::io::{self, BufRead};

use crate::geometry::DVec3;

use super::table::MAX_POINTS;

/// An error in a PLY file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlyError {
    /// A line of the header is not understood.
    #[error("line {line} of the header: {problem}")]
    Header {
        /// Number of the line, from 1.
        line: usize,
        /// Description of the mistake, and of what would be right.
        problem: String,
    },
    /// There are no vertices with coordinates.
    #[error("there is no element 'vertex' with the properties x, y and z")]
    NoVertices,
    /// A value of a text file is not a number.
    #[error("vertex {vertex}: '{text}' is not a number")]
    NotANumber {
        /// Number of the vertex, from 1.
        vertex: usize,
        /// The value, up to 40 characters.
        text: String,
    },
    /// A coordinate is not finite.
    #[error("vertex {vertex}: a coordinate is not finite")]
    NotFinite {
        /// Number of the vertex, from 1.
        vertex: usize,
    },
    /// The file has more vertices than the limit.
    #[error("there are more than {MAX_POINTS} vertices")]
    TooMany,
    /// The file ends before its last vertex.
    #[error("the file ends before the last of its vertices")]
    Ends,
    /// The file cannot be read.
    #[error("the file cannot be read: {0}")]
    Io(io::Error),
}

impl From<io::Error> for PlyError {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => Self::Ends,
            _ => Self::Io(error),
        }
    }
}

/// Order of the bytes of values, or text.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Text,
    Little,
    Big,
}

/// Type of a number.
#[derive(Clone, Copy)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Returns the value of bytes.
    #[inline]
    fn value(self, bytes: &[u8], is_big: bool) -> f64 {
        /// Returns the first bytes, the lowest one first.
        #[inline]
        fn low_first<const N: usize>(bytes: &[u8], is_big: bool) -> [u8; N] {
            let mut own = [0; N];
            own.copy_from_slice(&bytes[..N]);
            if is_big {
                own.reverse();
            }
            own
        }
        match self {
            Self::I8 => f64::from(i8::from_le_bytes(low_first(bytes, is_big))),
            Self::U8 => f64::from(bytes[0]),
            Self::I16 => f64::from(i16::from_le_bytes(low_first(bytes, is_big))),
            Self::U16 => f64::from(u16::from_le_bytes(low_first(bytes, is_big))),
            Self::I32 => f64::from(i32::from_le_bytes(low_first(bytes, is_big))),
            Self::U32 => f64::from(u32::from_le_bytes(low_first(bytes, is_big))),
            Self::F32 => f64::from(f32::from_le_bytes(low_first(bytes, is_big))),
            Self::F64 => f64::from_le_bytes(low_first(bytes, is_big)),
        }
    }
}

/// Property of an element: a number, or a list after its length.
struct Property {
    name: String,
    length: Option<Scalar>,
    scalar: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Reads the vertices of a PLY file.
///
/// # Errors
///
/// Returns an error if the header is not understood, if there are no vertices with x, y and z, if a coordinate is not
/// a finite number, or if the file cannot be read.
pub fn read_ply(mut input: impl BufRead) -> Result<Vec<DVec3>, PlyError> {
    let (encoding, elements) = header(&mut input)?;
    let mut values = Values {
        input,
        encoding,
        line: Vec::new(),
    };
    for element in &elements {
        if element.name != "vertex" {
            for _ in 0..element.count {
                values.skip(element)?;
            }
            continue;
        }
        let place = |name| {
            element
                .properties
                .iter()
                .position(|it| it.name == name && it.length.is_none())
        };
        let (Some(x), Some(y), Some(z)) = (place("x"), place("y"), place("z")) else {
            return Err(PlyError::NoVertices);
        };
        if element.count > MAX_POINTS {
            return Err(PlyError::TooMany);
        }
        // A false number must not reserve memory.
        let mut points = Vec::with_capacity(element.count.min(1 << 20));
        if encoding != Encoding::Text && element.properties.iter().all(|it| it.length.is_none()) {
            values.read_rows(element, [x, y, z], &mut points)?;
            return Ok(points);
        }
        let mut row = vec![0.0; element.properties.len()];
        for number in 1..=element.count {
            values.read(element, number, &mut row)?;
            let point = DVec3::new(row[x], row[y], row[z]);
            if !point.is_finite() {
                return Err(PlyError::NotFinite { vertex: number });
            }
            points.push(point);
        }
        return Ok(points);
    }
    Err(PlyError::NoVertices)
}

/// Maximum length of a line in bytes.
const MAX_LINE: u64 = 1 << 20;

/// Reads a line without its end.
fn read_line(input: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<()> {
    line.clear();
    let mut limited = io::Read::take(&mut *input, MAX_LINE);
    if limited.read_until(b'\n', line)? == 0 {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(())
}

fn header(input: &mut impl BufRead) -> Result<(Encoding, Vec<Element>), PlyError> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut line = Vec::new();
    for number in 1.. {
        read_line(input, &mut line)?;
        let text = String::from_utf8_lossy(&line);
        let words: Vec<&str> = text.split_whitespace().collect();
        let wrong = |problem: String| PlyError::Header {
            line: number,
            problem,
        };
        match words[..] {
            ["ply"] if number == 1 => {}
            _ if number == 1 => return Err(wrong("a PLY file starts with 'ply'".into())),
            [] | ["comment" | "obj_info", ..] => {}
            ["format", kind, _] => {
                encoding = Some(match kind {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => {
                        let known = "ascii, binary_little_endian and binary_big_endian are read";
                        return Err(wrong(format!("unknown format '{kind}': {known}")));
                    }
                });
            }
            ["element", name, count] => {
                let count = count.parse();
                elements.push(Element {
                    name: name.into(),
                    count: count.map_err(|_| wrong("the number of elements is missing".into()))?,
                    properties: Vec::new(),
                });
            }
            ["property", ref kind @ .., name] => {
                let scalar = |name: &str| {
                    Scalar::of(name).ok_or_else(|| wrong(format!("unknown type '{name}'")))
                };
                let (length, scalar) = match *kind {
                    [own] => (None, scalar(own)?),
                    ["list", length, own] => (Some(scalar(length)?), scalar(own)?),
                    _ => return Err(wrong("write 'property TYPE NAME'".into())),
                };
                let Some(element) = elements.last_mut() else {
                    return Err(wrong("a property belongs to an element".into()));
                };
                element.properties.push(Property {
                    name: name.into(),
                    length,
                    scalar,
                });
            }
            ["end_header"] => break,
            _ => return Err(wrong(format!("unknown keyword '{}'", words[0]))),
        }
    }
    let missing = || PlyError::Header {
        line: 2,
        problem: "the format is missing".into(),
    };
    Ok((encoding.ok_or_else(missing)?, elements))
}

/// Values after the header.
struct Values<R> {
    input: R,
    encoding: Encoding,
    line: Vec<u8>,
}

impl<R: BufRead> Values<R> {
    /// Reads the numbers of an element; those of lists are left out.
    fn read(&mut self, element: &Element, number: usize, row: &mut [f64]) -> Result<(), PlyError> {
        if self.encoding != Encoding::Text {
            for (property, own) in element.properties.iter().zip(row) {
                *own = self.number(property.scalar, property.length)?;
            }
            return Ok(());
        }
        read_line(&mut self.input, &mut self.line)?;
        let text = String::from_utf8_lossy(&self.line);
        let mut words = text.split_ascii_whitespace();
        let mut next = || {
            let word = words.next().ok_or(PlyError::Ends)?;
            word.parse::<f64>().map_err(|_| PlyError::NotANumber {
                vertex: number,
                text: word.chars().take(40).collect(),
            })
        };
        for (property, own) in element.properties.iter().zip(row) {
            *own = next()?;
            if property.length.is_some() {
                for _ in 0..crate::saturating::whole(*own) {
                    next()?;
                }
            }
        }
        Ok(())
    }

    /// Reads the points of all elements, which have no lists: their coordinates are the properties of these numbers.
    fn read_rows(
        &mut self,
        element: &Element,
        coordinates: [usize; 3],
        points: &mut Vec<DVec3>,
    ) -> Result<(), PlyError> {
        /// Number of bytes that are read at once, but for a longer row.
        const CHUNK: usize = 1 << 16;
        let mut size = 0;
        let places = element.properties.iter().map(|property| {
            size += property.scalar.size();
            (size - property.scalar.size(), property.scalar)
        });
        let places: Vec<(usize, Scalar)> = places.collect();
        let places = coordinates.map(|number| places[number]);
        let is_big = self.encoding == Encoding::Big;
        let mut bytes = vec![0; size * (CHUNK / size).max(1)];
        let mut left = element.count;
        while left > 0 {
            let rows = left.min(bytes.len() / size);
            let bytes = &mut bytes[..rows * size];
            self.input.read_exact(bytes)?;
            for row in bytes.chunks_exact(size) {
                let point = places.map(|(place, scalar)| scalar.value(&row[place..], is_big));
                let point = DVec3::from(point);
                if !point.is_finite() {
                    let vertex = points.len() + 1;
                    return Err(PlyError::NotFinite { vertex });
                }
                points.push(point);
            }
            left -= rows;
        }
        Ok(())
    }

    fn skip(&mut self, element: &Element) -> Result<(), PlyError> {
        if self.encoding == Encoding::Text {
            return Ok(read_line(&mut self.input, &mut self.line)?);
        }
        for property in &element.properties {
            self.number(property.scalar, property.length)?;
        }
        Ok(())
    }

    /// Reads a number; of a list, its length and all its numbers.
    fn number(&mut self, scalar: Scalar, length: Option<Scalar>) -> Result<f64, PlyError> {
        let Some(length) = length else {
            return Ok(self.bytes(scalar)?);
        };
        let length = self.bytes(length)?;
        for _ in 0..crate::saturating::whole(length) {
            self.bytes(scalar)?;
        }
        Ok(length)
    }

    #[inline]
    fn bytes(&mut self, scalar: Scalar) -> io::Result<f64> {
        let mut bytes = [0; 8];
        let size = scalar.size();
        self.input.read_exact(&mut bytes[..size])?;
        Ok(scalar.value(&bytes, self.encoding == Encoding::Big))
    }
}
