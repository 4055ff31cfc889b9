//! What commands that grow a rule have in common.

use std::num::NonZero;
use std::path::Path;

use anyhow::anyhow;

use crate::estimate::{Estimate, Estimator};
use crate::geometry::Bounds;
use crate::graph::{Chain, Graph, Replacement, TooLarge};
use crate::grow::{Growth, Progress, WalkError, extent};
use crate::model::Model;
use crate::parallel::all_cores;
use crate::render::{self, RenderError, Size};
use crate::rule::Placement;
use crate::wording::{counted, duration, grouped, rough_bytes};

use super::goal::Goal;
use super::rule::Loaded;
use super::{Failure, number, output};

/// The most elements that are grown unless said otherwise, where a detail in pixels bounds them and all
/// of them come to no more than pixels.
const MOST_GROWN_TO_DETAIL: u64 = 10 * Model::MOST_ELEMENTS;

/// The most where all of them are in memory: with some 200 bytes each, a gigabyte.
const MOST_PLOTTED: u64 = Model::MOST_ELEMENTS / 10;

/// How a rule is grown, and how far at most.
#[derive(clap::Args)]
pub(super) struct GrowthArguments {
    /// What random draws depend on: another seed makes another individual
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true)]
    pub(super) seed: u64,
    /// The most elements that are grown [default: 50 million; 500 million to a PNG's detail, 5 million
    /// of a plot]
    ///
    /// Where the number is known before, a step that has more is refused before the work starts.
    #[arg(long, value_name = "N")]
    #[arg(value_parser = number::whole("a number of elements", 0..=u64::MAX), allow_negative_numbers = true)]
    max_elements: Option<u64>,
    /// How many threads work [default: as many as there are cores]
    ///
    /// What they make does not depend on how many they are.
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Says nothing but what is wrong
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// Reads a number of threads.
pub(super) fn threads(text: &str) -> Result<NonZero<usize>, String> {
    let threads = number::whole("a number of threads", 1..=1024)(text)?;
    NonZero::new(threads).ok_or_else(|| "one thread at least works".into())
}

impl GrowthArguments {
    /// The number of threads.
    pub(super) fn threads(&self) -> NonZero<usize> {
        self.threads.unwrap_or_else(all_cores)
    }

    /// Whether the most elements are said on the command line.
    pub(super) fn says_most_elements(&self) -> bool {
        self.max_elements.is_some()
    }

    pub(super) fn most_elements(&self) -> u64 {
        self.max_elements.unwrap_or(Model::MOST_ELEMENTS)
    }

    /// The most elements of a picture.
    fn most_elements_of(&self, picture: &render::Options) -> u64 {
        let default = match picture {
            render::Options { plot: true, .. }
            | render::Options {
                format: render::Format::Dxf,
                ..
            } => MOST_PLOTTED,
            // Of which there are no more than pixels.
            render::Options {
                format: render::Format::Png,
                detail: Some(_),
                ..
            } => MOST_GROWN_TO_DETAIL,
            _ => Model::MOST_ELEMENTS,
        };
        self.max_elements.unwrap_or(default)
    }

    /// Refuses a step that has too many elements, as far as that can be told before.
    ///
    /// `picture` tells how it would be drawn, if it would.
    pub(super) fn check(
        &self,
        steps: u32,
        graph: &Graph,
        loaded: &Loaded,
        picture: Option<&render::Options>,
    ) -> Result<(), Failure> {
        let most = match picture {
            Some(picture) => self.most_elements_of(picture),
            None => self.most_elements(),
        };
        let checked = graph.check_size(steps, most);
        checked.map_err(|error| {
            anyhow!(too_large(&error, most, &loaded.name, steps, graph, picture))
        })?;
        Ok(())
    }

    /// Growth by a number of steps.
    pub(super) fn to<'a>(&self, steps: u32, progress: Option<&'a Progress>) -> Growth<'a> {
        Growth {
            steps,
            seed: self.seed,
            most_elements: self.most_elements(),
            cancel: None,
            progress,
        }
    }

    /// The same for a picture.
    pub(super) fn drawn_as<'a>(
        &self,
        picture: &render::Options,
        steps: u32,
        progress: Option<&'a Progress>,
    ) -> Growth<'a> {
        Growth {
            most_elements: self.most_elements_of(picture),
            ..self.to(steps, progress)
        }
    }

    /// The options that the draws depend on.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        vec![("seed", self.seed.to_string())]
    }

    /// Why `path` has not been written.
    pub(super) fn explain(&self, error: RenderError, loaded: &Loaded, path: &Path) -> Failure {
        match error {
            RenderError::Io(error) => output::failed(error, path),
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
            other => anyhow::Error::new(other).into(),
        }
    }
}

/// What is said of a step that has more elements than may be.
fn too_large(
    error: &TooLarge,
    most: u64,
    name: &str,
    steps: u32,
    graph: &Graph,
    picture: Option<&render::Options>,
) -> String {
    let limit = grouped(&most.into());
    let count = error.elements.as_ref().map_or_else(
        || "more elements than can be counted".into(),
        |elements| counted(elements, "element"),
    );
    let svg = picture.filter(|options| options.format == render::Format::Svg);
    let estimate = svg.and_then(|options| estimate(graph, steps, options));
    let size = estimate.map_or_else(String::new, |estimate| {
        let bytes = rough_bytes(estimate.svg_bytes);
        let time = duration(estimate.seconds);
        format!(", about {bytes} of SVG and {time} of drawing")
    });
    let deepest = match error.deepest {
        Some(step) => format!("{step} is the deepest step within --max-elements {limit}"),
        None => format!("no step is within --max-elements {limit}"),
    };
    let detail = if picture.is_some() && shrinks(graph) {
        "; --detail 0.5 draws it to half a pixel"
    } else {
        ""
    };
    format!("step {steps} of {name} has {count}{size}; {deepest}{detail}")
}

/// What a step takes that is not grown.
fn estimate(graph: &Graph, steps: u32, options: &render::Options) -> Option<Estimate> {
    let mut forecast = graph.forecast()?;
    if !(0..steps).all(|_| forecast.advance()) {
        return None;
    }
    let bounds = rough_bounds(graph, steps)?;
    Estimator::new(graph, options).at(&forecast, &bounds)
}

/// The bytes of a PNG, where that can be told: of what is to be drawn to a detail, those of the first
/// step whose elements are as small in the mean.
pub(super) fn png_bytes(graph: &Graph, goal: Goal, options: &render::Options) -> Option<f64> {
    const MOST_STEPS: u32 = 1_000;
    let steps = match goal {
        Goal::Steps(steps, _) => steps.min(MOST_STEPS),
        Goal::Detail(_) => MOST_STEPS.min(graph.depth().unwrap_or(MOST_STEPS)),
    };
    let bounds = rough_bounds(graph, steps)?;
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
    let estimate = Estimator::new(graph, options).at(&forecast, &bounds);
    estimate.map(|estimate| estimate.png_bytes)
}

/// The box of an approximant: from the graph, or else by a walk that is not too long.
pub(super) fn bounds(graph: &Graph, steps: u32) -> Option<Bounds> {
    const MOST_ELEMENTS: u64 = 1_000_000;
    let growth = Growth {
        most_elements: MOST_ELEMENTS,
        ..Growth::steps(steps)
    };
    let walked = || {
        let small = !graph.draws() && graph.check_size(steps, MOST_ELEMENTS).is_ok();
        let bounds = small.then(|| extent(graph, &growth).ok()).flatten();
        bounds.filter(Bounds::is_finite)
    };
    graph.bounds(steps).or_else(walked)
}

/// About the box of an approximant: where the graph does not tell it, that of a smaller one.
pub(super) fn rough_bounds(graph: &Graph, steps: u32) -> Option<Bounds> {
    let walked = || match graph.check_size(steps, 20_000) {
        Ok(_) => bounds(graph, steps),
        Err(error) => bounds(graph, error.deepest?),
    };
    graph.bounds(steps).or_else(walked)
}

/// Whether all that is replaced becomes smaller, so that elements fall below any size.
fn shrinks(graph: &Graph) -> bool {
    if graph.is_levelled() {
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
            Replacement::Kept | Replacement::Beyond => true,
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
