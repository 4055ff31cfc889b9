//! Affine maps whose numbers are doubles, long numbers, or programs.

use super::program::{Arithmetic, Evaluation, Program};
use crate::geometry::{DAffine2, DAffine3, DMat2, DVec2, DVec3};

/// Affine map over numbers of an arithmetic, of the plane or of a space of `D` dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineOf<N, const D: usize = 2> {
    /// Images of the unit vectors along the axes under the linear part.
    pub(crate) axes: [[N; D]; D],
    /// Image of the origin.
    pub(crate) origin: [N; D],
}

impl<N: Clone, const D: usize> AffineOf<N, D> {
    /// Creates a linear map from its columns.
    pub(crate) fn linear<A: Arithmetic<Number = N>>(of: &mut A, axes: [[N; D]; D]) -> Self {
        let zero = of.decimal(0.0);
        let origin = std::array::from_fn(|_| zero.clone());
        Self { axes, origin }
    }

    /// Creates the map that scales the axes.
    pub(crate) fn scaling<A: Arithmetic<Number = N>>(of: &mut A, factors: [N; D]) -> Self {
        let zero = of.decimal(0.0);
        let mut axis = 0..;
        let axes = factors.map(|factor| {
            let mut column = std::array::from_fn(|_| zero.clone());
            column[axis.next().unwrap_or(0)] = factor;
            column
        });
        Self::linear(of, axes)
    }

    /// Creates the identity.
    pub(crate) fn identity<A: Arithmetic<Number = N>>(of: &mut A) -> Self {
        let one = of.decimal(1.0);
        Self::scaling(of, std::array::from_fn(|_| one.clone()))
    }

    /// Returns the map with another image of the origin.
    pub(crate) fn moved_to(self, origin: [N; D]) -> Self {
        Self { origin, ..self }
    }

    /// Returns the map x → c + L (x − c) with the linear part L of this map and a fixed point c.
    pub(crate) fn about<A: Arithmetic<Number = N>>(self, of: &mut A, centre: &[N; D]) -> Self {
        let image = self.turned(of, centre);
        let origin = std::array::from_fn(|row| of.subtract(&centre[row], &image[row]));
        self.moved_to(origin)
    }

    /// Returns the image of a vector under the linear part.
    pub(crate) fn turned<A: Arithmetic<Number = N>>(&self, of: &mut A, vector: &[N; D]) -> [N; D] {
        std::array::from_fn(|row| {
            let terms = self.axes.iter().zip(vector);
            let mut terms = terms.map(|(axis, along)| (&axis[row], along));
            let first = terms.next().map(|(entry, along)| of.multiply(entry, along));
            let mut sum = first.unwrap_or_else(|| of.decimal(0.0));
            for (entry, along) in terms {
                let term = of.multiply(entry, along);
                sum = of.add(&sum, &term);
            }
            sum
        })
    }

    /// Returns the image of a point.
    pub(crate) fn image<A: Arithmetic<Number = N>>(&self, of: &mut A, point: &[N; D]) -> [N; D] {
        let turned = self.turned(of, point);
        std::array::from_fn(|row| of.add(&turned[row], &self.origin[row]))
    }

    /// Returns the composition with a map that is applied before.
    pub(crate) fn after<A: Arithmetic<Number = N>>(&self, of: &mut A, inner: &Self) -> Self {
        Self {
            axes: inner.axes.each_ref().map(|axis| self.turned(of, axis)),
            origin: self.image(of, &inner.origin),
        }
    }

    /// Returns the map with numbers that are a function of its numbers.
    pub(crate) fn map<M>(&self, mut number: impl FnMut(&N) -> M) -> AffineOf<M, D> {
        let mut vector = |vector: &[N; D]| vector.each_ref().map(&mut number);
        AffineOf {
            axes: self.axes.each_ref().map(&mut vector),
            origin: vector(&self.origin),
        }
    }
}

impl<N: Clone> AffineOf<N> {
    /// Creates a rotation from the cosine and the sine of its angle.
    pub(crate) fn rotation<A: Arithmetic<Number = N>>(of: &mut A, [cosine, sine]: [N; 2]) -> Self {
        let across = [of.negate(&sine), cosine.clone()];
        Self::linear(of, [[cosine, sine], across])
    }

    /// Creates the linear map that scales the x and the y axis, then rotates each by its own angle, of
    /// which it takes the cosine and the sine (Demko, Hodges & Naylor 1985, section 4.3).
    pub(crate) fn turned_axes<A: Arithmetic<Number = N>>(
        of: &mut A,
        [x, y]: &[N; 2],
        [first, second]: [&[N; 2]; 2],
    ) -> Self {
        let right = [of.multiply(x, &first[0]), of.multiply(x, &first[1])];
        let back = of.negate(&second[1]);
        let up = [of.multiply(y, &back), of.multiply(y, &second[0])];
        Self::linear(of, [right, up])
    }

    /// Creates the linear map z → s z of complex numbers, or z → s conj z.
    pub(crate) fn complex<A: Arithmetic<Number = N>>(
        of: &mut A,
        s: [N; 2],
        conjugate: bool,
    ) -> Self {
        let mut across = [of.negate(&s[1]), s[0].clone()];
        if conjugate {
            across = across.each_ref().map(|part| of.negate(part));
        }
        Self::linear(of, [s, across])
    }
}

impl<N: Clone> AffineOf<N, 3> {
    /// Creates the rotation about a unit vector, from the cosine and the sine of its angle, by the right-hand rule
    /// (Rodrigues 1840).
    pub(crate) fn rotation_about<A: Arithmetic<Number = N>>(
        of: &mut A,
        axis: &[N; 3],
        [cosine, sine]: &[N; 2],
    ) -> Self {
        let one = of.decimal(1.0);
        let rest = of.subtract(&one, cosine);
        let axes = [0, 1, 2].map(|column| {
            [0, 1, 2].map(|row: usize| {
                let outer = of.multiply(&axis[row], &axis[column]);
                let outer = of.multiply(&outer, &rest);
                if row == column {
                    return of.add(&outer, cosine);
                }
                let across = of.multiply(&axis[3 - row - column], sine);
                // The cross product of the axis and the unit vector of the column.
                if (column + 1) % 3 == row {
                    of.add(&outer, &across)
                } else {
                    of.subtract(&outer, &across)
                }
            })
        });
        Self::linear(of, axes)
    }
}

impl AffineOf<Program, 3> {
    /// Returns the map if its numbers are constants.
    pub(crate) fn as_constant(&self) -> Option<DAffine3> {
        let constant = self.map(Program::as_constant);
        let vector = |[x, y, z]: [Option<f64>; 3]| Some(DVec3::new(x?, y?, z?));
        let [x, y, z] = constant.axes.map(vector);
        Some(DAffine3::from_cols(x?, y?, z?, vector(constant.origin)?))
    }
}

impl AffineOf<Program> {
    /// Returns the map of space that acts on x and y like this one and takes all z to 0.
    pub(crate) fn in_space(&self) -> AffineOf<Program, 3> {
        let zero = || Program::constant(0.0);
        let vector = |[x, y]: &[Program; 2]| [x.clone(), y.clone(), zero()];
        let [right, up] = self.axes.each_ref().map(vector);
        AffineOf {
            axes: [right, up, [zero(), zero(), zero()]],
            origin: vector(&self.origin),
        }
    }

    /// Returns the map if its numbers are constants.
    pub(crate) fn as_constant(&self) -> Option<DAffine2> {
        let constant = self.map(Program::as_constant);
        let pair = |[x, y]: [Option<f64>; 2]| Some(DVec2::new(x?, y?));
        let [right, up] = constant.axes.map(pair);
        Some(DAffine2::from_cols(right?, up?, pair(constant.origin)?))
    }
}

impl<const D: usize> AffineOf<Program, D> {
    /// Iterates over the expressions.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = &Program> {
        self.axes.iter().flatten().chain(&self.origin)
    }

    /// Evaluates the product of maps, of which the first one is applied first, with constants as written.
    pub(crate) fn product<A: Evaluation>(
        of: &mut A,
        maps: &[Self],
        slots: &[A::Number],
    ) -> AffineOf<A::Number, D> {
        maps.iter().fold(AffineOf::identity(of), |before, map| {
            let map = map.map(|program| program.evaluate(of, slots));
            map.after(of, &before)
        })
    }
}

impl From<DAffine3> for AffineOf<Program, 3> {
    fn from(map: DAffine3) -> Self {
        let vector = |it: DVec3| it.to_array().map(Program::constant);
        let axes = [0, 1, 2].map(|axis| map.matrix3.col(axis));
        Self {
            axes: axes.map(vector),
            origin: vector(map.translation),
        }
    }
}

impl From<DAffine2> for AffineOf<Program> {
    fn from(map: DAffine2) -> Self {
        let vector = |it: DVec2| it.to_array().map(Program::constant);
        Self {
            axes: [map.matrix2.x_axis, map.matrix2.y_axis].map(vector),
            origin: vector(map.translation),
        }
    }
}

impl From<AffineOf<f64, 3>> for DAffine3 {
    fn from(AffineOf { axes, origin }: AffineOf<f64, 3>) -> Self {
        let [x, y, z] = axes.map(DVec3::from);
        Self::from_cols(x, y, z, origin.into())
    }
}

impl From<AffineOf<f64>> for DAffine2 {
    fn from(AffineOf { axes, origin }: AffineOf<f64>) -> Self {
        let [right, up] = axes.map(DVec2::from);
        Self::from_mat2_translation(DMat2::from_cols(right, up), origin.into())
    }
}
