//! `kfrac grow`: from a rule to a picture or a table.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, anyhow};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use num_bigint::BigUint;

use crate::catalogue::Catalogue;
use crate::export;
use crate::graph::{Graph, TooLarge};
use crate::grow::{Growth, WalkError};
use crate::render::{RenderError, Size, svg};
use crate::style::{Cap, ColorBy, Colour, Join, Named, Palette, Style, View, Width};

use super::output::{Counted, Output};
use super::rule::{Loaded, RuleArguments};
use super::{Failure, stop, text};

/// Grows a rule and draws it
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// How often fertile elements are replaced [default: what the rule says]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    steps: Option<u32>,
    /// The file to write, or - for standard output [default: NAME.svg]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The format [default: from the extension of the file]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// The picture's long side in pixels, or WIDTHxHEIGHT
    #[arg(long, value_name = "SIZE", default_value = "1024", value_parser = size)]
    size: Size,
    /// A window in the rule's units: lower left corner, width, height
    #[arg(long, value_name = "X,Y,W,H", value_parser = window, allow_hyphen_values = true)]
    view: Option<[f64; 4]>,
    /// What random draws depend on
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// The colour of strokes, as CSS writes it
    #[arg(long, value_name = "COLOR", value_parser = colour)]
    stroke: Option<Colour>,
    /// The width of strokes in pixels, or, with a % sign, relative to the element
    #[arg(long, value_name = "W", value_parser = width)]
    stroke_width: Option<Width>,
    /// The colour of areas
    #[arg(long, value_name = "COLOR", value_parser = colour)]
    fill: Option<Colour>,
    /// The ends of lines
    #[arg(long, value_parser = named::<Cap>())]
    cap: Option<Cap>,
    /// The corners of lines
    #[arg(long, value_parser = named::<Join>())]
    join: Option<Join>,
    /// Pixels left free around the picture
    #[arg(long, value_name = "PX", value_parser = length)]
    margin: Option<f64>,
    /// The colour behind the picture
    #[arg(long, value_name = "COLOR", value_parser = colour)]
    background: Option<Colour>,
    /// What colours tell
    #[arg(long, value_parser = named::<ColorBy>())]
    color_by: Option<ColorBy>,
    /// The colours
    #[arg(long, value_name = "NAME", value_parser = palette())]
    palette: Option<Palette>,
    /// Refuses to grow more elements than this
    #[arg(long, value_name = "N", default_value_t = 50_000_000)]
    max_elements: u64,
    /// Says nothing but what is wrong
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    Svg,
    Csv,
    Json,
}

impl Format {
    fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Csv => "csv",
            Self::Json => "json",
        }
    }

    fn of_path(path: &Path) -> Result<Self, Failure> {
        let extension = path
            .extension()
            .and_then(|extension| extension.to_str())
            .map(str::to_lowercase);
        match extension.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("csv") => Ok(Self::Csv),
            Some("json" | "jsonl" | "ndjson") => Ok(Self::Json),
            None => Ok(Self::Svg),
            Some(other) => {
                let message = format!(
                    "the format '.{other}' is not known: .svg, .csv and .json are (or say --format)"
                );
                Err(Failure::Usage(message))
            }
        }
    }
}

impl Arguments {
    /// The command that makes the picture again from the rule as resolved.
    fn command(&self, name: &str, growth: &Growth<'_>) -> String {
        let mut command = format!(
            "kfrac grow {name}.yaml --steps {} --seed {}",
            growth.steps, growth.seed
        );
        let mut option = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                command.push_str(&format!(" --{name} '{value}'"));
            }
        };
        for setting in &self.rule.set {
            option("set", Some(format!("{}={}", setting.name, setting.value)));
        }
        let colour = |colour: Option<Colour>| colour.map(|colour| format!("{colour:#}"));
        option(
            "size",
            Some(match self.size {
                Size::Long(side) => side.to_string(),
                Size::Exactly(width, height) => format!("{width}x{height}"),
            }),
        );
        option(
            "view",
            self.view
                .map(|view| view.map(|number| number.to_string()).join(",")),
        );
        option("stroke", colour(self.stroke));
        option(
            "stroke-width",
            self.stroke_width.map(|width| match width {
                Width::Pixels(width) => width.to_string(),
                Width::Relative(width) => format!("{}%", width * 100.0),
            }),
        );
        option("fill", colour(self.fill));
        option("cap", self.cap.map(|cap| cap.name().into()));
        option("join", self.join.map(|join| join.name().into()));
        option("margin", self.margin.map(|margin| margin.to_string()));
        option("background", colour(self.background));
        option("color-by", self.color_by.map(|by| by.name().into()));
        option(
            "palette",
            self.palette.as_ref().map(|palette| palette.name().into()),
        );
        command
    }
}

const MOST_PIXELS: u32 = 1_000_000;

fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| match text.parse::<u32>() {
        Ok(side) if (1..=MOST_PIXELS).contains(&side) => Ok(side),
        _ => Err(format!(
            "a side is a whole number of pixels from 1 to {MOST_PIXELS}"
        )),
    };
    match text.split_once('x') {
        Some((width, height)) => Ok(Size::Exactly(side(width)?, side(height)?)),
        None => Ok(Size::Long(side(text)?)),
    }
}

fn window(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, _> = text
        .split(',')
        .map(|number| number.trim().parse())
        .collect();
    match numbers.map(<[f64; 4]>::try_from) {
        Ok(Ok(window))
            if window.iter().all(|number| number.is_finite())
                && window[2] > 0.0
                && window[3] > 0.0 =>
        {
            Ok(window)
        }
        _ => Err("a window is X,Y,W,H: lower left corner, width and height above 0".into()),
    }
}

fn colour(text: &str) -> Result<Colour, String> {
    Colour::parse(text)
        .ok_or_else(|| "write a colour as CSS does: teal, #3b7ea1, rgb(59, 126, 161)".into())
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length.is_finite() && length >= 0.0 => Ok(length),
        _ => Err("this is a number that is not negative".into()),
    }
}

fn width(text: &str) -> Result<Width, String> {
    match text.strip_suffix('%') {
        Some(percent) => Ok(Width::Relative(length(percent)? / 100.0)),
        None => Ok(Width::Pixels(length(text)?)),
    }
}

fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(T::NAMES.iter().map(|(name, _)| *name))
        .try_map(|name| T::from_name(&name).ok_or("unknown"))
}

fn palette() -> impl TypedValueParser<Value = Palette> {
    PossibleValuesParser::new(Palette::names()).try_map(|name| Palette::named(&name))
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    let format = match (arguments.format, &arguments.output) {
        (Some(format), _) => format,
        (None, Some(path)) if path != Path::new("-") => Format::of_path(path)?,
        (None, _) => Format::Svg,
    };
    let loaded = arguments.rule.load(catalogue, arguments.quiet)?;
    let steps = match arguments.steps.or(loaded.rule.steps()) {
        Some(steps) => steps,
        None => sensible_steps(&loaded)?,
    };
    let graph = Graph::compile(&loaded.rule, steps).map_err(anyhow::Error::from)?;
    graph
        .check_size(steps, arguments.max_elements)
        .map_err(|error| anyhow!(too_large(&error, &loaded.name, steps)))?;
    let growth = Growth {
        steps,
        seed: arguments.seed,
        most_elements: arguments.max_elements,
        cancel: Some(stop::flag()),
    };
    let default = PathBuf::from(format!("{}.{}", loaded.name, format.extension()));
    let path = arguments.output.as_ref().unwrap_or(&default);
    let mut out = Counted::new(Output::create(path)?);
    let wrote = match format {
        Format::Svg => write_svg(arguments, &loaded, &graph, &growth, &mut out),
        Format::Csv => write_table(export::Format::Csv, &graph, &growth, &mut out),
        Format::Json => write_table(export::Format::JsonLines, &graph, &growth, &mut out),
    };
    let wrote =
        wrote.map_err(|failure| explain(failure, &loaded.name, path, arguments.max_elements))?;
    let (file, bytes) = out.into_parts();
    file.finish()?;
    if !arguments.quiet {
        let what = if path == Path::new("-") {
            loaded.name.clone()
        } else {
            path.display().to_string()
        };
        text::say(&format!(
            "{what}: step {steps} of {}, {}, {:.2} s",
            loaded.name,
            wrote.summary(bytes),
            start.elapsed().as_secs_f64(),
        ));
    }
    Ok(())
}

/// What has been written.
struct Wrote {
    elements: u64,
    fractals: u64,
    pixels: Option<[u32; 2]>,
}

impl Wrote {
    fn summary(&self, bytes: u64) -> String {
        let mut summary = text::counted(&BigUint::from(self.elements), "element");
        if self.fractals > 1 {
            summary.push_str(&format!(
                " in {}",
                text::counted(&BigUint::from(self.fractals), "fractal")
            ));
        }
        if let Some([width, height]) = self.pixels {
            summary.push_str(&format!(", {width} x {height} pixels"));
        }
        format!("{summary}, {}", text::bytes(bytes))
    }
}

/// Why nothing has been written.
enum Stopped {
    Render(RenderError),
    Table(WalkError<std::io::Error>),
}

fn write_svg(
    arguments: &Arguments,
    loaded: &Loaded,
    graph: &Graph,
    growth: &Growth<'_>,
    out: &mut impl Write,
) -> Result<Wrote, Stopped> {
    let labels = labels(arguments, loaded, growth);
    let (style, view) = (
        style(arguments, &loaded.rule),
        view(arguments, &loaded.rule),
    );
    svg::write(graph, growth, &style, &view, arguments.size, &labels, out)
        .map(|picture| Wrote {
            elements: picture.elements,
            fractals: picture.fractals,
            pixels: Some(picture.size),
        })
        .map_err(Stopped::Render)
}

fn write_table(
    format: export::Format,
    graph: &Graph,
    growth: &Growth<'_>,
    out: &mut impl Write,
) -> Result<Wrote, Stopped> {
    export::write(graph, growth, format, out)
        .map(|walked| Wrote {
            elements: walked.elements,
            fractals: walked.fractals,
            pixels: None,
        })
        .map_err(Stopped::Table)
}

fn style(arguments: &Arguments, rule: &crate::rule::Rule) -> Style {
    let own = rule.style();
    Style {
        stroke: arguments.stroke.or(own.stroke),
        width: arguments.stroke_width.unwrap_or(own.width),
        cap: arguments.cap.unwrap_or(own.cap),
        join: arguments.join.unwrap_or(own.join),
        fill: arguments.fill.or(own.fill),
        background: arguments.background.or(own.background),
        color_by: match arguments.color_by {
            Some(color_by) => color_by,
            // A colour that is asked for is not covered by a palette that is not.
            None if arguments.stroke.is_some() || arguments.fill.is_some() => ColorBy::None,
            None => own.color_by,
        },
        palette: arguments
            .palette
            .clone()
            .unwrap_or_else(|| own.palette.clone()),
    }
}

fn view(arguments: &Arguments, rule: &crate::rule::Rule) -> View {
    View {
        window: arguments.view.or(rule.view().window),
        margin: arguments.margin.unwrap_or(rule.view().margin),
    }
}

/// Title, description, and all that it takes to make the file again.
fn labels(arguments: &Arguments, loaded: &Loaded, growth: &Growth<'_>) -> svg::Labels {
    let description = loaded.rule.description();
    let title = description
        .title
        .clone()
        .unwrap_or_else(|| loaded.name.clone());
    let mut provenance = format!(
        "# kfrac {}\n# {}\n",
        env!("CARGO_PKG_VERSION"),
        arguments.command(&loaded.name, growth)
    );
    for parameter in loaded.rule.parameters() {
        provenance.push_str(&format!("# {} = {}\n", parameter.name, parameter.value));
    }
    provenance.push_str(&loaded.document.to_yaml());
    svg::Labels {
        title,
        description: format!(
            "Step {} of {}. {}",
            growth.steps,
            loaded.name,
            description.about.as_deref().unwrap_or_default().trim()
        ),
        provenance,
    }
}

/// The deepest step, up to 12, that has no more than 20,000 elements; 6 where that is not known.
fn sensible_steps(loaded: &Loaded) -> Result<u32, Failure> {
    const DEEPEST: u32 = 12;
    let graph = Graph::compile(&loaded.rule, DEEPEST).map_err(anyhow::Error::from)?;
    if graph.forecast().is_none() {
        return Ok(DEEPEST / 2);
    }
    Ok(match graph.check_size(DEEPEST, 20_000) {
        Ok(()) => DEEPEST,
        Err(error) => error.deepest.unwrap_or(0),
    })
}

fn too_large(error: &TooLarge, name: &str, steps: u32) -> String {
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| text::counted(elements, "element"),
    );
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements"),
        None => "no step is within --max-elements".into(),
    };
    format!("step {steps} of {name} has {count}; {deepest}")
}

fn explain(stopped: Stopped, name: &str, path: &Path, limit: u64) -> Failure {
    let walk = match stopped {
        Stopped::Render(RenderError::Io(error)) => return unwritten(error, path),
        Stopped::Table(WalkError::Visitor(error)) => return unwritten(error, path),
        Stopped::Render(RenderError::Walk(WalkError::Cancelled)) => return Failure::Interrupted,
        Stopped::Table(WalkError::Cancelled) => return Failure::Interrupted,
        Stopped::Render(RenderError::Walk(WalkError::TooManyElements { .. }))
        | Stopped::Table(WalkError::TooManyElements { .. }) => {
            let limit = text::counted(&BigUint::from(limit), "element");
            anyhow!("{name} has more than {limit}; --max-elements allows more")
        }
        Stopped::Render(error) => error.into(),
        Stopped::Table(error) => error.into(),
    };
    walk.into()
}

fn unwritten(error: std::io::Error, path: &Path) -> Failure {
    let result: anyhow::Result<()> =
        Err(error).with_context(|| format!("'{}' cannot be written", path.display()));
    match result {
        Err(error) => error.into(),
        Ok(()) => Failure::Said,
    }
}
