//! Transforms and sets, which structures of the plane and of space resolve differently.

use std::sync::Arc;

use crate::document::{ShapeDocument, TransformDocument, WrittenNumber};
use crate::expression::{AffineOf, Arithmetic, Folding, Program, Scope, Symbols};
use crate::geometry::{DAffine2, DAffine3, DVec3, Round, Solid};
use crate::ifs::{AffineMap, Shape};
use crate::resolve::Resolver;

use super::OfInstancing;

/// Affine map of a structure.
pub(in crate::resolve) trait StructureMap: AffineMap {
    /// Resolves a transform, whose expressions may use the slots of the scope. Reports mistakes and returns `None`.
    fn transform(
        resolver: &mut Resolver<OfInstancing<Self>>,
        document: &TransformDocument,
        scope: &Scope,
    ) -> Option<Self::Written>;

    /// Resolves a set. Reports mistakes and returns `None`.
    fn set<K>(resolver: &mut Resolver<K>, document: &ShapeDocument) -> Option<Self::Set>;

    /// Names of the canonical primitives.
    const PRIMITIVES: &[&str];

    /// Returns the canonical primitive of a name.
    fn primitive(name: &str) -> Option<Self::Set>;

    /// Returns the number of sides of a set of one shape.
    fn sides(set: &Self::Set) -> usize;

    /// Returns the [work](Program::work) of the formulas of transforms.
    fn work(transforms: &[Self::Written]) -> usize;
}

fn work<const D: usize>(transforms: &[AffineOf<Program, D>]) -> usize {
    let numbers = transforms.iter().flat_map(AffineOf::numbers);
    numbers.map(Program::work).sum()
}

impl StructureMap for DAffine2 {
    const PRIMITIVES: &[&str] = &[];

    fn transform(
        resolver: &mut Resolver<OfInstancing<Self>>,
        document: &TransformDocument,
        scope: &Scope,
    ) -> Option<AffineOf<Program>> {
        let mut two = |x: &WrittenNumber, y: &WrittenNumber| {
            [resolver.program(x, scope), resolver.program(y, scope)]
        };
        let of = &mut Symbols;
        Some(match document {
            TransformDocument::Scale([x, y]) => AffineOf::scaling(of, two(x, y)),
            TransformDocument::Translate(shift) => {
                AffineOf::identity(of).moved_to(two(&shift.x, &shift.y))
            }
            TransformDocument::Matrix([first, second]) => {
                let [a, c] = two(&first.x, &first.y);
                let [b, d] = two(&second.x, &second.y);
                AffineOf::linear(of, [[a, b], [c, d]])
            }
            TransformDocument::Rotate(angle) => {
                let [angle, _] = two(angle, angle);
                let turn = of.turn(&angle);
                AffineOf::rotation(of, turn)
            }
            TransformDocument::TranslateBack(shift) => {
                let back = two(&shift.x, &shift.y);
                let back = back.each_ref().map(|it| of.negate(it));
                AffineOf::identity(of).moved_to(back)
            }
            TransformDocument::Linear(map) => resolver.linear_in_scope::<Self, 2>(map, scope)?,
            // The notations of space were not read.
            TransformDocument::ScaleInSpace(_)
            | TransformDocument::Turns(_)
            | TransformDocument::MatrixInSpace(_) => return None,
        })
    }

    fn set<K>(resolver: &mut Resolver<K>, document: &ShapeDocument) -> Option<Shape> {
        resolver.set(document)
    }

    fn primitive(_: &str) -> Option<Shape> {
        None
    }

    fn sides(set: &Shape) -> usize {
        match set {
            Shape::Outline(outline) => outline.pieces().len(),
            Shape::Point(_) | Shape::Union(_) => 0,
        }
    }

    fn work(transforms: &[AffineOf<Program>]) -> usize {
        work(transforms)
    }
}

impl StructureMap for DAffine3 {
    const PRIMITIVES: &[&str] = &["sphere", "plane", "cylinder", "cone"];

    fn transform(
        resolver: &mut Resolver<OfInstancing<Self>>,
        document: &TransformDocument,
        scope: &Scope,
    ) -> Option<AffineOf<Program, 3>> {
        let of = &mut Folding;
        Some(match document {
            TransformDocument::ScaleInSpace(factors) => {
                let factors = factors.each_ref().map(|it| resolver.program(it, scope));
                AffineOf::scaling(of, factors)
            }
            TransformDocument::Translate(shift) => {
                AffineOf::identity(of).moved_to(resolver.point_in_scope(shift, scope))
            }
            TransformDocument::MatrixInSpace(rows) => {
                let rows = rows.each_ref().map(|it| resolver.point_in_scope(it, scope));
                // The document has rows, the map has columns.
                let columns =
                    [0, 1, 2].map(|column: usize| rows.each_ref().map(|row| row[column].clone()));
                AffineOf::linear(of, columns)
            }
            TransformDocument::Turns(turns) => {
                let mut all = AffineOf::identity(of);
                for turn in turns {
                    let angle = resolver.program(&turn.angle, scope);
                    all = resolver.turn(turn, &angle)?.after(of, &all);
                }
                all
            }
            TransformDocument::TranslateBack(shift) => {
                let back = resolver.point_in_scope(shift, scope);
                let back = back.each_ref().map(|it| of.negate(it));
                AffineOf::identity(of).moved_to(back)
            }
            // The notations of the plane were not read.
            TransformDocument::Scale(_)
            | TransformDocument::Rotate(_)
            | TransformDocument::Matrix(_)
            | TransformDocument::Linear(_) => return None,
        })
    }

    fn set<K>(resolver: &mut Resolver<K>, document: &ShapeDocument) -> Option<Arc<[Solid]>> {
        resolver.solids(document)
    }

    /// Returns a primitive of Hart 1992, section 2; of the plane y = 0, the square from -1 to 1.
    fn primitive(name: &str) -> Option<Arc<[Solid]>> {
        let round = |primitive| Solid::round(primitive, Self::IDENTITY);
        let solid = match name {
            "sphere" => round(Round::Ball),
            "cylinder" => round(Round::Cylinder),
            "cone" => round(Round::Cone),
            "plane" => {
                let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
                let (left, right) = (-1.0, 1.0);
                Solid::hull(&[
                    corner(left, left),
                    corner(left, right),
                    corner(right, right),
                    corner(right, left),
                ])
            }
            _ => return None,
        };
        Some([solid].into())
    }

    fn sides(set: &Arc<[Solid]>) -> usize {
        set.iter().map(|solid| solid.faces().len()).sum()
    }

    fn work(transforms: &[AffineOf<Program, 3>]) -> usize {
        work(transforms)
    }
}
