//! A system as a file has it.

use super::{Contraction, Ifs, Shape};
use crate::geometry::DVec2;
use crate::heading::Heading;

/// A system, and what its file says beside its mathematics.
///
/// Guarantees: the system does not diverge.
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    pub(crate) heading: Heading,
    pub(crate) ifs: Ifs,
    /// Whether the images of the initial set, in the order of the maps, make one line.
    pub(crate) chained: bool,
    pub(crate) contraction: Contraction,
}

impl System {
    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    /// The system itself.
    #[must_use]
    pub fn ifs(&self) -> &Ifs {
        &self.ifs
    }

    /// Whether it contracts, or whether that is undecided.
    #[must_use]
    pub fn contraction(&self) -> &Contraction {
        &self.contraction
    }
}

impl Ifs {
    /// `map 2`, or its name.
    pub(crate) fn map_name(&self, map: usize) -> String {
        let name = self.maps().get(map).and_then(|map| map.name.as_ref());
        name.map_or_else(
            || format!("map {}", map + 1),
            |name| format!("map '{name}'"),
        )
    }

    /// `map 2, then map 1`: maps one after the other.
    pub(crate) fn product_name(&self, word: &[usize]) -> String {
        let names: Vec<_> = word.iter().map(|&map| self.map_name(map)).collect();
        names.join(", then ")
    }
}

/// The convex hull of points, as a polygon, a segment or a point (Andrew's monotone chain).
pub(crate) fn hull(points: &[DVec2]) -> Shape {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    let side = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut around = side(&mut sorted.iter().copied());
    around.extend(side(&mut sorted.iter().rev().copied()));
    let shape = match around[..] {
        [from, to] => Shape::polyline(&[from, to]),
        _ => Shape::polygon(&around),
    };
    shape.unwrap_or_else(|| Shape::Point(sorted.first().copied().unwrap_or_default()))
}
