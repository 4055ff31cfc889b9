//! Sketches of whole runs of elements.

use crate::geometry::DVec2;
use crate::grow::{Colony, Element, LineElement, Run};
use crate::render::contribution::Painted;
use crate::render::display::Command;
use crate::render::paint::{FINE, Position, position};
use crate::render::paint_key::{PaintKey, PathKind, width_class};
use crate::render::png::{PlacedSprite, Put};

use super::{LineMark, Mark, Sketcher};

impl Sketcher<'_> {
    /// Draws lines of one class that end in the given points, one after another.
    pub(super) fn lines(&mut self, run: &Run<'_>, ends: &[DVec2], first: &Element) {
        self.see(first);
        let map = self.scene.canvas.map(run.map());
        let rest = ends[1..].iter();
        let rest = rest.map(|&end| position(map.transform_point2(end) * FINE));
        self.sketch.lines(rest);
    }

    /// Draws lines of one class that need not join.
    pub(super) fn sticks(&mut self, run: &Run<'_>, sticks: &[LineElement], first: &Element) {
        if self.scene.graph.joins() {
            self.see(first);
            let rest = sticks[1..].iter().map(|stick| (stick, stick.joined));
            self.draw_sticks(run, rest);
        } else {
            self.segments(run, sticks.iter());
        }
    }

    /// Draws lines, each with whether it joins the one before.
    fn draw_sticks<'b>(
        &mut self,
        run: &Run<'_>,
        sticks: impl Iterator<Item = (&'b LineElement, bool)>,
    ) {
        let placed = self.placing(run);
        for (stick, joined) in sticks {
            let (key, [from, to]) = placed(stick);
            let goes_on = match self.open.map(|open| &self.sketch.commands[open]) {
                Some(Command::Other(Mark::Line(line))) => joined && line.key == key,
                _ => false,
            };
            if !goes_on {
                self.mark(Mark::Line(LineMark {
                    key,
                    joined,
                    meets_frame: [true; 2],
                }));
                self.open = Some(self.sketch.commands.len() - 1);
                self.sketch.points.push(from);
            }
            self.go_to(to);
        }
    }

    /// Draws lines of which none joins another.
    fn segments<'b>(&mut self, run: &Run<'_>, sticks: impl Iterator<Item = &'b LineElement>) {
        let placed = self.placing(run);
        self.open = None;
        for stick in sticks {
            let (key, ends) = placed(stick);
            self.sketch.segments(key, &ends);
        }
    }

    /// Returns a function that places the lines of a run: their paint keys and their ends.
    fn placing(&self, run: &Run<'_>) -> impl Fn(&LineElement) -> (PaintKey, [Position; 2]) + use<> {
        let map = self.scene.canvas.map(run.map());
        let whole = self.octave(run.map().matrix2.x_axis.length());
        let kind = self.kind();
        move |stick| {
            let key = PaintKey {
                kind,
                width: whole.map_or(0, |whole| width_class(whole + stick.octave)),
                colour: None,
            };
            let fine = |point| position(map.transform_point2(point) * FINE);
            (key, stick.ends.map(fine))
        }
    }

    /// Draws some elements of a run, given with their indices, if no lines lead to others.
    pub(super) fn some(&mut self, run: &Run<'_>, elements: impl Iterator<Item = (usize, Element)>) {
        let mut next = 0;
        for (number, element) in elements {
            if number != next {
                self.pass_by(Mark::Break);
            }
            next = number + 1;
            self.see(&element);
        }
        if next as u64 != run.count() {
            self.pass_by(Mark::Break);
        }
    }

    /// Draws lines of one class, short and thin ones in segment batches. Returns `false`, and draws nothing, if
    /// lines may join and there are none of these.
    pub(super) fn batches(&mut self, run: &Run<'_>, sticks: &[LineElement]) -> bool {
        let (Some(builder), Some(last)) = (&self.means.batches, sticks.last()) else {
            return false;
        };
        let map = self.scene.canvas.map(run.map());
        let scale = map.matrix2.x_axis.length();
        let (batched, longer) = builder.batched(run.number(), sticks, scale);
        let apart = batched.apart.iter().map(|number| *number as usize);
        if !self.scene.graph.joins() {
            self.segments(run, apart.map(|number| &sticks[number]));
            self.sketch.batches(batched.placed(map, longer));
            return true;
        }
        if batched.is_empty() {
            return false;
        }
        let mut next = sticks.len();
        let apart = apart.map(|number| {
            let follows = std::mem::replace(&mut next, number + 1) == number;
            (&sticks[number], follows && sticks[number].joined)
        });
        self.draw_sticks(run, apart);
        self.sketch.batches(batched.placed(map, longer));
        self.pass_by(Mark::Skip { meets_frame: true });
        let end = position(map.transform_point2(last.ends[1]) * FINE);
        self.sketch.points.push(end);
        true
    }

    /// Draws the part of a colony that is painted, by a sprite or element by element.
    pub(super) fn colony_of(&mut self, colony: &Colony<'_>) {
        let Some(sprites) = self.means.sprites.clone() else {
            return;
        };
        match sprites.of_colony(self.scene, colony) {
            Put::Nothing => {}
            Put::Sprite(placed) => self.put(sprites.kind(), placed),
            Put::Elements => {
                sprites.see(self.scene, colony, |element| self.see(element));
                self.pass_by(Mark::Break);
            }
        }
    }

    /// Draws the part of a run that is painted by a sprite; returns whether there is a sprite.
    pub(super) fn sprite(&mut self, run: &Run<'_>, painted: Painted) -> bool {
        let sprites = self.means.sprites.as_ref();
        let Some(placed) = sprites.and_then(|sprites| sprites.of(self.scene, run, painted)) else {
            return false;
        };
        let graph = self.scene.graph;
        let is_open = |element: &Element| {
            let object = &graph.objects()[element.object];
            object.visible && !self.scene.base_element(object).is_closed()
        };
        // Elements that join the run continue at its end; nothing joins runs of closed elements.
        if let Some(end) = run.last().filter(is_open) {
            self.put(PathKind::Line, placed);
            self.pass_by(Mark::Skip { meets_frame: true });
            self.start_at(end.frame.ends()[1]);
        } else {
            self.put(PathKind::Polygon, placed);
        }
        true
    }

    fn put(&mut self, kind: PathKind, sprite: PlacedSprite) {
        self.open = None;
        self.sketch.sprites(PaintKey::of(kind), &[sprite]);
    }
}
