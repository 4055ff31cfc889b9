//! DXF of release 12, as read by cutters and plotters: polylines in millimetres, y up, a layer for each pen.

use std::io::{self, Write};

use crate::style::Colour;

use super::options::Labels;
use super::plot::{Page, Plot};

/// Writes a plot.
pub(super) fn write(
    plot: &Plot,
    page: Page,
    labels: &Labels,
    out: &mut impl Write,
) -> io::Result<()> {
    // Comments are the only place for text; the meaning of other than ASCII characters depends on the reader.
    let is_other = |c: char| !(' '..='~').contains(&c);
    let title = labels.title.replace(is_other, "?");
    let program = concat!("kfrac ", env!("CARGO_PKG_VERSION"));
    write!(out, "999\n{title}\n999\n{program}\n")?;
    // Release 12 has no unit; the variables of later releases state millimetres.
    out.write_all(b"0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n")?;
    out.write_all(b"9\n$INSUNITS\n70\n4\n9\n$MEASUREMENT\n70\n1\n")?;
    out.write_all(b"9\n$EXTMIN\n10\n0.0\n20\n0.0\n30\n0.0\n")?;
    let [right, top] = page.size();
    write!(out, "9\n$EXTMAX\n10\n{right:.6}\n20\n{top:.6}\n30\n0.0\n")?;
    out.write_all(b"0\nENDSEC\n0\nSECTION\n2\nTABLES\n")?;
    out.write_all(b"0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n70\n0\n3\nSolid\n")?;
    out.write_all(b"72\n65\n73\n0\n40\n0.0\n0\nENDTAB\n")?;
    let names: Vec<_> = (1..).zip(plot.colours()).map(layer).collect();
    write!(out, "0\nTABLE\n2\nLAYER\n70\n{}\n", names.len())?;
    for (name, colour) in names.iter().zip(plot.colours()) {
        let index = nearest_index(colour);
        write!(
            out,
            "0\nLAYER\n2\n{name}\n70\n0\n62\n{index}\n6\nCONTINUOUS\n"
        )?;
    }
    out.write_all(b"0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n")?;
    plot.each(|layer, vertices, closed| {
        let (name, flags) = (&names[layer], u8::from(closed));
        write!(
            out,
            "0\nPOLYLINE\n8\n{name}\n66\n1\n10\n0.0\n20\n0.0\n30\n0.0\n70\n{flags}\n"
        )?;
        for &vertex in vertices {
            let [x, y] = page.place(vertex);
            write!(
                out,
                "0\nVERTEX\n8\n{name}\n10\n{x:.6}\n20\n{y:.6}\n30\n0.0\n"
            )?;
        }
        write!(out, "0\nSEQEND\n8\n{name}\n")
    })?;
    out.write_all(b"0\nENDSEC\n0\nEOF\n")
}

/// Returns the name of a layer, in the characters allowed for names: the pen's number, which plotter software
/// expects first, and its colour.
fn layer((number, colour): (u32, Colour)) -> String {
    let [red, green, blue, _] = colour.rgba();
    format!("{number}_{red:02X}{green:02X}{blue:02X}")
}

/// Returns the index of the nearest of the 255 colours: seven named ones (7 is the contrast to the
/// background), 24 hues in ten shades, and greys.
fn nearest_index(colour: Colour) -> u8 {
    let [red, green, blue, _] = colour.rgba();
    if red == green && green == blue && (red == 0 || red == 255) {
        return 7;
    }
    let off = |[r, g, b]: [f64; 3]| {
        let square = |a: u8, b: f64| (f64::from(a) - b) * (f64::from(a) - b);
        square(red, r) + square(green, g) + square(blue, b)
    };
    let all = (1..=255).map(|index| (index, off(of_index(index))));
    // Of equally near colours the first is chosen: names come before shades.
    all.min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(7, |(index, _)| index)
}

/// Returns the red, green and blue of a colour index.
fn of_index(index: u8) -> [f64; 3] {
    const NAMED: [[u8; 3]; 9] = [
        [255, 0, 0],
        [255, 255, 0],
        [0, 255, 0],
        [0, 255, 255],
        [0, 0, 255],
        [255, 0, 255],
        [255, 255, 255],
        [128, 128, 128],
        [192, 192, 192],
    ];
    const VALUES: [f64; 5] = [255.0, 189.0, 129.0, 104.0, 79.0];
    const GREYS: [f64; 6] = [51.0, 80.0, 105.0, 130.0, 190.0, 255.0];
    match index {
        0..=9 => NAMED[usize::from(index.max(1) - 1)].map(f64::from),
        10..=249 => {
            let value = VALUES[usize::from(index % 10 / 2)];
            // Hues run from red over yellow, green and blue in steps of 15 degrees.
            let hue = f64::from(index / 10 - 1) / 4.0;
            let share = |at: f64| {
                let off = (hue - at).rem_euclid(6.0);
                (2.0 - off.min(6.0 - off)).clamp(0.0, 1.0)
            };
            // Odd indices are mixed with two thirds of white.
            let white = f64::from(index % 2) * 2.0 / 3.0;
            [0.0, 2.0, 4.0].map(|at| value * (white + (1.0 - white) * share(at)))
        }
        250.. => [GREYS[usize::from(index - 250)]; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_have_indices() {
        let cases = [
            ([0, 0, 0], 7),
            ([255, 255, 255], 7),
            ([255, 0, 0], 1),
            ([0, 255, 0], 3),
            ([0, 0, 255], 5),
            ([255, 63, 0], 20),
            ([255, 191, 170], 21),
            ([0, 129, 129], 134),
            ([50, 50, 50], 250),
        ];
        for ([red, green, blue], index) in cases {
            let colour = Colour::of_rgba([red, green, blue, 255]);
            assert_eq!(nearest_index(colour), index, "{colour}");
        }
    }
}
