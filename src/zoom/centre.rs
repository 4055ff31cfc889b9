//! Computation of the point that an address names.

use std::sync::Arc;

use crate::expression::Precise;
use crate::geometry::DMat2;
use crate::graph::{Graph, Instance, Replacement, Successor};
use crate::grow::{Evaluator, ReplacementContext, TraversalState};
use crate::rule::Placement;
use crate::saturating::{real, whole};

use super::constants::{Constants, Parent};
use super::fixed::{Fixed, Vector};
use super::{Address, GRAIN, SPARE, ZoomError, ZoomOptions, ZoomWindow};

/// Limit of the number of steps within which the elements of an address must shrink to a point.
const MAX_STEPS: u32 = 1_000_000;

/// Returns the centre of a window, in multiples of 2^-`bits`.
pub(super) fn centre(
    graph: &Graph,
    growth: &ZoomOptions<'_>,
    window: &ZoomWindow,
    constants: &mut Constants<'_>,
) -> Result<Vector, ZoomError> {
    let (first, repeated) = match &window.at {
        Address::Point(point) => return Ok([point.x, point.y].map(|it| constants.written(it))),
        Address::LongPoint([x, y]) => return Ok([x, y].map(|it| constants.digits(it.as_str()))),
        Address::Path { first, repeated } => (first, repeated),
    };
    let address = || window.at.clone();
    let mut positions = first.iter().chain(repeated.iter().cycle()).copied();
    let found = |all: &[(Placement, &Instance)], position, depth| {
        let instance = all
            .iter()
            .find(|(_, instance)| instance.position == position);
        instance
            .map(|&(placement, it)| (placement, it.clone()))
            .ok_or(ZoomError::NoSuchPosition {
                address: address(),
                position,
                depth,
                count: all.len(),
            })
    };
    let Some(position) = positions.next() else {
        unreachable!("something is repeated");
    };
    let initiator = graph.initiator(0).instances.iter();
    let initiator: Vec<_> = initiator.map(|it| (Placement::Stays, it)).collect();
    let (_, root) = found(&initiator, position, 0)?;
    // Step of the fractal's birth.
    let mut born = 0;
    let mut state = TraversalState::whole(growth.seed).root(graph, &root);
    let mut object = root.object;
    let mut maps = vec![constants.root(&root)];
    let mut product = Product::new(root.frame.map().matrix2);
    // Below this length, the rest of the address moves the point by less than the unit of the
    // computation.
    let enough = -(window.factor.log2() + window.scale.log2()).max(0.0) - real(GRAIN);
    let mut evaluator = Evaluator::default();
    for (position, level) in positions.zip(0..) {
        if product.log2 < enough {
            break;
        }
        if level == MAX_STEPS {
            return Err(ZoomError::NoPoint { address: address() });
        }
        super::descent::check(growth, level)?;
        let moment = ReplacementContext {
            born,
            level,
            rank: graph.objects()[object].index.into(),
        };
        let depth = level;
        match graph.objects()[object].replacement {
            Replacement::Kept => {
                return Err(ZoomError::Infertile {
                    address: address(),
                    depth,
                });
            }
            Replacement::Unresolved => return Err(ZoomError::TooShallow { depth: level }),
            _ => {}
        }
        let mut made = Successor::default();
        let successor = evaluator.successor(graph, &state, object, moment, &mut made)?;
        let instances: Vec<_> = successor.placed_instances().collect();
        let (placement, child) = found(&instances, position, depth + 1)?;
        let parent = Parent {
            state: &state,
            object,
            moment,
            bits: whole((product.log2 - enough).ceil()) + SPARE,
        };
        maps.extend(constants.children(parent, &[&child]));
        product.multiply(child.frame.map().matrix2);
        state = state.child(graph, &child);
        object = child.object;
        if placement.seeds() {
            born = level + 1;
        }
    }
    let bits = constants.bits();
    let middle = graph.middle();
    let start = [middle.x, middle.y].map(|it| Precise::of(it).fixed(bits));
    let image = |point: Vector, map: &Arc<Fixed>| map.image(&point, bits);
    Ok(maps.iter().rev().fold(start, image))
}

/// Product of linear maps along an address, with the logarithm of its size.
struct Product {
    matrix: DMat2,
    log2: f64,
}

impl Product {
    fn new(matrix: DMat2) -> Self {
        let mut product = Self {
            matrix: DMat2::IDENTITY,
            log2: 0.0,
        };
        product.multiply(matrix);
        product
    }

    fn multiply(&mut self, matrix: DMat2) {
        self.matrix *= matrix;
        let columns = [self.matrix.x_axis, self.matrix.y_axis];
        let size = columns[0].length().max(columns[1].length());
        self.log2 += libm::log2(size);
        if size > 0.0 {
            self.matrix *= 1.0 / size;
        }
    }
}
