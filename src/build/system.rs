//! Builder of iterated function systems.

use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::document::node::Value;
use crate::ifs::System;
use crate::metadata::{Description, Parameter};
use crate::model::Kind;
use crate::style::{Style, View};

use super::metadata::of_all_kinds;
use super::written::{self, Entries, sequence};
use super::{MapBuilder, NumberText, PointText, SetBuilder, built, read};

/// Builder of an iterated function system. Setting a key again replaces its value; maps, condensation
/// sets and edges accumulate.
#[derive(Clone, Debug)]
#[must_use = "a system is made by `build` or `document`"]
pub struct SystemBuilder {
    entries: Entries,
    parameters: Entries,
    maps: Vec<MapBuilder>,
    condensation: Vec<Value>,
    edges: Entries,
}

impl Default for SystemBuilder {
    fn default() -> Self {
        let kind = Value::Text(Kind::Ifs.name().into());
        Self {
            entries: Entries::default().set("kind", kind),
            parameters: Entries::default(),
            maps: Vec::new(),
            condensation: Vec::new(),
            edges: Entries::default(),
        }
    }
}

impl SystemBuilder {
    /// Creates a system without maps.
    pub fn new() -> Self {
        Self::default()
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self {
            entries: self.entries.set(key, value),
            ..self
        }
    }

    /// Appends a map.
    pub fn map(mut self, map: impl Into<MapBuilder>) -> Self {
        self.maps.push(map.into());
        self
    }

    /// Sets the maps to contractions towards the given points, x → `shrink` x + (1 − `shrink`) v, in
    /// place of other maps.
    pub fn vertices(
        self,
        points: impl IntoIterator<Item = impl Into<PointText>>,
        shrink: impl Into<NumberText>,
    ) -> Self {
        let points = points.into_iter().map(|point| point.into().0);
        let vertices = Entries::default().set("points", sequence(points));
        self.set("vertices", vertices.set("shrink", shrink.into().0).value())
    }

    /// Sets the maps to those of fractal interpolation through the given points, from left to right, in
    /// place of other maps. `scales` are the vertical scaling factors of the pieces.
    pub fn interpolate(
        self,
        points: impl IntoIterator<Item = impl Into<PointText>>,
        scales: impl IntoIterator<Item = impl Into<NumberText>>,
    ) -> Self {
        let scales = scales.into_iter().map(|scale| scale.into().0);
        self.curve(points, "scale", sequence(scales))
    }

    /// Sets the maps as [`SystemBuilder::interpolate`] does, with a vertical scaling factor that gives
    /// the curve the box dimension `dimension`, from 1 to less than 2.
    pub fn interpolate_to_dimension(
        self,
        points: impl IntoIterator<Item = impl Into<PointText>>,
        dimension: impl Into<NumberText>,
    ) -> Self {
        self.curve(points, "dimension", dimension.into().0)
    }

    fn curve(
        self,
        points: impl IntoIterator<Item = impl Into<PointText>>,
        key: &str,
        value: Value,
    ) -> Self {
        let points = points.into_iter().map(|point| point.into().0);
        let curve = Entries::default().set("points", sequence(points));
        self.set("interpolate", curve.set(key, value).value())
    }

    /// Appends a condensation set.
    pub fn condensation(mut self, set: SetBuilder) -> Self {
        self.condensation.push(set.0.value());
        self
    }

    /// Sets the initial set, which approximant 0 draws.
    pub fn initial(self, set: SetBuilder) -> Self {
        self.set("initial", set.0.value())
    }

    /// Sets the maps that may be applied after the map `from`, by name or by number from 1. If one map
    /// has edges, all maps need them.
    pub fn edges(self, from: impl ToString, to: impl IntoIterator<Item = impl ToString>) -> Self {
        let to = to.into_iter().map(|to| Value::Text(to.to_string()));
        Self {
            edges: self.edges.add(from.to_string(), sequence(to)),
            ..self
        }
    }

    /// Sets the maps that may be applied after the map `from`, with their weights.
    pub fn weighted_edges(
        self,
        from: impl ToString,
        to: impl IntoIterator<Item = (impl ToString, impl Into<NumberText>)>,
    ) -> Self {
        let to = to
            .into_iter()
            .fold(Entries::default(), |all, (to, weight)| {
                all.add(to.to_string(), weight.into().0)
            });
        Self {
            edges: self.edges.add(from.to_string(), to.value()),
            ..self
        }
    }

    of_all_kinds!();

    /// Returns the system as a document.
    ///
    /// # Errors
    ///
    /// Returns all mistakes that [`Document::read`] finds.
    pub fn document(&self) -> Result<Document, Diagnostics> {
        let mut entries = self.entries.clone();
        if self.maps.iter().any(|map| map.name.is_some()) {
            let numbered = self.maps.iter().zip(1..);
            let named = numbered.fold(Entries::default(), |named, (map, number): (_, u32)| {
                let name = map.name.clone().unwrap_or_else(|| number.to_string());
                named.add(name, map.entries.clone().value())
            });
            entries = entries.set("maps", named.value());
        } else if !self.maps.is_empty() {
            let maps = self.maps.iter().map(|map| map.entries.clone().value());
            entries = entries.set("maps", sequence(maps));
        }
        if !self.condensation.is_empty() {
            entries = entries.set("condensation", sequence(self.condensation.iter().cloned()));
        }
        read(
            &entries,
            &[("params", &self.parameters), ("edges", &self.edges)],
        )
    }

    /// Returns the validated system.
    ///
    /// # Errors
    ///
    /// Returns all mistakes: no maps, maps that do not contract, and so on.
    pub fn build(&self) -> Result<System, Diagnostics> {
        built(&self.document()?)
    }
}
