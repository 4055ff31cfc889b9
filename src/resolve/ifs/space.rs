//! Resolution of maps and systems in space.

use crate::document::{IfsDocument, LinearDocument, MapDocument, MapsDocument};
use crate::expression::{Affine, Program, Symbols};
use crate::geometry::DAffine3;
use crate::ifs::{AffineMap, Map, System};
use crate::metadata::Metadata;
use crate::resolve::Resolver;
use crate::resolve::space::value;

use super::{Maps, OfIfs};

impl Resolver<OfIfs> {
    /// Resolves a system in space. Reports mistakes and returns `None`.
    pub(in crate::resolve) fn system_in_space(
        &mut self,
        document: &IfsDocument,
        metadata: Metadata,
    ) -> Option<System<DAffine3>> {
        let maps = document.maps.as_ref();
        let maps = maps.and_then(|maps| self.maps_in_space(maps));
        let parts = self.parts(document, maps, Self::solids);
        self.assembled(document, metadata, parts)
    }

    fn maps_in_space(&mut self, document: &MapsDocument) -> Option<Maps<DAffine3>> {
        match document {
            MapsDocument::Listed(maps) => {
                let maps: Vec<_> = maps.iter().map(|map| self.map_in_space(map)).collect();
                let maps = maps.into_iter().collect::<Option<Vec<_>>>()?;
                let (maps, written) = maps.into_iter().unzip();
                Some(Maps {
                    maps,
                    written,
                    initial: None,
                    chained: false,
                })
            }
            MapsDocument::Vertices { points, shrink } => {
                let factor = self.constant_program(shrink);
                let points = self.vertices(points, Self::point_in_space)?;
                let toward = |point: &[Program; 3]| {
                    let factors = std::array::from_fn(|_| factor.clone());
                    Affine::scaling(&mut Symbols, factors).about(&mut Symbols, point)
                };
                let written: Vec<Affine<Program, 3>> = points.iter().map(toward).collect();
                let maps = written.iter().map(|map| map.as_constant().map(Map::new));
                let maps = maps.collect::<Option<_>>()?;
                let points: Option<Vec<_>> = points.iter().map(value).collect();
                Some(Maps {
                    maps,
                    written,
                    initial: Some(DAffine3::hull(&points?)),
                    chained: false,
                })
            }
            // Reported when the file was read.
            MapsDocument::Interpolated(_) => None,
        }
    }

    fn map_in_space(
        &mut self,
        document: &MapDocument,
    ) -> Option<(Map<DAffine3>, Affine<Program, 3>)> {
        let written = self.affine_in_space(document);
        let weight = self.optional(document.weight.as_ref());
        let written = written?;
        let map = Map {
            name: document.name.as_ref().map(|name| name.value.clone()),
            affine: written.as_constant()?,
            weight: weight?,
        };
        Some((map, written))
    }

    fn affine_in_space(&mut self, document: &MapDocument) -> Option<Affine<Program, 3>> {
        let linear = document.linear.as_ref();
        let linear = linear.and_then(|linear| self.linear_in_space(linear));
        let shift = document.shift.as_ref().map(|it| self.point_in_space(it));
        let fixed = document.fixed.as_ref().map(|it| self.point_in_space(it));
        let linear = linear?;
        Some(match (shift, fixed) {
            (_, Some(fixed)) => linear.about(&mut Symbols, &fixed?),
            (Some(shift), None) => linear.moved_to(shift?),
            (None, None) => linear,
        })
    }

    fn linear_in_space(&mut self, document: &LinearDocument) -> Option<Affine<Program, 3>> {
        match document {
            LinearDocument::MatrixInSpace(rows) => {
                let rows = rows.each_ref().map(|row| self.point_in_space(row));
                let [first, second, third] = rows;
                let rows = [first?, second?, third?];
                // The document has rows, the map has columns.
                let columns =
                    [0, 1, 2].map(|column: usize| rows.each_ref().map(|row| row[column].clone()));
                Some(Affine::linear(&mut Symbols, columns))
            }
            LinearDocument::AxesInSpace { scale, turns } => {
                let scale = scale.each_ref().map(|factor| self.constant_program(factor));
                let turns: Vec<_> = turns.iter().map(|turn| self.constant_turn(turn)).collect();
                let known = scale.iter().all(|it| it.as_constant().is_some());
                let turns = turns.into_iter().collect::<Option<Vec<_>>>()?;
                let scaling = known.then(|| Affine::scaling(&mut Symbols, scale))?;
                let turned = |map: Affine<Program, 3>, turn: &Affine<Program, 3>| {
                    turn.after(&mut Symbols, &map)
                };
                Some(turns.iter().fold(scaling, turned))
            }
            // The plane's notations were reported when the file was read.
            LinearDocument::Matrix(_)
            | LinearDocument::Axes { .. }
            | LinearDocument::Complex { .. } => None,
        }
    }
}
