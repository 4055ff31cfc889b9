//! `kfrac show`: draws a production rule as a figure.

use std::io::Write;
use std::path::{Path, PathBuf};
#[cfg(feature = "studio")]
use std::sync::Arc;

use clap::ValueHint;

use super::readable;
use crate::catalogue::{Catalogue, Shelf};
#[cfg(feature = "studio")]
use crate::diagnostic::Source;
use crate::figure::rule::{self, Topology};
use crate::model::Kind;
use crate::render::space::Camera;
use crate::render::{self, Size};
use crate::style::{ColorBy, Named};

use super::component::Component;
#[cfg(feature = "studio")]
use super::held::{self, Held, Memory};
use super::labels::labels;
use super::picture;
use super::rule::{Loaded, RuleArguments};
use super::{Failure, camera, format, help, length, number, output, text};

/// Draws a rule as a figure: its components, maps, objects or productions
///
/// A component of the library is drawn alone. Fertile elements are marked with an asterisk, directions with
/// their number; selection and random functions are written out (in the style of Kaandorp 1987, figures 1 to
/// 13). Productions of L-systems are drawn as the turtle draws what they replace, and what it becomes.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Output file, or - for standard output [default: NAME-rule.svg]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// Long side in pixels, or WIDTHxHEIGHT [default: the smallest legible size]
    #[arg(long, value_name = "SIZE", value_parser = length::size)]
    size: Option<Size>,
    /// Background colour of the figure
    #[arg(long, value_name = "COLOR", value_parser = picture::ink)]
    background: Option<picture::Ink>,
    /// Direction from which a system in space is seen: azimuth and elevation in degrees, or front, side, top or iso
    /// [default: 30,25]
    #[arg(long, value_name = "AZ,EL", value_parser = camera::direction, allow_hyphen_values = true)]
    from: Option<[f64; 2]>,
    /// Draws the instancing graph: objects as circles, instances as arrows [default topology: cyclic]
    ///
    /// cyclic: objects that instance each other or themselves, as for the limit set. levels: those of each step, down to the base
    /// elements. tree: a circle for each instance (Hart 1992, figures 1 to 3).
    #[arg(long, value_name = "TOPOLOGY", value_parser = picture::named::<Topology>())]
    #[arg(num_args = 0..=1, require_equals = true, default_missing_value = "cyclic")]
    graph: Option<Topology>,
    /// Number of steps of --graph=levels and --graph=tree [default: 3]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of steps", 0..=64_u32), requires = "graph")]
    steps: Option<u32>,
    /// Suppresses all messages except errors
    #[arg(long, short)]
    quiet: bool,
}

/// Number of steps of graphs where none is given.
const STEPS: u32 = 3;

const MORE: &str = "\
Examples:
  kfrac show dragon
      Draws the rule of the dragon sweep, into dragon-rule.svg
  kfrac show pythagoras --set angle=30 --background white -o rule.png
      Draws a rule with the given parameter, as a PNG on white
  kfrac show menger --from 20,30
      Draws the maps of a system in space as they are seen from a direction
  kfrac show sierpinski-triangles --graph=levels --steps 3
      Draws the instancing graph of an approximant, by levels
  kfrac show hilbert-lsystem
      Draws the productions of an L-system
  kfrac show generators/dragon
      Draws the generator alone, into dragon-generator.svg
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let component = Component::find(&arguments.rule.rule, catalogue)?;
    let loaded = match &component {
        Some(component) => {
            let rule = component.in_a_rule();
            arguments
                .rule
                .load_from(&rule, catalogue, arguments.quiet)?
        }
        None => arguments.rule.load(catalogue, arguments.quiet)?,
    };
    if arguments.from.is_some() && !loaded.model.is_in_space() {
        return Err(camera::in_plane("from", &loaded));
    }
    let alone = component.as_ref().map(Component::shelf);
    if let (Some(_), Some(shelf)) = (arguments.graph, alone) {
        let message = format!(
            "--graph draws the graph of a rule, and {} is {}",
            loaded.name,
            shelf.noun()
        );
        return Err(Failure::Usage(message));
    }
    let suffix = match (alone, arguments.graph) {
        (Some(shelf), _) => format!("-{}", shelf.kind().replace('_', "-")),
        (None, Some(_)) => "-graph".into(),
        (None, None) => "-rule".into(),
    };
    let default = arguments.rule.file(&suffix, format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let options = arguments.options(&loaded, alone, format);
    let ([width, height], bytes) = output::write(path, arguments.quiet, |out, _| {
        let Loaded {
            model, document, ..
        } = &loaded;
        match arguments.graph {
            Some(topology) => arguments.write_graph(&loaded, topology, &options, path, out),
            None => rule::write(model, document, alone, &options, out)
                .map_err(|error| output::explain(error, path)),
        }
    })?;
    if !arguments.quiet {
        text::print_message(&format!(
            "{}: the {} of {}, {width} x {height} pixels, {}",
            output::called(path),
            match arguments.graph {
                Some(_) => "graph",
                None => alone.map_or_else(|| loaded.model.kind().noun(), Shelf::noun),
            },
            loaded.name,
            readable::bytes(bytes),
        ));
    }
    Ok(())
}

/// Draws the figure of a rule in memory, with the arguments of `kfrac show`.
#[cfg(feature = "studio")]
pub(crate) fn hold(
    arguments: &[String],
    source: &Arc<Source>,
    catalogue: &Catalogue,
    held: &Held,
) -> Result<(), Failure> {
    let arguments: Arguments = held::parsed("show", arguments)?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let loaded = arguments.rule.load_from(source, catalogue, true)?;
    let options = arguments.options(&loaded, None, format);
    let mut out = Memory::new(Vec::new(), held.most);
    rule::write(&loaded.model, &loaded.document, None, &options, &mut out)
        .map_err(|error| output::explain(error, Path::new("-")))?;
    held.done().bytes = out.bytes;
    Ok(())
}

impl Arguments {
    /// Draws the instancing graph.
    fn write_graph(
        &self,
        loaded: &Loaded,
        topology: Topology,
        options: &rule::RuleFigureOptions,
        path: &Path,
        out: &mut impl Write,
    ) -> Result<[u32; 2], Failure> {
        let own = loaded.model.metadata().steps;
        let steps = match topology {
            Topology::Cyclic => self.steps.or(own).unwrap_or(STEPS),
            _ => self.steps.unwrap_or(STEPS),
        };
        let written = if loaded.model.is_in_space() {
            let graph = loaded.drawn_in_space(Some(steps), ColorBy::None)?.graph;
            rule::write_graph_in_space(&graph, topology, steps, options, out)
        } else {
            let graph = loaded.compile_for(steps, ColorBy::None)?;
            rule::write_graph(&graph, topology, steps, options, out)
        };
        written.map_err(|error| output::explain(error, path))
    }

    fn options(
        &self,
        loaded: &Loaded,
        alone: Option<Shelf>,
        format: render::Format,
    ) -> rule::RuleFigureOptions {
        let shown = match alone {
            _ if self.graph.is_some() => "The instancing graph".into(),
            Some(shelf) => format!("The {}", shelf.noun()),
            None => match loaded.model.kind() {
                Kind::Rule => "The production rule".into(),
                kind => format!("The {}", kind.noun()),
            },
        };
        let mut options = Vec::new();
        if format != render::Format::Svg {
            options.push(("format", format.name().into()));
        }
        options.extend(self.size.map(|size| ("size", size.to_string())));
        let background = self.background.map(|ink| ink.to_string());
        options.extend(background.map(|colour| ("background", colour)));
        let from = self
            .from
            .map(|from| from.map(|it| it.to_string()).join(","));
        options.extend(from.map(|from| ("from", from)));
        options.extend(self.graph.map(|graph| ("graph", graph.name().into())));
        options.extend(self.steps.map(|steps| ("steps", steps.to_string())));
        let view = &loaded.model.metadata().space;
        let camera = Camera::default().up(view.up);
        rule::RuleFigureOptions {
            format,
            size: self.size,
            background: self.background.and_then(picture::Ink::colour),
            camera: camera.from(self.from.unwrap_or(view.direction())),
            labels: labels(loaded, &shown, "show", options),
        }
    }
}
