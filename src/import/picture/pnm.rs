//! Pictures of the Netpbm formats: PBM, PGM and PPM, plain and raw (P1 to P6).

use super::{PictureError, PixelSink, check};

/// Returns whether bytes start with the signature of a PBM, PGM or PPM.
pub(super) fn is_pnm(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'1'..=b'6', next, ..] if next.is_ascii_whitespace() || *next == b'#')
}

/// Reads the first picture of a file.
pub(super) fn read(bytes: &[u8], pixels: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
    let kind = bytes.get(1).copied().unwrap_or_default();
    let mut reader = Reader(bytes.get(2..).unwrap_or_default());
    let (width, height) = (reader.number("its width")?, reader.number("its height")?);
    check(width, height)?;
    let is_bitmap = matches!(kind, b'1' | b'4');
    let most = match is_bitmap {
        true => 1,
        false => reader.number("its largest value")?,
    };
    let most = u16::try_from(most).ok().filter(|&most| most > 0);
    let most = most.ok_or_else(|| wrong("its largest value is not from 1 to 65535"))?;
    let channels = if matches!(kind, b'3' | b'6') { 3 } else { 1 };
    let (width, height) = (size(width)?, size(height)?);
    let samples = Samples { most, is_bitmap };
    // A short file is refused before memory is taken for all of its picture.
    let row = match (kind, most) {
        (b'4', _) => width.div_ceil(8),
        (b'5' | b'6', 256..) => 2 * channels * width,
        _ => channels * width,
    };
    if kind > b'3' {
        reader.skip_one();
    }
    if reader.0.len() / row < height {
        return Err(wrong("it ends before its last pixel"));
    }
    pixels.begin(width * height, channels);
    let mut values = vec![0; channels * width];
    for _ in 0..height {
        if kind > b'3' {
            let (own, rest) = reader.0.split_at(row);
            reader.0 = rest;
            samples.raw(own, &mut values);
        } else {
            for value in &mut values {
                *value = samples.scaled(match is_bitmap {
                    true => reader.digit()?,
                    false => reader.number("a value")?,
                });
            }
        }
        pixels.add(&values);
    }
    Ok([width, height])
}

fn size(side: u64) -> Result<usize, PictureError> {
    usize::try_from(side).map_err(|_| wrong("its sides are too long"))
}

fn wrong(reason: &str) -> PictureError {
    PictureError::Pnm(reason.into())
}

/// The values of a picture.
struct Samples {
    most: u16,
    is_bitmap: bool,
}

impl Samples {
    /// Returns a value as one from 0 to 255; in bitmaps, 1 is black.
    fn scaled(&self, value: u64) -> u8 {
        if self.is_bitmap {
            return if value == 0 { 255 } else { 0 };
        }
        let most = u64::from(self.most);
        u8::try_from((value.min(most) * 255 + most / 2) / most).unwrap_or(255)
    }

    /// Reads a row of binary values.
    fn raw(&self, row: &[u8], values: &mut [u8]) {
        for (number, value) in values.iter_mut().enumerate() {
            let read = match (self.is_bitmap, self.most) {
                (true, _) => u64::from(row[number / 8] >> (7 - number % 8) & 1),
                (_, 256..) => u16::from_be_bytes([row[2 * number], row[2 * number + 1]]).into(),
                _ => row[number].into(),
            };
            *value = self.scaled(read);
        }
    }
}

/// The rest of a file.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn skip_one(&mut self) {
        self.0 = self.0.get(1..).unwrap_or_default();
    }

    /// Skips white space and comments.
    fn skip_space(&mut self) {
        while let Some(&byte) = self.0.first() {
            match byte {
                b'#' => {
                    let end = self.0.iter().position(|&byte| byte == b'\n');
                    self.0 = &self.0[end.unwrap_or(self.0.len())..];
                }
                byte if byte.is_ascii_whitespace() => self.skip_one(),
                _ => break,
            }
        }
    }

    fn number(&mut self, name: &str) -> Result<u64, PictureError> {
        self.skip_space();
        let digits = self
            .0
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let (number, rest) = self.0.split_at(digits);
        self.0 = rest;
        let number = std::str::from_utf8(number)
            .ok()
            .and_then(|it| it.parse().ok());
        number.ok_or_else(|| wrong(&format!("{name} is no whole number")))
    }

    /// Reads a pixel of a plain bitmap; no space need separate pixels.
    fn digit(&mut self) -> Result<u64, PictureError> {
        self.skip_space();
        let digit = match self.0.first() {
            Some(b'0') => 0,
            Some(b'1') => 1,
            _ => return Err(wrong("a pixel is neither 0 nor 1")),
        };
        self.skip_one();
        Ok(digit)
    }
}
