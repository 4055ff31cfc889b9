//! Fractals as sets: approximants of other fractals, which are grown during resolution.

use crate::document::{FractalDocument, Setting};
use crate::geometry::{BaseElement, DAffine2, DAffine3, Frame2, Solid, triangulated};
use crate::graph::Graph;
use crate::grow::{Elements, Growth, OutlineError, WalkError, outlines};
use crate::ifs::Shape;
use crate::model::{DrawnError, DrawnInSpace, Model};
use crate::style::ColorBy;

use super::{Resolver, resolve};

/// Maximum number of lines, curves, sides and solids in all sets of a file that are fractals.
const MAX_PIECES: usize = 100_000;

/// Number of chords of a curve in space.
const CHORDS: u32 = 16;

/// Error: a fractal cannot be a set.
enum Failure {
    TooMany,
    /// There are too many elements, some of which are not drawn.
    TooManyHidden,
    Other(String),
}

impl From<WalkError<OutlineError>> for Failure {
    fn from(error: WalkError<OutlineError>) -> Self {
        match error {
            WalkError::Visitor(OutlineError::TooMany) | WalkError::TooManyElements { .. } => {
                Self::TooMany
            }
            error => Self::Other(error.to_string()),
        }
    }
}

impl From<DrawnError> for Failure {
    fn from(error: DrawnError) -> Self {
        match error {
            DrawnError::Walk(WalkError::TooManyElements { .. }) => Self::TooMany,
            error => Self::Other(error.to_string()),
        }
    }
}

impl<K> Resolver<K> {
    /// Grows a fractal and returns the outlines that it draws. Reports a mistake and returns `None`.
    pub(super) fn fractal(&mut self, document: &FractalDocument) -> Option<Shape> {
        let map = document
            .map
            .as_ref()
            .map(|map| self.affine::<DAffine2, 2>(map)?.as_constant());
        let (model, growth) = self.grown(document)?;
        let graph = self.graph(document, &model, growth.steps)?;
        let frame = map.map_or(Some(Frame2::UNIT), |map| map.map(Frame2::from))?;
        let drawn = outlines_of(&model, &graph, &growth, frame);
        let drawn = self.checked(document, growth.steps, drawn)?;
        self.pieces += drawn.iter().map(|one| one.pieces().len()).sum::<usize>();
        Some(Shape::Union(drawn.into()))
    }

    /// Grows a fractal, of the plane or of space, and returns the solids that it draws in space. Reports a mistake and
    /// returns `None`.
    pub(super) fn fractal_in_space(&mut self, document: &FractalDocument) -> Option<Vec<Solid>> {
        let map = document
            .map
            .as_ref()
            .map(|map| self.affine::<DAffine3, 3>(map)?.as_constant());
        let (model, growth) = self.grown(document)?;
        let map = map.map_or(Some(DAffine3::IDENTITY), |map| map)?;
        let solids = match model.drawn_in_space(Some(growth.steps), &growth, ColorBy::None) {
            Some(drawn) => solids_of(drawn, &growth, &map),
            None => {
                let graph = self.graph(document, &model, growth.steps)?;
                let drawn = outlines_of(&model, &graph, &growth, Frame2::UNIT);
                let left = MAX_PIECES.saturating_sub(self.pieces);
                drawn.and_then(|drawn| {
                    let mut solids = Vec::new();
                    for one in &drawn {
                        solids.extend(flat(one, &map));
                        if solids.len() > left {
                            return Err(Failure::TooMany);
                        }
                    }
                    Ok(solids)
                })
            }
        };
        let solids = self.checked(document, growth.steps, solids)?;
        self.pieces += solids.len();
        Some(solids)
    }

    /// Resolves a fractal, and returns how it grows. Reports mistakes and returns `None`.
    pub(super) fn grown(&mut self, document: &FractalDocument) -> Option<(Model, Growth<'static>)> {
        let steps = document.steps.as_ref().map(|steps| self.steps(steps));
        let seed = self.seed(document.seed.as_ref());
        let settings = self.settings(document)?;
        let model = match resolve(&document.file, &settings) {
            Ok((model, _)) => model,
            Err(mistakes) => {
                self.mistakes += 1;
                self.diagnostics.extend(mistakes);
                return None;
            }
        };
        if !document.is_sound {
            // Parts that could not be read, and were reported, are missing in the model.
            return None;
        }
        let Some(steps) = steps.unwrap_or(model.metadata().steps) else {
            if document.steps.is_none() {
                let message = "this fractal has no number of steps";
                let place = &document.place;
                self.error_with_hint(place, message, "add `steps: 4` beside `fractal`");
            }
            return None;
        };
        let growth = Growth {
            seed: seed?.into(),
            max_elements: MAX_PIECES.saturating_sub(self.pieces) as u64,
            ..Growth::steps(steps)
        };
        Some((model, growth))
    }

    pub(super) fn graph(
        &mut self,
        document: &FractalDocument,
        model: &Model,
        steps: u32,
    ) -> Option<Graph> {
        match model.compile(steps) {
            Ok(graph) => Some(graph),
            Err(error) => {
                self.mistakes += 1;
                let place = &document.place;
                self.diagnostics.push(model.diagnostic(&error).at(place));
                None
            }
        }
    }

    /// Returns the pieces of a fractal. Reports a failure, or that there are none, and returns `None`.
    fn checked<T>(
        &mut self,
        document: &FractalDocument,
        steps: u32,
        pieces: Result<Vec<T>, Failure>,
    ) -> Option<Vec<T>> {
        let message = match pieces {
            Ok(pieces) if pieces.is_empty() => {
                "this fractal draws nothing after so many steps".into()
            }
            Ok(pieces) => return Some(pieces),
            Err(Failure::TooMany) => {
                format!("sets that are fractals draw more than {MAX_PIECES} lines in all")
            }
            Err(Failure::TooManyHidden) => format!(
                "sets that are fractals have more than {MAX_PIECES} elements in all, with those that are not visible"
            ),
            Err(Failure::Other(message)) => message,
        };
        let s = if steps == 1 { "" } else { "s" };
        self.error_with_hint(
            &document.place,
            message,
            format!("this one is grown by {steps} step{s}"),
        );
        None
    }

    /// Returns the parameters that are set. Reports mistakes and returns `None`.
    fn settings(&mut self, document: &FractalDocument) -> Option<Vec<Setting>> {
        let metadata = document.file.metadata();
        let names = metadata
            .params
            .iter()
            .map(|param| param.name.value.as_str());
        let settings = document.set.iter().map(|(name, number)| {
            let value = self.constant(number);
            if !names.clone().any(|known| known == name.value) {
                let hint = metadata.instead_of(&name.value);
                let message = format!("this fractal has no parameter '{}'", name.value);
                self.error_with_hint(&name.place, message, hint);
                return None;
            }
            Some(Setting {
                name: name.value.clone(),
                value: value?,
                written: None,
                place: Some(number.place.clone()),
            })
        });
        let settings: Vec<_> = settings.collect();
        settings.into_iter().collect()
    }
}

/// Returns the outlines of an approximant in the plane.
fn outlines_of(
    model: &Model,
    graph: &Graph,
    growth: &Growth<'_>,
    frame: Frame2,
) -> Result<Vec<BaseElement>, Failure> {
    let mut visible = graph.objects().iter().map(|object| object.visible);
    if !visible.clone().any(|is_visible| is_visible) {
        return Ok(Vec::new());
    }
    let fills = model.metadata().style.fill.is_some();
    let most = usize::try_from(growth.max_elements).unwrap_or(usize::MAX);
    outlines(graph, growth, frame, fills, most).map_err(|error| match error {
        WalkError::TooManyElements { .. } if visible.any(|is_visible| !is_visible) => {
            Failure::TooManyHidden
        }
        error => error.into(),
    })
}

/// Returns the images of the elements of an approximant in space.
fn solids_of(
    drawn: Result<DrawnInSpace, DrawnError>,
    growth: &Growth<'_>,
    map: &DAffine3,
) -> Result<Vec<Solid>, Failure> {
    let drawn = drawn?;
    let graph = &drawn.graph;
    let growth = Growth {
        steps: drawn.steps.unwrap_or(growth.steps),
        ..*growth
    };
    let elements = Elements::of(graph, &growth).filter_map(|element| match element {
        Ok((_, element)) if !element.visible => None,
        Ok((_, element)) => {
            let solid = &graph.base_elements()[graph.objects()[element.object].base_element];
            Some(Ok(solid.image(&(*map * *element.frame.map()))))
        }
        Err(error) => Some(Err(DrawnError::from(error).into())),
    });
    elements.collect()
}

/// Returns the image of an outline of the plane z = 0: convex pieces of a closed one, or else segments.
fn flat(outline: &BaseElement, map: &DAffine3) -> Vec<Solid> {
    let corners = outline.corners(&DAffine2::IDENTITY, CHORDS);
    let corners: Vec<_> = { corners.iter() }
        .map(|corner| map.transform_point3(corner.extend(0.0)))
        .collect();
    if outline.is_closed() {
        let last = corners.len() - usize::from(corners.first() == corners.last());
        return triangulated(&corners[..last]);
    }
    let segments = corners.windows(2).filter(|ends| ends[0] != ends[1]);
    segments.map(Solid::hull).collect()
}
