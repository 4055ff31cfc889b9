//! First tiles of pictures, with and without short cuts.

use super::super::buffer::{Buffer, SIDE};
use super::super::descent::Descent;
use super::super::forms::Forms;
use super::super::place;
use super::super::roots::Roots;
use super::super::scene::{self, ClassBy, End};
use super::super::slice::Search;
use super::super::solid::{self, Depths, View};
use super::super::turned::Turned;
use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::render::Size;
use crate::style::{Camera, Colour};

/// First tile of a picture.
pub(in crate::render::space) struct FirstTile {
    pub(in crate::render::space) buffer: Buffer,
    pub(in crate::render::space) view: View<'static>,
    /// Number of solids that were drawn, those in copies included.
    pub(in crate::render::space) drawn: u64,
    /// Graph as it is seen, in the coordinates of the picture.
    pub(super) seen: Graph<Frame3>,
}

/// Whether a tile is drawn with copies and with instances that stand for others.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::render::space) enum Short {
    Cut,
    Exact,
}

impl FirstTile {
    /// Draws a set from a camera, with a longer side of so many pixels, to a detail in samples.
    pub(in crate::render::space) fn draw(
        graph: &Graph<Frame3>,
        steps: Option<u32>,
        (camera, side, detail): (&Camera, u32, f64),
        short: Short,
    ) -> Self {
        let parts = scene::parts(graph, steps);
        let search = Search {
            parts: &parts,
            start: &scene::start(graph),
            steps,
        };
        let placement = place::place(graph, &search, camera, &[], Size::Long(side), 0.0).unwrap();
        let view = View {
            projection: placement.projection,
            depths: Depths::new(placement.range),
            cuts: &[],
            corner: [0.0; 2],
        };
        let seen = scene::seen(graph, &placement.map);
        let start = scene::start(&seen);
        let pad = solid::pad(graph);
        let end = End {
            steps: steps.unwrap_or(1000),
            detail,
            unit: graph.unit(),
        };
        let class_by = ClassBy::Nothing;
        let mut forms = Forms::find(&parts, &start, &end, class_by, &placement, pad, true);
        let mut turned = Turned::of(&parts, &start, &forms, &end, class_by, &placement);
        if short == Short::Exact {
            turned = None;
            for form in &mut forms.known {
                form.stamps = None;
                form.gathered = Box::default();
            }
        }
        let roots = Roots {
            parts: &parts,
            forms: &forms,
            end,
            class_by,
            lit: None,
            inks: &[Colour::BLACK],
            pad,
            overlap: false,
            turned: turned.as_ref(),
        };
        let mut buffer = Buffer::new();
        let start = roots.start(&view);
        let mut descent = Descent::default();
        descent.run(&roots, &view, &mut buffer, &start);
        Self {
            buffer,
            view,
            drawn: descent.drawn,
            seen,
        }
    }

    /// Returns the number of samples that show something, and the share of them that have none of a depth within `near`
    /// samples as near in another picture.
    pub(in crate::render::space) fn away_from(&self, other: &Self, near: usize) -> (usize, f64) {
        let (mut ink, mut away) = (0, 0);
        let around = |at: usize| at.saturating_sub(near)..(at + near + 1).min(SIDE);
        for y in 0..SIDE {
            for x in 0..SIDE {
                let Some(depth) = solid::depth_of(self.buffer.row(y)[x]) else {
                    continue;
                };
                ink += 1;
                let is_near = around(y).any(|y| {
                    { other.buffer.row(y)[around(x)].iter() }
                        .filter_map(|key| solid::depth_of(*key))
                        .map(|own| f64::from(own.abs_diff(depth)))
                        .any(|away| away < self.view.depths.steps() * near as f64)
                });
                away += usize::from(!is_near);
            }
        }
        (ink, away as f64 / ink as f64)
    }
}
