//! The dimension of a strongly connected part of a system.

use crate::measure::similarity::dimension_of_part;
use crate::saturating::real;

use super::closed_form::{closed_form, plain, settled};
use super::distinct::upper_bound;
use super::hull::Flat;
use super::neighbours::{End, Neighbours};
use super::open_set::{copies_are_apart, hulls_are_open_sets};
use super::sizes::{Generations, Piece};
use super::spectral::spectral_radius;
use super::system::GraphDirectedSystem;
use super::types::Types;
use super::{Effort, Equation, Hausdorff, OtherDimension, Overlap, Similar};

/// Dimensions of a part, as far as they are known.
#[derive(Clone, Debug)]
pub(super) struct PartDimension {
    pub(super) similarity: Similar,
    pub(super) hausdorff: Hausdorff,
    pub(super) boundary: Option<OtherDimension>,
    pub(super) contact: Option<OtherDimension>,
}

/// Largest number of copies in a part for which it is decided whether they overlap.
const MAX_COPIES: usize = 1 << 20;

/// Difference up to which dimensions count as equal.
const SAME: f64 = 1e-10;

/// Computes the dimensions of a part, whose maps are similarities with ratios below 1.
pub(super) fn part_dimension(system: &GraphDirectedSystem, effort: Effort) -> PartDimension {
    let (value, moran) = dimension_of_part(system.size, system.ratios());
    let value = settled(value);
    let equation = if moran {
        Equation::Moran
    } else {
        Equation::Spectral
    };
    let mut part = PartDimension {
        similarity: Similar {
            value,
            equation,
            closed_form: plain(value),
        },
        hausdorff: Hausdorff::unknown(value.min(real(system.space)), String::new()),
        boundary: None,
        contact: None,
    };
    if value == 0.0 {
        part.decide(
            Overlap::None,
            "one copy in each: the limit is a point".into(),
        );
        return part;
    }
    if system.copies.len() > effort.of(MAX_COPIES) {
        part.give_up("there are too many copies");
        return part;
    }
    let flat = Flat::of(system);
    part.hausdorff.upper_bound = Some(value.min(real(flat.dimension)));
    match Generations::of(&flat) {
        Some(generations) => part.by_neighbours(&flat, &generations, effort),
        None => part.by_open_set(&flat, effort, "the ratios are not powers of one number"),
    }
    if part.has_inside(&flat) && part.boundary.is_none() {
        part.boundary = Some(OtherDimension {
            value: None,
            closed_form: None,
            method: "not decided: pieces coincide".into(),
        });
    }
    part
}
impl PartDimension {
    /// Records that the set has its similarity dimension.
    fn decide(&mut self, overlap: Overlap, method: String) {
        let Similar {
            value, closed_form, ..
        } = self.similarity.clone();
        self.hausdorff = Hausdorff {
            value: Some(value),
            closed_form,
            upper_bound: Some(value),
            overlap,
            method,
        };
    }

    /// Returns `true` if the set has the dimension of the space that contains it.
    fn has_inside(&self, flat: &Flat) -> bool {
        let own = self.hausdorff.value;
        own.is_some_and(|own| flat.dimension == flat.space && (own - real(flat.space)).abs() < SAME)
    }

    fn by_neighbours(&mut self, flat: &Flat, generations: &Generations, effort: Effort) {
        let similarity = self.similarity.value;
        let agrees =
            |growth: &f64| (libm::log(*growth) / generations.depth - similarity).abs() < SAME;
        let growth = growth(generations).filter(agrees);
        if let Some(growth) = growth {
            let form = closed_form(growth, generations.depth);
            self.similarity.closed_form = form.or(self.similarity.closed_form.take());
        }
        let neighbours = Neighbours::of(generations, effort);
        let count = neighbours.pairs.len();
        if neighbours.coincide.contains(&true) {
            self.by_types(generations, &neighbours, effort);
            return;
        }
        match neighbours.end {
            End::Complete => {}
            End::Capped => {
                let tried = format!("more than {count} neighbour maps");
                self.by_open_set(flat, effort, &tried);
                return;
            }
            End::TooClose => {
                self.by_open_set(
                    flat,
                    effort,
                    "neighbour maps that are neither equal nor apart",
                );
                return;
            }
        }
        let touching = neighbours.touching();
        let left = touching.iter().filter(|touching| **touching).count();
        if left == 0 {
            let method = "open set condition: no two copies touch, by neighbour maps";
            self.decide(Overlap::None, method.into());
            return;
        }
        let targets: Vec<Vec<usize>> = neighbours
            .next
            .iter()
            .enumerate()
            .map(|(pair, next)| {
                let next = next.iter().filter(|_| touching[pair]);
                let next = next.map(|successor| successor.pair as usize);
                next.filter(|&pair| touching[pair]).collect()
            })
            .collect();
        let spread = spectral_radius(&targets);
        let (Some(growth), Some(spread)) = (growth, spread) else {
            self.by_open_set(flat, effort, "a spectral radius was not found");
            return;
        };
        if spread > growth * (1.0 - SAME) {
            self.by_open_set(flat, effort, "different sets overlap as much as they grow");
            return;
        }
        let method = format!(
            "open set condition: none of {count} neighbour maps is the identity (Bandt & Graf 1992)"
        );
        self.decide(Overlap::Touching, method);
        let common = Some(OtherDimension {
            value: Some(settled(libm::log(spread) / generations.depth)),
            closed_form: closed_form(spread, generations.depth),
            method: format!("spectral radius of {left} touching neighbour maps"),
        });
        match self.has_inside(flat) {
            true => self.boundary = common,
            false => self.contact = common,
        }
    }

    /// Computes the dimension of a set whose pieces coincide, from the types of distinct pieces, or an upper
    /// bound.
    fn by_types(&mut self, generations: &Generations, neighbours: &Neighbours, effort: Effort) {
        self.hausdorff.overlap = Overlap::Exact;
        let types = (neighbours.end == End::Complete)
            .then(|| Types::of(generations, neighbours, effort))
            .flatten();
        if let Some(types) = types {
            let value = settled(libm::log(types.growth) / generations.depth);
            self.hausdorff.value = Some(value);
            self.hausdorff.upper_bound = Some(value);
            self.hausdorff.closed_form = closed_form(types.growth, generations.depth);
            self.hausdorff.method = format!(
                "growth of distinct pieces, of {} types (Ngai & Wang 2001)",
                types.count
            );
            return;
        }
        let tried = match neighbours.end {
            End::Complete => "pieces coincide, and are of too many types".into(),
            End::Capped => format!(
                "pieces coincide, among more than {} neighbour maps",
                neighbours.pairs.len()
            ),
            End::TooClose => {
                "pieces coincide, and neighbour maps are neither equal nor apart".into()
            }
        };
        self.give_up(&tried);
        if let (Some(bound), Some(known)) =
            (upper_bound(generations, effort), self.hausdorff.upper_bound)
        {
            self.hausdorff.upper_bound = Some(known.min(bound));
        }
    }

    /// Decides the dimension by the open set condition, where the system is not known to be of finite type.
    fn by_open_set(&mut self, flat: &Flat, effort: Effort, tried: &str) {
        if copies_are_apart(flat, effort) {
            self.decide(
                Overlap::None,
                "open set condition: no two copies touch".into(),
            );
        } else if hulls_are_open_sets(flat, effort) {
            let method = "open set condition: the convex hulls of copies overlap in sides only";
            self.decide(Overlap::Touching, method.into());
            // The hulls of copies leave no gap: their total area is that of the hull that contains them.
            if self.has_inside(flat) {
                let value = real(flat.space - 1);
                self.boundary = Some(OtherDimension {
                    value: Some(value),
                    closed_form: plain(value),
                    method: "the set is its convex hull".into(),
                });
            }
        } else if flat.dimension > 2 {
            self.give_up(&format!("{tried}; convex hulls in space are not looked at"));
        } else {
            self.give_up(&format!("{tried}; the convex hulls of copies overlap"));
        }
    }

    fn give_up(&mut self, tried: &str) {
        self.hausdorff.method = format!("not decided: {tried}");
    }
}

/// Returns the growth of the number of pieces from generation to generation.
fn growth(generations: &Generations) -> Option<f64> {
    let start = |set| Piece { set, wait: 0 };
    let mut pieces: Vec<Piece> = (0..generations.size()).map(start).collect();
    let mut numbers: std::collections::HashMap<Piece, usize> =
        pieces.iter().copied().zip(0..).collect();
    let mut targets: Vec<Vec<usize>> = Vec::new();
    while let Some(&piece) = pieces.get(targets.len()) {
        let mut next = Vec::new();
        for step in generations.steps(piece) {
            next.push(*numbers.entry(step.piece).or_insert_with(|| {
                pieces.push(step.piece);
                pieces.len() - 1
            }));
        }
        targets.push(next);
    }
    spectral_radius(&targets)
}
