//! Words between two steps: elements that the last successors draw grow out of the modules that they replace.

use std::mem::discriminant;

use crate::geometry::{Affine as _, Point as _};

use super::{Drawn, Placed, RewriteError, TubeLine, Turtle, TurtleFrame};

/// Turtles that read a word and the next one side by side.
///
/// A point that the turtle passes in the successor of a module begins at its foot on the turtle's way along that module,
/// and moves in a straight line. The foot divides this way as the foot of the point on the way along the whole successor
/// divides that one. Polygons and stamps grow out of their first points. Where a module and its successor draw the same
/// number of elements, these pass into each other.
pub(crate) struct GrowingTurtle<'s, F: TurtleFrame> {
    share: f64,
    before: Turtle<'s, F>,
    pub(crate) after: Turtle<'s, F>,
}

impl<'s, F: TurtleFrame> GrowingTurtle<'s, F> {
    pub(crate) fn new(system: &'s F::System, share: f64) -> Self {
        Self {
            share,
            before: Turtle::new(system),
            after: Turtle::new(system),
        }
    }

    /// Reads the word of a step and the one before it; `give` gets the elements between the two.
    ///
    /// # Errors
    ///
    /// As for [`LSystem::word`](super::LSystem::word).
    pub(crate) fn read(
        &mut self,
        system: &F::System,
        (steps, seed, max_elements): (u32, u64, u64),
        mut give: impl FnMut(&Placed<F>),
    ) -> Result<(), RewriteError> {
        let words = F::words(system);
        let replaced = words.replaced(steps, seed, max_elements)?;
        let mut successors = replaced.after.modules(words);
        let mut from = 0;
        for ((symbol, arguments), &to) in replaced.before.modules(words).zip(&replaced.ends) {
            let start = [self.before.place(), self.after.place()];
            self.before.read(symbol, arguments);
            for (symbol, arguments) in successors.by_ref().take(to - from) {
                self.after.read(symbol, arguments);
            }
            from = to;
            let way = Way {
                before: [start[0], self.before.place()],
                after: [start[1], self.after.place()],
            };
            self.give(&way, &mut give);
        }
        Ok(())
    }

    /// Gives the elements that the successor of a module has drawn.
    fn give(&mut self, way: &Way<F>, give: &mut impl FnMut(&Placed<F>)) {
        let mut old = std::mem::take(&mut self.before.drawing.elements);
        let mut new = std::mem::take(&mut self.after.drawing.elements);
        let mut pairs = old.iter().zip(&new);
        let pass = old.len() == new.len()
            && pairs.all(|(old, new)| discriminant(&old.of) == discriminant(&new.of));
        for (number, placed) in new.iter_mut().enumerate() {
            let passing = old.get(number).filter(|_| pass);
            self.grow(placed, passing, old.first(), way);
            give(placed);
        }
        // Their memory is used again.
        old.clear();
        new.clear();
        self.before.drawing.elements = old;
        self.after.drawing.elements = new;
    }

    /// Moves an element back on its way: from the one that passes into it, if there is one. `first` is the first element
    /// that the module draws.
    fn grow(
        &mut self,
        placed: &mut Placed<F>,
        passing: Option<&Placed<F>>,
        first: Option<&Placed<F>>,
        way: &Way<F>,
    ) {
        let ends = placed.frame.ends();
        let start = match (passing, placed.of) {
            (Some(old), _) => {
                if self.reshape(old, placed) {
                    return;
                }
                old.frame.ends()
            }
            (None, Drawn::Line(_)) => ends.map(|end| way.foot(end)),
            (None, Drawn::Polygon(_) | Drawn::Stamp(_)) => [way.foot(ends[0]); 2],
        };
        let [from, to] = [0, 1].map(|end| self.place([start[end], ends[end]]));
        placed.frame = placed.frame.spanning([from, to]);
        if let Drawn::Line(line) = placed.of {
            let length = (to - from).length();
            placed.of = Drawn::Line(TubeLine { length, ..line });
            if let Some(old) = first.filter(|it| matches!(it.of, Drawn::Line(_))) {
                placed.width = old.width + self.share * (placed.width - old.width);
            }
        }
    }

    fn place(&self, [before, after]: [F::Point; 2]) -> F::Point {
        before * (1.0 - self.share) + after * self.share
    }

    /// Replaces the outline of a polygon by that between two of the same number of corners; returns `false` for other
    /// elements, and for polygons of one shape.
    fn reshape(&mut self, old: &Placed<F>, new: &mut Placed<F>) -> bool {
        let (Drawn::Polygon(before), Drawn::Polygon(after)) = (old.of, new.of) else {
            return false;
        };
        let corners = [
            F::corners(&self.before.drawing.polygons[before]),
            F::corners(&self.after.drawing.polygons[after]),
        ];
        if corners[0] == corners[1] || corners[0].len() != corners[1].len() {
            return false;
        }
        let inverse = new.frame.map().inverse();
        let between = corners[0].iter().zip(&corners[1]).map(|(before, after)| {
            inverse.apply(self.place([old.frame.apply(*before), new.frame.apply(*after)]))
        });
        let Some(outline) = F::polygon(&between.collect::<Vec<_>>()) else {
            return false;
        };
        new.of = Drawn::Polygon(self.after.drawing.polygons.len());
        self.after.drawing.polygons.push(outline);
        true
    }
}

/// Places of the turtles before and behind a module, and before and behind its successor.
struct Way<F: TurtleFrame> {
    before: [F::Point; 2],
    after: [F::Point; 2],
}

impl<F: TurtleFrame> Way<F> {
    /// Returns the foot of a point of the successor on the way along the module.
    fn foot(&self, point: F::Point) -> F::Point {
        let [from, to] = self.after;
        let along = to - from;
        let length = along.dot(along);
        let share = match length > 0.0 {
            true => ((point - from).dot(along) / length).clamp(0.0, 1.0),
            false => 0.0,
        };
        self.before[0] * (1.0 - share) + self.before[1] * share
    }
}
