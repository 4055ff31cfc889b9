//! `kfrac grow`: from a rule to a picture or a table.

mod picture;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::anyhow;
use num_bigint::BigUint;

use crate::catalogue::Catalogue;
use crate::export;
use crate::graph::{Graph, TooLarge};
use crate::grow::{Growth, WalkError};
use crate::render::{RenderError, svg};

use super::output::{Counted, Output};
use super::rule::{Loaded, RuleArguments};
use super::{Failure, steps, stop, text};
use picture::PictureArguments;

/// Grows a rule and draws it
#[derive(clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// How often fertile elements are replaced [default: what the rule says]
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    /// The file to write, or - for standard output [default: NAME.svg]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The format [default: from the extension of the file]
    #[arg(long, value_enum)]
    format: Option<Format>,
    #[command(flatten)]
    picture: PictureArguments,
    /// What random draws depend on
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
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

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    let format = match (arguments.format, &arguments.output) {
        (Some(format), _) => format,
        (None, Some(path)) if path != Path::new("-") => Format::of_path(path)?,
        (None, _) => Format::Svg,
    };
    let loaded = arguments.rule.load(catalogue, arguments.quiet)?;
    let steps = steps::choose(arguments.steps, &loaded)?;
    let graph = loaded.compile(steps)?;
    graph
        .check_size(steps, arguments.max_elements)
        .map_err(|error| {
            anyhow!(too_large(
                &error,
                &loaded.name,
                steps,
                arguments.max_elements
            ))
        })?;
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
    let wrote = wrote.map_err(|failure| explain(failure, &loaded, path, arguments.max_elements))?;
    let (file, bytes) = out.into_parts();
    file.finish()?;
    if !arguments.quiet {
        let what = if path == Path::new("-") {
            "standard output".into()
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

/// An output, as messages call it.
fn named(path: &Path) -> String {
    if path == Path::new("-") {
        "standard output".into()
    } else {
        format!("'{}'", path.display())
    }
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

fn write_svg(
    arguments: &Arguments,
    loaded: &Loaded,
    graph: &Graph,
    growth: &Growth<'_>,
    out: &mut impl Write,
) -> Result<Wrote, RenderError> {
    let labels = labels(arguments, loaded, growth);
    let picture = &arguments.picture;
    let (style, view) = (picture.style(&loaded.rule), picture.view(&loaded.rule));
    svg::write(graph, growth, &style, &view, picture.size, &labels, out).map(|picture| Wrote {
        elements: picture.elements,
        fractals: picture.fractals,
        pixels: Some(picture.size),
    })
}

fn write_table(
    format: export::Format,
    graph: &Graph,
    growth: &Growth<'_>,
    out: &mut impl Write,
) -> Result<Wrote, RenderError> {
    export::write(graph, growth, format, out)
        .map(|walked| Wrote {
            elements: walked.elements,
            fractals: walked.fractals,
            pixels: None,
        })
        .map_err(RenderError::from)
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
        command(arguments, loaded, growth)
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

/// The command that makes the picture again from the rule as resolved.
fn command(arguments: &Arguments, loaded: &Loaded, growth: &Growth<'_>) -> String {
    let Growth { steps, seed, .. } = growth;
    let file = quoted(&format!("{}.yaml", loaded.name));
    let mut command = format!("kfrac grow {file} --steps {steps} --seed {seed}");
    let settings = arguments.rule.set.iter();
    let settings = settings.map(|setting| ("set", format!("{}={}", setting.name, setting.value)));
    for (name, value) in settings.chain(arguments.picture.options()) {
        // Joined by a sign of equality, so that a value may begin with a minus.
        command.push_str(&format!(" --{name}={}", quoted(&value)));
    }
    command
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_.,=%".contains(c);
    if word.chars().all(plain) {
        return word.into();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

fn too_large(error: &TooLarge, name: &str, steps: u32, limit: u64) -> String {
    let limit = text::grouped(&BigUint::from(limit));
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| text::counted(elements, "element"),
    );
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
        None => format!("no step is within --max-elements {limit}"),
    };
    format!("step {steps} of {name} has {count}; {deepest}")
}

fn explain(error: RenderError, loaded: &Loaded, path: &Path, limit: u64) -> Failure {
    match error {
        RenderError::Io(error) => anyhow::Error::new(error)
            .context(format!("{} cannot be written", named(path)))
            .into(),
        RenderError::Walk(WalkError::Cancelled) => Failure::Interrupted,
        RenderError::Walk(WalkError::NotFinite(error)) => error.diagnostic(&loaded.rule).into(),
        RenderError::Walk(WalkError::TooManyElements { .. }) => {
            let limit = text::counted(&BigUint::from(limit), "element");
            anyhow!(
                "{} has more than {limit}; --max-elements allows more",
                loaded.name
            )
            .into()
        }
        RenderError::Walk(error @ WalkError::TooLong { .. }) => anyhow::Error::new(error)
            .context(format!(
                "{} takes too long; --max-elements allows more",
                loaded.name
            ))
            .into(),
        other => anyhow::Error::new(other).into(),
    }
}
