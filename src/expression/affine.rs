//! Affine maps whose numbers are doubles, long numbers, or programs.

use super::program::{Arithmetic, Evaluation, Program};
use crate::geometry::{DAffine2, DMat2, DVec2};

/// Affine map of the plane over numbers of an [`Arithmetic`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Affine<N> {
    /// Images of the vectors (1, 0) and (0, 1) under the linear part.
    pub(crate) axes: [[N; 2]; 2],
    /// Image of (0, 0).
    pub(crate) origin: [N; 2],
}

impl<N: Clone> Affine<N> {
    /// Creates a linear map from its columns.
    pub(crate) fn linear<A: Arithmetic<Number = N>>(of: &mut A, axes: [[N; 2]; 2]) -> Self {
        let zero = of.decimal(0.0);
        let origin = [zero.clone(), zero];
        Self { axes, origin }
    }

    /// Creates the map that scales the x and the y axis.
    pub(crate) fn scaling<A: Arithmetic<Number = N>>(of: &mut A, [x, y]: [N; 2]) -> Self {
        let zero = of.decimal(0.0);
        Self::linear(of, [[x, zero.clone()], [zero, y]])
    }

    /// Creates the identity.
    pub(crate) fn identity<A: Arithmetic<Number = N>>(of: &mut A) -> Self {
        let one = of.decimal(1.0);
        Self::scaling(of, [one.clone(), one])
    }

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

    /// Returns the map with another image of (0, 0).
    pub(crate) fn moved_to(self, origin: [N; 2]) -> Self {
        Self { origin, ..self }
    }

    /// Returns the map x → c + L (x − c) with the linear part L of this map and a fixed point c.
    pub(crate) fn about<A: Arithmetic<Number = N>>(self, of: &mut A, centre: &[N; 2]) -> Self {
        let image = self.turned(of, centre);
        let origin = [0, 1].map(|row| of.subtract(&centre[row], &image[row]));
        self.moved_to(origin)
    }

    /// Returns the image of a vector under the linear part.
    pub(crate) fn turned<A: Arithmetic<Number = N>>(&self, of: &mut A, [x, y]: &[N; 2]) -> [N; 2] {
        let [right, up] = &self.axes;
        [0, 1].map(|row| {
            let (along, across) = (of.multiply(&right[row], x), of.multiply(&up[row], y));
            of.add(&along, &across)
        })
    }

    /// Returns the image of a point.
    pub(crate) fn image<A: Arithmetic<Number = N>>(&self, of: &mut A, point: &[N; 2]) -> [N; 2] {
        let turned = self.turned(of, point);
        [0, 1].map(|row| of.add(&turned[row], &self.origin[row]))
    }

    /// Returns the composition with a map that is applied before.
    pub(crate) fn after<A: Arithmetic<Number = N>>(&self, of: &mut A, inner: &Self) -> Self {
        Self {
            axes: inner.axes.each_ref().map(|axis| self.turned(of, axis)),
            origin: self.image(of, &inner.origin),
        }
    }

    /// Returns the map with numbers that are a function of its numbers.
    pub(crate) fn map<M>(&self, mut number: impl FnMut(&N) -> M) -> Affine<M> {
        let mut pair = |[x, y]: &[N; 2]| [number(x), number(y)];
        Affine {
            axes: self.axes.each_ref().map(&mut pair),
            origin: pair(&self.origin),
        }
    }
}

impl Affine<Program> {
    /// Returns the map if its numbers are constants.
    pub(crate) fn as_constant(&self) -> Option<DAffine2> {
        let constant = self.map(Program::as_constant);
        let pair = |[x, y]: [Option<f64>; 2]| Some(DVec2::new(x?, y?));
        let [right, up] = constant.axes.map(pair);
        Some(DAffine2::from_cols(right?, up?, pair(constant.origin)?))
    }

    /// Evaluates the product of maps, of which the first one is applied first, with constants as written.
    pub(crate) fn product<A: Evaluation>(
        of: &mut A,
        maps: &[Self],
        slots: &[A::Number],
    ) -> Affine<A::Number> {
        maps.iter().fold(Affine::identity(of), |before, map| {
            let map = map.map(|program| program.evaluate(of, slots));
            map.after(of, &before)
        })
    }
}

impl From<Affine<f64>> for DAffine2 {
    fn from(Affine { axes, origin }: Affine<f64>) -> Self {
        let [right, up] = axes.map(DVec2::from);
        Self::from_mat2_translation(DMat2::from_cols(right, up), origin.into())
    }
}
