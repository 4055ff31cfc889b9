//! Conversion to a production rule: objects become generators, instances become elements.

use crate::build::written::{self, Entries, sequence};
use crate::document::node::Value;
use crate::geometry::{DAffine2, DVec2, stretch};
use crate::rule::{BaseElement, Piece};

use super::number::{point, value};
use super::structure::{PlacedObject, Structure};
use super::{Keeps, Refusal};

/// Relative difference of a map's stretches below which it is a similarity.
const ROUNDING: f64 = 1e-12;

pub(super) fn write(structure: &Structure, _: Keeps) -> Result<Entries, Refusal> {
    let writer = Writer {
        structure,
        usual: structure.instances().find(|placed| placed.object.is_some()),
    };
    let entries = Entries::default().set("initiator", writer.elements(None)?);
    let entries = match structure.objects.len() {
        // A rule needs a generator: no element uses this one.
        0 => {
            let nothing = [DVec2::ZERO, DVec2::X].map(point);
            entries.set("generator", sequence(nothing))
        }
        1 => entries.set("generator", writer.elements(Some(0))?),
        count => {
            let generators = (0..count).try_fold(Entries::default(), |entries, object| {
                let elements = writer.elements(Some(object))?;
                Ok::<_, Refusal>(entries.add(name(object), elements))
            })?;
            entries.set("generators", generators.value())
        }
    };
    Ok(entries.set_some("base_element", writer.base_element()))
}

fn name(object: usize) -> String {
    format!("A{}", object + 1)
}

struct Writer<'s> {
    structure: &'s Structure,
    /// The first replaced instance, whose shape becomes the rule's base element.
    usual: Option<&'s PlacedObject>,
}

impl Writer<'_> {
    fn base_element(&self) -> Option<Value> {
        let outline = &self.structure.shapes[self.usual?.shape];
        (!outline.is_line()).then(|| written::base_element(outline))
    }

    /// Returns the elements of a generator, or of the initiator.
    fn elements(&self, object: Option<usize>) -> Result<Value, Refusal> {
        let all = self.structure.placed(object);
        let elements: Result<Vec<_>, _> = all
            .iter()
            .enumerate()
            .map(|(number, placed)| {
                let called = || self.structure.called(object, number);
                self.element(placed, &called)
            })
            .collect();
        Ok(Entries::default()
            .set("connected", Value::Bool(false))
            .set("elements", sequence(elements?))
            .value())
    }

    fn element(
        &self,
        placed: &PlacedObject,
        called: &dyn Fn() -> String,
    ) -> Result<Value, Refusal> {
        let outline = &self.structure.shapes[placed.shape];
        let similar = similarity(&placed.map, called);
        let (frame, outline) = match (placed.object, similar) {
            (_, Ok(())) => (placed.map, outline.clone()),
            (Some(_), Err(refusal)) => return Err(refusal),
            // A kept element may have a base element of its own.
            (None, Err(refusal)) => {
                let outline = image(outline, &placed.map).ok_or(refusal)?;
                (DAffine2::IDENTITY, outline)
            }
        };
        let is_usual = self
            .usual
            .is_some_and(|usual| self.structure.shapes[usual.shape] == outline);
        let is_line = self.usual.is_none() && outline.is_line();
        let flipped = frame.matrix2.determinant() < 0.0;
        let from = frame.translation;
        let flag = |no: bool| no.then_some(Value::Bool(false));
        let several = self.structure.objects.len() > 1;
        let generator = placed.object.filter(|_| several);
        let entries = Entries::default()
            .set("from", point(from))
            .set("to", point(from + frame.matrix2.x_axis))
            .set_some("direction", flipped.then(|| value(2.0)))
            .set_some("fertile", flag(placed.object.is_none()))
            .set_some("visible", flag(!placed.visible))
            .set_some("use", generator.map(|object| Value::Text(name(object))));
        let own = (!is_usual && !is_line).then(|| written::base_element(&outline));
        Ok(entries.set_some("base_element", own).value())
    }
}

/// Returns an error if a map is not a similarity, or if its rank is 0.
pub(super) fn similarity(map: &DAffine2, called: &dyn Fn() -> String) -> Result<(), Refusal> {
    let longest = stretch(&map.matrix2);
    if longest == 0.0 {
        return Err(Refusal::Point(called()));
    }
    let shortest = map.matrix2.determinant().abs() / longest;
    if longest - shortest > ROUNDING * longest {
        return Err(Refusal::Shear {
            what: called(),
            longest,
            shortest,
        });
    }
    Ok(())
}

/// Returns the image of an outline; `None` if it has no extent.
fn image(outline: &BaseElement, map: &DAffine2) -> Option<BaseElement> {
    let pieces = outline.pieces().iter();
    let pieces: Vec<Piece> = pieces.map(|piece| piece.transformed(map)).collect();
    let start = map.transform_point2(outline.start());
    BaseElement::new(start, pieces, outline.is_closed())
}
