//! Resolution of vertices, also of those at random places.

use crate::document::{ScatterDocument, VerticesDocument};
use crate::draws::{Distribution, Path, Variable};
use crate::expression::Program;
use crate::resolve::map::WrittenMap;
use crate::resolve::{Resolver, numbers, whole_number};

use super::OfIfs;

/// Largest number of points of a scatter.
const MAX_POINTS: u32 = 1000;

impl Resolver<OfIfs> {
    /// Resolves the vertices of a system. Reports mistakes and returns `None`.
    pub(super) fn vertices<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &VerticesDocument,
    ) -> Option<Vec<[Program; N]>> {
        match document {
            VerticesDocument::Listed(points) => {
                let points: Vec<_> = points.iter().map(|it| M::point(self, it)).collect();
                points.into_iter().collect()
            }
            VerticesDocument::Scattered(document) => {
                let axes = M::point(self, &document.ellipsoid);
                self.scattered(document, axes)
            }
        }
    }

    /// Draws the points of a scatter in an ellipsoid with the given semi-axes.
    fn scattered<const N: usize>(
        &mut self,
        document: &ScatterDocument,
        axes: Option<[Program; N]>,
    ) -> Option<Vec<[Program; N]>> {
        let ScatterDocument {
            ellipsoid,
            count,
            seed,
        } = document;
        let seed = self.seed(seed.as_ref());
        let number = self.constant(count).and_then(|value| {
            let whole = whole_number(value, MAX_POINTS).filter(|&count| count > 0);
            if whole.is_none() {
                let but = numbers::but(count, value);
                let message = format!("a scatter has from 1 to {MAX_POINTS} points{but}");
                self.error_with_hint(&count.place, message, "count: 24");
            }
            whole
        });
        let axes = axes?.map(|axis| axis.as_constant().unwrap_or(f64::NAN));
        if !axes.iter().all(|axis| *axis > 0.0) {
            let message = "half the lengths of the axes are above 0";
            let hint = "a thin ellipsoid has a small one: [3, 0.01, 2]";
            self.error_with_hint(&ellipsoid.place, message, hint);
            return None;
        }
        let root = Path::of_seed(seed?.into());
        let points = (0..number?).map(|position| {
            let unit: [f64; N] = in_unit_ball(root.child(position));
            std::array::from_fn(|axis| Program::constant(axes[axis] * unit[axis]))
        });
        Some(points.collect())
    }
}

/// Draws a point of the unit ball for a path, all places being equally likely: points of the cube are drawn until
/// one lies in the ball.
fn in_unit_ball<const N: usize>(path: Path) -> [f64; N] {
    let along = ["x", "y", "z"].map(|name| {
        let [low, high] = [-1.0, 1.0].map(Program::constant);
        Variable::new(name, Distribution::Uniform(low, high))
    });
    let mut attempts = (0..).map(|attempt| {
        let path = path.child(attempt);
        std::array::from_fn(|axis| along[axis].draw(path, &[]))
    });
    let is_inside = |point: &[f64; N]| point.iter().map(|it| it * it).sum::<f64>() <= 1.0;
    attempts.find(is_inside).unwrap_or([0.0; N])
}

#[cfg(test)]
mod tests {
    use crate::Fractal;
    use crate::geometry::DVec3;
    use crate::model::Model;

    /// Returns the fixed points of the maps of a scatter.
    fn points(count: u32, seed: u32) -> Vec<DVec3> {
        let text = format!(
            "{{kind: ifs, space: 3, vertices: {{scatter: {{ellipsoid: [3, 1, 2], count: {count}, \
             seed: {seed}}}, shrink: 0}}}}"
        );
        let read = Fractal::parse(&text);
        let Ok(Model::IfsInSpace(system)) = read.map(|it| it.model().clone()) else {
            panic!("it is a system in space");
        };
        let maps = system.ifs().maps().iter();
        maps.map(|map| map.affine.translation).collect()
    }

    #[test]
    fn points_fill_the_ellipsoid_and_hang_on_seed_and_number() {
        let many = points(1000, 0);
        let units: Vec<DVec3> = { many.iter() }
            .map(|point| *point / DVec3::new(3.0, 1.0, 2.0))
            .collect();
        assert!(units.iter().all(|unit| unit.length() <= 1.0));
        // Half of the volume lies beyond the radius 2^(-1/3), and half on either side of a plane through the middle.
        let outer = units.iter().filter(|unit| unit.length() > 0.5_f64.cbrt());
        assert!((450..550).contains(&outer.count()));
        for axis in 0..3 {
            let above = units.iter().filter(|unit| unit[axis] > 0.0);
            assert!((450..550).contains(&above.count()));
        }
        assert_eq!(points(24, 0), many[..24]);
        assert_ne!(points(24, 1), many[..24]);
    }
}
