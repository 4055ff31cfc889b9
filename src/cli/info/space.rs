//! Description of a fractal in space.

use crate::count::Count;
use crate::geometry::Frame3;
use crate::graph::{Graph, Level};
use crate::measure::exact::{Effort, dimensions_of_graph_within};
use crate::measure::similarity_dimension;
use crate::model::Model;

use super::super::rule::Loaded;
use super::super::structure::StructureInfo;
use super::super::system::SystemInfo;
use super::{Dimension, Info, corners, hausdorff, number};

/// Collects the description. The area is the sum of the surfaces of all elements, where maps are similarities.
pub(super) fn info<'a>(loaded: &'a Loaded, graph: &Graph<Frame3>, steps: u32) -> Info<'a> {
    let levels = levels(graph, steps);
    let counts = |count: fn(&Level) -> &Count| {
        let levels = levels.as_ref()?;
        Some(levels.iter().map(|level| count(level).clone()).collect())
    };
    let measures = |measure: fn(&Level) -> Option<f64>| {
        let all: Option<Vec<f64>> = levels.as_ref()?.iter().map(measure).collect();
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        Some(all?.into_iter().map(finite).collect())
    };
    let metadata = loaded.model.metadata();
    let similarity = similarity_dimension(graph);
    let exact = dimensions_of_graph_within(graph, Effort::Quick).dimensions;
    Info {
        name: &loaded.name,
        kind: loaded.model.kind().name(),
        space: 3,
        title: metadata.description.title.as_deref(),
        params: { metadata.parameters.iter() }
            .map(|parameter| (parameter.name.clone(), number(parameter.value)))
            .collect(),
        random: graph.draws(),
        regular: graph.is_regular(),
        steps,
        elements: counts(|level| &level.elements),
        fertile: counts(|level| &level.fertile),
        fractals: counts(|level| &level.fractals),
        length: measures(|level| level.length),
        area: graph
            .is_similar()
            .then(|| measures(|level| level.area))
            .flatten(),
        svg_bytes: None,
        seconds: None,
        instanced_svg_bytes: None,
        bounds: graph.bounds(steps).as_ref().map(corners),
        limit_bounds: graph.limit_bounds().as_ref().map(corners),
        dimension: Dimension {
            similarity: similarity.value,
            note: similarity.note,
            hausdorff: hausdorff(exact.as_ref()),
            exact: exact.map(|known| known.hausdorff),
        },
        system: match &loaded.model {
            Model::IfsInSpace(system) => Some(SystemInfo::in_space(system)),
            _ => None,
        },
        structure: StructureInfo::of(&loaded.model),
    }
}

/// Returns the forecast of all steps; `None` if it takes too long.
fn levels(graph: &Graph<Frame3>, steps: u32) -> Option<Vec<Level>> {
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
