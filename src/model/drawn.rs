//! Graphs of models in space as they are drawn.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

use crate::geometry::{Frame as _, Frame3};
use crate::graph::{Chain, CompileError, Graph, Instance, Object, Replacement};
use crate::grow::{Element, Elements, FractalInfo, Growth, WalkError};
use crate::rule::Rule;
use crate::style::{ColorBy, Palette, Style};

use super::Model;

/// Largest number of elements of an approximant that is held in memory.
pub const MAX_HELD: u64 = 1_000_000;

/// Largest number of classes into which values are quantised.
const MAX_CLASSES: u128 = 64;

/// Number of steps whose ages are distinguished in the limit.
const STEPS_OF_LIMIT: u32 = 16;

/// Graph of a model in space as it is drawn: with fixed instances, and one object for each surface.
#[derive(Clone, Debug)]
pub struct DrawnInSpace {
    /// Graph to be drawn.
    pub graph: Graph<Frame3>,
    /// Number of steps of the graph to be drawn; `None` for the limit set.
    pub steps: Option<u32>,
    /// Property that the origins of objects stand for, in place of generators.
    records: Option<ColorBy>,
}

impl DrawnInSpace {
    /// Adapts a style to the graph: colours by a property that the origins of objects stand for are those by generator, with the
    /// colours that a range gives them.
    pub fn colour(&self, style: &mut Style) {
        if self.records != Some(style.color_by) {
            return;
        }
        if style.range().is_some() {
            // The origins are steps or ages from 0.
            let count = u32::try_from(self.graph.origins()).unwrap_or(u32::MAX);
            let last = f64::from(count.saturating_sub(1));
            let colours = (0..count).map(|value| style.colour_of_value(value.into(), last));
            style.palette = Palette::of_colours("", &colours.collect::<Vec<_>>());
        }
        style.color_by = ColorBy::Generator;
    }
}

/// Returns the property that the graph of a picture of pixels has to record: not the map that is applied last, which the
/// descent finds.
#[must_use]
pub fn for_pixels(color_by: ColorBy) -> ColorBy {
    match color_by {
        ColorBy::LastMap => ColorBy::None,
        by => by,
    }
}

/// Error: a model in space cannot be compiled or grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawnError {
    /// The model cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The model cannot be grown.
    #[error(transparent)]
    Walk(#[from] WalkError<Infallible>),
}

impl Model {
    /// Returns the graph of a model in space as it is drawn after a number of steps, or in the limit, in colours by a
    /// property; `None` for a model of the plane. A structure with drawn instances, and a rule whose elements depend on draws or
    /// on more than place and age, or whose colours do, are grown: the approximant is held in memory, with at most [`MAX_HELD`] elements. An L-system without a limit
    /// set has its last step instead. Lines of its steps are tubes if its style asks for them.
    ///
    /// Objects of a system record the map that is applied last if colours depend on it, unless there are too many for it.
    ///
    /// # Errors
    ///
    /// If a generator yields points that are not finite within these steps, or there are too many elements.
    pub fn drawn_in_space(
        &self,
        steps: Option<u32>,
        growth: &Growth<'_>,
        color_by: ColorBy,
    ) -> Option<Result<DrawnInSpace, DrawnError>> {
        let records = None;
        let limit = match steps {
            Some(_) => Cow::Borrowed(self),
            None => self.of_zoom(),
        };
        match &*limit {
            Self::RuleInSpace(rule) => Some(drawn(rule, steps, growth, color_by)),
            Self::LSystemInSpace(system) if !limit.as_kind().starts_anew() => {
                let graph = Graph::of_lsystem_in_space(system, 0, 0, growth.max_elements);
                let drawn = graph.map(|graph| DrawnInSpace {
                    graph,
                    steps,
                    records,
                });
                Some(drawn.map_err(DrawnError::from))
            }
            Self::LSystemInSpace(system) => {
                let steps = steps.unwrap_or(growth.steps);
                let (seed, most) = (growth.seed, growth.max_elements);
                let graph = Graph::drawn_of_lsystem(system, steps, seed, most);
                let drawn = graph.map(|graph| DrawnInSpace {
                    graph,
                    steps: Some(steps),
                    records,
                });
                Some(drawn.map_err(DrawnError::from))
            }
            model => {
                let graph = model.compile_in_space(color_by == ColorBy::LastMap)?;
                if graph.draws() {
                    let value = value_of(color_by);
                    let held = held(&graph, growth, value).map(|graph| DrawnInSpace {
                        graph,
                        steps: Some(0),
                        records: value.is_some().then_some(color_by),
                    });
                    return Some(held.map_err(DrawnError::from));
                }
                Some(Ok(DrawnInSpace {
                    graph,
                    steps,
                    records,
                }))
            }
        }
    }
}

fn drawn(
    rule: &Arc<Rule<Frame3>>,
    steps: Option<u32>,
    growth: &Growth<'_>,
    color_by: ColorBy,
) -> Result<DrawnInSpace, DrawnError> {
    let graph = Graph::compile(rule, steps.unwrap_or(growth.steps))?;
    let is_fixed = graph.is_plain() && !graph.resets().contains(&true);
    let is_counted = matches!(color_by, ColorBy::Index | ColorBy::Fractal);
    let is_limit = steps.is_none() && graph.depth().is_none();
    // A graph that is resolved for any number of steps has a limit.
    let (graph, steps, records) = if is_fixed && !is_counted && (steps.is_some() || is_limit) {
        match color_by {
            ColorBy::Direction => (graph.by_direction(), steps, true),
            ColorBy::Age => {
                let distinguished = steps.unwrap_or(STEPS_OF_LIMIT);
                (graph.by_age(distinguished), steps, true)
            }
            _ => (graph, steps, false),
        }
    } else {
        let value = value_of(color_by);
        (held(&graph, growth, value)?, Some(0), value.is_some())
    };
    Ok(DrawnInSpace {
        graph: graph.with_surfaces(rule.base_elements()),
        steps,
        records: records.then_some(color_by),
    })
}

/// Property of an element on which its colour depends.
type Value = fn(&Element<Frame3>, &FractalInfo) -> u128;

/// Returns the property of elements that are held, if their objects do not record it.
fn value_of(color_by: ColorBy) -> Option<Value> {
    match color_by {
        ColorBy::Step => Some(|element, _| element.born.into()),
        ColorBy::Age => Some(|_, fractal| fractal.age.into()),
        ColorBy::Fractal => Some(|_, fractal| fractal.number.into()),
        ColorBy::Index => Some(|element, _| element.index - 1),
        ColorBy::Direction => Some(|element, _| u128::from(element.frame.direction().number()) - 1),
        _ => None,
    }
}

/// Returns a graph whose initiator consists of the elements of an approximant, none of which is replaced. The origins of
/// its objects stand for a value of their elements, if one is given.
fn held(
    graph: &Graph<Frame3>,
    growth: &Growth<'_>,
    value_of_element: Option<Value>,
) -> Result<Graph<Frame3>, WalkError<Infallible>> {
    let growth = Growth {
        max_elements: growth.max_elements.min(MAX_HELD),
        ..*growth
    };
    let mut elements = Vec::new();
    let mut largest = 0;
    for element in Elements::of(graph, &growth) {
        let (fractal, element) = element?;
        let value = value_of_element.map_or(0, |value| value(&element, &fractal));
        largest = largest.max(value);
        if graph.objects()[element.object].visible {
            elements.push((element.object, element.appearance, element.frame, value));
        }
    }
    let classes = (largest + 1).min(MAX_CLASSES);
    let class = |value: u128| {
        let class = match largest < MAX_CLASSES {
            true => value,
            false => value * MAX_CLASSES / (largest + 1),
        };
        usize::try_from(class).unwrap_or_default()
    };
    let classes = usize::try_from(classes).unwrap_or(1);
    let mut objects: Vec<Object<Frame3>> = Vec::new();
    let mut numbers = BTreeMap::new();
    let instances = elements.iter().map(|&(object, appearance, frame, value)| {
        let class = class(value);
        let key = (object, class, appearance.bits());
        let number = *numbers.entry(key).or_insert(objects.len());
        if number == objects.len() {
            let own = &graph.objects()[object];
            objects.push(Object {
                replacement: Replacement::Kept,
                behaviour: 0,
                origin: value_of_element.map_or(own.origin, |_| Some(class)),
                tint: None,
                thickness: None,
                composed: Some(appearance),
                ..own.clone()
            });
        }
        Instance::new(number, frame, 0)
    });
    let instances = instances.collect();
    Ok(Graph {
        origins: value_of_element.map_or(graph.origins(), |_| classes),
        tints: graph.tints(),
        affine: graph.is_affine(),
        middle: graph.middle,
        ..Graph::of(
            objects,
            graph.base_elements().to_vec(),
            vec![Chain::loose(instances)],
        )
    })
}
