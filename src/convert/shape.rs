//! Outlines as sets of the plane in documents.

use crate::build::written::Entries;
use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::ifs::Shape;
use crate::rule::{BaseElement, Piece};

use super::Refusal;
use super::number::{point, points, value};

/// The number of pieces of an ellipse's outline.
const PIECES_OF_ELLIPSES: usize = 16;

/// Length, relative to the position, up to which a line stands for a point.
const POINT: f64 = 1e-15;

/// Writes the image of an outline under a map as a set: a mapping with one key.
pub(super) fn set(outline: &BaseElement, map: &DAffine2) -> Result<Entries, Refusal> {
    let set = Entries::default();
    let straight: Option<Vec<DVec2>> = outline
        .pieces()
        .iter()
        .map(|piece| match piece {
            Piece::Line(end) => Some(map.transform_point2(*end)),
            Piece::Cubic(..) => None,
        })
        .collect();
    let start = map.transform_point2(outline.start());
    if let Some(ends) = straight {
        let mut all: Vec<DVec2> = std::iter::once(start).chain(ends).collect();
        let small = POINT * (1.0 + start.abs().max_element());
        if all
            .iter()
            .all(|end| (*end - start).abs().max_element() <= small)
        {
            return Ok(set.set("point", point(start)));
        }
        if outline.is_closed() {
            // A polygon closes by itself.
            all.pop();
            if Shape::polygon(&all).is_some_and(|polygon| polygon.moments().is_some()) {
                return Ok(set.set("polygon", points(all)));
            }
            let ends = ends_of_line(&all).ok_or(Refusal::NoArea)?;
            return Ok(set.set("segment", points(ends.to_vec())));
        }
        let name = if all.len() == 2 {
            "segment"
        } else {
            "polyline"
        };
        return Ok(set.set(name, points(all)));
    }
    let ellipse = ellipse(outline).ok_or(Refusal::Round)?;
    let (half_axes, angle) = axes((*map * ellipse).matrix2);
    let centre = map.transform_point2(ellipse.translation);
    let form = Entries::default().set("centre", point(centre));
    Ok(if half_axes.x == half_axes.y {
        set.set("disk", form.set("radius", value(half_axes.x)).value())
    } else {
        let form = form.set("axes", point(half_axes));
        let angle = (angle != 0.0).then(|| value(angle));
        set.set("ellipse", form.set_some("rotate", angle).value())
    })
}

/// Returns the ends of the segment on which all points lie; `None` if they do not lie on a line.
fn ends_of_line(all: &[DVec2]) -> Option<[DVec2; 2]> {
    const ROUNDING: f64 = 1e-12;
    let start = *all.first()?;
    let by =
        |key: &dyn Fn(&DVec2) -> f64| all.iter().copied().max_by(|a, b| key(a).total_cmp(&key(b)));
    let along = by(&|point| point.distance_squared(start))? - start;
    let is_on_line =
        |point: &DVec2| along.perp_dot(*point - start).abs() <= ROUNDING * along.length_squared();
    if !all.iter().all(is_on_line) {
        return None;
    }
    Some([
        by(&|point| -along.dot(*point))?,
        by(&|point| along.dot(*point))?,
    ])
}

/// Returns whether an outline stands for a point: whether its extent is that of rounding errors at its place.
pub(super) fn is_point(outline: &BaseElement) -> bool {
    let start = outline.start();
    let small = POINT * (1.0 + start.abs().max_element());
    let mut ends = outline.pieces().iter().map(Piece::end);
    ends.all(|end| (end - start).abs().max_element() <= small)
}

/// Returns the map of the unit disc onto an outline; `None` if the outline is not an ellipse.
fn ellipse(outline: &BaseElement) -> Option<DAffine2> {
    const ROUNDING: f64 = 1e-12;
    let pieces = outline.pieces();
    if !outline.is_closed() || pieces.len() != PIECES_OF_ELLIPSES {
        return None;
    }
    let [quarter, half] = [4, 8].map(|count| pieces[count - 1].end());
    let centre = (outline.start() + half) / 2.0;
    let map = DAffine2::from_cols(outline.start() - centre, quarter - centre, centre);
    let Some(Shape::Outline(disc)) = Shape::ellipse(DVec2::ZERO, DVec2::ONE, 0.0) else {
        return None;
    };
    let size = map.matrix2.x_axis.length() + map.matrix2.y_axis.length();
    let near = |a: DVec2, b: DVec2| (a - b).length() <= ROUNDING * size;
    let same = |(own, of_disc): (&Piece, &Piece)| match (*own, of_disc.transformed(&map)) {
        (Piece::Cubic(a, b, c), Piece::Cubic(d, e, f)) => near(a, d) && near(b, e) && near(c, f),
        _ => false,
    };
    pieces.iter().zip(disc.pieces()).all(same).then_some(map)
}

/// Returns the half axes of the unit disc's image under a linear map, and the angle of the first axis in
/// degrees.
fn axes(linear: DMat2) -> (DVec2, f64) {
    let (x, y) = (linear.x_axis, linear.y_axis);
    let [long, short] = [x.length(), y.length()];
    if (long - short).abs() <= 1e-12 * long && x.dot(y).abs() <= 1e-12 * long * long {
        return (DVec2::splat(long), 0.0);
    }
    if x.y == 0.0 && y.x == 0.0 {
        return (DVec2::new(x.x.abs(), y.y.abs()), 0.0);
    }
    // The axes are the images of the orthogonal directions that stay orthogonal.
    let turn = 0.5 * libm::atan2(2.0 * x.dot(y), x.length_squared() - y.length_squared());
    let (cosine, sine) = (libm::cos(turn), libm::sin(turn));
    let [first, second] = [x * cosine + y * sine, y * cosine - x * sine];
    let angle = libm::atan2(first.y, first.x).to_degrees();
    (DVec2::new(first.length(), second.length()), angle)
}
