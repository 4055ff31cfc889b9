//! Visible lines of a plot: the parts of strokes that no area hides, and hatching.

use std::io;

use crate::geometry::DVec2;
use crate::render::error::RenderError;
use crate::render::paint::{FINE, position};

use super::areas::{Area, Areas};
use super::hatch::{Hatch, HatchPattern, parallels};
use super::occlusion::Occlusion;
use super::points::{Point, Points, vector};
use super::strokes::Strokes;

/// Length below which a remaining part of a stroke is left out, in positions.
const SPECK: f64 = 8.0;

/// Limit of the number of lines of a hatching, which are held in memory.
const MAX_HATCH_LINES: usize = 20_000_000;

/// Lines of a plot, processed from the top down.
pub(super) struct Visible<'a> {
    points: &'a mut Points,
    occlusion: Occlusion,
    /// Strokes of each layer, in reverse order.
    strokes: Vec<Strokes>,
    /// Number of edges that are hidden, in whole or in part.
    hidden: u64,
    /// Visible part of a stroke so far.
    part: Vec<Point>,
    /// Number of lines of the hatching.
    hatch_lines: usize,
}

impl<'a> Visible<'a> {
    /// Removes from the strokes of each layer the parts that areas hide, and hatches areas. Returns the number of edges that
    /// are hidden, in whole or in part. `size` is the longer side of the picture, in positions.
    pub(super) fn find(
        layers: &mut [Strokes],
        areas: &Areas,
        hatch: Option<&Hatch>,
        points: &'a mut Points,
        size: f64,
        go_on: impl Fn() -> Result<(), RenderError>,
    ) -> Result<u64, RenderError> {
        let mut this = Self {
            points,
            occlusion: Occlusion::new(size),
            strokes: vec![Strokes::default(); layers.len()],
            hidden: 0,
            part: Vec::new(),
            hatch_lines: 0,
        };
        let mut left: Vec<_> = layers.iter().map(Strokes::len).collect();
        for turn in areas.turns().iter().rev() {
            go_on()?;
            for _ in 0..turn.strokes {
                left[turn.layer] -= 1;
                this.draw(turn.layer, layers[turn.layer].get(left[turn.layer]))?;
            }
            let Some(area) = turn.area.map(|number| areas.get(number)) else {
                continue;
            };
            if let (Some(hatch), Some(layer)) = (hatch, area.paint.hatched) {
                this.hatch(layer, &area, hatch)?;
            }
            if area.paint.hides {
                this.occlusion.add(area);
            }
        }
        for (layer, reversed) in layers.iter_mut().zip(&this.strokes) {
            *layer = Strokes::default();
            reversed.iter().rev().for_each(|stroke| layer.push(stroke));
        }
        Ok(this.hidden)
    }

    /// Draws the visible parts of a stroke.
    fn draw(&mut self, layer: usize, stroke: &[Point]) -> Result<(), RenderError> {
        let mut is_cut = false;
        for edge in stroke.windows(2) {
            let line = [edge[0], edge[1]].map(|point| vector(self.points.place(point)));
            let hidden = self.occlusion.hidden(line).to_vec();
            self.hidden += u64::from(!hidden.is_empty());
            if self.part.is_empty() {
                self.part.push(edge[0]);
            }
            let place = |at: f64| line[0] + (line[1] - line[0]) * at;
            for [from, to] in hidden {
                if from > 0.0 {
                    let point = self.point(place(from))?;
                    self.part.push(point);
                }
                self.finish(layer, true);
                is_cut = true;
                if to < 1.0 {
                    let point = self.point(place(to))?;
                    self.part.push(point);
                }
            }
            if !self.part.is_empty() {
                self.part.push(edge[1]);
            }
        }
        self.finish(layer, is_cut);
        Ok(())
    }

    /// Ends the visible part of a stroke; a short rest of one that is cut is left out.
    fn finish(&mut self, layer: usize, is_cut: bool) {
        self.part.dedup();
        let places = self
            .part
            .iter()
            .map(|&point| vector(self.points.place(point)));
        let places: Vec<_> = places.collect();
        let length: f64 = places
            .windows(2)
            .map(|edge| edge[0].distance(edge[1]))
            .sum();
        if length > if is_cut { SPECK } else { 0.0 } {
            self.strokes[layer].push(&self.part);
        }
        self.part.clear();
    }

    /// Draws the hatching of an area.
    fn hatch(&mut self, layer: usize, area: &Area<'_>, hatch: &Hatch) -> Result<(), RenderError> {
        let spacing = hatch.spacing.max(Hatch::LEAST_SPACING) * FINE;
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        match &hatch.pattern {
            HatchPattern::Lines(directions) => {
                for &direction in directions {
                    parallels(area, direction, spacing, |line| lines.push(line.to_vec()));
                }
            }
            #[cfg(feature = "contours")]
            HatchPattern::Contour => {
                super::contours::contours(area, spacing, |line| lines.push(line.to_vec()));
            }
        }
        self.hatch_lines += lines.len();
        if self.hatch_lines > MAX_HATCH_LINES {
            let message = format!(
                "the hatching has more than {MAX_HATCH_LINES} lines; a larger spacing has fewer"
            );
            return Err(io::Error::other(message).into());
        }
        // The order of strokes is reversed.
        for line in lines.into_iter().rev() {
            let stroke = line.into_iter().map(|place| self.point(place));
            let mut stroke = stroke.collect::<Result<Vec<_>, _>>()?;
            stroke.dedup();
            if stroke.len() > 1 {
                self.draw(layer, &stroke)?;
            }
        }
        Ok(())
    }

    fn point(&mut self, place: DVec2) -> Result<Point, RenderError> {
        let point = self.points.at(position(place));
        Ok(point.ok_or_else(super::plotter::too_many_points)?)
    }
}
