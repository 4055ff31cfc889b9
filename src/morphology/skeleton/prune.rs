//! Branches that hardly reach out of the disk where they begin.

use super::super::interior::Interior;
use super::SkeletonNode;
use super::trace::Traced;

/// Least distance in pixels to which the disks of a branch reach out of the disk of its branch point.
const LEAST: f64 = 1.0;

/// Removes branches that end in the disk of their branch point, or a node in the disk of the only other one. Returns
/// whether there was one.
pub(super) fn prune(interior: &Interior, traced: &Traced, pixels: &mut Vec<usize>) -> bool {
    let (nodes, branches) = traced;
    let width = interior.map.width();
    let mut removed = Vec::new();
    for branch in branches {
        let [mut junction, mut end] = branch.ends.map(|node| &nodes[node]);
        let rank = |node: &SkeletonNode| (node.is_junction(), node.point.radius);
        if rank(junction) < rank(end) {
            std::mem::swap(&mut junction, &mut end);
        }
        let away = junction.point.distance(&end.point);
        if end.is_end() && away + end.point.radius - junction.point.radius <= LEAST {
            let points = branch.points.iter();
            let points = points.filter(|&point| !junction.points.contains(point));
            removed.extend(points.map(|point| (point.row + 1) * width + point.column + 1));
        }
    }
    removed.sort_unstable();
    pixels.retain(|pixel| removed.binary_search(pixel).is_err());
    !removed.is_empty()
}
