//! Description of a fractal: its sizes step by step, its extent, its dimension, its file.

use std::borrow::Cow;

use crate::diagnostic::Diagnostics;
use crate::estimate::{Estimator, SizeEstimate};
use crate::extent::Bounded;
use crate::geometry::{Bounds, Point};
use crate::graph::{Graph, Level};
use crate::measure::exact::{Effort, Hausdorff, dimensions_of_graph_within};
use crate::measure::{Similarity, similarity_dimension};
use crate::render::Format;

use super::results::forecast;
use super::{Error, Fractal};

/// Properties of a fractal that are known without growing it; see [`Fractal::info`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Info {
    /// Number of steps of the approximant.
    pub steps: u32,
    /// Whether numbers are drawn at random.
    pub is_random: bool,
    /// Whether every element of a kind is replaced by equal numbers of elements of each kind.
    pub is_regular: bool,
    /// Sizes of the approximants 0 to `steps`, lengths and areas in the file's units; `None` if they depend on draws or on
    /// the number of all elements before one.
    pub levels: Option<Vec<Level>>,
    /// Least and largest coordinates of the approximant, in the file's units; `None` if only growing it would show.
    pub bounds: Option<[Vec<f64>; 2]>,
    /// Least and largest coordinates of the limit set.
    pub limit_bounds: Option<[Vec<f64>; 2]>,
    /// Similarity dimension.
    pub similarity: Similarity,
    /// Dimension of the limit set, or its bound, as far as it is decided in a moment.
    pub dimension: Option<Hausdorff>,
}

impl Fractal {
    /// Returns the properties of the approximant, and of the limit set, that are known without growing it.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let info = kfrac::Fractal::named("koch")?.steps(3).info()?;
    /// let levels = info.levels.expect("koch is regular");
    /// assert_eq!(levels.len(), 4);
    /// assert!((levels[3].length.unwrap() - 64.0 / 27.0).abs() < 1e-12);
    /// assert!((info.limit_bounds.unwrap()[1][0] - 1.0).abs() < 1e-12);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled.
    pub fn info(&self) -> Result<Info, Error> {
        self.check_cancelled()?;
        if self.model.is_in_space() {
            let graph = self.graph_in_space("it has a description, too")?;
            let limit = match self.model.of_limit() {
                Cow::Borrowed(_) => None,
                Cow::Owned(model) => model.graph_in_space_for(0, self.seed, self.max_elements),
            };
            let limit = limit.transpose();
            let limit = limit.map_err(|error| self.model.diagnostic(&error))?;
            let steps = self.steps_in_space(graph);
            return Ok(info(graph, limit.as_ref().unwrap_or(graph), steps));
        }
        let (graph, steps) = (self.graph()?, self.steps_grown()?);
        let limit = match self.model.of_limit() {
            Cow::Borrowed(_) => None,
            Cow::Owned(model) => {
                let limit = model.compile_for(steps, self.seed, self.max_elements);
                Some(limit.map_err(|error| self.model.diagnostic(&error))?)
            }
        };
        Ok(info(graph, limit.as_ref().unwrap_or(graph), steps))
    }

    /// Returns estimates of the size of pictures and of the time to draw them; `None` in space, where a detail decides the
    /// number of steps, and if the sizes depend on draws or exceed doubles.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let koch = kfrac::Fractal::named("koch")?;
    /// let bytes = |steps| koch.clone().steps(steps).estimate().map(|it| it.unwrap().svg_bytes);
    /// assert!(bytes(4)? < 10_000.0 && bytes(12)? > 10_000_000.0);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled.
    pub fn estimate(&self) -> Result<Option<SizeEstimate>, Error> {
        if self.model.is_in_space() {
            return Ok(None);
        }
        let options = self.options(Format::Svg, self.size)?;
        if options.detail.is_some_and(|detail| detail.decides_steps) {
            return Ok(None);
        }
        let (graph, steps) = (self.graph()?, self.steps_grown()?);
        let known = forecast(graph, steps).zip(graph.bounds(steps));
        let estimator = Estimator::new(graph, &options);
        Ok(known.and_then(|(forecast, bounds)| estimator.at(&forecast, &bounds)))
    }

    /// Returns all that is to be said about the file: [warnings](Self::warnings), and mistakes that show only where
    /// elements are replaced.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// assert!(kfrac::Fractal::named("koch")?.check().is_empty());
    /// let unused = "params: {a: 1}\ninitiator: segment\ngenerator: [[0, 0], [1/2, 1/2], [1, 0]]";
    /// assert_eq!(kfrac::Fractal::parse(unused)?.check().len(), 1);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn check(&self) -> Diagnostics {
        let mut found = self.warnings.clone();
        if let Some(mistake) = self.model.mistake() {
            found.push(mistake);
        }
        found
    }

    /// Returns the file with its parents and components inlined, and with the values of its parameters that are set, as
    /// YAML that reads back as an equal fractal; `None` for a fractal without a file: a model that a program has built, or
    /// [between](Self::toward) two others.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::Fractal;
    ///
    /// let tree = Fractal::named("pythagoras")?.set("angle", 30.0)?;
    /// let again = Fractal::parse(&tree.yaml().expect("it has a file"))?;
    /// assert_eq!(again.steps(4).svg()?, tree.steps(4).svg()?);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn yaml(&self) -> Option<String> {
        let document = self.document.as_ref()?;
        Some(document.to_yaml_with(&self.settings))
    }
}

/// Describes a graph; `limit` is the graph that has the limit set.
fn info<F: Bounded>(graph: &Graph<F>, limit: &Graph<F>, steps: u32) -> Info {
    let corners = |bounds: Bounds<F::Point>| {
        let corner = |point: F::Point| point.coordinates()[..F::Point::DIMENSION].to_vec();
        [corner(bounds.min()), corner(bounds.max())]
    };
    let dimension = (!limit.draws())
        .then(|| dimensions_of_graph_within(limit, Effort::Quick).dimensions)
        .flatten();
    Info {
        steps,
        is_random: graph.draws(),
        is_regular: graph.is_regular(),
        levels: levels(graph, steps),
        bounds: graph.bounds(steps).map(corners),
        limit_bounds: limit.limit_bounds().map(corners),
        similarity: similarity_dimension(limit),
        dimension: dimension.map(|known| known.hausdorff),
    }
}

/// Returns the sizes of all approximants; `None` if they are not known in a reasonable time.
fn levels<F: Bounded>(graph: &Graph<F>, steps: u32) -> Option<Vec<Level>> {
    let mut forecast = graph.forecast()?;
    let mut levels = vec![forecast.level()];
    for _ in 0..steps {
        if !forecast.advance() {
            return None;
        }
        levels.push(forecast.level());
    }
    Some(levels)
}
