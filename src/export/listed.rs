//! Frames as rows of a table, in the plane and in space.

use crate::geometry::{DAffine2, DVec3, Frame, Frame2, Frame3, Homothety};

/// Frame whose elements are listed in tables.
pub trait Listed: Frame {
    /// Names of the columns, those of the entries of maps last.
    const COLUMNS: &'static [&'static str];
    /// Number of columns of the entries of maps.
    const ENTRIES: usize;
    /// Coordinates of an element.
    type Coordinates: AsRef<[f64]> + Send;
    /// Entries of a map, column by column.
    type Entries: AsRef<[f64]> + Send;

    /// Returns the coordinates and entries of an element in the units that a homothety leads to, where it moves the
    /// ends of the element, or all of its map; `None` if they are not finite.
    #[must_use]
    fn listed(
        self,
        place: &Homothety<Self::Point>,
        moves_map: bool,
    ) -> Option<(Self::Coordinates, Self::Entries)>;

    /// Returns the map of the plane that moves the coordinates, if these are the first and the last point in the plane.
    #[must_use]
    fn plane_map(&self) -> Option<&DAffine2> {
        None
    }
}

impl Listed for Frame2 {
    const COLUMNS: &'static [&'static str] = &[
        "fractal",
        "age",
        "index",
        "x0",
        "y0",
        "x1",
        "y1",
        "fertile",
        "direction",
        "visible",
        "a",
        "b",
        "c",
        "d",
        "e",
        "f",
    ];
    const ENTRIES: usize = 6;
    type Coordinates = [f64; 4];
    type Entries = [f64; 6];

    fn listed(mut self, place: &Homothety, moves_map: bool) -> Option<([f64; 4], [f64; 6])> {
        if !self.is_in_range() {
            return None;
        }
        let moves = !place.is_identity();
        if moves && moves_map {
            self = self.conjugated(place);
        }
        let mut ends = self.ends();
        if moves && !moves_map {
            ends = ends.map(|end| place.point(end));
        }
        let is_finite = ends.iter().all(|end| end.is_finite()) && self.is_finite();
        let [from, to] = ends;
        let ends = [from.x, from.y, to.x, to.y];
        is_finite.then(|| (ends, self.map().to_cols_array()))
    }

    fn plane_map(&self) -> Option<&DAffine2> {
        Some(self.map())
    }
}

impl Listed for Frame3 {
    const COLUMNS: &'static [&'static str] = &[
        "fractal",
        "age",
        "index",
        "x0",
        "y0",
        "z0",
        "x1",
        "y1",
        "z1",
        "ux",
        "uy",
        "uz",
        "fertile",
        "direction",
        "visible",
        "a",
        "b",
        "c",
        "d",
        "e",
        "f",
        "g",
        "h",
        "i",
        "j",
        "k",
        "l",
    ];
    const ENTRIES: usize = 12;
    type Coordinates = [f64; 9];
    type Entries = [f64; 12];

    /// Graphs in space have the coordinates of their files. The vector upwards is the normal of the element's surface:
    /// H × L, the direction of the x axis times that of the y axis, or the opposite where the map mirrors. It is zero
    /// where the map takes both to one line.
    fn listed(self, _place: &Homothety<DVec3>, _moves_map: bool) -> Option<([f64; 9], [f64; 12])> {
        let [from, to] = self.ends();
        let linear = &self.map().matrix3;
        let heading = linear.x_axis.normalize_or_zero();
        let up = heading.cross(linear.y_axis.normalize_or_zero());
        let up = match linear.determinant() < 0.0 {
            true => -up.normalize_or_zero(),
            false => up.normalize_or_zero(),
        };
        let coordinates = [from.x, from.y, from.z, to.x, to.y, to.z, up.x, up.y, up.z];
        let is_finite = self.is_in_range() && from.is_finite() && to.is_finite();
        is_finite.then(|| (coordinates, self.map().to_cols_array()))
    }
}
