//! Tweens: fractals between two fractals of one kind, for films that lead from one to the other.
//!
//! Generators, parts, elements, maps, objects and instances of the two correspond to each other by their order. One that
//! has no counterpart grows out of a point: an element out of the end of the chain that it would go on with, a map out of
//! its fixed point, an instance out of the image of its origin. Numbers, points, weights, colours and widths pass from one
//! value to the other. Everything else, among it directions and whether an element is fertile or visible, changes half-way.

mod chain;
mod growing;
mod maps;
mod rule;
mod structure;
mod style;
mod system;

pub(crate) use growing::{Growing, Grown, lifted, nearer_end, out_of, raised, shrunk, turned_ends};

use std::ops::{Add, Mul};

use crate::expression::{Arithmetic as _, Program, Symbols};
use crate::kind::Kind;
use crate::metadata::Metadata;
use crate::model::Model;
use crate::style::{Named, View};
use crate::symmetry::Symmetry;

/// Course of linear maps and of chains of elements in a tween.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TweenBy {
    /// Lengths and angles change evenly, so that things turn. In the plane, the images of both axes under a map turn by
    /// the smaller angle; in space, rotations turn about one axis.
    #[default]
    Polar,
    /// Entries of matrices, and coordinates of points, change evenly.
    Matrix,
}

impl Named for TweenBy {
    const NAMES: &'static [(&'static str, Self)] =
        &[("polar", Self::Polar), ("matrix", Self::Matrix)];
}

/// Reason why there is no tween between two models.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TweenError {
    /// The models are of different kinds, or one lies in the plane and the other in space.
    #[error("one is {0}, the other {1}: `kfrac convert` may give them one kind")]
    Kinds(&'static str, &'static str),
    /// The models are L-systems.
    #[error("L-systems have no tweens: `kfrac convert` may make rules or systems of them")]
    LSystems,
    /// Generators that correspond to each other draw different variables, or move different points.
    #[error(
        "the random functions of their generators '{0}' and '{1}' differ: a tween needs equal ones, or one without any"
    )]
    Draws(String, String),
    /// The digraphs of recurrent systems do not correspond.
    #[error("they have different edges, and one has more maps")]
    Edges,
    /// Validation of the system between the two fails.
    #[error("the system between them is not valid: {0}")]
    Invalid(String),
    /// The maps between the two do not contract.
    #[error("the maps between them do not contract; another course (polar, matrix) may avoid it")]
    Diverges,
}

impl Model {
    /// Returns the model at a share of the way to another model of the same kind: this model at 0, the other one at 1.
    /// The share is confined to these limits.
    ///
    /// # Errors
    ///
    /// If the kinds differ, or if the [reasons](TweenError) of a kind apply.
    pub fn toward(&self, other: &Self, share: f64, by: TweenBy) -> Result<Self, TweenError> {
        let alike = |it: &Self| (it.kind(), it.is_in_space());
        if alike(self) != alike(other) {
            return Err(TweenError::Kinds(described(self), described(other)));
        }
        if self.kind() == Kind::LSystem {
            return Err(TweenError::LSystems);
        }
        if share <= 0.0 || share >= 1.0 {
            return Ok(if share <= 0.0 { self } else { other }.clone());
        }
        let tween = Tween { share, by };
        Ok(match (self, other) {
            (Self::Rule(a), Self::Rule(b)) => rule::tween(tween, a, b)?.into(),
            (Self::RuleInSpace(a), Self::RuleInSpace(b)) => rule::tween(tween, a, b)?.into(),
            (Self::Ifs(a), Self::Ifs(b)) => system::tween(tween, a, b)?.into(),
            (Self::IfsInSpace(a), Self::IfsInSpace(b)) => system::tween(tween, a, b)?.into(),
            (Self::Instancing(a), Self::Instancing(b)) => structure::tween(tween, a, b).into(),
            (Self::InstancingInSpace(a), Self::InstancingInSpace(b)) => {
                structure::tween(tween, a, b).into()
            }
            _ => return Err(TweenError::LSystems),
        })
    }
}

/// Returns the kind of a model in words.
fn described(model: &Model) -> &'static str {
    match (model.kind(), model.is_in_space()) {
        (Kind::Rule, false) => "a production rule in the plane",
        (Kind::Rule, true) => "a production rule in space",
        (Kind::Ifs, false) => "a system of maps in the plane",
        (Kind::Ifs, true) => "a system of maps in space",
        (Kind::Instancing, false) => "a structure of objects in the plane",
        (Kind::Instancing, true) => "a structure of objects in space",
        (Kind::LSystem, false) => "an L-system in the plane",
        (Kind::LSystem, true) => "an L-system in space",
    }
}

/// Side of a tween: 0 for the model that it leaves, 1 for the one that it reaches.
type Side = usize;

/// A share of the way between two models.
#[derive(Clone, Copy, Debug)]
struct Tween {
    share: f64,
    by: TweenBy,
}

impl Tween {
    /// Returns the value between two, each of which may be a number, a vector or a matrix.
    fn between<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(self, [a, b]: [T; 2]) -> T {
        a * self.of(0) + b * self.of(1)
    }

    /// Returns the program whose value lies between those of two.
    fn program(self, [a, b]: [&Program; 2]) -> Program {
        if a == b {
            return a.in_doubles();
        }
        if let (Some(a), Some(b)) = (a.as_constant(), b.as_constant()) {
            return Program::constant(self.between([a, b]));
        }
        let of = &mut Symbols;
        let mut part = |program: &Program, share: f64| {
            let share = of.decimal(share);
            of.multiply(&program.in_doubles(), &share)
        };
        let parts = [part(a, self.of(0)), part(b, self.of(1))];
        Symbols.add(&parts[0], &parts[1])
    }

    /// Returns the share that a side has.
    fn of(self, side: Side) -> f64 {
        if side == 0 {
            1.0 - self.share
        } else {
            self.share
        }
    }

    /// Returns the side of which is taken what changes at once.
    fn nearer(self) -> Side {
        usize::from(self.share >= 0.5)
    }

    /// Returns the one of two that is nearer.
    fn pick<T>(self, both: [T; 2]) -> T {
        let [a, b] = both;
        if self.nearer() == 0 { a } else { b }
    }

    /// Returns the metadata of the model between two.
    fn metadata(self, both: [&Metadata; 2]) -> Metadata {
        let [a, b] = both;
        let windows = [a, b].map(|it| it.view.window);
        let window = match windows {
            [Some(a), Some(b)] => Some(std::array::from_fn(|at| self.between([a[at], b[at]]))),
            _ => None,
        };
        let symmetry = match [a, b].map(|it| it.symmetry.as_ref()) {
            [Some(a), Some(b)] if (a.rotate, a.mirror) == (b.rotate, b.mirror) => {
                let axis = a.mirror.then(|| self.between([a.axis, b.axis]));
                Some(Symmetry::new(
                    a.rotate,
                    axis,
                    self.between([a.centre, b.centre]),
                ))
            }
            // A group changes at once.
            both => self.pick(both).map(Symmetry::in_doubles),
        };
        Metadata {
            symmetry,
            steps: a.steps.into_iter().chain(b.steps).min(),
            style: style::tween(self, [&a.style, &b.style]),
            view: View {
                window,
                margin: match (a.view.margin, b.view.margin) {
                    (Some(a), Some(b)) => Some(self.between([a, b])),
                    (a, b) => a.or(b),
                },
            },
            numbers: Vec::new(),
            dimension: None,
            hausdorff_dimension: None,
            ..self.pick(both).clone()
        }
    }
}
