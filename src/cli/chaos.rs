//! `kfrac grow --method chaos`: systems of maps by random iteration.

use std::io::Write;
use std::num::NonZero;
use std::sync::Arc;

use anyhow::anyhow;

use crate::chaos::{ClassBy, Game, GameError, Point, Points, Start, System, Window, play};
use crate::export;
use crate::geometry::{Bounds, DVec2, Homothety};
use crate::graph::Graph;
use crate::grow::Progress;
use crate::ifs;
use crate::model::Model;
use crate::render::{Canvas, Density, RenderError, Shades, Size, Tone, write_density};
use crate::style::{ColorBy, Colour, Named, Style};
use crate::wording::counted;

use super::growth::GrowthArguments;
use super::labels::labels;
use super::picture::{self, PictureArguments};
use super::rule::Loaded;
use super::{Failure, number};

/// How systems of maps are iterated, and the options of random iteration.
#[derive(clap::Args)]
#[command(next_help_heading = "Random iteration")]
pub(super) struct ChaosArguments {
    /// How a system of maps is iterated: all compositions of maps, or one walk by chance
    ///
    /// Random iteration, the chaos game, moves a point by one map after the other, picked by their
    /// weights, and draws where it comes. It makes PNGs, and tables of points.
    #[arg(long, value_parser = picture::named::<Method>(), default_value = "deterministic")]
    method: Method,
    /// How many points are drawn: 500k, 10M, 2G [default: 10M, of tables 100k]
    #[arg(long, value_name = "N", value_parser = points, allow_negative_numbers = true)]
    points: Option<u64>,
    /// How numbers of hits become tones [default: log]
    #[arg(long, value_parser = picture::named::<Tone>())]
    tone: Option<Tone>,
    /// Where walks start, if not on the attractor: their way there is drawn; it may be given several times
    #[arg(long, value_name = "X,Y", value_parser = start, allow_hyphen_values = true)]
    start: Vec<DVec2>,
    /// The points of a walk from a start, before the next one begins [default: 256]
    #[arg(long, value_name = "N", requires = "start", value_parser = number::whole("a number of steps", 1..=u32::MAX))]
    walk: Option<u32>,
}

/// How a system of maps is iterated.
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

/// The most points that can be asked for.
const MOST_POINTS: u64 = 1_000_000_000_000;

/// Reads a number of points.
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
        Ok(points) if points > MOST_POINTS as f64 && points.is_finite() => {
            Err("this takes too long: there are no more than 1000G points".into())
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

/// Reads a point.
fn start(text: &str) -> Result<DVec2, String> {
    let coordinates = text.split_once(',').and_then(|(x, y)| {
        let point = DVec2::new(x.trim().parse().ok()?, y.trim().parse().ok()?);
        point.is_finite().then_some(point)
    });
    coordinates.ok_or_else(|| "a start is a point X,Y".into())
}

impl ChaosArguments {
    /// Whether random iteration is asked for.
    pub(super) fn is_asked(&self) -> bool {
        self.method == Method::Chaos
    }

    /// Refuses options of random iteration where it is not asked for.
    pub(super) fn refuse_alone(&self) -> Result<(), Failure> {
        let asked = [
            ("--points", self.points.is_some()),
            ("--tone", self.tone.is_some()),
            ("--start", !self.start.is_empty()),
        ];
        match asked.into_iter().find(|(_, is_asked)| *is_asked) {
            Some((option, _)) => Err(Failure::Usage(format!(
                "{option} is of random iteration: add --method chaos"
            ))),
            None => Ok(()),
        }
    }

    /// The game that is asked for.
    pub(super) fn game<'a>(
        &'a self,
        loaded: &'a Loaded,
        steps: Option<u32>,
        picture: &PictureArguments,
    ) -> Result<ChaosGame<'a>, Failure> {
        let Model::Ifs(_) = &loaded.model else {
            return Err(Failure::Usage(format!(
                "--method chaos needs a system of maps (kind: ifs), and {} is of the kind {}; \
                 without --method it is grown step by step",
                loaded.name,
                loaded.model.kind().name()
            )));
        };
        let place = loaded.place()?;
        let Model::Ifs(source) = loaded.model.within(&place) else {
            unreachable!("a system stays one");
        };
        let system = System::of(source.ifs()).map_err(|error| {
            let error = anyhow::Error::new(error);
            error.context(format!(
                "{} cannot be drawn by random iteration",
                loaded.name
            ))
        })?;
        let color_by = color_by(picture, &source)?;
        if steps.is_some() && color_by != ColorBy::FirstMap {
            let message = "--steps is of deterministic iteration; with --method chaos, --points says \
                           how much is drawn";
            return Err(Failure::Usage(message.into()));
        }
        let walks = NonZero::new(self.walk.unwrap_or(256)).unwrap_or(NonZero::<u32>::MIN);
        let start = match &self.start[..] {
            [] => Start::Attractor,
            points => Start::Points {
                points: points.iter().map(|&point| place.origin_of(point)).collect(),
                steps: walks,
            },
        };
        Ok(ChaosGame {
            arguments: self,
            loaded,
            system,
            start,
            color_by,
            is_by_steps: color_by == ColorBy::Hits
                && picture.asked_color_by().is_none()
                && !picture.asks_palette()
                && source.heading().style.color_by == ColorBy::Step,
            steps: steps.or(source.heading().steps).unwrap_or(8),
            source,
            place,
        })
    }
}

/// What colours tell: as asked for, or as the file says where points can be told apart by it. What
/// a file colours by steps, which points have none of, is coloured by hits.
fn color_by(picture: &PictureArguments, system: &ifs::System) -> Result<ColorBy, Failure> {
    let color_by = picture.style(system.heading()).color_by;
    match (color_by, picture.asked_color_by()) {
        (ColorBy::None | ColorBy::Hits | ColorBy::FirstMap | ColorBy::LastMap, _) => Ok(color_by),
        (_, None) => Ok(ColorBy::Hits),
        (_, Some(asked)) => Err(Failure::Usage(format!(
            "--color-by {} is of elements, and --method chaos draws points: they have hits, \
             last-map and first-map",
            asked.name()
        ))),
    }
}

/// A game that is ready to be played.
pub(super) struct ChaosGame<'a> {
    arguments: &'a ChaosArguments,
    loaded: &'a Loaded,
    /// The system in the coordinates from which the place leads to those of its file.
    source: Arc<ifs::System>,
    place: Homothety,
    system: System,
    start: Start,
    color_by: ColorBy,
    /// Whether hits stand for steps, whose palette the file has.
    is_by_steps: bool,
    /// The step whose first maps are told apart.
    steps: u32,
}

/// Why there is no file.
pub(super) enum Stopped {
    /// Something about points or pictures.
    Said(Failure),
    /// What may happen to any picture.
    Render(RenderError),
}

impl From<RenderError> for Stopped {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

/// Points that tell how far walks lead.
const PILOT: usize = 20_000;

/// Pixels that keep what lies on the edge of the box inside of the picture.
const EDGE: f64 = 1.0 / 32.0;

impl ChaosGame<'_> {
    /// The canvas that shows the attractor, and the ways to it, or the window.
    fn canvas(&self, picture: &PictureArguments, size: Size) -> Result<Canvas, RenderError> {
        let view = picture.view(self.source.heading()).within(&self.place);
        if let Some(window) = view.window {
            return Ok(Canvas::of_window(window, &view, size)?);
        }
        let limit = Graph::of_system(&self.source).limit_bounds();
        let mut bounds = limit.unwrap_or(Bounds::EMPTY);
        if limit.is_none() || self.start != Start::Attractor {
            for point in Points::new(&self.system, &self.start, 0).take(PILOT) {
                bounds.add(point.place);
            }
        }
        Ok(Canvas::fit(&bounds, size, view.margin.max(EDGE))?)
    }

    /// Plays and draws; tells what has been drawn.
    pub(super) fn draw(
        &self,
        size: Size,
        growth: &GrowthArguments,
        picture: &PictureArguments,
        progress: Option<&Progress>,
        out: &mut impl Write,
    ) -> Result<String, Stopped> {
        let canvas = self.canvas(picture, size)?;
        let points = self.arguments.points.unwrap_or(10_000_000);
        let window = Window {
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
            Stopped::Said(match error {
                error @ GameError::TooManyBins { .. } => anyhow::anyhow!(
                    "{error}; a smaller --size works, and --method deterministic draws large pictures \
                     in bands"
                )
                .into(),
                other => anyhow::Error::new(other).into(),
            })
        })?;
        let style = picture.style(self.source.heading());
        let density = Density {
            tone: self.arguments.tone.unwrap_or_default(),
            shades: self.shades(&style, picture.ink(self.source.heading())),
            background: style.background,
        };
        let described = counted(&points.into(), "point");
        let mut options = self.options(points);
        options.extend(growth.options());
        options.push(("format", "png".into()));
        options.push(("size", size.to_string()));
        options.extend(picture.options());
        let labels = labels(self.loaded, &described, "grow", options);
        write_density(&histogram, &density, &labels, out)?;
        let inside = match histogram.inside() {
            inside if inside == points => String::new(),
            inside => format!(", {} inside", crate::wording::grouped(&inside.into())),
        };
        let [width, height] = canvas.size();
        Ok(format!(
            "{}, {described}{inside}, {width} x {height} pixels",
            self.loaded.name
        ))
    }

    /// Lists points; tells what has been listed.
    pub(super) fn list(
        &self,
        format: export::Format,
        growth: &GrowthArguments,
        progress: Option<&Progress>,
        out: &mut impl Write,
    ) -> Result<String, Stopped> {
        let points = self.arguments.points.unwrap_or(100_000);
        if points > growth.most_elements() {
            let error = anyhow!(
                "{} are more rows than --max-elements {} allows",
                counted(&points.into(), "point"),
                growth.most_elements()
            );
            return Err(Stopped::Said(error.into()));
        }
        if let Some(progress) = progress {
            progress.expect(points);
        }
        let all = Points::new(&self.system, &self.start, growth.seed);
        let all = all.take(usize::try_from(points).unwrap_or(usize::MAX));
        let all = all.map(|point| Point {
            place: self.place.point(point.place),
            ..point
        });
        export::write_points(all, format, None, progress, out).map_err(RenderError::from)?;
        let described = counted(&points.into(), "point");
        Ok(format!("{}, {described}", self.loaded.name))
    }

    /// What points are told apart by.
    fn classes(&self) -> ClassBy {
        let ago = match self.color_by {
            ColorBy::LastMap => 0,
            // The maps of a walk are known no further back.
            ColorBy::FirstMap => u8::try_from(self.steps.clamp(1, 200) - 1).unwrap_or(u8::MAX),
            _ => return ClassBy::One,
        };
        ClassBy::Map { ago }
    }

    /// The colours that a style gives to hits, maps or all points.
    fn shades(&self, style: &Style, ink: Option<Colour>) -> Shades {
        let maps = self.source.ifs().maps().len();
        match self.color_by {
            // What a file colours by steps begins with what is large, and so is hit most.
            ColorBy::Hits if self.is_by_steps => Shades::Palette(style.palette.clone().reversed()),
            ColorBy::Hits => Shades::Palette(style.palette.clone()),
            ColorBy::FirstMap | ColorBy::LastMap => {
                // As of approximants, where condensation sets come first, if there are any.
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

    /// The options of the game as the command line has them.
    fn options(&self, points: u64) -> Vec<(&'static str, String)> {
        let mut options = vec![("method", Method::Chaos.name().into())];
        options.push(("points", points.to_string()));
        if let Some(tone) = self.arguments.tone {
            options.push(("tone", tone.name().into()));
        }
        if let Start::Points { steps, .. } = &self.start {
            let starts = self.arguments.start.iter();
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
    use super::{MOST_POINTS, points};

    #[test]
    fn points_are_counted_in_thousands_millions_and_milliards() {
        for (text, number) in [
            ("1", 1),
            ("500k", 500_000),
            ("2.5M", 2_500_000),
            ("1e7", 10_000_000),
            ("1000G", MOST_POINTS),
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
