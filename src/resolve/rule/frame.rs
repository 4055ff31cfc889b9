//! Points, turns and base elements, which rules of the plane and of space resolve differently.

use crate::document::{
    BaseElementDocument, MoveDocument, RotateDocument, WrittenNumber, WrittenPoint,
};
use crate::expression::{Program, Scope};
use crate::geometry::{DVec3, Frame2, Frame3};
use crate::resolve::Resolver;
use crate::rule::{BaseElement, Body, RuleFrame, Turn};

use super::OfRule;

/// Frame of the elements of a rule that is resolved.
pub(in crate::resolve) trait ResolvedFrame: RuleFrame {
    /// Largest number of a direction.
    const DIRECTIONS: u32;

    /// Compiles a point in a scope. Reports mistakes.
    fn point_in<K>(
        resolver: &mut Resolver<K>,
        point: &WrittenPoint,
        scope: &Scope,
    ) -> Self::Coordinates;

    /// Compiles a point in the scope of parameters. Returns `None` if a coordinate is unknown.
    fn point<K>(resolver: &mut Resolver<K>, point: &WrittenPoint) -> Option<Self::Coordinates>;

    /// Returns a point all of whose coordinates are an expression.
    fn splat(program: &Program) -> Self::Coordinates;

    /// Compiles the factors of a move; those that are left out are 1.
    fn factors(
        resolver: &mut Resolver<OfRule<Self>>,
        factors: &[WrittenNumber],
        scope: &Scope,
    ) -> Self::Coordinates;

    /// Compiles the turns of a move.
    fn turns(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &MoveDocument,
        scope: &Scope,
    ) -> Self::Turns;

    /// Returns the base element of a rule that names none; in space, a tube of a width if one is given.
    fn line(width: Option<f64>) -> Self::BaseElement;

    /// Returns the corners of the polygon to which faces of elements must be similar; empty if there is none.
    fn face(base_element: &Self::BaseElement) -> &[DVec3];

    /// Returns whether parts of a base element have colours of their own.
    fn has_colours(base_element: &Self::BaseElement) -> bool;

    /// Resolves a base element. Reports mistakes and returns `None`.
    fn base_element(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &BaseElementDocument,
    ) -> Option<Self::BaseElement>;
}

impl ResolvedFrame for Frame2 {
    const DIRECTIONS: u32 = 4;

    fn point_in<K>(
        resolver: &mut Resolver<K>,
        point: &WrittenPoint,
        scope: &Scope,
    ) -> [Program; 2] {
        [&point.x, &point.y].map(|number| resolver.program(number, scope))
    }

    fn point<K>(resolver: &mut Resolver<K>, point: &WrittenPoint) -> Option<[Program; 2]> {
        resolver.point(point)
    }

    fn splat(program: &Program) -> [Program; 2] {
        [program.clone(), program.clone()]
    }

    fn factors(
        resolver: &mut Resolver<OfRule<Self>>,
        factors: &[WrittenNumber],
        scope: &Scope,
    ) -> [Program; 2] {
        [0, 1].map(|axis| factor(resolver, factors.get(axis), scope))
    }

    fn turns(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &MoveDocument,
        scope: &Scope,
    ) -> Program {
        match &document.rotate {
            Some(RotateDocument::Angle(angle)) => resolver.program(angle, scope),
            // Turns about axes were reported when the file was read.
            Some(RotateDocument::Turns(_)) | None => Program::constant(0.0),
        }
    }

    fn line(_: Option<f64>) -> BaseElement {
        BaseElement::line()
    }

    fn face(_: &BaseElement) -> &[DVec3] {
        &[]
    }

    fn has_colours(_: &BaseElement) -> bool {
        false
    }

    fn base_element(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &BaseElementDocument,
    ) -> Option<BaseElement> {
        resolver.plane_base_element(document)
    }
}

impl ResolvedFrame for Frame3 {
    const DIRECTIONS: u32 = 8;

    fn point_in<K>(
        resolver: &mut Resolver<K>,
        point: &WrittenPoint,
        scope: &Scope,
    ) -> [Program; 3] {
        resolver.point_in_scope(point, scope)
    }

    fn point<K>(resolver: &mut Resolver<K>, point: &WrittenPoint) -> Option<[Program; 3]> {
        resolver.point_in_space(point)
    }

    fn splat(program: &Program) -> [Program; 3] {
        [program.clone(), program.clone(), program.clone()]
    }

    fn factors(
        resolver: &mut Resolver<OfRule<Self>>,
        factors: &[WrittenNumber],
        scope: &Scope,
    ) -> [Program; 3] {
        [0, 1, 2].map(|axis| factor(resolver, factors.get(axis), scope))
    }

    fn turns(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &MoveDocument,
        scope: &Scope,
    ) -> Vec<Turn> {
        match &document.rotate {
            None => Vec::new(),
            Some(RotateDocument::Angle(angle)) => vec![Turn {
                axis: [0.0, 0.0, 1.0].map(Program::constant),
                angle: resolver.program(angle, scope),
            }],
            Some(RotateDocument::Turns(turns)) => {
                let turns = turns.iter().map(|turn| Turn {
                    axis: resolver.axis_in_scope(&turn.axis, scope),
                    angle: resolver.program(&turn.angle, scope),
                });
                turns.collect()
            }
        }
    }

    fn line(width: Option<f64>) -> Body {
        let tube = width.map(|width| super::body::tube(&[DVec3::ZERO, DVec3::X], width));
        let tube = tube.and_then(|surfaces| Body::new(surfaces, Vec::new(), true));
        tube.unwrap_or_else(Body::line)
    }

    fn face(body: &Body) -> &[DVec3] {
        body.face()
    }

    fn has_colours(body: &Body) -> bool {
        body.surfaces()
            .iter()
            .any(|surface| surface.color.is_some())
    }

    fn base_element(
        resolver: &mut Resolver<OfRule<Self>>,
        document: &BaseElementDocument,
    ) -> Option<Body> {
        resolver.body(document, resolver.kind.tube)
    }
}

/// Compiles a factor of a move; 1 if it is left out.
fn factor<K>(resolver: &mut Resolver<K>, number: Option<&WrittenNumber>, scope: &Scope) -> Program {
    number.map_or(Program::constant(1.0), |number| {
        resolver.program(number, scope)
    })
}
