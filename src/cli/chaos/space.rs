//! Random iteration in space: pictures, tables and PLY files of points.

use std::collections::VecDeque;
use std::io::Write;
use std::path::Path;

use crate::chaos::{ClassBy, RandomPoint, RandomPoints, Start};
use crate::export::{self, Relief};
use crate::geometry::{Bounds, DAffine3, DVec3, Frame3, Homothety};
use crate::graph::Graph;
use crate::grow::Progress;
use crate::model::Model;
use crate::render::Options;
use crate::render::space::{SpaceOptions, SpacePicture, colours_of_maps, points_in_space};
use crate::style::{ColorBy, Style};

use super::super::Failure;
use super::super::rule::Loaded;
use super::{GameArguments, RandomIteration, classes};

/// Number of points from which normals are computed.
const SURFACE: usize = 1_000_000;

/// Random iteration in space.
pub(in crate::cli) type SpaceGame<'a> = RandomIteration<'a, DAffine3>;

impl<'a> SpaceGame<'a> {
    /// Returns the game that the options request.
    pub(in crate::cli) fn in_space(
        arguments: GameArguments<'a>,
        loaded: &'a Loaded,
    ) -> Result<Self, Failure> {
        let Model::IfsInSpace(source) = &loaded.model else {
            return Err(Failure::Usage(format!(
                "--method chaos needs a system of maps (kind: ifs), and {} is of the kind {}",
                loaded.name,
                loaded.model.kind().name()
            )));
        };
        arguments.chaos.refuse_in_space()?;
        let start = arguments.chaos.start(|start| start.place);
        Self::new(arguments, loaded, source, Homothety::IDENTITY, start)
    }

    /// Plays the game and draws it.
    pub(in crate::cli) fn draw(
        &self,
        graph: &Graph<Frame3>,
        options: &Options,
        space: &SpaceOptions,
        progress: Option<&Progress>,
        path: &Path,
    ) -> Result<SpacePicture, Failure> {
        if space.shadows {
            let message = "--shadows are those of elements, and --method chaos draws points";
            return Err(Failure::Usage(message.into()));
        }
        let mut options = options.clone();
        options.style.color_by = self.color_by;
        let game = self.game(progress);
        let tone = self.arguments.chaos.tone.unwrap_or_default();
        points_in_space(graph, &self.system, &game, tone, &options, space)
            .map_err(|error| self.explain(error, path))
    }

    /// Writes the points as a PLY file and returns a summary.
    pub(in crate::cli) fn write_ply(
        &self,
        graph: &Graph<Frame3>,
        style: &Style,
        progress: Option<&Progress>,
        mut out: &mut dyn Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let (points, mut all) = self.walk(progress)?;
        let cloud = || RandomPoints::new(&self.system, &self.start, !self.arguments.seed);
        let cloud = || cloud().take(SURFACE).map(|point| point.place);
        let bounds = match (graph.limit_bounds(), &self.start) {
            (Some(bounds), Start::Attractor) => bounds,
            _ => {
                let mut bounds = Bounds::EMPTY;
                cloud().for_each(|place| bounds.add(place));
                bounds
            }
        };
        let surface = Relief::of(&bounds, cloud());
        let mut style = style.clone();
        style.color_by = match (self.color_by, self.arguments.picture.asked_color_by()) {
            (ColorBy::Hits, None) => ColorBy::LastMap,
            (ColorBy::Hits, Some(_)) => {
                let message = "--color-by hits counts the points of pixels, and a .ply has none: use last-map or \
                               first-map";
                return Err(Failure::Usage(message.into()));
            }
            (other, _) => other,
        };
        let colours = colours_of_maps(&style, graph, &self.system);
        let mut past = Past::new(classes(style.color_by, self.steps), &self.start);
        if self.start == Start::Attractor {
            // The maps before the first point.
            { all.by_ref().take(past.ago) }.for_each(|point| {
                past.add(&point);
            });
        }
        let colour = |point: &RandomPoint<DVec3>| colours[past.add(point) % colours.len()];
        export::write_ply(
            all,
            points,
            &surface,
            colour,
            self.arguments.growth.cancel(),
            progress,
            &mut out,
        )
        .map_err(|error| self.explain(error.into(), path))?;
        Ok(self.listed(points))
    }
}

/// The recent maps of a walk.
struct Past {
    maps: VecDeque<usize>,
    /// Number of steps ago of the map that counts.
    ago: usize,
    /// Number of steps of a walk from a given start; 0 for walks on the attractor.
    walk: usize,
    taken: usize,
}

impl Past {
    fn new(classes: ClassBy, start: &Start<DVec3>) -> Self {
        Self {
            maps: VecDeque::new(),
            ago: match classes {
                ClassBy::Map { ago } => ago.into(),
                ClassBy::One => 0,
            },
            walk: match start {
                Start::Attractor => 0,
                Start::Points { steps, .. } => steps.get() as usize,
            },
            taken: 0,
        }
    }

    /// Adds a point; returns the map that counts for it, the first one of a walk that is shorter.
    fn add(&mut self, point: &RandomPoint<DVec3>) -> usize {
        if self.walk > 0 && self.taken.is_multiple_of(self.walk) {
            self.maps.clear();
        }
        self.taken += 1;
        self.maps.push_back(point.map);
        if self.maps.len() > self.ago + 1 {
            self.maps.pop_front();
        }
        self.maps[0]
    }
}
