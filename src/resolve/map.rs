//! Resolution of affine maps of the plane and of space.

use crate::document::{InterpolationDocument, LinearDocument, MapDocument, WrittenPoint};
use crate::expression::{AffineOf, Arithmetic, Folding, Program, Scope, Symbols};
use crate::geometry::{DAffine2, DAffine3};
use crate::ifs::PointOf;

use super::ifs::{Maps, OfIfs};
use super::instancing::StructureMap;
use super::{Resolver, numbers, space};

/// Affine map with `N` coordinates as files write it, with constants.
pub(super) trait WrittenMap<const N: usize>:
    StructureMap<Written = AffineOf<Program, N>>
{
    /// Compiles a point. Reports mistakes and returns `None`.
    fn point<K>(resolver: &mut Resolver<K>, document: &WrittenPoint) -> Option<[Program; N]>;

    /// Evaluates a point.
    fn value(point: &[Program; N]) -> Option<PointOf<Self>>;

    /// Resolves a linear map. Reports mistakes and returns `None`.
    fn linear_map<K>(
        resolver: &mut Resolver<K>,
        document: &LinearDocument,
    ) -> Option<AffineOf<Program, N>>;

    /// Returns the map if its numbers are constants.
    fn as_constant(written: &AffineOf<Program, N>) -> Option<Self>;

    /// Computes the maps of fractal interpolation; `None` in space, where it was reported when the file was read.
    fn interpolation(
        _resolver: &mut Resolver<OfIfs>,
        _document: &InterpolationDocument,
    ) -> Option<Maps<Self>> {
        None
    }
}

impl<K> Resolver<K> {
    /// Resolves an affine map, whose numbers are constants. Reports mistakes and returns `None`.
    pub(super) fn affine<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &MapDocument,
    ) -> Option<AffineOf<Program, N>> {
        let linear = document.linear.as_ref();
        let linear = linear.and_then(|linear| M::linear_map(self, linear));
        let shift = document.shift.as_ref().map(|it| M::point(self, it));
        let fixed = document.fixed.as_ref().map(|it| M::point(self, it));
        let linear = linear?;
        Some(match (shift, fixed) {
            (_, Some(fixed)) => linear.about(&mut Symbols, &fixed?),
            (Some(shift), None) => linear.moved_to(shift?),
            (None, None) => linear,
        })
    }
}

impl<K> Resolver<K> {
    /// Resolves a linear map whose numbers may depend on the slots of a scope. Reports mistakes and returns `None`.
    pub(super) fn linear_in_scope<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &LinearDocument,
        scope: &Scope,
    ) -> Option<AffineOf<Program, N>> {
        let constants = std::mem::replace(&mut self.constants, scope.clone());
        let varies = std::mem::replace(&mut self.varies, true);
        let map = M::linear_map(self, document);
        (self.constants, self.varies) = (constants, varies);
        map
    }
}

impl WrittenMap<2> for DAffine2 {
    fn point<K>(resolver: &mut Resolver<K>, document: &WrittenPoint) -> Option<[Program; 2]> {
        resolver.point(document)
    }

    fn value(point: &[Program; 2]) -> Option<PointOf<Self>> {
        numbers::value(point)
    }

    fn linear_map<K>(
        resolver: &mut Resolver<K>,
        document: &LinearDocument,
    ) -> Option<AffineOf<Program>> {
        match document {
            LinearDocument::Matrix([first, second]) => {
                let (first, second) = (resolver.point(first), resolver.point(second));
                // The document has rows, the map has columns.
                let ([a, c], [b, d]) = (first?, second?);
                Some(AffineOf::linear(&mut Symbols, [[a, b], [c, d]]))
            }
            LinearDocument::Axes { scale, rotate } => {
                let scale = resolver.numbers(scale.each_ref());
                let rotate = match rotate {
                    Some(rotate) => resolver.numbers(rotate.each_ref()),
                    None => Some([0.0; 2].map(Program::constant)),
                };
                let (scale, rotate) = (scale?, rotate?);
                let turns = rotate.map(|angle| Symbols.turn(&angle));
                Some(AffineOf::turned_axes(
                    &mut Symbols,
                    &scale,
                    turns.each_ref(),
                ))
            }
            LinearDocument::Complex { times, conjugate } => {
                let times = resolver.point(times)?;
                Some(AffineOf::complex(&mut Symbols, times, *conjugate))
            }
            // The notations of space were reported when the file was read.
            LinearDocument::MatrixInSpace(_) | LinearDocument::AxesInSpace { .. } => None,
        }
    }

    fn as_constant(written: &AffineOf<Program>) -> Option<Self> {
        written.as_constant()
    }

    fn interpolation(
        resolver: &mut Resolver<OfIfs>,
        document: &InterpolationDocument,
    ) -> Option<Maps> {
        resolver.interpolation(document)
    }
}

impl WrittenMap<3> for DAffine3 {
    fn point<K>(resolver: &mut Resolver<K>, document: &WrittenPoint) -> Option<[Program; 3]> {
        resolver.point_in_space(document)
    }

    fn value(point: &[Program; 3]) -> Option<PointOf<Self>> {
        space::value(point)
    }

    fn linear_map<K>(
        resolver: &mut Resolver<K>,
        document: &LinearDocument,
    ) -> Option<AffineOf<Program, 3>> {
        match document {
            LinearDocument::MatrixInSpace(rows) => {
                let [first, second, third] =
                    rows.each_ref().map(|row| resolver.point_in_space(row));
                let rows = [first?, second?, third?];
                // The document has rows, the map has columns.
                let columns =
                    [0, 1, 2].map(|column: usize| rows.each_ref().map(|row| row[column].clone()));
                Some(AffineOf::linear(&mut Folding, columns))
            }
            LinearDocument::AxesInSpace { scale, turns } => {
                let scale = scale.each_ref();
                let scale = scale.map(|factor| resolver.constant_program(factor));
                let turns: Vec<_> = turns
                    .iter()
                    .map(|turn| resolver.constant_turn(turn))
                    .collect();
                let known = scale.iter().all(|it| it.as_constant().is_some());
                let turns = turns.into_iter().collect::<Option<Vec<_>>>()?;
                let scaling = known.then(|| AffineOf::scaling(&mut Folding, scale))?;
                let turned = |map: AffineOf<Program, 3>, turn: &AffineOf<Program, 3>| {
                    turn.after(&mut Folding, &map)
                };
                Some(turns.iter().fold(scaling, turned))
            }
            // The plane's notations were reported when the file was read.
            LinearDocument::Matrix(_)
            | LinearDocument::Axes { .. }
            | LinearDocument::Complex { .. } => None,
        }
    }

    fn as_constant(written: &AffineOf<Program, 3>) -> Option<Self> {
        written.as_constant()
    }
}
