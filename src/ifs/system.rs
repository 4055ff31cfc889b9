//! An iterated function system with the metadata and the options of its file.

use super::{AffineMap, Contraction, Ifs, IfsError};
use crate::geometry::{DAffine2, Homothety};
use crate::metadata::Metadata;
use crate::tween::Growing;

/// A system with the data of its file that do not belong to its mathematics.
///
/// Guarantee: the system contracts, or does so on average, or neither is decided; unless maps have been
/// [omitted](Self::omitting).
#[derive(Clone, Debug, PartialEq)]
pub struct System<M: AffineMap = DAffine2> {
    pub(crate) metadata: Metadata,
    pub(crate) ifs: Ifs<M>,
    /// The maps as written, in the coordinates of the file.
    pub(crate) written: Vec<M::Written>,
    /// Whether the images of the initial set, in the order of the maps, form one line.
    pub(crate) chained: bool,
    /// Whether the maps are those of [`interpolate`](super::interpolate).
    pub(crate) interpolates: bool,
    /// Step that is drawn while it grows, if there is one.
    pub(crate) growing: Option<Growing>,
    pub(crate) contraction: Contraction,
}

impl<M: AffineMap> System<M> {
    /// Returns the metadata that files of all kinds have.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns the system of maps.
    #[must_use]
    pub fn ifs(&self) -> &Ifs<M> {
        &self.ifs
    }

    /// Returns the bounds by which the system contracts, or by which contraction is undecided.
    #[must_use]
    pub fn contraction(&self) -> &Contraction {
        &self.contraction
    }

    /// Returns whether the maps are those of a curve through points, with the weights that
    /// [`interpolate`](super::interpolate) gives them.
    #[must_use]
    pub fn is_interpolation(&self) -> bool {
        self.interpolates
    }
}

impl System {
    /// Returns the system in the coordinates that a homothety maps to its own; `None` if a set has no extent
    /// there.
    pub(crate) fn within(&self, place: &Homothety) -> Option<Self> {
        Some(Self {
            metadata: self.metadata.within(place),
            ifs: self.ifs.within(place)?,
            ..self.clone()
        })
    }
}

impl<M: AffineMap> System<M> {
    /// Returns the system without some maps, and without the edges from and to them. Approximant 0 is
    /// unchanged.
    ///
    /// # Errors
    ///
    /// Returns an error where the remaining parts are not a system: no maps, or maps that no edge enters or
    /// leaves.
    pub fn omitting(&self, maps: &[usize]) -> Result<Self, Vec<IfsError>> {
        let mut definition = self.ifs.definition.clone();
        let stays = |map: usize| !maps.contains(&map);
        // The new indices of the remaining maps.
        let numbers: Vec<usize> = (0..definition.maps.len())
            .map(|map| (0..map).filter(|&map| stays(map)).count())
            .collect();
        let mut number = 0..;
        definition.maps.retain(|_| number.next().is_some_and(stays));
        let written = self.written.iter().enumerate();
        let written = written.filter(|(map, _)| stays(*map));
        if let Some(edges) = &mut definition.edges {
            edges.retain(|edge| stays(edge.from) && stays(edge.to));
            for edge in edges {
                (edge.from, edge.to) = (numbers[edge.from], numbers[edge.to]);
            }
        }
        let ifs = Ifs::new(definition)?;
        Ok(Self {
            metadata: self.metadata.clone(),
            contraction: ifs.contraction(),
            ifs,
            written: written.map(|(_, map)| map.clone()).collect(),
            chained: self.chained && maps.is_empty(),
            interpolates: self.interpolates,
            growing: self.growing,
        })
    }
}

impl<M: AffineMap> Ifs<M> {
    /// Returns a map's name for messages: `map 'name'`, or `map 2` without a name.
    pub(crate) fn map_name(&self, map: usize) -> String {
        let name = self.maps().get(map).and_then(|map| map.name.as_ref());
        name.map_or_else(
            || format!("map {}", map + 1),
            |name| format!("map '{name}'"),
        )
    }

    /// Returns the name of a product for messages: `map 2, then map 1`. Of a long one, only the first maps are named.
    pub(crate) fn product_name(&self, word: &[usize]) -> String {
        const MOST: usize = 12;
        let named = if word.len() <= MOST {
            word
        } else {
            &word[..MOST - 1]
        };
        let mut names: Vec<_> = named.iter().map(|&map| self.map_name(map)).collect();
        if named.len() < word.len() {
            names.push(format!("{} others", word.len() - named.len()));
        }
        names.join(", then ")
    }
}
