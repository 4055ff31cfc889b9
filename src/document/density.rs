//! Reading of `density`: pictures of hits.

use crate::chaos::points_of_text;
use crate::style::{DensityView, Iteration, Tone};

use super::node::Node;
use super::reader::{Fields, Reader};
use super::shape::{Form, Member, Shape, keys};
use super::style::constant;

/// Keys that apply to pictures of the plane alone.
const PLANE: [Member; 3] = keys![
    gamma: Form::Positive, "Tones are raised to its inverse, so that few hits are shown better the larger it is; 1 if left out.";
    oversample: Form::Whole(1, Some(DensityView::MAX_OVERSAMPLE)),
        "With `method: chaos`: the number of bins across a pixel, whose colours are averaged; 1 if left out.";
    kernel: Form::Positive,
        "With `method: chaos`: the radius in pixels over which a point that is alone is spread; that of n points is less \
         by the factor n^(-2/5). Nothing is spread if left out.";
];

pub(super) const DENSITY: Shape = Shape {
    what: "a density",
    keys: &[
        &keys![
            method: Form::variant::<Iteration>(),
                "With `chaos`, a PNG of a system of maps shows random iteration, unless `--steps` or another option of elements is given.";
            points: Form::Text,
                "With `method: chaos`: the number of points, such as 10M; 10M if left out.";
            tone: Form::variant::<Tone>(),
                "How hits become tones. Without `method: chaos`, the hits are those of elements, and elements have no tones if left out.";
        ],
        &PLANE,
    ],
    alternatives: &[],
    hint: "density: {method: chaos, points: 10M, tone: log}",
};

/// Reads the density of a file. Keys for the plane alone are errors in space.
pub(super) fn read_density(
    reader: &mut Reader,
    fields: &Fields<'_>,
    in_space: bool,
) -> DensityView {
    let Some(node) = fields.take("density") else {
        return DensityView::default();
    };
    let Some(fields) = reader.fields(node, &DENSITY) else {
        return DensityView::default();
    };
    if in_space {
        for member in &PLANE {
            if let Some(node) = fields.take(member.name) {
                let message = format!(
                    "`{}` is for pictures of the plane, and this file lies in space",
                    member.name
                );
                reader.error_with_hint(
                    &node.place,
                    message,
                    "in space, a density has a method, points and a tone",
                );
            }
        }
    }
    let density = DensityView {
        method: fields.optional(reader, "method"),
        points: { fields.take("points") }.and_then(|node| points(reader, node)),
        tone: fields.optional(reader, "tone"),
        gamma: { fields.take("gamma") }.and_then(|node| {
            above_zero(reader, node, "an exponent of tones", DensityView::MAX_GAMMA)
        }),
        oversample: { fields.take("oversample") }.and_then(|node| oversample(reader, node)),
        kernel: { fields.take("kernel") }.and_then(|node| {
            above_zero(
                reader,
                node,
                "a radius of the kernel",
                DensityView::MAX_KERNEL,
            )
        }),
    };
    for (name, is_given) in [
        ("points", density.points.is_some()),
        ("oversample", density.oversample.is_some()),
        ("kernel", density.kernel.is_some()),
    ] {
        if is_given && density.method == Some(Iteration::Deterministic) {
            let message =
                format!("`{name}` is for random iteration, and the method is deterministic");
            reader.error_with_hint(fields.place_of(name), message, "method: chaos");
        }
    }
    density
}

fn points(reader: &mut Reader, node: &Node) -> Option<u64> {
    let text = reader.text(node)?;
    match points_of_text(&text) {
        Ok(points) => Some(points),
        Err(message) => {
            reader.error_with_hint(&node.place, message, "points: 10M");
            None
        }
    }
}

fn oversample(reader: &mut Reader, node: &Node) -> Option<u32> {
    let value = constant(reader, node)?;
    let found = (1..=DensityView::MAX_OVERSAMPLE).find(|count| f64::from(*count) == value);
    if found.is_none() {
        let message = format!(
            "there are from 1 to {} bins across a pixel",
            DensityView::MAX_OVERSAMPLE
        );
        reader.error_with_hint(&node.place, message, "oversample: 2");
    }
    found
}

/// Reads a number above 0 and up to a largest one.
fn above_zero(reader: &mut Reader, node: &Node, what: &str, most: f64) -> Option<f64> {
    let value = constant(reader, node)?;
    let found = (value > 0.0 && value <= most).then_some(value);
    if found.is_none() {
        let message = format!("{what} is a number above 0, up to {most}");
        reader.error_with_hint(&node.place, message, "leave it out");
    }
    found
}
