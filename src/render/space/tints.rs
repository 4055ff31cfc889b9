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

/// Number of entries of a table of classes; those beyond the known ones stand for samples that show nothing.
pub(super) const TABLE: usize = 1 << CLASS_BITS;

/// Limit of the number of tables that are remembered.
const MAX_TABLES: usize = 256;

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
    /// Tables of classes, and their numbers by name.
    tables: Vec<[u32; TABLE]>,
    names: FastMap<TableName, usize>,
}

/// Name of a table of classes: the number of a stamp, and the class and the appearance of a copy.
pub(super) type TableName = (usize, u16, ([u32; 6], [u32; 7]));

impl Tints {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.appearances.clear();
        self.appearances.push(Appearance::NONE);
        self.classes.clear();
        self.colours.clear();
        self.forget_tables();
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
        // A solid of thousands of faces by their normals, for which there is no room at all.
        if self.colours.len() == usize::from(MAX_CLASS) {
            return MAX_CLASS;
        }
        self.colours.push(colour);
        let class = u16::try_from(self.colours.len()).unwrap_or(MAX_CLASS);
        self.classes.insert(colour, class);
        class
    }

    /// Returns an appearance by its number.
    pub(super) fn appearance(&self, number: u32) -> Appearance {
        self.appearances[number as usize]
    }

    /// Returns the classes of colours, fewer than [`TABLE`], that have a name, by which the table may be remembered.
    pub(super) fn table(
        &mut self,
        name: TableName,
        buffer: &mut Buffer,
        colours: impl Iterator<Item = Colour>,
    ) -> &[u32; TABLE] {
        let number = match self.names.get(&name) {
            Some(number) => *number,
            None => {
                let colours: Vec<Colour> = colours.collect();
                let is_new = |colour: &&Colour| !self.classes.contains_key(*colour);
                let new = colours.iter().filter(is_new).count();
                self.make_room(new, buffer);
                if self.tables.len() == MAX_TABLES {
                    self.forget_tables();
                }
                let mut table = [u32::MAX; TABLE];
                for (class, colour) in table.iter_mut().zip(colours) {
                    *class = u32::from(self.class(colour));
                }
                self.tables.push(table);
                self.names.insert(name, self.tables.len() - 1);
                self.tables.len() - 1
            }
        };
        &self.tables[number]
    }

    fn forget_tables(&mut self) {
        self.names.clear();
        self.tables.clear();
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
        self.forget_tables();
    }

    /// Returns the colours of the samples in a row, if they are [settled](Self::settle).
    pub(super) fn row(&self, y: usize) -> &[Colour] {
        &self.samples[y * SIDE..(y + 1) * SIDE]
    }
}

#[cfg(test)]
mod tests {
    use tiny_skia::Pixmap;

    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::instancing::{Appearance, Tint};
    use crate::render::space::{Camera, Shade, SpaceOptions, draw};
    use crate::render::{Options, Size};
    use crate::style::{Colour, View};

    /// Draws a scene from the front, a pixel a unit.
    fn drawn(text: String) -> Pixmap {
        let source = Source::new("test", text);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let (model, doubts) = document.resolve(&[]).unwrap();
        assert!(doubts.is_empty(), "{doubts}");
        let graph = model.compile_in_space(false).unwrap();
        let options = Options::default()
            .size(Size::Long(40))
            .style(model.metadata().style.clone())
            .view(View::default());
        let camera = Camera::default().from([0.0, 0.0]);
        let space = SpaceOptions::default()
            .camera(camera)
            .shade(Some(Shade::None));
        draw(&graph, Some(1), &options, &space, None)
            .unwrap()
            .pixmap
    }

    /// Instances of four boxes are copies of a stamp, with more colours than a key has classes.
    #[test]
    fn tints_of_copies_are_composed_with_those_inside() {
        let tint = |red: u32, green: u32, blue: u32| {
            format!("tint: {{color: \"rgb({red}, {green}, {blue})\", alpha: 1/2}}")
        };
        let mut text = "kind: instancing\nspace: 3\nobjects:\n  four:\n".to_owned();
        for at in 0..4 {
            let (x, y, tint) = (at % 2, at / 2, tint(80 * at, 0, 0));
            text.push_str(&format!(
                "  - {{box: {{}}, translate: [{x}, {y}, 0], {tint}}}\n"
            ));
        }
        text.push_str("scene:\n");
        for at in 0..400 {
            let (x, y) = (at % 20, at / 20);
            let (left, low, tint) = (2 * x, 2 * y, tint(0, 12 * x, 12 * y));
            let place = format!("translate: [{left}, {low}, 0]");
            text.push_str(&format!("  - {{object: four, {place}, {tint}}}\n"));
        }
        text.push_str("style: {fill: \"#404040\"}\n");
        let pixmap = drawn(text);
        let tint = |colour: [u32; 3]| {
            let [red, green, blue] = colour.map(|part| u8::try_from(part).unwrap());
            Appearance::of(Tint::cover(Colour::of_rgba([red, green, blue, 255]), 0.5))
        };
        for (at, pixel) in (0u32..).zip(pixmap.pixels()) {
            let (x, y) = (at % 40, 39 - at / 40);
            let outer = tint([0, 12 * (x / 2), 12 * (y / 2)]);
            let inner = tint([80 * (x % 2 + 2 * (y % 2)), 0, 0]);
            let expected = outer.over(inner).on(Colour::grey(64)).rgba();
            let found = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
            assert_eq!(found, expected, "{x} {y}");
        }
    }

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
        let pixmap = drawn(text);
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
