//! Builder of plane sets.

use crate::document::node::Value;

use super::written::{Entries, sequence};
use super::{MapBuilder, NumberText, PointText};

/// A condensation set of a system, an initial set, or a primitive of a structure.
#[derive(Clone, Debug)]
#[must_use]
pub struct SetBuilder(pub(super) Entries);

impl SetBuilder {
    fn new(key: &str, value: Value) -> Self {
        Self(Entries::default().set(key, value))
    }

    fn points(key: &str, points: impl IntoIterator<Item = impl Into<PointText>>) -> Self {
        let points = points.into_iter().map(|point| point.into().0);
        Self::new(key, sequence(points))
    }

    /// Creates a point.
    pub fn point(point: impl Into<PointText>) -> Self {
        Self::new("point", point.into().0)
    }

    /// Creates a line segment.
    pub fn segment(from: impl Into<PointText>, to: impl Into<PointText>) -> Self {
        Self::points("segment", [from.into(), to.into()])
    }

    /// Creates a polyline.
    pub fn polyline(points: impl IntoIterator<Item = impl Into<PointText>>) -> Self {
        Self::points("polyline", points)
    }

    /// Creates a filled polygon.
    pub fn polygon(points: impl IntoIterator<Item = impl Into<PointText>>) -> Self {
        Self::points("polygon", points)
    }

    /// Creates a disk.
    pub fn disk(centre: impl Into<PointText>, radius: impl Into<NumberText>) -> Self {
        let disk = Entries::default().set("centre", centre.into().0);
        Self::new("disk", disk.set("radius", radius.into().0).value())
    }

    /// Creates a filled ellipse from its half axes, of which the first is rotated from the x axis by
    /// `angle` degrees, counter-clockwise.
    pub fn ellipse(
        centre: impl Into<PointText>,
        half_axes: impl Into<PointText>,
        angle: impl Into<NumberText>,
    ) -> Self {
        let ellipse = Entries::default()
            .set("centre", centre.into().0)
            .set("axes", half_axes.into().0)
            .set("rotate", angle.into().0);
        Self::new("ellipse", ellipse.value())
    }

    /// Creates a set from approximant `steps` of another fractal of the library.
    pub fn fractal(name: impl Into<String>, steps: impl Into<NumberText>) -> Self {
        Self(
            Self::new("fractal", Value::Text(name.into()))
                .0
                .set("steps", steps.into().0),
        )
    }

    /// Sets the seed of the random draws of a [fractal](SetBuilder::fractal).
    pub fn seed(self, seed: impl Into<NumberText>) -> Self {
        Self(self.0.set("seed", seed.into().0))
    }

    /// Sets parameters of a [fractal](SetBuilder::fractal) by name.
    pub fn parameters(
        self,
        values: impl IntoIterator<Item = (impl Into<String>, impl Into<NumberText>)>,
    ) -> Self {
        let values = values.into_iter();
        let values = values.fold(Entries::default(), |entries, (name, value)| {
            entries.add(name, value.into().0)
        });
        Self(self.0.set("set", values.value()))
    }

    /// Sets the map that places a [fractal](SetBuilder::fractal).
    pub fn placed(self, map: impl Into<MapBuilder>) -> Self {
        Self(self.0.set("map", map.into().entries.value()))
    }

    /// Sets the relative probability with which random iteration restarts in a condensation set.
    pub fn weight(self, weight: impl Into<NumberText>) -> Self {
        Self(self.0.set("weight", weight.into().0))
    }
}
