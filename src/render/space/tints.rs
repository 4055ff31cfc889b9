//! Tints of instances (Hart 1992, section 5) in a tile: the colours of its samples.
//!
//! A tile shows far more colours than a key has classes. Classes are therefore given to colours as they come, from 1;
//! when there is none left, samples take their colours, and class 0.
//!
//! Solids are opaque: alphas mix the tints of an instance with those around it, and with the colour of the
//! style, and nothing behind it shows.

use crate::fast_hash::FastMap;
use crate::instancing::Appearance;
use crate::style::Colour;

use super::buffer::{Buffer, CLASS_BITS, EMPTY, MAX_CLASS, SIDE};

/// Colours of a tile.
#[derive(Default)]
pub(super) struct Tints {
    /// Appearances of instances; the first is that of instances without tint.
    appearances: Vec<Appearance>,
    classes: FastMap<Colour, u16>,
    /// Colours of the classes from 1 on.
    colours: Vec<Colour>,
    /// Colours of the samples that have class 0, in rows.
    samples: Vec<Colour>,
}

impl Tints {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.appearances.clear();
        self.appearances.push(Appearance::NONE);
        self.classes.clear();
        self.colours.clear();
    }

    /// Returns the number of appearances.
    pub(super) fn len(&self) -> usize {
        self.appearances.len()
    }

    /// Forgets all appearances but so many.
    pub(super) fn truncate(&mut self, count: usize) {
        self.appearances.truncate(count);
    }

    /// Returns the number of the appearance of an instance inside another.
    pub(super) fn inside(&mut self, outer: u32, inner: Appearance) -> u32 {
        if inner == Appearance::NONE {
            return outer;
        }
        let appearance = self.appearances[outer as usize].over(inner);
        self.appearances.push(appearance);
        u32::try_from(self.appearances.len() - 1).unwrap_or(outer)
    }

    /// Returns the colour of a solid in an instance.
    pub(super) fn colour(&self, appearance: u32, ink: Colour) -> Colour {
        self.appearances[appearance as usize].on(ink)
    }

    /// Makes room for classes of new colours, at most [`MAX_CLASS`].
    pub(super) fn make_room(&mut self, count: usize, buffer: &mut Buffer) {
        if self.colours.len() + count > usize::from(MAX_CLASS) {
            self.settle(buffer);
        }
    }

    /// Returns the class of a colour, for which there must be [room](Self::make_room) if it is new.
    pub(super) fn class(&mut self, colour: Colour) -> u16 {
        if let Some(known) = self.classes.get(&colour) {
            return *known;
        }
        self.colours.push(colour);
        let class = u16::try_from(self.colours.len()).unwrap_or(MAX_CLASS);
        self.classes.insert(colour, class);
        class
    }

    /// Gives all samples the colours of their classes.
    pub(super) fn settle(&mut self, buffer: &mut Buffer) {
        self.samples.resize(SIDE * SIDE, Colour::BLACK);
        for (y, colours) in self.samples.chunks_mut(SIDE).enumerate() {
            for (key, colour) in buffer.row_mut(y).iter_mut().zip(colours) {
                let class = (*key & ((1 << CLASS_BITS) - 1)) as usize;
                if *key != EMPTY && class > 0 {
                    *colour = self.colours[class - 1];
                    *key = *key >> CLASS_BITS << CLASS_BITS;
                }
            }
        }
        self.classes.clear();
        self.colours.clear();
    }

    /// Returns the colours of the samples in a row, if they are [settled](Self::settle).
    pub(super) fn row(&self, y: usize) -> &[Colour] {
        &self.samples[y * SIDE..(y + 1) * SIDE]
    }
}

#[cfg(test)]
mod tests {
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::instancing::{Appearance, Tint};
    use crate::render::space::{Camera, Shade, SpaceOptions, draw};
    use crate::render::{Options, Size};
    use crate::style::{Colour, View};

    /// More colours than a key has classes, in one tile: each pixel is a cell.
    #[test]
    fn tints_are_composed_as_in_the_paper() {
        const SIDE: u8 = 40;
        let [row, column] = [0, 1].map(|which| {
            move |number: u8| match which {
                0 => [6 * number, 0, 255],
                _ => [0, 6 * number, 128],
            }
        });
        let tinted = |at: u8, [red, green, blue]: [u8; 3], what: &str, shift: &str| {
            format!(
                "  - {{{what}, translate: [{shift}, 0], \
                 tint: {{color: \"rgb({red}, {green}, {blue})\", alpha: 1/2}}}}\n"
            )
            .replace("AT", &at.to_string())
        };
        let mut text = "kind: instancing\nspace: 3\nobjects:\n  row:\n".to_owned();
        for number in 0..SIDE {
            let one = tinted(number, column(number), "box: {}", "AT, 0");
            text.push_str(&format!("  {one}"));
        }
        text.push_str("scene:\n");
        for number in 0..SIDE {
            text.push_str(&tinted(number, row(number), "object: row", "0, AT"));
        }
        text.push_str("style: {fill: \"#404040\"}\n");
        let source = Source::new("test", text);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let (model, doubts) = document.resolve(&[]).unwrap();
        assert!(doubts.is_empty(), "{doubts}");
        let graph = model.compile_in_space(false).unwrap();
        let options = Options::default()
            .size(Size::Long(SIDE.into()))
            .style(model.metadata().style.clone())
            .view(View::default());
        let camera = Camera::default().from([0.0, 0.0]);
        let space = SpaceOptions::default()
            .camera(camera)
            .shade(Some(Shade::None));
        let crate::render::space::Drawn { pixmap, .. } =
            draw(&graph, Some(1), &options, &space, None).unwrap();
        assert_eq!(pixmap.width(), u32::from(SIDE));
        let tint = |[red, green, blue]: [u8; 3]| {
            let colour = Colour::of_rgba([red, green, blue, 255]);
            Appearance::of(Tint::cover(colour, 0.5))
        };
        for (at, pixel) in (0u16..).zip(pixmap.pixels()) {
            let [x, y] = [at % 40, 39 - at / 40].map(|at| u8::try_from(at).unwrap());
            let appearance = tint(row(y)).over(tint(column(x)));
            let expected = appearance.on(Colour::grey(64)).rgba();
            let found = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
            assert_eq!(found, expected, "{x} {y}");
        }
    }
}
