//! Options and messages of all commands that grow a rule.

use std::num::NonZero;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use anyhow::anyhow;

use super::readable::{counted, duration, grouped, rough_bytes};
use crate::estimate::{Estimator, SizeEstimate};
use crate::extent::{ApproximantBounds, bounding_box};
use crate::geometry::Bounds;
use crate::geometry::Frame;
use crate::graph::{Chain, Graph, Replacement, TooLarge};
use crate::grow::{Growth, Progress, WalkError};
use crate::model::Model;
use crate::parallel::all_cores;
use crate::render::{self, PngEncoding, RenderError, Size, Spares};
use crate::rule::Placement;

use super::held::{Held, Survey};
use super::output::{Counted, Output};
use super::rule::Loaded;
use super::{Failure, number, output, text};
use crate::fractal::Goal;

/// Default limit of the number of elements, where a detail in pixels bounds them: at most as many are drawn
/// as there are pixels.
const MAX_GROWN_TO_DETAIL: u64 = 10 * Model::MAX_ELEMENTS;

/// Default limit where all elements are held in memory: a gigabyte, at about 200 bytes each.
const MAX_PLOTTED: u64 = Model::MAX_ELEMENTS / 10;

/// Options of growth and its limits.
#[derive(clap::Args, Clone)]
pub(super) struct GrowthArguments {
    /// Seed of random draws: each seed gives another individual
    ///
    /// `kfrac sheet` and `kfrac grow` draw one individual for each of several seeds, as 1..12 or 3,5,9.
    #[arg(long, value_name = "S", default_value = "0", value_parser = parse_seeds, allow_hyphen_values = true)]
    pub(super) seed: Seeds,
    /// Limit of the number of elements [default: 50 million; 500 million to the detail of a PNG, 5 million
    /// for a plot]
    ///
    /// If the number is known in advance, a step that exceeds the limit is refused before the work starts.
    #[arg(long, value_name = "N")]
    #[arg(value_parser = number::whole("a number of elements", 0..=u64::MAX), allow_negative_numbers = true)]
    max_elements: Option<u64>,
    /// Number of threads [default: the number of cores]
    ///
    /// The output does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Suppresses all messages except errors
    #[arg(long, short)]
    pub(super) quiet: bool,
    /// Destination of a command that runs within the program.
    #[arg(skip)]
    pub(super) held: Option<Arc<Held>>,
}

/// Several seeds, at least one.
pub(super) type Seeds = number::Several<u64>;

/// Parses seeds: one, a range such as `1..24`, or a list.
pub(super) fn parse_seeds(text: &str) -> Result<Seeds, String> {
    number::several("a seed", 0..=u64::MAX)(text)
}

/// Parses a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZero<usize>, String> {
    let threads = number::whole("a number of threads", 1..=1024)(text)?;
    NonZero::new(threads).ok_or_else(|| "at least one thread is needed".into())
}

impl GrowthArguments {
    /// Returns the number of threads.
    pub(super) fn threads(&self) -> NonZero<usize> {
        self.threads.unwrap_or_else(all_cores)
    }

    /// Writes a file completely or not at all, and returns its size in bytes. Standard output is held in memory if the
    /// command runs within the program.
    pub(super) fn write<T>(
        &self,
        path: &Path,
        content: impl FnOnce(&mut Counted<Output>, Option<&Progress>) -> Result<T, Failure>,
    ) -> Result<(T, u64), Failure> {
        match &self.held {
            Some(held) if path == Path::new("-") => {
                let spare = std::mem::take(&mut held.done().bytes);
                let (written, bytes) = output::write_held(spare, held.most, content)?;
                let count = bytes.len() as u64;
                held.done().bytes = bytes;
                Ok((written, count))
            }
            held => output::write(path, self.quiet || held.is_some(), content),
        }
    }

    /// Prints a message, unless messages are suppressed. A command within the program keeps it.
    pub(super) fn note(&self, line: &str) {
        match &self.held {
            Some(held) => held.done().notes.push(line.to_owned()),
            None if self.quiet => {}
            None => text::print_message(line),
        }
    }

    /// Returns the flag that cancels a command within the program.
    pub(super) fn cancel(&self) -> Option<&AtomicBool> {
        self.held.as_ref().map(|held| &*held.cancel)
    }

    /// Returns the encoding of PNGs.
    pub(super) fn png_encoding(&self) -> PngEncoding {
        self.held
            .as_ref()
            .map_or_else(PngEncoding::default, |held| held.png)
    }

    /// Returns the numbers for which a picture is grown, with the destination that records them, if it need not be drawn.
    pub(super) fn survey(&self) -> Option<(&Held, Survey)> {
        let held = self.held.as_deref()?;
        Some((held, held.survey?))
    }

    /// Returns the memory of finished pictures, for those that follow.
    pub(super) fn spares(&self) -> Spares {
        let held = self.held.as_ref();
        held.map_or_else(Spares::default, |held| held.spares.clone())
    }

    /// Returns an error if several seeds are given.
    pub(super) fn refuse_several_seeds(&self) -> Result<(), Failure> {
        match self.seed.as_slice() {
            [_] => Ok(()),
            _ => Err(Failure::Usage(format!(
                "--seed {}: several seeds are for `kfrac sheet`, which draws them side by side, for `kfrac grow`, which draws a file for each, \
                 and for `kfrac animate`",
                self.seed
            ))),
        }
    }

    pub(super) fn max_elements(&self) -> u64 {
        self.max_elements.unwrap_or(Model::MAX_ELEMENTS)
    }

    /// Returns the limit of the number of elements, if it is given.
    pub(super) fn given_max_elements(&self) -> Option<u64> {
        self.max_elements
    }

    /// Returns the limit of the number of elements of a picture.
    fn max_elements_of(&self, picture: &render::Options) -> u64 {
        let default = match picture {
            options if options.plot || options.format.is_plot() => MAX_PLOTTED,
            // Their number is bounded by that of pixels.
            render::Options {
                format: render::Format::Png,
                detail: Some(_),
                ..
            } => MAX_GROWN_TO_DETAIL,
            _ => Model::MAX_ELEMENTS,
        };
        self.max_elements.unwrap_or(default)
    }

    /// Returns an error if a step has too many elements, where the number is known in advance.
    pub(super) fn check<F: Frame>(
        &self,
        steps: u32,
        graph: &Graph<F>,
        loaded: &Loaded,
    ) -> Result<(), Failure> {
        self.check_or(steps, graph, loaded, "")
    }

    /// Returns an error, which ends with another way, if a step has too many elements, where the number is known in
    /// advance.
    pub(super) fn check_or<F: Frame>(
        &self,
        steps: u32,
        graph: &Graph<F>,
        loaded: &Loaded,
        otherwise: &str,
    ) -> Result<(), Failure> {
        let most = self.max_elements();
        let checked = graph.check_size(steps, most);
        checked.map_err(|error| {
            anyhow!(too_large(&error, most, &loaded.name, steps, "") + otherwise)
        })?;
        Ok(())
    }

    /// Returns an error if a picture of a step has too many elements, where the number is known in advance.
    pub(super) fn check_picture(
        &self,
        steps: u32,
        graph: &Graph,
        loaded: &Loaded,
        picture: &render::Options,
    ) -> Result<(), Failure> {
        let most = self.max_elements_of(picture);
        let checked = graph.check_size(steps, most);
        checked.map_err(|error| {
            let svg = Some(picture).filter(|options| options.format == render::Format::Svg);
            let estimate = svg.and_then(|options| estimate(graph, steps, options));
            let size = estimate.map_or_else(String::new, |estimate| {
                let bytes = rough_bytes(estimate.svg_bytes);
                let time = duration(estimate.seconds);
                format!(", about {bytes} of SVG and {time} of drawing")
            });
            let detail = match shrinks(graph) {
                true => "; --detail 0.5 draws it to half a pixel",
                false => "",
            };
            anyhow!(too_large(&error, most, &loaded.name, steps, &size) + detail)
        })?;
        Ok(())
    }

    /// Returns the parameters of growth by a number of steps.
    pub(super) fn to<'a>(&'a self, steps: u32, progress: Option<&'a Progress>) -> Growth<'a> {
        Growth {
            steps,
            seed: self.seed.first(),
            max_elements: self.max_elements(),
            cancel: self.cancel(),
            progress,
        }
    }

    /// Returns the parameters of growth for a picture.
    pub(super) fn drawn_as<'a>(
        &'a self,
        picture: &render::Options,
        steps: u32,
        progress: Option<&'a Progress>,
    ) -> Growth<'a> {
        Growth {
            max_elements: self.max_elements_of(picture),
            ..self.to(steps, progress)
        }
    }

    /// Returns the options on which random draws depend, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        vec![("seed", self.seed.to_string())]
    }

    /// Returns the failure for which `path` has not been written.
    pub(super) fn explain(&self, error: RenderError, loaded: &Loaded, path: &Path) -> Failure {
        match error {
            RenderError::Walk(WalkError::NotFinite(error)) => {
                loaded.model.diagnostic(&error).into()
            }
            RenderError::Walk(WalkError::TooManyElements { limit }) => {
                let limit = counted(&limit.into(), "element");
                let otherwise = match loaded.model {
                    Model::Ifs(_) => {
                        ", and --method chaos --points 10M draws it by random iteration"
                    }
                    _ => "",
                };
                anyhow!(
                    "{} has more than {limit}; --max-elements allows more{otherwise}",
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
            RenderError::NoDetail(_) => anyhow::Error::new(error)
                .context(format!(
                    "{} cannot be grown to a detail, only by a number of --steps",
                    loaded.name
                ))
                .into(),
            other => output::explain(other, path),
        }
    }
}

/// Returns the message for a step that has too many elements, followed by its size.
fn too_large(error: &TooLarge, most: u64, name: &str, steps: u32, size: &str) -> String {
    let limit = grouped(&most.into());
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| counted(elements, "element"),
    );
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
        None => format!("no step is within --max-elements {limit}"),
    };
    format!("step {steps} of {name} has {count}{size}; {deepest}")
}

/// Estimates the SVG of a step without growing it.
fn estimate(graph: &Graph, steps: u32, options: &render::Options) -> Option<SizeEstimate> {
    let mut forecast = graph.forecast()?;
    if !(0..steps).all(|_| forecast.advance()) {
        return None;
    }
    let bounds = Boxes::of(graph).roughly_at(steps)?;
    Estimator::new(graph, options).at(&forecast, &bounds)
}

/// Estimates the cost of a PNG, if possible. For a detail, it is that of the first step whose mean element is as
/// small.
pub(super) fn png_estimate(
    graph: &Graph,
    goal: Goal,
    options: &render::Options,
) -> Option<SizeEstimate> {
    const MAX_STEPS: u32 = 1_000;
    let steps = match goal {
        Goal::Steps(steps, _) => steps.min(MAX_STEPS),
        Goal::Detail(_) => MAX_STEPS.min(graph.depth().unwrap_or(MAX_STEPS)),
    };
    let bounds = Boxes::of(graph).roughly_at(steps)?;
    let window = options.view.window.map(|window| window[2].max(window[3]));
    let across = window.unwrap_or(bounds.size().max_element());
    let side = match options.size {
        Size::Long(side) => side,
        Size::Exactly(width, height) => width.max(height),
    };
    let shortest = options
        .detail
        .map_or(0.0, |detail| detail.pixels * across / f64::from(side));
    let mut forecast = graph.forecast()?;
    while forecast.step() < steps {
        let level = forecast.level();
        if level.length? <= shortest * level.elements.to_f64() {
            break;
        }
        if !forecast.advance() {
            return None;
        }
    }
    Estimator::new(graph, options).at(&forecast, &bounds)
}

/// Number of elements of the smaller approximant whose box stands for that of a large one.
const FEW: u64 = 20_000;

/// Boxes of approximants: from the graph, or else by a walk that is not too long.
pub(super) struct Boxes<'g> {
    graph: &'g Graph,
    known: Option<ApproximantBounds<'g>>,
}

impl<'g> Boxes<'g> {
    /// Prepares the boxes that the graph determines.
    pub(super) fn of(graph: &'g Graph) -> Self {
        Self {
            graph,
            known: graph.boxes(),
        }
    }

    /// Returns the bounding box of an approximant if the graph determines it.
    pub(super) fn known(&self, steps: u32) -> Option<Bounds> {
        self.known.as_ref()?.at(steps)
    }

    /// Returns the bounding box of an approximant if the graph determines it, and with little work.
    pub(super) fn known_soon(&self, steps: u32) -> Option<Bounds> {
        /// Number of states that are looked at for all boxes, after which no more are found.
        const MAX_LOOKED: usize = 1 << 18;
        let known = self.known.as_ref()?;
        (known.looked() < MAX_LOOKED).then(|| known.at(steps))?
    }

    /// Returns the bounding box of an approximant.
    pub(super) fn at(&self, steps: u32) -> Option<Bounds> {
        self.known(steps).or_else(|| self.walked(steps))
    }

    /// Returns an approximate bounding box of an approximant: that of a smaller one, where the graph does not
    /// determine it.
    pub(super) fn roughly_at(&self, steps: u32) -> Option<Bounds> {
        self.known(steps)
            .or_else(|| match self.graph.check_fits(steps, FEW) {
                Ok(()) => self.walked(steps),
                Err(deepest) => self.at(deepest?),
            })
    }

    /// Returns the box of [`roughly_at`](Self::roughly_at) where [`at`](Self::at) has found none, without the same walk
    /// again.
    pub(super) fn of_fewer(&self, steps: u32) -> Option<Bounds> {
        self.at(self.graph.check_fits(steps, FEW).err()??)
    }

    /// Returns the bounding box of an approximant by a walk, if it draws nothing at random and has few elements.
    fn walked(&self, steps: u32) -> Option<Bounds> {
        const MAX_ELEMENTS: u64 = 1_000_000;
        /// Numbers of choices, and of pieces of an outline, that take as long as the rest of an element.
        const CHOICES: u64 = 8;
        const PIECES: u64 = 32;
        let graph = self.graph;
        let pieces = { graph.base_elements().iter() }.map(|outline| outline.pieces().len() as u64);
        let choosing = (graph.choices() / CHOICES).max(1);
        let max_elements = MAX_ELEMENTS / choosing / (pieces.max().unwrap_or(0) / PIECES).max(1);
        let growth = Growth {
            max_elements,
            ..Growth::steps(steps)
        };
        // An element may come after as many replacements as there are steps.
        let small = u64::from(steps).saturating_mul(choosing - 1) <= MAX_ELEMENTS
            && !graph.draws()
            && graph.check_fits(steps, max_elements).is_ok();
        let bounds = small.then(|| bounding_box(graph, &growth).ok()).flatten();
        bounds.filter(Bounds::is_finite)
    }
}

/// Returns whether all replacements shrink, so that elements fall below any size.
fn shrinks(graph: &Graph) -> bool {
    if graph.is_time_indexed() {
        return true;
    }
    let smaller = |chain: &Chain| {
        chain.instances.iter().all(|instance| {
            let next = &graph.objects()[instance.object].replacement;
            instance.length < 1.0 || matches!(next, Replacement::Kept)
        })
    };
    graph
        .objects()
        .iter()
        .all(|object| match &object.replacement {
            Replacement::Kept | Replacement::Unresolved => true,
            Replacement::Fixed(production) => {
                let mut seeds = production.seeds.iter();
                smaller(&production.body)
                    && seeds.all(|seed| {
                        seed.placement != Placement::SeedsAsInitiator && smaller(&seed.chain)
                    })
            }
            Replacement::Evaluated(_) => false,
        })
}
