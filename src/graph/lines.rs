//! Recognition of graphs whose elements are lines that join each other.

use crate::geometry::{Frame, Outline};
use crate::rule::Part;

use super::{Chain, Graph, Instance, Replacement};

impl<F: Frame> Chain<F> {
    /// Returns whether every instance but the first of a fractal joins the one before it.
    pub(crate) fn is_joined(&self) -> bool {
        let mut later = self.fractals().flat_map(|fractal| fractal.iter().skip(1));
        later.all(|instance| instance.joined)
    }

    /// Returns whether the last instance joins the first one, in any of the fractals that the chain starts.
    #[must_use]
    pub fn is_ring(&self) -> bool {
        self.fractals().any(is_ring)
    }
}

/// Returns whether the last of the instances of a fractal joins the first one.
pub(crate) fn is_ring<F: Frame>(fractal: &[Instance<F>]) -> bool {
    fractal.first().is_some_and(|instance| instance.joined)
}

impl<F: Frame> Graph<F> {
    /// Returns whether every element is a visible line from end to end of its frame and is replaced by
    /// such a line.
    pub(crate) fn keeps_lines(&self) -> bool {
        self.objects.iter().all(|object| {
            object.visible
                && self.base_elements()[object.base_element].ends_meet_frame() == [true; 2]
                && match &object.replacement {
                    Replacement::Fixed(successor) => {
                        let body = &successor.body;
                        !body.instances.is_empty()
                            && body.meets_frame == [true; 2]
                            && body.is_joined()
                    }
                    Replacement::Kept | Replacement::Unresolved => true,
                    Replacement::Evaluated(alternatives) => {
                        let mut all = alternatives.iter();
                        all.all(|alternative| is_line(self.parts(alternative)))
                    }
                }
        })
    }
}

/// Returns whether the elements of the parts that stay form one line from end to end of the replaced
/// element's frame.
fn is_line(parts: &[Part]) -> bool {
    let stay = || {
        let stay = parts.iter().filter(|part| !part.placement.seeds());
        stay.filter(|part| !part.elements.is_empty())
    };
    let ends = stay().next().zip(stay().next_back());
    let meets_frame = ends.is_some_and(|(first, last)| first.meets_frame[0] && last.meets_frame[1]);
    let mut later = stay().flat_map(|part| &part.elements).skip(1);
    meets_frame && later.all(|element| element.joined)
}
