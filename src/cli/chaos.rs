//! `--method chaos`: random iteration of iterated function systems.

mod plane;
mod space;

pub(super) use plane::PlaneGame;
pub(super) use space::SpaceGame;

use std::fmt;
use std::io::Write;
use std::num::NonZero;
use std::path::Path;

use anyhow::anyhow;

use crate::chaos::{
    ChaosMap, ClassBy, Game, RandomPoint, RandomPoints, Start, WeightedMaps, points_of_text,
};
use crate::export;
use crate::geometry::{DVec3, Homothety};
use crate::grow::Progress;
use crate::ifs::{PointOf, System, Verdict};
use crate::metadata::Metadata;
use crate::render::RenderError;
use crate::style::{ColorBy, DensityView, Iteration, Named, Tone};

use super::growth::GrowthArguments;
use super::picture::{self, PictureArguments};
use super::readable::counted;
use super::rule::Loaded;
use super::{Failure, number};

/// Options of random iteration, and the choice of the method.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Random iteration")]
pub(super) struct ChaosArguments {
    /// Method of iteration of a system of maps: all compositions of maps, or a random walk [default: deterministic]
    ///
    /// Random iteration (the chaos game) moves a point by one map after the other, chosen at random by their
    /// weights, and draws every point that it reaches. It produces PNGs, and tables of points.
    #[arg(long, value_parser = picture::named::<Iteration>())]
    method: Option<Iteration>,
    /// Number of points to draw: 500k, 10M, 2G [default: 10M; 100k for tables]
    #[arg(long, value_name = "N", value_parser = points_of_text, allow_negative_numbers = true)]
    points: Option<u64>,
    /// Mapping of the number of hits of a pixel to a tone [default: log]
    ///
    /// Without --method chaos, a PNG of the plane shows how many elements cover each pixel, in one ink, or in the palette of
    /// --palette or --color-by hits.
    #[arg(long, value_parser = picture::named::<Tone>())]
    tone: Option<Tone>,
    /// Exponent of tones, which are raised to its inverse: the larger, the better few hits are shown [default: 1]
    #[arg(long, value_name = "G", value_parser = gamma)]
    gamma: Option<f64>,
    /// Number of bins across a pixel of random iteration, whose colours are averaged [default: 1]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of bins", 1..=DensityView::MAX_OVERSAMPLE))]
    oversample: Option<u32>,
    /// Radius in pixels over which a point that is alone is spread, so that thin parts are smooth [default: none]
    ///
    /// The radius is that of flam3's density estimation: for n points in a pixel, it is less by the factor n^(-2/5).
    #[arg(long, value_name = "PX", value_parser = kernel)]
    kernel: Option<f64>,
    /// Start of the walks, if not on the attractor; the way there is drawn; may be given several times
    #[arg(long, value_name = "X,Y[,Z]", value_parser = start, allow_hyphen_values = true)]
    start: Vec<StartPoint>,
    /// Number of points of a walk from a start, before the next walk begins [default: 256]
    #[arg(long, value_name = "N", requires = "start", value_parser = number::whole("a number of steps", 1..=u32::MAX))]
    walk: Option<u32>,
}

/// Arguments of a command that a game follows.
#[derive(Clone, Copy)]
pub(super) struct GameArguments<'a> {
    pub(super) chaos: &'a ChaosArguments,
    pub(super) growth: &'a GrowthArguments,
    pub(super) picture: &'a PictureArguments,
    /// Number of steps, for colours by the first map.
    pub(super) steps: Option<u32>,
    pub(super) seed: u64,
}

/// Start of walks: a point of the plane, which in space lies in z = 0, or of space.
#[derive(Clone, Copy)]
struct StartPoint {
    place: DVec3,
    is_flat: bool,
}

impl fmt::Display for StartPoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.place.x, self.place.y)?;
        match self.is_flat {
            true => Ok(()),
            false => write!(f, ",{}", self.place.z),
        }
    }
}

/// Parses a point `X,Y` or `X,Y,Z`.
fn start(text: &str) -> Result<StartPoint, String> {
    let numbers = text.split(',').map(|number| number.trim().parse::<f64>());
    let place = match numbers.collect::<Result<Vec<_>, _>>().as_deref() {
        Ok(&[x, y]) => Some((DVec3::new(x, y, 0.0), true)),
        Ok(&[x, y, z]) => Some((DVec3::new(x, y, z), false)),
        _ => None,
    };
    let place = place.filter(|(place, _)| place.is_finite());
    let place = place.map(|(place, is_flat)| StartPoint { place, is_flat });
    place.ok_or_else(|| "expected a point X,Y, or X,Y,Z in space".into())
}

/// Parses an exponent of tones.
fn gamma(text: &str) -> Result<f64, String> {
    above_zero(text, "an exponent", DensityView::MAX_GAMMA)
}

/// Parses a radius of the kernel.
fn kernel(text: &str) -> Result<f64, String> {
    above_zero(text, "a radius in pixels", DensityView::MAX_KERNEL)
}

fn above_zero(text: &str, what: &str, most: f64) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|number| *number > 0.0 && *number <= most);
    number.ok_or_else(|| format!("expected {what} above 0, up to {most}"))
}

impl ChaosArguments {
    /// Returns the arguments with the values of a file where none are given. Values for random iteration apply only if that is
    /// the method.
    pub(super) fn or(&self, file: DensityView) -> Self {
        let method = self.method.or(file.method);
        let file = match method {
            Some(Iteration::Chaos) => file,
            _ => DensityView {
                points: None,
                oversample: None,
                kernel: None,
                ..file
            },
        };
        Self {
            method,
            points: self.points.or(file.points),
            tone: self.tone.or(file.tone),
            gamma: self.gamma.or(file.gamma),
            oversample: self.oversample.or(file.oversample),
            kernel: self.kernel.or(file.kernel),
            start: self.start.clone(),
            walk: self.walk,
        }
    }

    /// Returns the method that is given.
    pub(super) fn method(&self) -> Option<Iteration> {
        self.method
    }

    /// Returns whether random iteration is requested.
    pub(super) fn is_asked(&self) -> bool {
        self.method == Some(Iteration::Chaos)
    }

    /// Returns whether a number of points is given.
    pub(super) fn has_points(&self) -> bool {
        self.points.is_some()
    }

    /// Returns the start of walks.
    fn start<P>(&self, place: impl Fn(&StartPoint) -> P) -> Start<P> {
        match &self.start[..] {
            [] => Start::Attractor,
            points => Start::Points {
                points: points.iter().map(place).collect(),
                steps: NonZero::new(self.walk.unwrap_or(256)).unwrap_or(NonZero::<u32>::MIN),
            },
        }
    }

    /// Returns the options of a game that are given, with their values. `steps` is the number of steps for which
    /// first maps are distinguished.
    fn options(&self, points: u64, color_by: ColorBy, steps: u32) -> Vec<(&'static str, String)> {
        let mut options = vec![("method", Iteration::Chaos.name().into())];
        options.push(("points", points.to_string()));
        options.extend(self.tones());
        let bins = self
            .oversample
            .map(|count| ("oversample", count.to_string()));
        let kernel = self.kernel.map(|radius| ("kernel", radius.to_string()));
        options.extend(bins.into_iter().chain(kernel));
        options.extend(self.start.iter().map(|start| ("start", start.to_string())));
        if let Start::Points { steps, .. } = self.start(|_| ()) {
            options.push(("walk", steps.to_string()));
        }
        if color_by == ColorBy::FirstMap {
            options.push(("steps", steps.to_string()));
        }
        options
    }

    /// Returns the options of tones that are given, with their values.
    pub(super) fn tones(&self) -> Vec<(&'static str, String)> {
        let tone = self.tone.map(|tone| ("tone", tone.name().to_owned()));
        let gamma = self.gamma.map(|gamma| ("gamma", gamma.to_string()));
        tone.into_iter().chain(gamma).collect()
    }

    /// Returns the exponent of tones.
    pub(super) fn gamma(&self) -> f64 {
        self.gamma.unwrap_or(1.0)
    }

    /// Refuses options of pictures of the plane.
    fn refuse_in_space(&self) -> Result<(), Failure> {
        let given = self.of_plane().into_iter().find(|(_, is_given)| *is_given);
        given.map_or(Ok(()), |(option, _)| {
            let message = format!("{option} is for pictures of the plane");
            Err(Failure::Usage(message))
        })
    }

    /// Returns the options of pictures of the plane, and whether they are given.
    fn of_plane(&self) -> [(&'static str, bool); 3] {
        [
            ("--gamma", self.gamma.is_some()),
            ("--oversample", self.oversample.is_some()),
            ("--kernel", self.kernel.is_some()),
        ]
    }

    /// Returns the tone that is given for hits of elements.
    pub(super) fn tone_of_elements(&self) -> Option<Tone> {
        self.tone.filter(|_| !self.is_asked())
    }

    /// Returns an error if options of random iteration are given without it. Elements may have a tone if `has_tone`.
    pub(super) fn check(&self, picture: &PictureArguments, has_tone: bool) -> Result<(), Failure> {
        if self.is_asked() {
            return Ok(());
        }
        let tone = self.tone.filter(|_| !has_tone);
        let gamma = self.gamma.filter(|_| self.tone.is_none());
        for (option, is_given) in { self.of_points().into_iter() }
            .chain([("--tone", tone.is_some()), ("--gamma", gamma.is_some())])
        {
            if is_given {
                let message = format!("{option} applies to random iteration: add --method chaos");
                return Err(Failure::Usage(message));
            }
        }
        match self.tone {
            Some(_) => Ok(()),
            None => picture.refuse_hits(),
        }
    }

    /// Returns the options that apply to random iteration only, and whether they are given.
    fn of_points(&self) -> [(&'static str, bool); 4] {
        [
            ("--points", self.points.is_some()),
            ("--oversample", self.oversample.is_some()),
            ("--kernel", self.kernel.is_some()),
            ("--start", !self.start.is_empty()),
        ]
    }
}

/// Returns the property that colours points: as requested, or as in the file where points have it. A file
/// that colours by step is coloured by hits, because points have no step.
fn color_by(picture: &PictureArguments, metadata: &Metadata) -> Result<ColorBy, Failure> {
    let color_by = picture.style(metadata).color_by;
    match (color_by, picture.asked_color_by()) {
        (ColorBy::None | ColorBy::Hits | ColorBy::FirstMap | ColorBy::LastMap, _) => Ok(color_by),
        (_, None) => Ok(ColorBy::Hits),
        (_, Some(asked)) => Err(Failure::Usage(format!(
            "--color-by {} applies to elements, and --method chaos draws points: use hits, \
             last-map or first-map",
            asked.name()
        ))),
    }
}

/// Returns the property by which points are classified for a colour. `steps` is the number of steps for which first
/// maps are distinguished.
fn classes(color_by: ColorBy, steps: u32) -> ClassBy {
    let ago = match color_by {
        ColorBy::LastMap => 0,
        // Walks record no more maps than that.
        ColorBy::FirstMap => u8::try_from(steps.clamp(1, 200) - 1).unwrap_or(u8::MAX),
        _ => return ClassBy::One,
    };
    ClassBy::Map { ago }
}

/// Returns an error if the number of steps is given, and has no meaning for points of a colour.
fn refuse_steps(steps: Option<u32>, color_by: ColorBy) -> Result<(), Failure> {
    if steps.is_none() || color_by == ColorBy::FirstMap {
        return Ok(());
    }
    let message = "--steps applies to deterministic iteration; with --method chaos, --points is the number of \
                   points";
    Err(Failure::Usage(message.into()))
}

/// Returns an error if a list has more points than are allowed.
fn check_rows(points: u64, most: u64) -> Result<(), Failure> {
    if points <= most {
        return Ok(());
    }
    let points = counted(&points.into(), "point");
    Err(anyhow!("{points} are more rows than --max-elements {most} allows").into())
}

/// Number of points of a picture, and of a list, where none is given.
const DRAWN: u64 = 10_000_000;
const LISTED: u64 = 100_000;

/// Random iteration of a system, as the options request it.
pub(super) struct RandomIteration<'a, M: ChaosMap> {
    arguments: GameArguments<'a>,
    loaded: &'a Loaded,
    /// System in the coordinates that `place` maps to those of its file.
    system: WeightedMaps<M>,
    place: Homothety<PointOf<M>>,
    start: Start<PointOf<M>>,
    color_by: ColorBy,
    /// Number of steps for which first maps are distinguished.
    steps: u32,
}

impl<'a, M: ChaosMap> RandomIteration<'a, M> {
    fn new(
        arguments: GameArguments<'a>,
        loaded: &'a Loaded,
        source: &System<M>,
        place: Homothety<PointOf<M>>,
        start: Start<PointOf<M>>,
    ) -> Result<Self, Failure> {
        let contracts = source.contraction().verdict != Verdict::Diverges || {
            source.ifs().lyapunov_exponent()
        }
        .is_some_and(|it| it.is_negative());
        if !contracts {
            return Err(anyhow!(
                "{} cannot be drawn by random iteration: its maps do not contract, not even on average",
                loaded.name
            )
            .into());
        }
        let system = WeightedMaps::of(source.ifs()).map_err(|error| {
            let message = format!("{} cannot be drawn by random iteration", loaded.name);
            anyhow::Error::new(error).context(message)
        })?;
        let color_by = color_by(arguments.picture, source.metadata())?;
        refuse_steps(arguments.steps, color_by)?;
        let steps = arguments.steps.or(source.metadata().steps);
        Ok(Self {
            arguments,
            loaded,
            system,
            place,
            start,
            color_by,
            steps: steps.unwrap_or(8),
        })
    }

    /// Returns the number of points.
    fn points(&self, default: u64) -> u64 {
        self.arguments.chaos.points.unwrap_or(default)
    }

    /// Describes the points of a picture.
    pub(super) fn described(&self) -> String {
        counted(&self.points(DRAWN).into(), "point")
    }

    /// Returns the options of a picture, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let chaos = &self.arguments.chaos;
        let mut options = chaos.options(self.points(DRAWN), self.color_by, self.steps);
        options.extend(self.arguments.growth.options());
        options
    }

    /// Returns the game of a picture.
    fn game<'p>(&'p self, progress: Option<&'p Progress>) -> Game<'p, PointOf<M>> {
        let growth = &self.arguments.growth;
        Game {
            points: self.points(DRAWN),
            seed: self.arguments.seed,
            start: self.start.clone(),
            classes: classes(self.color_by, self.steps),
            threads: growth.threads(),
            cancel: growth.cancel(),
            progress,
        }
    }

    /// Returns the number of points of a list, and a walk without end.
    fn walk(&self, progress: Option<&Progress>) -> Result<(u64, RandomPoints<'_, M>), Failure> {
        let growth = &self.arguments.growth;
        let points = self.points(LISTED);
        check_rows(points, growth.max_elements())?;
        if let Some(progress) = progress {
            progress.expect(points);
        }
        let all = RandomPoints::new(&self.system, &self.start, self.arguments.seed);
        Ok((points, all))
    }

    /// Lists the points as a table and returns a summary.
    pub(super) fn list(
        &self,
        format: export::TableFormat,
        progress: Option<&Progress>,
        mut out: &mut dyn Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let (points, all) = self.walk(progress)?;
        let all = all.take(usize::try_from(points).unwrap_or(usize::MAX));
        let all = all.map(|point| RandomPoint {
            place: self.place.point(point.place),
            ..point
        });
        export::write_points(
            all,
            format,
            self.arguments.growth.cancel(),
            progress,
            &mut out,
        )
        .map_err(|error| self.explain(error.into(), path))?;
        Ok(self.listed(points))
    }

    /// Describes a number of points of the system.
    pub(super) fn listed(&self, points: u64) -> String {
        format!("{}, {}", self.loaded.name, counted(&points.into(), "point"))
    }

    /// Returns the failure for which `path` has not been written.
    fn explain(&self, error: RenderError, path: &Path) -> Failure {
        (self.arguments.growth).explain(error, self.loaded, path)
    }
}
