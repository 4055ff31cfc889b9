//! Drawing of stamps.

use crate::fast_hash::FastMap;
use crate::geometry::{DAffine3, DVec3, Solid};
use crate::instancing::Appearance;

use super::super::forms::Form;
use super::super::gathered::Gathered;
use super::super::lit::{Classes, LEAST, Lit};
use super::super::planes::Planes;
use super::super::roots::Roots;
use super::super::solid::{Body, View};
use super::{Ink, PIECE, Piece, STEEPEST, Stamp, bias, spread};

/// Depths that differ by less, in steps, are equal.
const EQUAL: f32 = 1.0 / 64.0;

/// Sine of the angle between a surface and the ray below which it is seen edge-on.
const EDGE_ON: f64 = 1e-3;

/// Limit of the number of inks of a stamp: a tile has classes for those of a few.
const MAX_INKS: usize = 3 << LEAST;

/// Limit of the number of inks while a stamp is drawn.
const MAX_DRAWN_INKS: usize = 8 * MAX_INKS;

const NOTHING: Piece = Piece {
    depth: [0.0; PIECE],
    slope: [[0.0; PIECE]; 2],
    class: [u32::MAX; PIECE],
};

/// Draws the elements of a form.
pub(super) struct Builder<'a> {
    roots: &'a Roots<'a>,
    view: &'a View<'a>,
    stamp: Stamp,
    inks: Inks,
    planes: Planes,
    /// Half sides of the form across the view, and of its elements beyond.
    reach: [f64; 2],
    /// The middle of the form.
    middle: [f64; 2],
    /// z of the depth 0.
    near: f64,
    /// Positions along a side of a sample.
    phases: usize,
    /// Samples by which solids are drawn larger than they are.
    spread: f64,
}

/// A point of a solid that a sample shows: z, its slopes, and the class or the number of the ink.
type Shown = (f64, [f64; 2], u32);

impl<'a> Builder<'a> {
    /// Draws the stamp of a form in a position relative to a sample; `None` if it would have too many inks.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    pub(super) fn build(
        roots: &'a Roots<'a>,
        view: &'a View<'a>,
        form: &Form,
        (phase, phases): ([usize; 2], usize),
    ) -> Option<Stamp> {
        let spread = spread(phases);
        let within = [form.half.x, form.half.y].map(|half| half + roots.pad + spread);
        let reach = within.map(|reach| (reach + 1.0).ceil() as usize);
        let sides = reach.map(|reach| 2 * reach + 1);
        let columns = sides[0].div_ceil(PIECE);
        let mut builder = Self {
            roots,
            view,
            stamp: Stamp {
                pieces: vec![NOTHING; columns * sides[1]],
                columns,
                corner: reach.map(|reach| -(reach as isize)),
                extent: [sides[0], sides[1], 0, 0],
                inks: Vec::new(),
                elements: 0,
                deepest: 0,
            },
            inks: Inks::default(),
            planes: Planes::default(),
            reach: within,
            middle: [0, 1].map(|axis| reach[axis] as f64 + phase[axis] as f64 / phases as f64),
            near: form.half.z,
            phases,
            spread,
        };
        builder.add(form, DVec3::ZERO, (0, Appearance::NONE));
        builder.stamp.inks = builder.inks.all;
        let is_complete = builder.stamp.inks.len() <= MAX_DRAWN_INKS;
        builder.stamp.crop();
        builder.stamp.keep_shown();
        (is_complete && builder.stamp.inks.len() <= MAX_INKS).then_some(builder.stamp)
    }

    /// Adds what is in an instance, `at` being the vector from the middle of the form of the stamp to its own, and
    /// `paint` its class and its appearance in the form.
    fn add(&mut self, form: &Form, at: DVec3, paint @ (class, appearance): (u16, Appearance)) {
        let roots = self.roots;
        if self.inks.all.len() > MAX_DRAWN_INKS {
            return;
        }
        if let Some(gathered) = form.gathered(&roots.end, 1.0) {
            for own in gathered {
                let class = own.class.unwrap_or(class);
                self.add_gathered(own, at, (class, appearance.over(own.appearance)));
            }
        } else if let Some(steps) = roots.forms.steps(form) {
            // From near to far.
            for step in steps.iter().rev() {
                let inner = &roots.forms.known[step.form];
                let appearance = appearance.over(roots.tint(inner));
                let paint = (step.class.unwrap_or(class), appearance);
                self.add(inner, at + step.offset, paint);
            }
        } else if let Some(solid) = self.solid(form) {
            let map = DAffine3::from_mat3_translation(form.linear, at - form.middle);
            let body = Body::new(solid, &map);
            self.add_solid(&body, (at, form.half), self.paint_of(form, paint));
        }
    }

    fn add_gathered(&mut self, own: &Gathered, at: DVec3, paint: (u16, Appearance)) {
        let form = &self.roots.forms.known[own.form];
        if let Some(solid) = self.solid(form) {
            let at = at + own.offset();
            let map = DAffine3::from_mat3_translation(form.linear, at - form.middle);
            let body = Body::new(solid, &map).grown(own.reach());
            let half = form.half + own.reach();
            self.add_solid(&body, (at, half), self.paint_of(form, paint));
        }
    }

    /// Returns the solid that is drawn for a form, which is counted.
    fn solid(&mut self, form: &Form) -> Option<&'a Solid> {
        let roots = self.roots;
        let solid = roots.parts[form.object].drawn(form.level, &roots.end)?;
        self.stamp.elements += 1;
        self.stamp.deepest = self.stamp.deepest.max(form.level);
        Some(solid)
    }

    fn paint_of(&self, form: &Form, (class, appearance): (u16, Appearance)) -> (u16, Appearance) {
        (self.roots.class(form, class), appearance)
    }

    /// Adds a solid, in a box about a point.
    fn add_solid(
        &mut self,
        body: &Body<'_>,
        within: (DVec3, DVec3),
        (class, appearance): (u16, Appearance),
    ) {
        let roots = self.roots;
        let (view, projection) = (self.view, self.view.projection);
        let spread = self.spread;
        // Classes of keys, of the levels of light if it has any.
        let finds_colours = roots.finds_colours();
        let bits = match roots.lit {
            Some(lit) => lit.bits().unwrap_or(LEAST),
            None => 0,
        };
        let mut known = vec![None; 1 << bits];
        let mut inks = std::mem::take(&mut self.inks);
        let mut of = |level: u16| {
            let found = known[usize::from(level)].get_or_insert_with(|| match finds_colours {
                true => inks.number(Ink {
                    class,
                    appearance,
                    level,
                }),
                false => class << bits | level,
            });
            *found
        };
        if let Some(own) = body.surface(view) {
            let larger = body.grown(spread).surface(view);
            let mut planes = std::mem::take(&mut self.planes);
            if let Some(larger) = &larger {
                larger.find_sides(view, &mut planes, usize::MAX);
            }
            let ends = |y| match larger {
                Some(_) => planes.ends(y),
                None => [f64::NEG_INFINITY, f64::INFINITY],
            };
            self.show(within, ends, |at| {
                let beyond = || larger.as_ref()?.meet(at);
                let (z, normal) = own.meet(at).or_else(beyond)?;
                // Where it is seen edge-on, it has no slope.
                let slope = match normal.z > EDGE_ON * normal.length() {
                    true => [-normal.x / normal.z, -normal.y / normal.z],
                    false => [0.0; 2],
                };
                let level = roots.lit.map_or(0, |lit: Lit| lit.level(normal, bits));
                Some((z, slope, u32::from(of(level))))
            });
            self.planes = planes;
        } else {
            let mut planes = std::mem::take(&mut self.planes);
            let faces = body.faces(view);
            match &roots.lit {
                None => planes.set(projection, faces, &mut Classes::One(of(0))),
                Some(lit) => {
                    let classes = &mut Classes::OfLevels {
                        lit,
                        bits,
                        of: &mut of,
                    };
                    planes.set(projection, faces, classes);
                }
            }
            planes.find_sides(usize::MAX, spread);
            let ends = |y| planes.ends(y);
            self.show(within, ends, |at| {
                let (z, slope, class) = planes.meet(at, spread)?;
                Some((z, slope, u32::from(class)))
            });
            self.planes = planes;
        }
        self.inks = inks;
    }

    /// Shows what lies in a box about a point. `ends` returns the first and the last place on a row at which something may lie,
    /// `meet` what is shown at a place.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    fn show(
        &mut self,
        (at, half): (DVec3, DVec3),
        ends: impl Fn(f64) -> [f64; 2],
        mut meet: impl FnMut([f64; 2]) -> Option<Shown>,
    ) {
        let steps = self.view.depths.steps();
        let bias = bias(self.roots, self.view, self.phases);
        let spread = self.spread;
        let reach = half + self.roots.pad;
        let columns = self.stamp.columns;
        let sides = [columns * PIECE, self.stamp.pieces.len() / columns];
        let span = |axis: usize| {
            let [at, reach] = [at, reach].map(|it| it[axis]);
            // Nothing is drawn beyond the box of the form.
            let limit = self.reach[axis];
            let ends = [at - reach - spread, at + reach + spread];
            let ends = ends.map(|end| end.clamp(-limit, limit) + self.middle[axis]);
            let most = sides[axis] as f64;
            let [first, last] = ends.map(|end| end.clamp(0.0, most));
            first.floor() as usize..last.ceil() as usize
        };
        let nearest = self.near + self.roots.pad;
        let columns_within = span(0);
        for y in span(1) {
            let at_y = y as f64 + 0.5 - self.middle[1];
            let [first, last] = ends(at_y).map(|end| end + self.middle[0] - 0.5);
            let first = columns_within.start.max(first as usize);
            let last = columns_within.end.min((last + 1.0) as usize);
            for x in first..last {
                let place = [x as f64 + 0.5 - self.middle[0], at_y];
                let Some((z, slope, class)) = meet(place) else {
                    continue;
                };
                // Beyond its outline the solid is continued.
                let z = z.clamp(at.z - reach.z, at.z + reach.z).min(nearest);
                let depth = ((self.near - z) * steps + bias) as f32;
                let piece = &mut self.stamp.pieces[y * columns + x / PIECE];
                let within = x % PIECE;
                let known = piece.class[within];
                let farther = depth - piece.depth[within];
                if known == u32::MAX || farther < -EQUAL || farther <= EQUAL && class < known {
                    piece.depth[within] = depth;
                    for (own, slope) in piece.slope.iter_mut().zip(slope) {
                        own[within] = (slope.clamp(-STEEPEST, STEEPEST) * steps) as f32;
                    }
                    piece.class[within] = class;
                    let [left, top, right, bottom] = self.stamp.extent;
                    self.stamp.extent =
                        [left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)];
                }
            }
        }
    }
}

/// Inks, and their numbers.
#[derive(Default)]
struct Inks {
    all: Vec<Ink>,
    numbers: FastMap<InkName, u16>,
}

/// Class, level and appearance of an ink.
type InkName = (u16, u16, ([u32; 6], [u32; 7]));

impl Inks {
    /// Returns the number of an ink, which is known from then on.
    fn number(&mut self, ink: Ink) -> u16 {
        let name = (ink.class, ink.level, ink.appearance.bits());
        *self.numbers.entry(name).or_insert_with(|| {
            self.all.push(ink);
            u16::try_from(self.all.len() - 1).unwrap_or(u16::MAX)
        })
    }
}

impl Stamp {
    /// Forgets the inks of which no sample shows anything.
    fn keep_shown(&mut self) {
        let all = std::mem::take(&mut self.inks);
        let mut numbers = vec![None; all.len()];
        let classes = self.pieces.iter_mut().flat_map(|piece| &mut piece.class);
        for class in classes.filter(|class| **class != u32::MAX) {
            let Some(number) = numbers.get_mut(*class as usize) else {
                return;
            };
            *class = *number.get_or_insert_with(|| {
                self.inks.push(all[*class as usize]);
                u32::try_from(self.inks.len() - 1).unwrap_or(u32::MAX)
            });
        }
    }

    /// Removes the pieces that show nothing around what is shown.
    #[expect(clippy::cast_possible_wrap, reason = "the numbers are small")]
    fn crop(&mut self) {
        let [left, top, right, bottom] = self.extent;
        if left >= right {
            (self.pieces, self.extent) = (Vec::new(), [0; 4]);
            return;
        }
        let columns = left / PIECE..right.div_ceil(PIECE);
        let rows = self
            .pieces
            .chunks_exact(self.columns)
            .take(bottom)
            .skip(top);
        self.pieces = rows
            .flat_map(|row| &row[columns.clone()])
            .cloned()
            .collect();
        self.columns = columns.len();
        let first = columns.start * PIECE;
        self.corner[0] += first as isize;
        self.corner[1] += top as isize;
        self.extent = [left - first, 0, right - first, bottom - top];
    }
}
