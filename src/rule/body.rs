//! Base elements in space: surfaces and solids in the unit frame.

use crate::geometry::{DAffine3, DVec3, Solid};
use crate::style::Colour;

/// Surface or solid of a base element (Kaandorp 1987, section 2.4): a convex piece, with its normal if it is flat.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Convex solid, which is flat for a surface. Its [side](Solid::side) is the normal.
    pub solid: Solid,
    /// Colour; that of the style if `None`.
    pub color: Option<Colour>,
}

impl From<Solid> for Surface {
    fn from(solid: Solid) -> Self {
        Self { solid, color: None }
    }
}

/// Base element in space: surfaces, solids and lines, in the unit frame, in which the element runs from (0, 0, 0) to
/// (1, 0, 0).
///
/// Guarantees: there is at least one surface, and all coordinates are finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    surfaces: Vec<Surface>,
    hull: Solid,
    /// Corners of the first polygon as listed, to which `face` is compared.
    face: Vec<DVec3>,
    is_closed: bool,
}

impl Body {
    /// Creates a base element from its surfaces. `face` lists the corners of the first polygon. `is_closed` states that
    /// the surfaces enclose a solid, so that no back of a surface is seen from outside.
    ///
    /// Returns `None` if there is no surface, or a coordinate that is not finite.
    #[must_use]
    pub fn new(surfaces: Vec<Surface>, face: Vec<DVec3>, is_closed: bool) -> Option<Self> {
        let hull = match surfaces.as_slice() {
            [] => return None,
            [only] => only.solid.clone(),
            several => {
                let corners = several.iter().flat_map(|it| extremes(&it.solid));
                Solid::hull(&corners.collect::<Vec<_>>())
            }
        };
        let is_finite = surfaces.iter().all(|it| it.solid.is_finite());
        is_finite.then_some(Self {
            surfaces,
            hull,
            face,
            is_closed,
        })
    }

    /// Returns the line from (0, 0, 0) to (1, 0, 0), the base element of a rule that names none.
    #[must_use]
    pub fn line() -> Self {
        let solid = Solid::hull(&[DVec3::ZERO, DVec3::X]);
        Self {
            surfaces: vec![solid.clone().into()],
            hull: solid,
            face: Vec::new(),
            is_closed: false,
        }
    }

    /// Returns the surfaces and solids.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Returns a convex solid with the same extent.
    #[must_use]
    pub fn hull(&self) -> &Solid {
        &self.hull
    }

    /// Returns the corners of the first polygon as listed; empty if there is none.
    #[must_use]
    pub fn face(&self) -> &[DVec3] {
        &self.face
    }

    /// Returns whether the surfaces enclose a solid.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }
}

/// Returns points whose convex hull contains a solid: its corners, or those of the box around a round one.
fn extremes(solid: &Solid) -> Vec<DVec3> {
    match solid.primitive() {
        None => solid.corners().to_vec(),
        Some(_) => Solid::cuboid(&solid.bounds(&DAffine3::IDENTITY))
            .corners()
            .to_vec(),
    }
}
