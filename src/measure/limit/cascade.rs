//! Measures on a limit set: a multiplicative cascade distributes the mass of a copy over its parts.

use crate::extent::Bounded;
use crate::geometry::{Affine, DAffine2, Point};
use crate::graph::Graph;
use crate::ifs::{AffineMap, Ifs};
use crate::measure::copies::{Copies, WeightedCopies};
use crate::measure::exact::distinct;
use crate::measure::space::Space;

use super::groups::Shared;
use super::{LimitCopy, LimitSet, Shares};

/// A measure on a limit set, defined by the share of every copy in the mass of its set: the mass of a nested
/// copy is the product of the shares along its path (Hutchinson 1981; for graphs: Mauldin & Williams 1988).
///
/// Copies without a share are left out, and the set is the measure's support.
#[derive(Clone, Debug)]
pub struct Cascade<M: Affine = DAffine2> {
    pub(super) set: LimitSet<M>,
    /// Shares of the copies, by object; they add up to 1.
    pub(super) shares: Vec<Vec<f64>>,
    /// Masses of the copies that the whole is made of; they add up to 1.
    pub(super) start: Vec<f64>,
    /// Centres of mass of the objects.
    pub(super) centres: Vec<M::Point>,
}

/// Maximum number of sweeps in the computation of centres.
const MAX_SWEEPS: usize = 1_000;

impl<M: Space> Cascade<M> {
    /// Creates the natural measure of the limit set of a graph's fertile elements: a copy of size r has a
    /// mass of about r^s, where s is the set's dimension (Hutchinson 1981; for graphs: Mauldin & Williams
    /// 1988).
    ///
    /// Pieces that coincide count once, where they are of finitely many types (Ngai & Wang 2001); otherwise s
    /// is the similarity dimension. For maps that are not similarities, the singular value function replaces
    /// r^s (Falconer 1988).
    ///
    /// Returns `None` where the graph is not made of fixed maps that contract.
    #[must_use]
    pub fn natural<F: Bounded<Map = M>>(graph: &Graph<F>) -> Option<Self> {
        Self::of(&distinct(Copies::of(graph)?).natural()?)
    }

    /// Creates the measure that the weights of a system define, without condensation sets.
    ///
    /// Returns `None` where [the measure is not unique](crate::ifs::Walk::stationary).
    #[must_use]
    pub fn of_weights(ifs: &Ifs<M>) -> Option<Self>
    where
        M: AffineMap,
    {
        Self::of(&WeightedCopies::of_weights(ifs)?)
    }

    /// Creates the measure of shares; `None` if no copy of the whole has mass.
    pub(in crate::measure) fn of(shared: &WeightedCopies<M>) -> Option<Self> {
        let mut children = vec![Vec::new(); shared.copies.size];
        for (copy, &share) in shared.copies.copies.iter().zip(&shared.shares) {
            if share > 0.0 {
                children[copy.from].push((LimitCopy::new(copy.map, copy.to), share));
            }
        }
        let all = shared.copies.start.iter().zip(&shared.masses);
        let all = all.filter(|(_, mass)| **mass > 0.0);
        let start = all.map(|(&(object, map), &mass)| (LimitCopy::new(map, object), mass));
        let start: Vec<Shared<M>> = start.collect();
        if start.is_empty() {
            return None;
        }
        let Shares {
            set,
            shares,
            masses,
        } = LimitSet::of_copies(children, start)?;
        let mut cascade = Self {
            centres: vec![M::Point::ZERO; shares.len()],
            set,
            shares,
            start: masses,
        };
        cascade.find_centres();
        Some(cascade)
    }

    /// Returns the support of the measure.
    #[must_use]
    pub fn set(&self) -> &LimitSet<M> {
        &self.set
    }

    /// Computes the centres of mass, c(o) = Σ share f(c(p)) over the copies f of p.
    fn find_centres(&mut self) {
        const TOLERANCE: f64 = 1e-6;
        let mut centres: Vec<M::Point> = self.set.objects.iter().map(|part| part.point).collect();
        for _ in 0..MAX_SWEEPS {
            let mut change: f64 = 0.0;
            for object in (0..centres.len()).rev() {
                let part = &self.set.objects[object];
                let copies = part.children.iter().zip(&self.shares[object]);
                let centre = copies
                    .map(|(copy, share)| copy.map.apply(centres[copy.object]) * *share)
                    .fold(M::Point::ZERO, |sum, part| sum + part);
                if !part.children.is_empty() {
                    change = change.max((centre - centres[object]).length() / part.radius);
                    centres[object] = centre;
                }
            }
            // A set of a single point has radius 0.
            if change <= TOLERANCE || change.is_nan() {
                break;
            }
        }
        self.centres = centres;
    }
}
