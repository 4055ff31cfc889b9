//! Conversion of validated values to the nodes of a file.

use crate::document::node::{Key, Node, Value};
use crate::geometry::{DVec2, DVec3};
use crate::metadata::Description;
use crate::rule::{BaseElement, Piece};
use crate::style::{Colour, DensityView, Named, Palette, SpaceView, Style, Tube, View, Width};
use crate::symmetry::Symmetry;

use super::{NumberText, PointText};

/// A mapping under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Entries(Vec<(Key, Node)>);

impl Entries {
    /// Sets the value of a key, replacing an existing one.
    pub(crate) fn set(mut self, key: &str, value: Value) -> Self {
        let node = Node::from(value);
        match self.0.iter_mut().find(|(known, _)| known.name == key) {
            Some((_, old)) => *old = node,
            None => self.0.push((Key::new(key), node)),
        }
        self
    }

    pub(crate) fn set_some(self, key: &str, value: Option<Value>) -> Self {
        match value {
            Some(value) => self.set(key, value),
            None => self,
        }
    }

    /// Appends an entry without a check: the reader of the file reports a duplicate name.
    pub(crate) fn add(mut self, name: impl Into<String>, value: Value) -> Self {
        self.0.push((Key::new(name), value.into()));
        self
    }

    /// Appends the entries of another mapping.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes the entries that another mapping has with equal values.
    fn without(mut self, other: &Self) -> Self {
        let same = |(key, node): &(Key, Node), (other, as_node): &(Key, Node)| {
            key.name == other.name && node.same_value(as_node)
        };
        self.0
            .retain(|entry| !other.0.iter().any(|known| same(entry, known)));
        self
    }

    pub(crate) fn value(self) -> Value {
        Value::Mapping(self.0)
    }
}

pub(crate) fn sequence(values: impl IntoIterator<Item = Value>) -> Value {
    Value::Sequence(values.into_iter().map(Node::from).collect())
}

pub(crate) fn base_element(element: &BaseElement) -> Value {
    let start = element.start();
    let mut pieces = element.pieces();
    // `closed` implies the last side of a polygon.
    if let (true, [others @ .., Piece::Line(_)]) = (element.is_closed(), pieces) {
        pieces = others;
    }
    let pieces = pieces.iter().map(|piece| match *piece {
        Piece::Line(end) => PointText::from(end).0,
        Piece::Cubic(a, b, end) => Entries::default()
            .set("curve", PointText::from(end).0)
            .set(
                "control",
                sequence([a, b].map(|point| PointText::from(point).0)),
            )
            .value(),
    });
    let points = [PointText::from(start).0].into_iter().chain(pieces);
    Entries::default()
        .set("points", sequence(points))
        .set("closed", Value::Bool(element.is_closed()))
        .value()
}

pub(crate) fn description(entries: Entries, description: &Description) -> Entries {
    let Description {
        title,
        about,
        source,
        tags,
    } = description;
    let text = |text: &String| Value::Text(text.clone());
    let tags = (!tags.is_empty()).then(|| sequence(tags.iter().map(text)));
    entries
        .set_some("title", title.as_ref().map(text))
        .set_some("about", about.as_ref().map(text))
        .set_some("source", source.as_ref().map(text))
        .set_some("tags", tags)
}

/// Returns the entries of a symmetry that differ from the defaults.
pub(crate) fn symmetry(symmetry: &Symmetry) -> Value {
    let number = |value: f64| NumberText::from(value).0;
    let axis = Some(symmetry.axis).filter(|&axis| symmetry.mirror && axis != 90.0);
    let centre = Some(symmetry.centre).filter(|&centre| centre != DVec2::ZERO);
    Entries::default()
        .set("rotate", number(symmetry.rotate.into()))
        .set_some("mirror", symmetry.mirror.then_some(Value::Bool(true)))
        .set_some("centre", centre.map(|centre| PointText::from(centre).0))
        .set_some("axis", axis.map(number))
        .value()
}

/// Returns the entries of a style that differ from the defaults.
pub(crate) fn style(style: &Style) -> Entries {
    let entries = |style: &Style| {
        let colour = |colour: Option<Colour>| colour.map(colour_text);
        let width = match style.width {
            Width::Pixels(width) => NumberText::from(width).0,
            Width::Relative(width) => Entries::default()
                .set("relative", NumberText::from(width).0)
                .value(),
        };
        Entries::default()
            .set_some("stroke", colour(style.stroke))
            .set_some("fill", colour(style.fill))
            .set_some("background", colour(style.background))
            .set("width", width)
            .set("cap", Value::Text(style.cap.name().into()))
            .set("join", Value::Text(style.join.name().into()))
            .set("blend", Value::Text(style.blend.name().into()))
            .set("color_by", Value::Text(style.color_by.name().into()))
            .set("palette", palette(&style.palette))
            .set_some("color_range", style.color_range.map(range))
            .set_some("tube", style.tube.map(tube))
    };
    entries(style).without(&entries(&Style::default()))
}

pub(super) fn colour_text(colour: Colour) -> Value {
    Value::Text(format!("{colour:#}"))
}

fn range(range: [f64; 2]) -> Value {
    sequence(range.map(|end| NumberText::from(end).0))
}

fn tube(tube: Tube) -> Value {
    let entries = Entries::default().set("sides", NumberText::from(f64::from(tube.sides)).0);
    entries.set("width", NumberText::from(tube.width).0).value()
}

fn palette(palette: &Palette) -> Value {
    let name = palette.name();
    if Palette::named(name).is_ok_and(|known| known == *palette) {
        Value::Text(name.into())
    } else {
        sequence(palette.colours().iter().copied().map(colour_text))
    }
}

/// Returns the entries of a density that are given.
pub(crate) fn density(density: &DensityView) -> Entries {
    let number = |value: f64| NumberText::from(value).0;
    let name = |name: &str| Value::Text(name.into());
    let points = { density.points }.map(|points| Value::Text(points.to_string()));
    Entries::default()
        .set_some("method", density.method.map(|it| name(it.name())))
        .set_some("points", points)
        .set_some("tone", density.tone.map(|it| name(it.name())))
        .set_some("gamma", density.gamma.map(number))
        .set_some("oversample", density.oversample.map(|it| number(it.into())))
        .set_some("kernel", density.kernel.map(number))
}

/// Returns the entries of a view that differ from the defaults.
pub(crate) fn view(view: &View) -> Entries {
    let number = |value| NumberText::from(value).0;
    let entries = |view: &View| {
        let window = view.window.map(|window| sequence(window.map(number)));
        Entries::default()
            .set_some("window", window)
            .set_some("margin", view.margin.map(number))
    };
    entries(view).without(&entries(&View::default()))
}

/// Returns the entries of a view in space.
pub(crate) fn space_view(view: &SpaceView) -> Entries {
    let number = |value: f64| NumberText::from(value).0;
    let vector = |vector: DVec3| sequence(vector.to_array().map(number));
    let angles = |angles: [f64; 2]| sequence(angles.map(number));
    let plane = |normal: DVec3, at: f64| {
        let entries = Entries::default().set("normal", vector(normal));
        entries.set("at", number(at))
    };
    let slice = view.slice.map(|slice| {
        let entries = plane(slice.normal, slice.offset);
        let thickness = slice.thickness.map(number);
        entries.set_some("thickness", thickness).value()
    });
    let cuts = { view.cuts.iter() }.map(|cut| plane(cut.normal, cut.distance).value());
    Entries::default()
        .set_some("from", view.from.map(angles))
        .set_some("up", view.up.map(vector))
        .set_some("look_at", view.look_at.map(vector))
        .set_some("perspective", view.perspective.map(number))
        .set_some("slice", slice)
        .set_some("cut", (!view.cuts.is_empty()).then(|| sequence(cuts)))
        .set_some("shade", view.shade.map(|it| Value::Text(it.name().into())))
        .set_some("light", view.light.map(angles))
        .set_some("ambient", view.ambient.map(number))
        .set_some("occlusion", view.occlusion.map(Value::Bool))
        .set_some("shadows", view.shadows.map(Value::Bool))
}
