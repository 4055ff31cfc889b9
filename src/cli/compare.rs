//! `kfrac compare`: Hausdorff distance of two fractals.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::ValueHint;
use serde::Serialize;

use super::readable;
use crate::catalogue::Catalogue;
use crate::document::{Document, Setting};
use crate::figure::difference::{self, PixelSet};
use crate::geometry::{Bounds, Frame, Frame2, Homothety};
use crate::graph::Graph;
use crate::grow::{Growth, WalkError};
use crate::measure::{
    Covering, Distance, NoCover, Precision, Similarity, Subject, Subset, hausdorff,
    similarity_dimension,
};
use crate::render::{self, Canvas, Size};
use crate::style::{ColorBy, Style};

use super::exchanged::ExchangedComponents;
use super::family::{Assignment, assignment};
use super::info::{Corners, corners};
use super::labels::labels_of_two;
use super::rule::{self, Loaded, RuleArguments};
use super::{Failure, format, help, input, length, number, output, picture, steps, text};

/// Computes the Hausdorff distance of the limit sets of two fractals
///
/// The Hausdorff distance is the largest distance of a point of one set from the other set. It is reported
/// with a bound of its error; the sets are considered the same if the distance does not exceed that bound.
/// Closed outlines and solids include their interior. The exit status is 0 in either case.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Rule file, name of a rule in the library, or - for standard input
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Rule to compare with A, in the same notation
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Sets a parameter of A, of B, or of both, whichever has it; may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,
    /// Compares the approximants of this step instead of the limit sets
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    /// Target error of the distance, relative to the size of the larger set
    #[arg(long, value_name = "E", default_value = "0.001", value_parser = tolerance)]
    tolerance: f64,
    /// Largest number of points that represent each set; too few increase the error
    #[arg(long, value_name = "N", default_value_t = 4_000_000, value_parser = number::whole("a number of points", 0..=usize::MAX))]
    max_points: usize,
    /// Writes a picture of the difference: A alone in orange, B alone in blue, both in grey
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Format of the picture [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// Long side of the picture in pixels, or WIDTHxHEIGHT
    #[arg(long, value_name = "SIZE", default_value = "1024", value_parser = length::size)]
    size: Size,
    /// Background colour of the picture
    #[arg(long, value_name = "COLOR", value_parser = picture::ink)]
    background: Option<picture::Ink>,
    /// Prints the result as JSON
    ///
    /// a and b have name, kind, bounds (min and max, of the set that is compared) and dimension (similarity,
    /// note). steps is null for limit sets. distance, a_to_b and b_to_a (the largest distance of a point of
    /// one set from the other) are correct within error. reached is true if error is at most what --tolerance
    /// requests. same is true if distance is at most error.
    #[arg(long)]
    json: bool,
    /// Prints only the result and errors
    #[arg(long, short)]
    quiet: bool,
}

const MORE: &str = "\
Examples:
  kfrac compare dragon twindragon --tolerance 0.01
      Computes the distance of two dragons, to a hundredth of their size
  kfrac compare koch koch-quadratic -o difference.png
      Also draws the parts that only one of the two has
  kfrac compare koch koch-snowflake --steps 4 --json
      Compares approximants, with JSON output
";

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if (1e-9..=1.0).contains(&tolerance) => Ok(tolerance),
        _ => Err("expected a number from 1e-9 to 1".into()),
    }
}

#[derive(Serialize)]
struct Comparison<'a> {
    a: Side<'a>,
    b: Side<'a>,
    steps: Option<u32>,
    distance: f64,
    error: f64,
    reached: bool,
    a_to_b: f64,
    b_to_a: f64,
    same: bool,
}

#[derive(Serialize)]
struct Side<'a> {
    name: &'a str,
    kind: &'static str,
    bounds: Corners,
    dimension: Dimension,
}

#[derive(Serialize)]
struct Dimension {
    similarity: Option<f64>,
    note: Option<String>,
}

/// One of the two fractals.
struct One<F: Frame = Frame2> {
    loaded: Loaded,
    graph: Graph<F>,
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let both = arguments.load(catalogue)?;
    match both.each_ref().map(|loaded| loaded.model.is_in_space()) {
        [true, true] => return arguments.compare_in_space(both),
        [false, false] => {}
        [is_first, _] => {
            let [plane, space] = if is_first { [1, 0] } else { [0, 1] };
            let (plane, space) = (&both[plane].name, &both[space].name);
            let message = format!("{plane} lies in the plane, and {space} in space");
            return Err(Failure::Usage(message));
        }
    }
    let both = arguments.compile(both)?;
    let subjects = arguments.subjects(&both)?;
    let place = both[0].graph.place();
    let in_units = |bounds: &Bounds| corners(&place.bounds(bounds));
    let (comparison, distance) = arguments.compare(&both, &subjects, place.ratio(), in_units)?;
    // The picture is written first, so that a failure leaves no result that looks complete.
    if let Some(path) = &arguments.output {
        arguments.draw(path, format, &both, &subjects)?;
    }
    output::print_as(arguments.json, &comparison, || {
        described(&comparison, &distance)
    })
}

impl Arguments {
    fn compare_in_space(&self, both: [Loaded; 2]) -> Result<(), Failure> {
        if self.output.is_some() {
            let message = "a picture of the difference is for the plane";
            return Err(Failure::Usage(message.into()));
        }
        let compiled = both.map(|loaded| {
            let graph = loaded.drawn_in_space(self.steps, ColorBy::None)?.graph;
            Ok::<_, Failure>(One { loaded, graph })
        });
        let [a, b] = compiled;
        let both = [a?, b?];
        let subjects = self.subjects(&both)?;
        let (comparison, distance) = self.compare(&both, &subjects, 1.0, corners)?;
        output::print_as(self.json, &comparison, || described(&comparison, &distance))
    }

    /// Returns the sets that are compared.
    fn subjects<'a, F: Covering>(
        &self,
        both: &'a [One<F>; 2],
    ) -> Result<[Subject<'a, F>; 2], Failure> {
        let set = match self.steps {
            None => Subset::Limit,
            Some(steps) => Subset::Approximant(Growth::steps(steps)),
        };
        let subject = |which: usize| {
            let One { loaded, graph } = &both[which];
            Subject::new(graph, set).map_err(|error| explain(error, loaded))
        };
        Ok([subject(0)?, subject(1)?])
    }

    /// Compares two sets. `unit` is the length of a unit of the graphs in the files' units, and `in_units` converts
    /// boxes.
    fn compare<'a, F: Covering>(
        &self,
        both: &'a [One<F>; 2],
        subjects: &[Subject<'_, F>; 2],
        unit: f64,
        in_units: impl Fn(&Bounds<F::Point>) -> Corners,
    ) -> Result<(Comparison<'a>, Distance), Failure> {
        let precision = Precision {
            tolerance: self.tolerance,
            max_points: self.max_points,
        };
        let distance = hausdorff([&subjects[0], &subjects[1]], &precision)
            .map_err(|(which, error)| explain(error, &both[which].loaded))?;
        let side = |which: usize| {
            let One { loaded, graph } = &both[which];
            let Similarity { value, note } = similarity_dimension(graph);
            Side {
                name: &loaded.name,
                kind: loaded.model.kind().name(),
                bounds: in_units(subjects[which].bounds()),
                dimension: Dimension {
                    similarity: value,
                    note,
                },
            }
        };
        let distance = Distance {
            there: distance.there * unit,
            back: distance.back * unit,
            error: distance.error * unit,
            ..distance
        };
        let comparison = Comparison {
            a: side(0),
            b: side(1),
            steps: self.steps,
            distance: distance.value(),
            error: distance.error,
            reached: distance.is_reached(),
            a_to_b: distance.there,
            b_to_a: distance.back,
            same: distance.may_be_same(),
        };
        Ok((comparison, distance))
    }

    /// Reads both fractals and applies every setting to whichever has the parameter.
    fn load(&self, catalogue: &Catalogue) -> Result<[Loaded; 2], Failure> {
        let paths = [&self.a, &self.b];
        if paths.iter().all(|path| *path == Path::new("-")) {
            let message = "only one of the two can come from standard input";
            return Err(Failure::Usage(message.into()));
        }
        let read = |path: &Path| -> Result<Document, Failure> {
            let source = rule::open(path, catalogue)?;
            Ok(input::document(&source, catalogue)?)
        };
        let documents = [read(paths[0])?, read(paths[1])?];
        let has = |document: &Document, setting: &Setting| {
            let mut params = document.metadata().params.iter();
            params.any(|param| param.name.value == setting.name)
        };
        let nobody = |setting: &&Setting| !documents.iter().any(|it| has(it, setting));
        let settings: Result<Vec<_>, _> = self.set.iter().map(Assignment::settings).collect();
        let settings = settings?.concat();
        let lost: Vec<_> = settings.iter().filter(nobody).cloned().collect();
        let mut both = Vec::new();
        for (path, document) in paths.into_iter().zip(documents) {
            let own = settings.iter().filter(|setting| has(&document, setting));
            let arguments = RuleArguments {
                rule: path.clone(),
                set: Vec::new(),
                omit: Vec::new(),
                components: ExchangedComponents::default(),
            };
            // A parameter that neither has is reported for the first.
            let settings = own.chain(&lost).cloned().collect();
            let quiet = self.quiet || self.json;
            both.push(arguments.resolve(document.into(), settings, quiet)?);
        }
        both.try_into()
            .map_err(|_| anyhow!("two fractals are compared").into())
    }

    /// Compiles both fractals, in coordinates that suit the first.
    fn compile(&self, [a, b]: [Loaded; 2]) -> Result<[One; 2], Failure> {
        let graph = |loaded: &Loaded| match self.steps {
            Some(steps) => loaded.compile(steps),
            None => loaded
                .compile_limit(STEPS)
                .map_err(|error| loaded.failure(&error)),
        };
        let one = |loaded: Loaded, place: Homothety| {
            let loaded = loaded.within(place);
            let graph = graph(&loaded)?;
            Ok::<_, Failure>(One { loaded, graph })
        };
        let place = a.place()?;
        let first = one(a, place)?;
        let place = *first.graph.place();
        Ok([first, one(b, place)?])
    }

    fn draw(
        &self,
        path: &Path,
        format: render::Format,
        both: &[One; 2],
        subjects: &[Subject<'_>; 2],
    ) -> Result<(), Failure> {
        const MARGIN: f64 = 8.0;
        let mut bounds = *subjects[0].bounds();
        bounds.add_all(subjects[1].bounds());
        let canvas = Canvas::fit(&bounds, self.size, MARGIN).map_err(anyhow::Error::from)?;
        let [width, height] = canvas.size().map(|side| side as usize);
        let most = MAX_POINTS_A_PIXEL.saturating_mul(width.saturating_mul(height));
        let pixels = |which: usize| -> Result<PixelSet, Failure> {
            let mut pixels = PixelSet::new(canvas).map_err(anyhow::Error::from)?;
            let visited = subjects[which].visit(pixels.radius(), most, &mut |it| pixels.add(it));
            visited.map_err(|error| match error {
                NoCover::TooMany(_) => anyhow!(
                    "{} cannot be drawn: its pixels need too many points; a smaller --size \
                     needs fewer",
                    both[which].loaded.name
                )
                .into(),
                error => explain(error, &both[which].loaded),
            })?;
            Ok(pixels)
        };
        let (first, second) = (pixels(0)?, pixels(1)?);
        let options = render::Options {
            format,
            style: Style {
                background: self.background.and_then(picture::Ink::colour),
                ..Style::default()
            },
            labels: labels_of_two(&both[0].loaded, &both[1].loaded),
            ..render::Options::default()
        };
        let (pixels, bytes) = output::write(path, true, |out, _| {
            difference::write(canvas, [&first, &second], &options, out)
                .map_err(|error| output::explain(error, path))
        })?;
        if !self.quiet {
            let [width, height] = canvas.size();
            let [first, second, shared] = pixels.map(|count| readable::grouped(&count.into()));
            text::print_message(&format!(
                "{}: {width} x {height} pixels, {first} of A alone, {second} of B alone, \
                 {shared} of both, {}",
                output::called(path),
                readable::bytes(bytes),
            ));
        }
        Ok(())
    }
}

/// Largest number of points per pixel of a picture: more than a cover by discs of half a pixel needs.
const MAX_POINTS_A_PIXEL: usize = 16;

/// Number of steps for which graphs are compiled if limit sets are compared.
const STEPS: u32 = 64;

fn explain(error: NoCover, loaded: &Loaded) -> Failure {
    match error {
        NoCover::Walk(WalkError::NotFinite(error)) => loaded.model.diagnostic(&error).into(),
        NoCover::NoLimit(reason) => anyhow!(
            "{} cannot be compared: {reason}; --steps N compares approximants",
            loaded.name
        )
        .into(),
        NoCover::TooMany(_) => anyhow!(
            "{} cannot be compared: {error}; --max-points allows more",
            loaded.name
        )
        .into(),
        _ => anyhow!("{} cannot be compared: {error}", loaded.name).into(),
    }
}

/// Describes the result in text.
fn described(comparison: &Comparison<'_>, distance: &Distance) -> String {
    let mut text = String::new();
    let Comparison { a, b, .. } = comparison;
    let what = match comparison.steps {
        None => "limit sets".into(),
        Some(steps) => format!("step {steps}"),
    };
    let verdict = if comparison.same {
        "the same, within the error"
    } else {
        "different"
    };
    let mut line = |label: &str, value: &str| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{label:<12}{value}");
    };
    line("compared", &format!("{what} of {} and {}", a.name, b.name));
    line("verdict", verdict);
    let error = distance.error;
    line(
        "distance",
        &format!("{} ± {error:.2e}", formatted(distance.value(), error)),
    );
    if !distance.is_reached() {
        let wanted = distance.wanted;
        line(
            "error",
            &format!(
                "above the {wanted:.2e} that --tolerance requests: --max-points allows more points"
            ),
        );
    }
    for (label, one, other, way) in [
        ("A to B", a, b, distance.there),
        ("B to A", b, a, distance.back),
    ] {
        let way = formatted(way, error);
        line(
            label,
            &format!("{way} from {} to {}, at most", one.name, other.name),
        );
    }
    for (label, side) in [("box of A", a), ("box of B", b)] {
        let axes = side.bounds.min.iter().zip(&side.bounds.max);
        let spans: Vec<_> = axes
            .map(|(low, high)| format!("{low:.6} to {high:.6}"))
            .collect();
        line(label, &spans.join(", "));
    }
    let dimension = |side: &Side<'_>| match side.dimension.similarity {
        Some(value) => format!("{value:.6}"),
        None => side.dimension.note.clone().unwrap_or_default(),
    };
    line(
        "dimension",
        &format!("{} and {}", dimension(a), dimension(b)),
    );
    text
}

/// Formats a value with the digits that its error leaves.
fn formatted(value: f64, error: f64) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "there are few digits"
    )]
    let digits = (1.0 - libm::log10(error).floor()).clamp(0.0, 15.0) as usize;
    format!("{value:.digits$}")
}
