//! Colours of single elements, for files that hold a colour for each.

use crate::geometry::Frame;
use crate::graph::{Graph, Object};
use crate::instancing::Appearance;
use crate::style::{ColorProperty, Colour, Style};

use super::classes::Classes;
use super::space::{SpaceError, ink};

/// Colours of the elements of an approximant, by the properties that an element knows of itself.
pub(super) struct Colours<'a> {
    style: &'a Style,
    classes: Classes,
}

impl<'a> Colours<'a> {
    /// Returns the colours of approximant `steps`; an error if they depend on other elements.
    pub(super) fn of<F: Frame>(
        style: &'a Style,
        graph: &Graph<F>,
        steps: u32,
    ) -> Result<Self, SpaceError> {
        use ColorProperty::{Object, Step, Tint, Uniform};
        match style.color_by.property() {
            Uniform | Tint | Step | Object => Ok(Self {
                style,
                classes: Classes::before_survey(style, graph, steps),
            }),
            _ => Err(SpaceError::ColorBy(style.color_by)),
        }
    }

    /// Returns the colour of an element of an object that is born in a step.
    pub(super) fn at<F: Frame>(
        &self,
        object: &Object<F>,
        born: u32,
        appearance: Appearance,
    ) -> Colour {
        let own = ink(self.style);
        let class = match self.style.color_by.property() {
            ColorProperty::Tint => return appearance.on(own),
            ColorProperty::Step => Some(self.classes.of_value(born.into())),
            _ => self.classes.of_object(object),
        };
        let colour = class.and_then(|class| self.classes.colour(class, self.style));
        colour.unwrap_or(own)
    }

    /// Returns the style.
    pub(super) fn style(&self) -> &'a Style {
        self.style
    }

    /// Returns the classes, for symbols.
    pub(super) fn classes(&self) -> Classes {
        self.classes
    }
}
