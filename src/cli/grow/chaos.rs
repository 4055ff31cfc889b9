//! `kfrac grow --method chaos`: random iteration of iterated function systems.

use std::io::Write;
use std::num::NonZero;
use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;

use crate::chaos::{
    ClassBy, Game, GameError, HistogramWindow, RandomPoint, RandomPoints, Start, WeightedMaps, play,
};
use crate::export;
use crate::geometry::{Bounds, DVec2, Homothety};
use crate::graph::Graph;
use crate::grow::Progress;
use crate::ifs;
use crate::model::Model;
use crate::render::{Canvas, Density, RenderError, Shades, Size, Tone, write_density};
use crate::style::{ColorBy, Colour, Named, Style};

use super::super::labels::labels;
use super::super::length::Paper;
use super::super::picture::{self, PictureArguments};
use super::super::readable::counted;
use super::super::rule::Loaded;
use super::super::{Failure, number};
use super::Arguments;

/// Options of random iteration, and the choice of the method.
#[derive(clap::Args)]
#[command(next_help_heading = "Random iteration")]
pub(super) struct ChaosArguments {
    /// Method of iteration of a system of maps: all compositions of maps, or a random walk
    ///
    /// Random iteration (the chaos game) moves a point by one map after the other, chosen at random by their
    /// weights, and draws every point that it reaches. It produces PNGs, and tables of points.
    #[arg(long, value_parser = picture::named::<Method>(), default_value = "deterministic")]
    method: Method,
    /// Number of points to draw: 500k, 10M, 2G [default: 10M; 100k for tables]
    #[arg(long, value_name = "N", value_parser = points, allow_negative_numbers = true)]
    points: Option<u64>,
    /// Mapping of the number of hits to a tone [default: log]
    #[arg(long, value_parser = picture::named::<Tone>())]
    tone: Option<Tone>,
    /// Start of the walks, if not on the attractor; the way there is drawn; may be given several times
    #[arg(long, value_name = "X,Y", value_parser = start, allow_hyphen_values = true)]
    start: Vec<DVec2>,
    /// Number of points of a walk from a start, before the next walk begins [default: 256]
    #[arg(long, value_name = "N", requires = "start", value_parser = number::whole("a number of steps", 1..=u32::MAX))]
    walk: Option<u32>,
}

/// Method of iteration of a system of maps.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Method {
    Deterministic,
    Chaos,
}

impl Named for Method {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("deterministic", Self::Deterministic),
        ("chaos", Self::Chaos),
    ];
}

/// Largest number of points that can be requested.
const MAX_POINTS: u64 = 1_000_000_000_000;

/// Parses a number of points with an optional suffix k, M or G.
fn points(text: &str) -> Result<u64, String> {
    let (number, factor) = match text.char_indices().next_back() {
        Some((end, 'k')) => (&text[..end], 1e3),
        Some((end, 'M')) => (&text[..end], 1e6),
        Some((end, 'G')) => (&text[..end], 1e9),
        _ => (text, 1.0),
    };
    let points = number.parse::<f64>().map(|number| number * factor);
    match points {
        #[expect(clippy::cast_precision_loss, reason = "the limit is exact")]
        Ok(points) if points > MAX_POINTS as f64 && points.is_finite() => {
            Err("too many points: the limit is 1000G".into())
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number within the limit"
        )]
        Ok(points) if points >= 1.0 && points.fract() == 0.0 => Ok(points as u64),
        _ => Err("a number of points is a whole number from 1, such as 500k, 10M or 2G".into()),
    }
}

/// Parses a point `X,Y`.
fn start(text: &str) -> Result<DVec2, String> {
    let coordinates = text.split_once(',').and_then(|(x, y)| {
        let point = DVec2::new(x.trim().parse().ok()?, y.trim().parse().ok()?);
        point.is_finite().then_some(point)
    });
    coordinates.ok_or_else(|| "expected a point X,Y".into())
}

impl ChaosArguments {
    /// Returns whether random iteration is requested.
    pub(super) fn is_asked(&self) -> bool {
        self.method == Method::Chaos
    }

    /// Returns the options that apply to random iteration only, and whether they are given.
    pub(super) fn of_points(&self) -> [(&'static str, bool); 3] {
        [
            ("--points", self.points.is_some()),
            ("--tone", self.tone.is_some()),
            ("--start", !self.start.is_empty()),
        ]
    }
}

/// Returns the property that colours points: as requested, or as in the file where points have it. A file
/// that colours by step is coloured by hits, because points have no step.
fn color_by(picture: &PictureArguments, system: &ifs::System) -> Result<ColorBy, Failure> {
    let color_by = picture.style(system.metadata()).color_by;
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

/// Game that is ready to be played.
pub(super) struct ChaosGame<'a> {
    arguments: &'a Arguments,
    loaded: &'a Loaded,
    /// System in the coordinates that `place` maps to those of its file.
    source: Arc<ifs::System>,
    place: Homothety,
    system: WeightedMaps,
    start: Start,
    color_by: ColorBy,
    /// Whether hits replace steps, for which the file has a palette.
    is_by_steps: bool,
    /// Number of steps for which first maps are distinguished.
    steps: u32,
}

/// Number of points from which the extent of walks is estimated.
const PILOT: usize = 20_000;

/// Least margin in pixels, which keeps points on the edge of the box inside the picture.
const EDGE: f64 = 1.0 / 32.0;

impl<'a> ChaosGame<'a> {
    /// Returns the game that the options request.
    pub(super) fn new(arguments: &'a Arguments, loaded: &'a Loaded) -> Result<Self, Failure> {
        let Arguments {
            chaos,
            picture,
            steps,
            ..
        } = arguments;
        let Model::Ifs(source) = &loaded.model else {
            return Err(Failure::Usage(format!(
                "--method chaos needs a system of maps (kind: ifs), and {} is of the kind {}; \
                 without --method it is grown step by step",
                loaded.name,
                loaded.model.kind().name()
            )));
        };
        let place = loaded.place()?;
        let source = source
            .within(&place)
            .map_or_else(|| source.clone(), Arc::new);
        let system = WeightedMaps::of(source.ifs()).map_err(|error| {
            let error = anyhow::Error::new(error);
            error.context(format!(
                "{} cannot be drawn by random iteration",
                loaded.name
            ))
        })?;
        let color_by = color_by(picture, &source)?;
        if steps.is_some() && color_by != ColorBy::FirstMap {
            let message = "--steps applies to deterministic iteration; with --method chaos, \
                           --points is the number of points";
            return Err(Failure::Usage(message.into()));
        }
        let walks = NonZero::new(chaos.walk.unwrap_or(256)).unwrap_or(NonZero::<u32>::MIN);
        let start = match &chaos.start[..] {
            [] => Start::Attractor,
            points => Start::Points {
                points: points.iter().map(|&point| place.origin_of(point)).collect(),
                steps: walks,
            },
        };
        Ok(Self {
            arguments,
            loaded,
            system,
            start,
            color_by,
            is_by_steps: color_by == ColorBy::Hits
                && picture.asked_color_by().is_none()
                && !picture.asks_palette()
                && source.metadata().style.color_by == ColorBy::Step,
            steps: steps.or(source.metadata().steps).unwrap_or(8),
            source,
            place,
        })
    }

    /// Returns the canvas that shows the attractor and the ways to it, or the window.
    fn canvas(&self, size: Size) -> Result<Canvas, RenderError> {
        let view = self
            .arguments
            .picture
            .view(self.source.metadata())
            .within(&self.place);
        if let Some(window) = view.window {
            return Ok(Canvas::of_window(window, &view, size)?);
        }
        let limit = Graph::of_system(&self.source).limit_bounds();
        let mut bounds = limit.unwrap_or(Bounds::EMPTY);
        if limit.is_none() || self.start != Start::Attractor {
            for point in RandomPoints::new(&self.system, &self.start, 0).take(PILOT) {
                bounds.add(point.place);
            }
        }
        Ok(Canvas::fit(&bounds, size, view.margin.max(EDGE))?)
    }

    /// Returns the failure for which `path` has not been written.
    fn explain(&self, error: RenderError, path: &Path) -> Failure {
        (self.arguments.growth).explain(error, self.loaded, path)
    }

    /// Plays the game, draws it and returns a summary.
    pub(super) fn draw(
        &self,
        progress: Option<&Progress>,
        out: &mut impl Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let Arguments {
            chaos,
            growth,
            picture,
            size: Paper { size, .. },
            ..
        } = self.arguments;
        let canvas = self
            .canvas(*size)
            .map_err(|error| self.explain(error, path))?;
        let points = chaos.points.unwrap_or(10_000_000);
        let window = HistogramWindow {
            to_pixels: canvas.to_pixels(),
            size: canvas.size(),
        };
        let game = Game {
            points,
            seed: growth.seed,
            start: self.start.clone(),
            classes: self.classes(),
            threads: growth.threads(),
            cancel: None,
            progress,
        };
        let histogram = play(&self.system, &window, &game).map_err(|error| {
            match error {
                error @ GameError::TooManyBins { .. } => anyhow!(
                    "{error}; use a smaller --size, or --method deterministic, which draws large pictures \
                     in bands"
                ),
                other => anyhow::Error::new(other),
            }
        })?;
        let style = picture.style(self.source.metadata());
        let density = Density {
            tone: chaos.tone.unwrap_or_default(),
            shades: self.shades(&style, picture.ink(self.source.metadata())),
            background: style.background,
        };
        let described = counted(&points.into(), "point");
        let mut options = self.options(points);
        options.extend(growth.options());
        options.push(("format", "png".into()));
        options.push(("size", size.to_string()));
        options.extend(picture.options());
        let labels = labels(self.loaded, &described, "grow", options);
        write_density(&histogram, &density, &labels, out)
            .map_err(|error| self.explain(error, path))?;
        let inside = match histogram.inside() {
            inside if inside == points => String::new(),
            inside => format!(", {} inside", crate::readable::grouped(&inside.into())),
        };
        let [width, height] = canvas.size();
        Ok(format!(
            "{}, {described}{inside}, {width} x {height} pixels",
            self.loaded.name
        ))
    }

    /// Lists the points and returns a summary.
    pub(super) fn list(
        &self,
        format: export::TableFormat,
        progress: Option<&Progress>,
        out: &mut impl Write,
        path: &Path,
    ) -> Result<String, Failure> {
        let growth = &self.arguments.growth;
        let points = self.arguments.chaos.points.unwrap_or(100_000);
        if points > growth.max_elements() {
            let error = anyhow!(
                "{} are more rows than --max-elements {} allows",
                counted(&points.into(), "point"),
                growth.max_elements()
            );
            return Err(error.into());
        }
        if let Some(progress) = progress {
            progress.expect(points);
        }
        let all = RandomPoints::new(&self.system, &self.start, growth.seed);
        let all = all.take(usize::try_from(points).unwrap_or(usize::MAX));
        let all = all.map(|point| RandomPoint {
            place: self.place.point(point.place),
            ..point
        });
        export::write_points(all, format, None, progress, out)
            .map_err(|error| self.explain(error.into(), path))?;
        let described = counted(&points.into(), "point");
        Ok(format!("{}, {described}", self.loaded.name))
    }

    /// Returns the property by which points are classified.
    fn classes(&self) -> ClassBy {
        let ago = match self.color_by {
            ColorBy::LastMap => 0,
            // Walks record no more maps than that.
            ColorBy::FirstMap => u8::try_from(self.steps.clamp(1, 200) - 1).unwrap_or(u8::MAX),
            _ => return ClassBy::One,
        };
        ClassBy::Map { ago }
    }

    /// Returns the colours of hits, maps or all points in a style.
    fn shades(&self, style: &Style, ink: Option<Colour>) -> Shades {
        let maps = self.source.ifs().maps().len();
        match self.color_by {
            // A palette by steps begins with the largest elements, which are hit most.
            ColorBy::Hits if self.is_by_steps => Shades::Palette(style.palette.clone().reversed()),
            ColorBy::Hits => Shades::Palette(style.palette.clone()),
            ColorBy::FirstMap | ColorBy::LastMap => {
                // As in approximants, the palette begins with condensation sets, if there are any.
                let before = usize::from(self.system.classes() > maps);
                let last = (maps + before).saturating_sub(1).max(1);
                let place = |class: usize| {
                    let number = if class < maps { class + before } else { 0 };
                    #[expect(clippy::cast_precision_loss, reason = "there are not so many maps")]
                    style.palette.at(number as f64 / last as f64)
                };
                Shades::Classes((0..self.system.classes()).map(place).collect())
            }
            _ => Shades::Ink(ink.unwrap_or(Colour::BLACK)),
        }
    }

    /// Returns the options of the game that are given, with their values.
    fn options(&self, points: u64) -> Vec<(&'static str, String)> {
        let mut options = vec![("method", Method::Chaos.name().into())];
        options.push(("points", points.to_string()));
        if let Some(tone) = self.arguments.chaos.tone {
            options.push(("tone", tone.name().into()));
        }
        if let Start::Points { steps, .. } = &self.start {
            let starts = self.arguments.chaos.start.iter();
            options.extend(starts.map(|start| ("start", format!("{},{}", start.x, start.y))));
            options.push(("walk", steps.to_string()));
        }
        if self.color_by == ColorBy::FirstMap {
            options.push(("steps", self.steps.to_string()));
        }
        options
    }
}

#[cfg(test)]
mod tests {
    use super::{MAX_POINTS, points};

    #[test]
    fn points_are_counted_in_thousands_millions_and_milliards() {
        for (text, number) in [
            ("1", 1),
            ("500k", 500_000),
            ("2.5M", 2_500_000),
            ("1e7", 10_000_000),
            ("1000G", MAX_POINTS),
        ] {
            assert_eq!(points(text), Ok(number), "{text}");
        }
        for text in [
            "", "0", "-1", "0.5", "k", "M", "10m", "NaN", "inf", "1001G", "1é",
        ] {
            assert!(points(text).is_err(), "{text}");
        }
    }
}
