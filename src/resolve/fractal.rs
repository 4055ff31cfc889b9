//! Fractals as sets: approximants of other fractals, which are grown during resolution.

use crate::document::{FractalDocument, Setting};
use crate::geometry::{BaseElement, DAffine2, DAffine3, Frame2, Solid, triangulated};
use crate::graph::Graph;
use crate::grow::{Elements, Growth, OutlineError, WalkError, outlines};
use crate::ifs::Shape;
use crate::model::{DrawnError, DrawnInSpace, Model};
use crate::style::ColorBy;
use crate::work;

use super::{Resolver, resolve};

/// Maximum number of lines, curves, sides and solids in all sets of a file that are fractals.
const MAX_PIECES: usize = 100_000;

/// [Work](work) of growing sets after which no other is grown.
const MAX_WORK: u64 = 1 << 25;

/// Message about a rule with many generators to choose from, or long conditions.
pub(super) const TOO_SLOW: &str = "choosing the generators of so many elements takes too long";

/// Hint beside [`TOO_SLOW`].
pub(super) const INSTEAD: &str = "fewer steps, cases, or operations in their conditions";

/// Maximum number of generators that are looked at to choose those of a set.
const MAX_CHOICES: u64 = 1 << 23;

/// Number of chords of a curve in space.
const CHORDS: u32 = 16;

/// Error: a fractal cannot be a set.
enum Failure {
    /// There are too many lines.
    TooMany,
    /// There are too many elements.
    TooManyElements,
    /// There are too many elements, some of which are not drawn.
    TooManyHidden,
    Other(String),
}

impl From<WalkError<OutlineError>> for Failure {
    fn from(error: WalkError<OutlineError>) -> Self {
        match error {
            WalkError::Visitor(OutlineError::TooMany) => Self::TooMany,
            WalkError::TooManyElements { .. } => Self::TooManyElements,
            error => Self::Other(error.to_string()),
        }
    }
}

impl From<DrawnError> for Failure {
    fn from(error: DrawnError) -> Self {
        match error {
            DrawnError::Walk(WalkError::TooManyElements { .. }) => Self::TooManyElements,
            error => Self::Other(error.to_string()),
        }
    }
}

impl<K> Resolver<K> {
    /// Grows a fractal and returns the outlines that it draws. Reports a mistake and returns `None`.
    pub(super) fn fractal(&mut self, document: &FractalDocument) -> Option<Shape> {
        self.within_budget(document, |resolver| resolver.fractal_in_plane(document))
    }

    /// Grows a fractal, of the plane or of space, and returns the solids that it draws in space. Reports a mistake and
    /// returns `None`.
    pub(super) fn fractal_in_space(&mut self, document: &FractalDocument) -> Option<Vec<Solid>> {
        self.within_budget(document, |resolver| resolver.solids_of_fractal(document))
    }

    /// Grows a fractal, unless those before it took too much work, which is reported once.
    pub(super) fn within_budget<T>(
        &mut self,
        document: &FractalDocument,
        grow: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        const REPORTED: u64 = u64::MAX;
        if self.work > MAX_WORK {
            if self.work < REPORTED {
                self.work = REPORTED;
                let message = "growing the sets of the file that are fractals takes too long";
                let mut hint = "let fewer sets be fractals, or grow simpler ones".to_owned();
                if let Some((_, costliest)) = &self.costliest {
                    hint = format!("{hint}; that of line {} takes longest", costliest.line());
                }
                self.error_with_hint(&document.place, message, hint);
            }
            return None;
        }
        let before = work::counted();
        let grown = grow(self);
        let work = work::since(before);
        self.work += work;
        if { self.costliest.as_ref() }.is_none_or(|(most, _)| work > *most) {
            self.costliest = Some((work, document.place.clone()));
        }
        grown
    }

    fn fractal_in_plane(&mut self, document: &FractalDocument) -> Option<Shape> {
        let map = document
            .map
            .as_ref()
            .map(|map| self.affine::<DAffine2, 2>(map)?.as_constant());
        let (model, growth) = self.grown(document)?;
        let graph = self.graph(document, &model, growth.steps)?;
        let frame = map.map_or(Some(Frame2::UNIT), |map| map.map(Frame2::from))?;
        let drawn = outlines_of(&model, &graph, (&growth, self.left()), frame);
        let drawn = self.checked(document, &growth, drawn)?;
        self.pieces += drawn.iter().map(|one| one.pieces().len()).sum::<usize>();
        Some(Shape::Union(drawn.into()))
    }

    fn solids_of_fractal(&mut self, document: &FractalDocument) -> Option<Vec<Solid>> {
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
                let left = self.left();
                let drawn = outlines_of(&model, &graph, (&growth, left), Frame2::UNIT);
                drawn.and_then(|drawn| {
                    let mut solids = Vec::new();
                    for one in &drawn {
                        solids.extend(flat(one, &map));
                        if solids.len() as u64 > left {
                            return Err(Failure::TooMany);
                        }
                    }
                    Ok(solids)
                })
            }
        };
        let solids = self.checked(document, &growth, solids)?;
        self.pieces += solids.len();
        Some(solids)
    }

    /// Returns the number of lines, curves, sides and solids that other sets may have.
    fn left(&self) -> u64 {
        MAX_PIECES.saturating_sub(self.pieces) as u64
    }

    /// Returns whether the number of elements is limited by the generators to choose from.
    pub(super) fn is_slow(&self, growth: &Growth<'_>) -> bool {
        growth.max_elements < self.left()
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
        let most = MAX_CHOICES / model.choices();
        // An element may come after as many replacements as there are steps.
        if u64::from(steps) > most {
            self.error_with_hint(&document.place, TOO_SLOW, INSTEAD);
            return None;
        }
        let growth = Growth {
            seed: seed?.into(),
            max_elements: most.min(self.left()),
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
        growth: &Growth<'_>,
        pieces: Result<Vec<T>, Failure>,
    ) -> Option<Vec<T>> {
        let message = match pieces {
            Ok(pieces) if pieces.is_empty() => {
                "this fractal draws nothing after so many steps".into()
            }
            Ok(pieces) => return Some(pieces),
            Err(Failure::TooManyElements | Failure::TooManyHidden) if self.is_slow(growth) => {
                self.error_with_hint(&document.place, TOO_SLOW, INSTEAD);
                return None;
            }
            Err(Failure::TooMany | Failure::TooManyElements) => {
                format!("sets that are fractals draw more than {MAX_PIECES} lines in all")
            }
            Err(Failure::TooManyHidden) => format!(
                "sets that are fractals have more than {MAX_PIECES} elements in all, with those that are not visible"
            ),
            Err(Failure::Other(message)) => message,
        };
        let steps = growth.steps;
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

/// Returns the outlines of an approximant in the plane, of at most `most` lines.
fn outlines_of(
    model: &Model,
    graph: &Graph,
    (growth, most): (&Growth<'_>, u64),
    frame: Frame2,
) -> Result<Vec<BaseElement>, Failure> {
    let mut visible = graph.objects().iter().map(|object| object.visible);
    if !visible.clone().any(|is_visible| is_visible) {
        return Ok(Vec::new());
    }
    let fills = model.metadata().style.fill.is_some();
    let most = usize::try_from(most).unwrap_or(usize::MAX);
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
