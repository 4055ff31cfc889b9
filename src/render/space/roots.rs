//! Scene into which all tiles of a picture in space descend.

use crate::instancing::Appearance;
use crate::style::Colour;

use super::buffer::MAX_CLASS;
use super::forms::{Form, Forms, class};
use super::lit::Lit;
use super::scene::{ClassBy, End, Part};
use super::solid::View;
use super::turned::Turned;

/// Parts of the graph into which all tiles descend.
pub(super) struct Roots<'a> {
    pub(super) parts: &'a [Part],
    pub(super) forms: &'a Forms,
    pub(super) end: End,
    pub(super) class_by: ClassBy,
    /// Light on faces.
    pub(super) lit: Option<Lit>,
    /// Colours of the classes, or of what has no tint.
    pub(super) inks: &'a [Colour],
    /// Samples by which flat solids may exceed the hulls of their objects.
    pub(super) pad: f64,
    /// Whether instances may lie in equal positions.
    pub(super) overlap: bool,
    /// Stamps of turned instances, where there are any.
    pub(super) turned: Option<&'a Turned>,
}

impl Roots<'_> {
    /// Returns the instances of the initiator that may be seen in the row of tiles of a view.
    pub(super) fn start(&self, view: &View<'_>) -> Vec<usize> {
        let may_be_seen = |number: &usize| {
            let step = &self.forms.start[*number];
            let half = self.forms.known[step.form].half;
            let pad = self.pad / view.scale_of_box(step.offset.z + half.z);
            view.has_in_row(step.offset, half + pad)
        };
        (0..self.forms.start.len()).filter(may_be_seen).collect()
    }

    /// Returns whether the classes of samples are colours that are found tile by tile.
    pub(super) fn finds_colours(&self) -> bool {
        let by_face = self.lit.is_some_and(|lit| lit.bits().is_none());
        self.class_by == ClassBy::Tint || by_face
    }

    /// Returns the class of an element; `outer` is that of the instance that contains it.
    pub(super) fn class(&self, form: &Form, outer: u16) -> u16 {
        let class = match self.class_by {
            ClassBy::Step => u16::try_from(form.level).unwrap_or(MAX_CLASS),
            ClassBy::FirstMap => class(self.parts[form.object].origin),
            ClassBy::LastMap | ClassBy::Nothing | ClassBy::Tint | ClassBy::Normal => outer,
        };
        class.min(MAX_CLASS)
    }
    /// Returns the tint of the object of a form.
    pub(super) fn tint(&self, form: &Form) -> Appearance {
        self.parts[form.object].appearance
    }
}
