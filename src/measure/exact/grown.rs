//! Exact dimensions of the limit of a graph.

use crate::extent::{Bounded, NoLimit};
use crate::geometry::{Outline, Point};
use crate::graph::Graph;
use crate::measure::similarity_dimension;
use crate::saturating::real;

use super::closed_form::{plain, settled};
use super::random::expected_dimension;
use super::{
    Dimensions, Effort, Equation, GraphDirectedSystem, Hausdorff, Similar, dimensions_within,
};

/// Exact dimensions of the limit of a graph, as far as they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct GraphDimensions {
    /// Dimensions of the limit set of the fertile elements; `None` where there is no limit, or it is not made
    /// of copies of itself.
    pub dimensions: Option<Dimensions>,
    /// Hausdorff dimension of the visible limit, including infertile elements that are visible; `None` where
    /// it is not known.
    pub drawn: Option<f64>,
    /// Remarks on the dimensions.
    pub notes: Vec<String>,
}

impl GraphDimensions {
    /// Returns dimensions of a limit set with a note, where nothing is known of what is drawn.
    fn of(dimensions: Option<Dimensions>, note: String) -> Self {
        Self {
            dimensions,
            drawn: None,
            notes: vec![note],
        }
    }
}

/// Computes the exact dimensions of a graph's limit, as far as they are known.
#[must_use]
pub fn dimensions_of_graph<F: Bounded>(graph: &Graph<F>) -> GraphDimensions {
    dimensions_of_graph_within(graph, Effort::Full)
}

/// Computes the dimensions of a graph's limit, as [`dimensions_of_graph`] does, within an effort.
#[must_use]
pub fn dimensions_of_graph_within<F: Bounded>(graph: &Graph<F>, effort: Effort) -> GraphDimensions {
    if graph.draws() {
        return at_random(graph);
    }
    // Rounded, an isometry may seem to contract.
    let system = GraphDirectedSystem::of(graph).filter(|_| graph.no_limit.is_none());
    let dimensions = system.and_then(|system| dimensions_within(&system, effort));
    let Some(dimensions) = dimensions else {
        let reason = similarity_dimension(graph).note;
        let reason = reason.unwrap_or_else(|| NoLimit::DoesNotShrink.to_string());
        return GraphDimensions::of(None, reason);
    };
    let mut notes = Vec::new();
    let own = dimensions.hausdorff.value;
    let infertile = infertile(graph);
    if own == Some(0.0) {
        let points = "the limit set of the fertile elements is made of single points";
        notes.push(match infertile {
            Some(dimension) if dimension > 1.0 => points.into(),
            _ => format!("{points}, and the line that is drawn has finite length"),
        });
    }
    let drawn = match infertile {
        None => own,
        Some(infertile) => {
            notes.push(format!(
                "what stays infertile and is drawn has the dimension {infertile}: all that is drawn \
                 has the larger of the two"
            ));
            let bound = dimensions.hausdorff.upper_bound;
            let small = bound.is_some_and(|bound| bound <= infertile);
            own.map(|own| own.max(infertile))
                .or(small.then_some(infertile))
        }
    };
    GraphDimensions {
        dimensions: Some(dimensions),
        drawn,
        notes,
    }
}

fn at_random<F: Bounded>(graph: &Graph<F>) -> GraphDimensions {
    match expected_dimension(graph) {
        Err(reason) => GraphDimensions::of(None, format!("the ratios are drawn: {reason}")),
        Ok(value) => {
            let value = settled(value);
            let method = "for almost all draws, if copies do not overlap (Falconer 1986)";
            let dimensions = Dimensions {
                similarity: Some(Similar {
                    value,
                    equation: Equation::Expected,
                    closed_form: plain(value),
                }),
                affinity: None,
                hausdorff: Hausdorff::unknown(value.min(real(F::Point::DIMENSION)), method.into()),
                boundary: None,
                contact: None,
                box_dimension: None,
                regular: false,
            };
            GraphDimensions::of(Some(dimensions), "the expected sum of ratio^D is 1".into())
        }
    }
}

/// Returns the largest dimension of the visible infertile elements, if there are any.
fn infertile<F: Bounded>(graph: &Graph<F>) -> Option<f64> {
    let objects = graph.objects().iter();
    let drawn = objects.filter(|object| object.visible && object.is_kept());
    drawn
        .map(|object| graph.base_elements()[object.base_element].dimension())
        .reduce(f64::max)
}
