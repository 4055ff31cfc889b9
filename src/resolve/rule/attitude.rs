//! Checks of how elements in space are turned about themselves, and of their faces.

use crate::document::WrittenPoint;
use crate::geometry::{Attitude, DVec3, Direction, Frame3, Point as _};
use crate::resolve::Resolver;
use crate::rule::{ListedAttitude, ListedElement, newell};

use super::{OfRule, ResolvedFrame};

/// Largest distance of the corners of a face from those of the base element, as a multiple of its first side.
const FITS: f64 = 1e-9;

/// Least sine of the angle between an element and its normal.
const PARALLEL: f64 = 1e-12;

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    /// Reports normals along their elements, and faces that the base element does not fit. Points that are not known
    /// are NaN.
    pub(super) fn check_attitudes(
        &mut self,
        elements: &[ListedElement],
        points: &[F::Point],
        written: &[WrittenPoint],
    ) {
        for element in elements {
            let at = |number: usize| DVec3::from(points[number].coordinates());
            let along = at(element.to) - at(element.from);
            if !along.is_finite() || along == DVec3::ZERO {
                continue;
            }
            match &element.attitude {
                ListedAttitude::Least | ListedAttitude::Roll(_) => {}
                ListedAttitude::Normal(number) => {
                    let normal = at(*number);
                    let across = normal.cross(along).length();
                    if across <= PARALLEL * normal.length() * along.length() {
                        let message =
                            "this normal is along the element, and does not say how it is turned";
                        let hint = "a normal points across the element: away from its surface";
                        self.error_with_hint(&written[*number].place, message, hint);
                    }
                }
                ListedAttitude::Corners { points, up, .. } => {
                    let [from, to, other] = points.map(at);
                    let normal = (to - from).cross(other - from);
                    let size = along.length() * (other - from).length();
                    if normal.length() <= PARALLEL * size {
                        let hint = "the first three corners of the base element are a triangle, and so are these";
                        let message = "these corners lie on a line";
                        self.error_with_hint(&written[points[2]].place, message, hint);
                    } else if let Some(up) = up
                        && normal.dot(at(*up)).abs()
                            <= PARALLEL * normal.length() * at(*up).length()
                    {
                        let message = "this vector lies in the plane of the corners";
                        let hint = "`up` points away from the front";
                        self.error_with_hint(&written[*up].place, message, hint);
                    }
                }
                ListedAttitude::Face(numbers) => {
                    let face: Vec<DVec3> = numbers.iter().map(|number| at(*number)).collect();
                    // Too few corners were reported when the file was read.
                    if face.len() < 3 || !face.iter().all(|corner| corner.is_finite()) {
                        continue;
                    }
                    let base = F::face(&self.kind.base_elements[element.base_element]);
                    if let Some((corner, message)) = misfit(&face, base) {
                        let hint = "a base element is put into place by a similarity: the polygons must be similar, with \
                                    their corners in the same order";
                        self.error_with_hint(&written[numbers[corner]].place, message, hint);
                    }
                }
            }
        }
    }
}

/// Returns the number of a corner and a message for a face that is not similar to that of the base element, if there is
/// one.
fn misfit(face: &[DVec3], base: &[DVec3]) -> Option<(usize, String)> {
    let normal = newell(face.iter().copied());
    let along = face[1] - face[0];
    if normal.cross(along).length() <= PARALLEL * along.length_squared() * along.length() {
        return Some((2, "the corners of this face lie on a line".into()));
    }
    if base.is_empty() {
        return None;
    }
    if face.len() != base.len() {
        let message = format!(
            "this face has {} corners, and that of the base element {}",
            face.len(),
            base.len()
        );
        return Some((face.len() - 1, message));
    }
    let frame = Frame3::between(
        face[0],
        face[1],
        Direction::Normal,
        Attitude::Normal(normal),
    );
    let back = frame.map().inverse();
    let far = |(own, base): (&DVec3, &DVec3)| (back.transform_point3(*own) - *base).length() > FITS;
    let corner = face.iter().zip(base).position(far)?;
    let ratio = |all: &[DVec3], corner: usize| {
        (all[corner] - all[corner - 1]).length() / (all[1] - all[0]).length()
    };
    let angle = |all: &[DVec3], corner: usize| {
        let before = all[corner - 2] - all[corner - 1];
        let after = all[corner] - all[corner - 1];
        libm::atan2(before.cross(after).length(), before.dot(after)).to_degrees()
    };
    if corner < 2 {
        let message = "the face of the base element does not run from [0, 0, 0] to [1, 0, 0]: a face cannot be \
                       compared to it";
        return Some((corner, message.into()));
    }
    let rounded = |value: f64| (value * 1e6).round() / 1e6;
    let [own, other] = [ratio(face, corner), ratio(base, corner)];
    if (own - other).abs() > FITS * other {
        let message = format!(
            "side {corner} of this face is {} times as long as its first side, and that of the base element {} times",
            rounded(own),
            rounded(other)
        );
        return Some((corner, message));
    }
    let [own, other] = [angle(face, corner), angle(base, corner)];
    let message = if (own - other).abs() > 1e-6 {
        format!(
            "the angle of this face at corner {corner} is {}°, and that of the base element {}°",
            rounded(own),
            rounded(other)
        )
    } else {
        format!(
            "corner {} of this face lies beside its plane, or turns the other way",
            corner + 1
        )
    };
    Some((corner, message))
}
