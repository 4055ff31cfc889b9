//! Resolution of iterated function systems.

mod drawn;
mod scatter;

use crate::document::{
    EdgeDocument, IfsDocument, MapDocument, MapsDocument, VerticesDocument, Written, WrittenNumber,
};
use crate::expression::{AffineOf, Program, Symbols};
use crate::geometry::{DAffine2, Point};
use crate::ifs::{
    AffineMap, Condensation, Contraction, Definition, Edge, Exponent, Ifs, IfsError, Map, PointOf,
    System, Verdict, WeightOwner,
};
use crate::metadata::Metadata;
use crate::style::ColorBy;

use super::Resolver;
use super::instancing::StructureMap;
use super::map::WrittenMap;
pub(super) use drawn::structure;

/// Maximum size of a system, with all instances of sets and of maps in maps.
const MAX_INSTANCES: usize = 2_000_000;

/// Maximum number of these instances that its graph holds.
const MAX_HELD: usize = 1_000_000;

/// Maximum number of these instances in space, where each takes several times as much memory.
const MAX_HELD_IN_SPACE: usize = 250_000;

/// State that is specific to systems: none.
#[derive(Default)]
pub(super) struct OfIfs;

/// Maps of a system, the default initial set, and whether its images, in the order of the maps, form
/// one line.
pub(super) struct Maps<M: AffineMap = DAffine2> {
    pub(super) maps: Vec<Map<M>>,
    /// The maps as written.
    pub(super) written: Vec<M::Written>,
    pub(super) initial: Option<M::Set>,
    pub(super) chained: bool,
}

/// Vertices, and the contractions towards them.
type Toward<const N: usize> = (Vec<[Program; N]>, Vec<AffineOf<Program, N>>);

/// Parts of a system; `None` for what has mistakes.
struct Parts<M: AffineMap> {
    maps: Option<Maps<M>>,
    condensation: Vec<Option<Condensation<M>>>,
    /// The initial set, if the file has one.
    initial: Option<Option<M::Set>>,
}

impl Resolver<OfIfs> {
    /// Resolves the system. Reports mistakes and returns `None`.
    pub(super) fn system<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &IfsDocument,
        metadata: Metadata,
    ) -> Option<System<M>> {
        // Too many are refused before they take memory.
        if let Some(MapsDocument::Listed(maps)) = &document.maps
            && maps.len().saturating_mul(maps.len()) > MAX_INSTANCES
        {
            self.refuse_size(document);
            return None;
        }
        let maps = document.maps.as_ref();
        let maps = maps.and_then(|maps| self.maps(maps));
        let parts = self.parts(document, maps);
        self.assembled(document, metadata, parts)
    }

    /// Resolves the sets of a system.
    fn parts<M: StructureMap>(
        &mut self,
        document: &IfsDocument,
        maps: Option<Maps<M>>,
    ) -> Parts<M> {
        let condensation = document.condensation.iter().map(|own| {
            let weight = self.optional(own.weight.as_ref());
            let shape = M::set(self, &own.shape);
            Some(Condensation {
                weight: weight?,
                shape: shape?,
            })
        });
        Parts {
            maps,
            condensation: condensation.collect(),
            initial: document.initial.as_ref().map(|own| M::set(self, own)),
        }
    }

    /// Resolves the edges and puts the parts of a system together.
    fn assembled<M: AffineMap>(
        &mut self,
        document: &IfsDocument,
        mut metadata: Metadata,
        parts: Parts<M>,
    ) -> Option<System<M>> {
        let Parts {
            maps,
            condensation,
            initial,
        } = parts;
        let names = maps.as_ref().map(|maps| {
            let names = maps.maps.iter().map(|map| map.name.as_deref());
            names.collect::<Vec<_>>()
        });
        let edges = match (&document.edges, names) {
            (Some((edges, _)), Some(names)) => {
                let edges: Vec<_> = edges.iter().map(|edge| self.edge(edge, &names)).collect();
                Some(edges.into_iter().collect::<Option<Vec<_>>>()?)
            }
            _ => None,
        };
        let maps = maps?;
        let condensation = condensation.into_iter().collect::<Option<Vec<_>>>()?;
        // The default initial set of the maps applies only without condensation sets.
        let default = maps.initial.filter(|_| condensation.is_empty());
        let initial = match initial {
            None => default,
            Some(initial) => Some(initial?),
        };
        let chained = maps.chained && document.initial.is_none() && condensation.is_empty();
        let definition = Definition {
            maps: maps.maps,
            edges,
            condensation,
            initial,
        };
        let ifs = match Ifs::new(definition) {
            Ok(ifs) => ifs,
            Err(errors) => {
                for error in errors {
                    self.refuse(document, &error);
                }
                return None;
            }
        };
        if ifs.size() > MAX_INSTANCES || ifs.held() > MAX_HELD {
            self.refuse_size(document);
            return None;
        }
        if PointOf::<M>::DIMENSION == 3 && ifs.held() > MAX_HELD_IN_SPACE {
            let message = "so many parts of sets under so many maps are too much";
            let hint = "solids, faces and lines of all sets, times the number of maps, are no more than 250,000";
            self.error_with_hint(&document.metadata.place.first_line(), message, hint);
            return None;
        }
        let contraction = ifs.contraction();
        self.check_contraction(document, &ifs, &contraction)?;
        if ifs.maps().iter().any(|map| map.tint.is_some()) && !document.metadata.sets_colours {
            metadata.style.color_by = ColorBy::Tint;
        }
        Some(System {
            metadata,
            ifs,
            written: maps.written,
            chained,
            interpolates: matches!(document.maps, Some(MapsDocument::Interpolated(_))),
            growing: None,
            contraction,
        })
    }

    fn refuse_size(&mut self, document: &IfsDocument) {
        let message = "so many sets under so many maps are too much";
        let hint =
            format!("of all sets and maps inside all maps there are no more than {MAX_INSTANCES}");
        self.error_with_hint(&document.metadata.place.first_line(), message, hint);
    }

    fn maps<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &MapsDocument,
    ) -> Option<Maps<M>> {
        match document {
            MapsDocument::Listed(maps) => {
                let maps: Vec<_> = maps.iter().map(|map| self.map(map)).collect();
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
                let (points, written) = self.toward::<M, N>(points, shrink)?;
                let maps = written.iter().map(|map| M::as_constant(map).map(Map::new));
                let maps = maps.collect::<Option<_>>()?;
                let points: Option<Vec<_>> = points.iter().map(M::value).collect();
                Some(Maps {
                    maps,
                    written,
                    initial: Some(M::hull(&points?)),
                    chained: false,
                })
            }
            MapsDocument::Interpolated(document) => M::interpolation(self, document),
            MapsDocument::AtRandom(_) => unreachable!("such systems are resolved as structures"),
        }
    }

    /// Resolves vertices and the contractions towards them. Reports mistakes and returns `None`.
    pub(super) fn toward<M: WrittenMap<N>, const N: usize>(
        &mut self,
        points: &VerticesDocument,
        shrink: &WrittenNumber,
    ) -> Option<Toward<N>> {
        let factor = self.constant_program(shrink);
        let points = self.vertices::<M, N>(points)?;
        let toward = |point: &[Program; N]| {
            let factors = std::array::from_fn(|_| factor.clone());
            AffineOf::scaling(&mut Symbols, factors).about(&mut Symbols, point)
        };
        let maps = points.iter().map(toward).collect();
        Some((points, maps))
    }

    fn map<M: WrittenMap<N>, const N: usize>(
        &mut self,
        document: &MapDocument,
    ) -> Option<(Map<M>, AffineOf<Program, N>)> {
        let written = self.affine::<M, N>(document);
        let weight = self.optional(document.weight.as_ref());
        let written = written?;
        let map = Map {
            name: document.name.as_ref().map(|name| name.value.clone()),
            affine: M::as_constant(&written)?,
            weight: weight?,
            tint: self.constant_tint(document.tint.as_deref(), &document.place),
        };
        Some((map, written))
    }

    fn edge(&mut self, edge: &EdgeDocument, names: &[Option<&str>]) -> Option<Edge> {
        let from = self.map_called(&edge.from, names);
        let to = self.map_called(&edge.to, names);
        let weight = self.optional(edge.weight.as_ref());
        Some(Edge {
            from: from?,
            to: to?,
            weight: weight?,
        })
    }

    /// Returns the index of the map of the given name, or of the given number from 1.
    fn map_called(&mut self, called: &Written<String>, names: &[Option<&str>]) -> Option<usize> {
        let name = called.value.as_str();
        let named = names.iter().position(|known| *known == Some(name));
        let number = name.parse::<usize>().ok();
        let numbered = number.and_then(|number| number.checked_sub(1));
        let found = named.or(numbered.filter(|&number| number < names.len()));
        if found.is_none() {
            let s = if names.len() == 1 { "" } else { "s" };
            let message = format!("there is no map '{name}'");
            let hint = { self.suggestion(name, names.iter().copied().flatten()) }
                .unwrap_or_else(|| format!("there are {} map{s}, numbered from 1", names.len()));
            self.error_with_hint(&called.place, message, hint);
        }
        found
    }

    /// Reports a mistake in a part of the system at the place of that part.
    fn refuse(&mut self, document: &IfsDocument, error: &IfsError) {
        let edges = document.edges.as_ref();
        let edge = |number: usize| edges.and_then(|(edges, _)| edges.get(number));
        let condensation = |number: usize| document.condensation.get(number);
        let weight = match *error {
            IfsError::Weight { of, .. } => match of {
                WeightOwner::Map(map) => listed(document, map).and_then(|map| map.weight.as_ref()),
                WeightOwner::Edge(number) => edge(number).and_then(|edge| edge.weight.as_ref()),
                WeightOwner::Condensation(set) => {
                    condensation(set).and_then(|set| set.weight.as_ref())
                }
            },
            _ => None,
        };
        let place = match *error {
            IfsError::MapNotFinite { map } | IfsError::WeightMissing { map } => {
                listed(document, map).map(|map| map.place.first_line())
            }
            IfsError::Weight { .. } => weight.map(|weight| weight.place.clone()),
            IfsError::EdgeTwice { edge: number, .. } | IfsError::NoSuchMap { edge: number, .. } => {
                edge(number).map(|edge| edge.to.place.clone())
            }
            IfsError::NothingEnters { .. } | IfsError::NothingLeaves { .. } => {
                edges.map(|(_, place)| place.clone())
            }
            IfsError::NoExtent { condensation: set } => {
                condensation(set).map(|set| set.shape.place.clone())
            }
            IfsError::InitialNotFinite => document.initial.as_ref().map(|set| set.place.clone()),
            IfsError::NoMaps => None,
        };
        let place = place.unwrap_or_else(|| document.metadata.place.first_line());
        self.error(&place, error.to_string());
    }

    /// Refuses a system that does not contract even on average, and warns if it does on average only or if the verdict is
    /// undecided.
    fn check_contraction<M: AffineMap>(
        &mut self,
        document: &IfsDocument,
        ifs: &Ifs<M>,
        contraction: &Contraction,
    ) -> Option<()> {
        let first = contraction.word.first().copied();
        let map = first.and_then(|map| listed(document, map));
        let place = match &document.maps {
            Some(MapsDocument::Vertices { shrink, .. }) => &shrink.place,
            _ => map.map_or(&document.metadata.place, |map| &map.place),
        };
        let place = place.first_line();
        match contraction.verdict {
            Verdict::Contracts => Some(()),
            Verdict::Diverges => {
                let length = f64::from(u32::try_from(contraction.word.len()).unwrap_or(u32::MAX));
                let factor = libm::pow(contraction.lower, length);
                let (does, it, s) = match contraction.word.len() {
                    1 => ("does", "it", "s"),
                    _ => ("do", "they", ""),
                };
                let grows = if factor > 1.0 + 1e-9 {
                    format!("grow{s} by the factor {factor:.6}")
                } else {
                    format!("never get{s} smaller")
                };
                let name = ifs.product_name(&contraction.word);
                let message = format!("{name} {does} not contract: over and over, {it} {grows}");
                if let Some(exponent) = ifs.lyapunov_exponent().filter(Exponent::is_negative) {
                    let message = format!("{message}; the system contracts on average: {exponent}");
                    let hint = "random iteration (--method chaos) draws its measure; it has no limit set to descend to";
                    self.warn(&place, message, hint);
                    return Some(());
                }
                let hint = "a system needs maps that contract: all of their products must shrink";
                self.error_with_hint(&place, message, hint);
                None
            }
            Verdict::Undecided => {
                let message = format!(
                    "products of up to {} maps do not decide whether the system contracts",
                    contraction.length
                );
                let hint = "it can be grown by a number of steps, but its limit is not known";
                self.warn(&place, message, hint);
                Some(())
            }
        }
    }
}

/// Returns a map of a list of maps.
fn listed(document: &IfsDocument, map: usize) -> Option<&MapDocument> {
    match &document.maps {
        Some(MapsDocument::Listed(maps)) => maps.get(map),
        _ => None,
    }
}
