//! Reading of `style`.

use crate::expression::Scope;
use crate::style::{Blend, Cap, ColorBy, Colour, Join, Palette, Style, Tube, Width};

use super::mapping::FromNode;
use super::node::{Node, Value};
use super::reader::{Fields, Reader};
use super::shape::{Choice, Form, Shape, keys};

pub(super) const STYLE: Shape = Shape {
    what: "a style",
    keys: &[&keys![
        stroke: Form::Colour, "The colour of lines, as CSS writes it, or `none`; black if left out.";
        fill: Form::Colour, "The colour of areas, as CSS writes it; `none` if left out.";
        background: Form::Colour, "The colour behind everything, as CSS writes it, or `transparent`; if left out, white in PNG and PDF.";
        width: Form::Either(&[Form::Positive, Form::Mapping(&WIDTH)]),
            "The width of lines in pixels, 1.5 if left out; or `{relative: 0.1}`, times the element's \
             length.";
        cap: Form::variant::<Cap>(),
            "The ends of lines: a half disk, cut off at the end point, or half a width longer.";
        join: Form::variant::<Join>(), "The corners of lines: a disk, cut off, or pointed.";
        blend: Form::variant::<Blend>(),
            "How overlapping elements are mixed; if left out, those of one colour are one area.";
        color_by: Form::variant::<ColorBy>(),
            "What the colours of the palette mean: the step of an element's birth, the age or the \
             number of its fractal, its rank in it, the generator that it comes from, its direction, or in the plane its \
             angle, length, place or distance from the centre of the picture.";
        palette: Form::Either(&[Form::Choice(|| Choice { names: Palette::names().collect(), default: Palette::default().name().into(), }), Form::List(&Form::Colour, 1, None)]),
            "The colours for `color_by`: a palette's name, or a list of colours that are mixed evenly.";
        color_range: Form::List(&Form::Number, 2, Some(2)),
            "Where colours are by step, age, angle, length or place: the value of the palette's first colour and that of its last \
             one, in degrees or units of the rule; those of the picture if left out.";
        tube: Form::Either(&[Form::Whole(3, Some(48)), Form::Mapping(&TUBE)]),
            "In L-systems in space: lines are tubes of so many sides, or `{sides: 8, width: 0.1}`.";
    ]],
    alternatives: &[],
    hint: "style: {stroke: black, width: 1.5}",
};

const WIDTH: Shape = Shape {
    what: "a width",
    keys: &[&keys![
        needed relative: Form::Positive, "The width as a multiple of the element's length.";
    ]],
    alternatives: &[],
    hint: "width: 1.5 in pixels, or width: {relative: 0.1} of the element's length",
};

const TUBE: Shape = Shape {
    what: "a tube",
    keys: &[&keys![
        sides: Form::Whole(3, Some(48)), "The number of sides; 8 if left out.";
        width: Form::Positive,
            "The width of a line of width 1, in the coordinates of the file; 0.1 if left out.";
    ]],
    alternatives: &[],
    hint: "tube: 8, or tube: {sides: 8, width: 0.1}",
};

impl FromNode for Style {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let fields = reader.fields(node, &STYLE)?;
        Some(Self {
            stroke: fields.optional(reader, "stroke"),
            fill: fields.optional(reader, "fill"),
            background: fields.optional(reader, "background"),
            width: fields.read(reader, "width")?,
            cap: fields.read(reader, "cap")?,
            join: fields.read(reader, "join")?,
            blend: fields.read(reader, "blend")?,
            color_by: fields.read(reader, "color_by")?,
            palette: fields.read(reader, "palette")?,
            color_range: { fields.take("color_range") }.and_then(|node| range(reader, node)),
            tube: fields.optional(reader, "tube"),
        })
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::default())
    }
}

/// Reads a colour. Returns `None` for `none` and for null, and reports other values that are not
/// colours.
pub(super) fn read_colour(reader: &mut Reader, node: &Node) -> Option<Colour> {
    let Value::Text(text) = &node.value else {
        if !matches!(node.value, Value::Null) {
            reader.mismatch(
                node,
                "a colour",
                "quote a colour that begins with #: \"#3b7ea1\"",
            );
        }
        return None;
    };
    if text == "none" {
        return None;
    }
    let colour = Colour::parse(text);
    if colour.is_none() {
        let hint = "a colour as CSS writes it: teal, \"#3b7ea1\", \"rgb(59, 126, 161)\"";
        reader.error_with_hint(&node.place, format!("'{text}' is no colour"), hint);
    }
    colour
}

impl FromNode for Width {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        if let Value::Mapping(_) = node.value {
            let fields = reader.fields(node, &WIDTH)?;
            let Some(relative) = fields.take("relative") else {
                if matches!(&node.value, Value::Mapping(entries) if entries.is_empty()) {
                    reader.mismatch(node, WIDTH.what, WIDTH.hint);
                }
                return None;
            };
            return f64::from_node(reader, relative).map(Self::Relative);
        }
        if let Value::Text(text) = &node.value
            && let Some(pixels) = text.strip_suffix("px").map(str::trim_end)
            && pixels.parse::<f64>().is_ok()
        {
            let hint = format!("write {pixels}: widths are pixels");
            reader.error_with_hint(&node.place, "a width has no unit", hint);
            return None;
        }
        f64::from_node(reader, node).map(Self::Pixels)
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Style::default().width)
    }
}

impl FromNode for Tube {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let (sides, width) = match node.value {
            Value::Mapping(_) => {
                let fields = reader.fields(node, &TUBE)?;
                (fields.take("sides"), fields.take("width"))
            }
            _ => (Some(node), None),
        };
        let width_of = |reader: &mut Reader| match width {
            Some(width) => f64::from_node(reader, width),
            None => Some(Self::WIDTH),
        };
        let sides = match sides {
            None => 8,
            Some(node) => {
                let [least, most] = Self::SIDES;
                let value = constant(reader, node)?;
                let sides = (least..=most).find(|sides| f64::from(*sides) == value);
                if sides.is_none() {
                    let message = format!("a tube has from {least} to {most} sides");
                    reader.error_with_hint(&node.place, message, TUBE.hint);
                }
                sides?
            }
        };
        let width = width_of(reader)?;
        Some(Self { sides, width })
    }
}

/// Reads the values of the first and the last colour.
fn range(reader: &mut Reader, node: &Node) -> Option<[f64; 2]> {
    const HINT: &str = "color_range: [0, 8]";
    let entries = reader.list(node, "a list of two numbers", HINT);
    let ends: Option<Vec<f64>> = { entries.iter() }
        .map(|entry| constant(reader, entry))
        .collect();
    let range = <[f64; 2]>::try_from(ends?).ok();
    let range = range.filter(|[first, last]| first < last);
    if range.is_none() && matches!(node.value, Value::Sequence(_)) {
        let message = "a range of colours is two numbers, the smaller one first";
        reader.error_with_hint(&node.place, message, HINT);
    }
    range
}

/// Reads a constant expression whose value is not negative.
impl FromNode for f64 {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let value = constant(reader, node)?;
        if value < 0.0 {
            reader.error_with_hint(&node.place, "this cannot be negative", "0 or more");
            return None;
        }
        Some(value)
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(0.0)
    }
}

pub(super) fn constant(reader: &mut Reader, node: &Node) -> Option<f64> {
    let number = reader.number(node);
    match number.value.compile(&Scope::new()) {
        Ok(program) => program.as_constant(),
        Err(mut error) => {
            if !number.value.names().is_empty() {
                error.hint = Some("a style or view does not know the parameters".into());
            }
            let place = node.within(error.range.clone());
            reader.diagnostics.push(error.at(&place));
            None
        }
    }
}

impl FromNode for Palette {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        match &node.value {
            Value::Text(name) => {
                let palette = Palette::named(name);
                if palette.is_err() {
                    let known = crate::diagnostic::did_you_mean(name, Palette::names());
                    let hint = known.unwrap_or_else(|| {
                        format!(
                            "one of: {}",
                            Palette::names().collect::<Vec<_>>().join(", ")
                        )
                    });
                    reader.error_with_hint(
                        &node.place,
                        format!("there is no palette '{name}'"),
                        hint,
                    );
                }
                palette.ok()
            }
            Value::Sequence(entries) if !entries.is_empty() => {
                let colours: Vec<_> = entries
                    .iter()
                    .filter_map(|entry| read_colour(reader, entry))
                    .collect();
                (!colours.is_empty()).then(|| Palette::of_colours("", &colours))
            }
            _ => {
                reader.mismatch(node, "a palette", "palette: viridis, or a list of colours");
                None
            }
        }
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::default())
    }
}
