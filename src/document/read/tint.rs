//! Reading of tints: of instances, of maps and of elements.

use crate::document::WrittenNumber;
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::Form;
use crate::style::Colour;

mapping! {
    /// A tint as written.
    struct TintDocument: TINT = "a tint", "tint: {color: brown, alpha: 0.5}, or tint: {hue: 10, lightness: 0.1}";
    color as colour: Option<Colour> = Form::Colour, "The colour, as CSS writes it.";
    alpha: Option<WrittenNumber> = Form::Number,
        "How much it covers of what comes from further inside, from 0 to 1; all if left out.";
    hue: Option<WrittenNumber> = Form::Number,
        "Degrees that are added to the hue, here and further inside.";
    saturation: Option<WrittenNumber> = Form::Number,
        "The share of the way to full saturation, here and further inside; to none, if negative.";
    lightness: Option<WrittenNumber> = Form::Number,
        "The share of the way to white, here and further inside; to black, if negative.";
    opacity: Option<WrittenNumber> = Form::Number,
        "The share of the way to full opacity, here and further inside; to none, if negative.";
}

/// Form of a tint.
pub(super) const TINT_OF: Form = Form::Mapping(&TINT);

/// Reads a tint. Reports one that changes nothing, or that has the coverage of no colour.
impl FromNode for Box<TintDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let document = TintDocument::from_node(reader, node)?;
        let Value::Mapping(entries) = &node.value else {
            return Some(Self::new(document));
        };
        let find = |key: &str| entries.iter().find(|(known, _)| known.name == key);
        if entries.is_empty() {
            let message = "a tint needs a `color`, or a change of `hue`, `saturation`, `lightness` or `opacity`";
            reader.error_with_hint(&node.place, message, TINT.hint);
        } else if let (None, Some((_, alpha))) = (find("color"), find("alpha")) {
            let message = "`alpha` goes with `color`, and there is none";
            let hint = "tint: {color: brown, alpha: 0.5}, or tint: {opacity: -0.5}";
            reader.error_with_hint(&alpha.place, message, hint);
        }
        Some(Self::new(document))
    }
}
