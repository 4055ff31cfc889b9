//! Fractals as sets: approximants of other fractals, which are grown during resolution.

use crate::document::{FractalDocument, Setting};
use crate::geometry::{DAffine2, Frame2};
use crate::grow::{Growth, OutlineError, WalkError, outlines};
use crate::ifs::Shape;

use super::{Resolver, resolve};

/// Maximum number of lines, curves and sides in all sets of a file that are fractals.
const MAX_PIECES: usize = 100_000;

impl<K> Resolver<K> {
    /// Grows a fractal and returns the outlines that it draws. Reports a mistake and returns `None`.
    pub(super) fn fractal(&mut self, document: &FractalDocument) -> Option<Shape> {
        let steps = document.steps.as_ref().map(|steps| self.steps(steps));
        let seed = self.seed(document.seed.as_ref());
        let map = document
            .map
            .as_ref()
            .map(|map| self.affine::<DAffine2, 2>(map)?.as_constant());
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
        let place = &document.place;
        let Some(steps) = steps.unwrap_or(model.metadata().steps) else {
            if document.steps.is_none() {
                let message = "this fractal has no number of steps";
                self.error_with_hint(place, message, "add `steps: 4` beside `fractal`");
            }
            return None;
        };
        let graph = match model.compile(steps) {
            Ok(graph) => graph,
            Err(error) => {
                self.mistakes += 1;
                self.diagnostics.push(model.diagnostic(&error).at(place));
                return None;
            }
        };
        let growth = Growth {
            seed: seed?.into(),
            ..Growth::steps(steps)
        };
        let frame = map.map_or(Some(Frame2::UNIT), |map| map.map(Frame2::from))?;
        let fills = model.metadata().style.fill.is_some();
        let most = MAX_PIECES.saturating_sub(self.pieces);
        let message = match outlines(&graph, &growth, frame, fills, most) {
            Ok(drawn) if drawn.is_empty() => {
                "this fractal draws nothing after so many steps".into()
            }
            Ok(drawn) => {
                self.pieces += drawn.iter().map(|one| one.pieces().len()).sum::<usize>();
                return Some(Shape::Union(drawn.into()));
            }
            Err(WalkError::Visitor(OutlineError::TooMany) | WalkError::TooManyElements { .. }) => {
                format!("sets that are fractals draw more than {MAX_PIECES} lines in all")
            }
            Err(error) => error.to_string(),
        };
        let s = if steps == 1 { "" } else { "s" };
        self.error_with_hint(
            place,
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
