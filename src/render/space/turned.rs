//! Stamps of turned instances: small pictures of an object in one of many orientations.
//!
//! Where maps turn, hardly two instances differ by a translation only, and there are no exact
//! [stamps](super::stamp). Instances of at most three pixels are then copies of the picture in an orientation and
//! of a size near to theirs: of all their points, none is drawn more than a pixel from its place, and most within a
//! quarter of a pixel. Elements that are replaced because they are larger than the detail are never drawn so.

use std::sync::OnceLock;

use crate::geometry::{DAffine3, DMat3, DQuat, DVec3};

use super::buffer::{Buffer, CLASS_BITS, EMPTY, MARGIN, MAX_CLASS, SAMPLES, STEPS, STRIDE};
use super::camera::{Placement, Projection};
use super::descent::Roots;
use super::forms::{Form, Forms, MAX_FORMS};
use super::lit::Classes;
use super::planes::{Planes, draw_row};
use super::scene::{Child, ClassBy, End, Part, ends};
use super::solid::{Depths, View, faces};
use super::stamp::{PIECE, WIDTH};

/// Longest side of the box of an instance that is a copy, in samples.
#[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
const SIDE: f64 = 3.0 * SAMPLES as f64;

/// Number of sizes between that of an element and that of the largest copy.
const SIZES: usize = 8;

/// Logarithm of the ratio of sizes.
const RATIO: f64 = 0.15;

/// Number of steps of each of the three coordinates of an orientation.
const TURNS: usize = 10;

/// Number of orientations: in each of four charts one component of the quaternion is the largest.
const ORIENTATIONS: usize = 4 * TURNS * TURNS * TURNS;

/// Number of stamps of an object: orientations, mirrored or not, and sizes.
const CELLS: usize = 2 * ORIENTATIONS * SIZES;

/// Limit of the number of objects that have stamps.
const MAX_OBJECTS: usize = 16;

/// Samples by which solids are drawn larger than they are, so that neighbours leave no gap.
const SPREAD: f64 = 0.35;

/// Curvature of the scale of coordinates of orientations, by which steps are turns of similar angles.
const BEND: f64 = 0.27;

/// Half of the range of depths of a stamp, in samples.
#[expect(clippy::cast_precision_loss, reason = "stamps are small")]
const REACH: f64 = WIDTH as f64 / 2.0;

/// The stamps of all objects, which are drawn when they are needed.
pub(super) struct Turned {
    /// Number of the stamps of each object.
    sets: Vec<usize>,
    stamps: Vec<OnceLock<TurnedStamp>>,
}

/// Picture of an object in an orientation.
pub(super) struct TurnedStamp {
    /// Keys with depths of its own range, in rows.
    keys: Vec<u32>,
    columns: usize,
    /// Corner of what is stored, and the end of what shows something, in samples.
    corner: [usize; 2],
    end: [usize; 2],
    /// Number of solids.
    pub(super) elements: u64,
    /// Number of steps of its deepest element.
    pub(super) deepest: u32,
}

/// Orientation and size of an instance, rounded.
struct Cell {
    is_mirrored: bool,
    /// The component of the quaternion that is largest.
    chart: usize,
    turn: [usize; 3],
    size: usize,
}

impl Turned {
    /// Creates stamps for systems of similarities in parallel pictures, if they have so many forms that they are not
    /// known before the descent.
    pub(super) fn of(
        parts: &[Part],
        start: &[Child],
        forms: &Forms,
        end: &End,
        class_by: ClassBy,
        placement: &Placement,
    ) -> Option<Self> {
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let pixel = SAMPLES as f64;
        let is_apt = forms.known.len() >= MAX_FORMS
            && matches!(placement.projection, Projection::Parallel)
            && class_by != ClassBy::Tint
            && (pixel..SIDE / 2.0).contains(&end.detail)
            // Stamps consist of planes.
            && parts.iter().all(|part| part.solid.as_ref().is_none_or(|it| it.primitive().is_none()));
        if !is_apt || start.is_empty() {
            return None;
        }
        let name = |part: &Part, number| match class_by {
            ClassBy::FirstMap => number,
            _ => part.kind,
        };
        let mut names = Vec::new();
        let sets = parts.iter().enumerate().map(|(number, part)| {
            let name = name(part, number);
            { names.iter() }
                .position(|known| *known == name)
                .unwrap_or_else(|| {
                    names.push(name);
                    names.len() - 1
                })
        });
        let sets: Vec<usize> = sets.collect();
        (names.len() <= MAX_OBJECTS).then(|| Self {
            sets,
            stamps: (0..CELLS * names.len()).map(|_| OnceLock::new()).collect(),
        })
    }

    /// Draws a small instance whose middle is at a point; `None` if it is too large, or replaced to the last step.
    #[expect(clippy::cast_possible_truncation, reason = "the numbers are small")]
    pub(super) fn draw(
        &self,
        roots: &Roots<'_>,
        view: &View<'_>,
        buffer: &mut Buffer,
        (form, at, class): (&Form, DVec3, u16),
    ) -> Option<&TurnedStamp> {
        let size = form.length * roots.end.unit;
        if size > SIDE || size <= roots.end.detail {
            return None;
        }
        let cell = Cell::of(&form.linear, form.length, size)?;
        let number = self.sets[form.object] * CELLS + cell.number();
        // Stamps have the hull in their middle.
        let at = at - form.middle + form.centre;
        let stamp = self.stamps[number].get_or_init(|| {
            let length = cell.size() / roots.end.unit;
            let form = Form::new(roots.parts, (form.object, 0), cell.turn() * length, length);
            Builder::build(roots, &form)
        });
        let class = match roots.class_by {
            ClassBy::Step => form.level,
            _ => u32::from(class),
        };
        if form.level + stamp.deepest >= roots.end.steps
            || class + stamp.deepest > u32::from(MAX_CLASS)
        {
            return None;
        }
        let corner = [0, 1].map(|axis| {
            let at = (at[axis] - view.corner[axis] - REACH).round() as isize;
            let at = at + MARGIN.cast_signed();
            let at = at.clamp(0, (STRIDE - WIDTH).cast_signed());
            at.cast_unsigned() + stamp.corner[axis]
        });
        if !stamp.keys.is_empty() {
            let copy = Copy {
                base: view.depths.exact(at.z + REACH).floor() as i32,
                scale: (2.0 * REACH * view.depths.steps() / STEPS) as f32,
                class,
            };
            let keys = &mut buffer.with_margin()[corner[1] * STRIDE + corner[0]..];
            if blit(keys, stamp.columns, &stamp.keys, &copy) {
                let end = [0, 1].map(|axis| corner[axis] + stamp.end[axis] - stamp.corner[axis]);
                buffer.refresh_with_margin([corner[0], corner[1], end[0], end[1]]);
            }
        }
        Some(stamp)
    }
}

impl Cell {
    /// Returns the cell of a similarity, whose stretch is given, and of the longest side of its box.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the numbers are small"
    )]
    fn of(linear: &DMat3, length: f64, size: f64) -> Option<Self> {
        let is_mirrored = linear.determinant() < 0.0;
        let scale = if is_mirrored { -1.0 } else { 1.0 } / length;
        let parts = DQuat::from_mat3(&(*linear * scale)).to_array();
        let chart = (0..4).fold(0, |chart, part| {
            if parts[part].abs() > parts[chart].abs() {
                part
            } else {
                chart
            }
        });
        let others = [1, 2, 3].map(|step| parts[(chart + step) % 4] / parts[chart]);
        let turn = others.map(|part| {
            let bent = part * (1.0 + BEND - BEND * part.abs());
            let step = (bent + 1.0) / 2.0 * TURNS as f64;
            (step as usize).min(TURNS - 1)
        });
        let size = (libm::log(SIDE / size) / RATIO) as usize;
        (size < SIZES).then_some(Self {
            is_mirrored,
            chart,
            turn,
            size,
        })
    }

    fn number(&self) -> usize {
        let [a, b, c] = self.turn;
        let turn = ((self.chart * TURNS + a) * TURNS + b) * TURNS + c;
        (turn * SIZES + self.size) * 2 + usize::from(self.is_mirrored)
    }

    /// Returns the orientation in the middle of the cell.
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    fn turn(&self) -> DMat3 {
        let mut parts = [1.0; 4];
        for (step, turn) in self.turn.iter().enumerate() {
            let bent = (*turn as f64 + 0.5) / TURNS as f64 * 2.0 - 1.0;
            let slope = 1.0 + BEND;
            let part = (slope - (slope * slope - 4.0 * BEND * bent.abs()).sqrt()) / (2.0 * BEND);
            parts[(self.chart + step + 1) % 4] = part.copysign(bent);
        }
        let turn = DMat3::from_quat(DQuat::from_array(parts).normalize());
        if self.is_mirrored { -turn } else { turn }
    }

    /// Returns the longest side of the box in the middle of the cell, in samples.
    #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
    fn size(&self) -> f64 {
        SIDE * libm::exp(-RATIO * (self.size as f64 + 0.5))
    }
}

/// A copy, in the depths of the picture.
struct Copy {
    /// Depth of what has the depth 0.
    base: i32,
    /// Depths of the picture in one of the stamp.
    scale: f32,
    class: u32,
}

/// Draws a copy, whose corner is that of `keys`; returns whether it is seen.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets("x86_64+avx2")))]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "the numbers are clamped"
)]
fn blit(keys: &mut [u32], columns: usize, stamp: &[u32], copy: &Copy) -> bool {
    const LAST: i32 = STEPS as i32;
    let mut seen = 0;
    for (row, stamp) in keys.chunks_mut(STRIDE).zip(stamp.chunks_exact(columns)) {
        let pieces = row.chunks_exact_mut(PIECE).zip(stamp.chunks_exact(PIECE));
        for (keys, stamp) in pieces {
            for (key, own) in keys.iter_mut().zip(stamp) {
                let depth = ((own >> CLASS_BITS) as i32 as f32 * copy.scale) as i32;
                let depth = (depth + copy.base).clamp(0, LAST) as u32;
                let class = (own & u32::from(MAX_CLASS)) + copy.class;
                let new = if *own == EMPTY {
                    EMPTY
                } else {
                    depth << CLASS_BITS | class
                };
                seen |= u32::from(new < *key);
                *key = (*key).min(new);
            }
        }
    }
    seen > 0
}

/// Draws the elements of a form.
struct Builder<'a> {
    roots: &'a Roots<'a>,
    end: End,
    view: View<'a>,
    planes: Planes,
    keys: Vec<u32>,
    elements: u64,
    deepest: u32,
}

impl<'a> Builder<'a> {
    fn build(roots: &'a Roots<'a>, form: &Form) -> TurnedStamp {
        let mut builder = Self {
            roots,
            end: End {
                steps: u32::MAX,
                ..roots.end
            },
            view: View {
                projection: Projection::Parallel,
                depths: Depths::new([-REACH, REACH]),
                cuts: &[],
                corner: [0.0; 2],
            },
            planes: Planes::default(),
            keys: vec![EMPTY; WIDTH * WIDTH],
            elements: 0,
            deepest: 0,
        };
        builder.add(form, DVec3::new(REACH, REACH, 0.0));
        builder.stamp()
    }

    /// Adds what is in an instance, whose middle is given.
    fn add(&mut self, form: &Form, at: DVec3) {
        let parts = self.roots.parts;
        if ends(parts, form, &self.end) || form.is_small(&self.end, 1.0) {
            return self.add_solid(form, at);
        }
        for child in &parts[form.object].children {
            let inner = form.inner(parts, child);
            self.add(&inner, at + form.offset(child, &inner));
        }
    }

    fn add_solid(&mut self, form: &Form, at: DVec3) {
        let Some(solid) = self.roots.parts[form.object].drawn(form.level, &self.end) else {
            return;
        };
        self.elements += 1;
        self.deepest = self.deepest.max(form.level);
        let reach = form.half + self.roots.pad + SPREAD;
        let Some([left, top, right, bottom]) = self.view.rectangle(at, reach) else {
            return;
        };
        let map = DAffine3::from_mat3_translation(form.linear, at - form.middle);
        let faces = faces(solid, &map, &self.view)
            .map(|(normal, distance)| (normal, distance + SPREAD * normal.length()));
        let class = self.roots.class(form, 0);
        self.planes
            .set(Projection::Parallel, faces, &mut Classes::One(class));
        for y in top..bottom.min(WIDTH) {
            let row = &mut self.keys[y * WIDTH..(y + 1) * WIDTH];
            let row = &mut row[left.min(WIDTH)..right.min(WIDTH)];
            draw_row::<false>(&self.planes, row, &self.view, [left, y], class);
        }
    }

    /// Returns the stamp, without what shows nothing around what is shown.
    fn stamp(self) -> TurnedStamp {
        let shown = { self.keys.iter().enumerate() }
            .filter(|(_, key)| **key != EMPTY)
            .map(|(at, _)| [at % WIDTH, at / WIDTH]);
        let (mut corner, mut end) = ([WIDTH; 2], [0; 2]);
        for at in shown {
            for axis in 0..2 {
                corner[axis] = corner[axis].min(at[axis]);
                end[axis] = end[axis].max(at[axis] + 1);
            }
        }
        corner = [corner[0].min(end[0]), corner[1].min(end[1])];
        // Rows consist of pieces.
        let columns = (end[0] - corner[0]).next_multiple_of(PIECE);
        let corner = [corner[0].min(WIDTH - columns), corner[1]];
        let rows = self.keys.chunks_exact(WIDTH).take(end[1]).skip(corner[1]);
        TurnedStamp {
            keys: { rows.flat_map(|row| &row[corner[0]..corner[0] + columns]) }
                .copied()
                .collect(),
            columns,
            corner,
            end,
            elements: self.elements,
            deepest: self.deepest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::buffer::SIDE as TILE_SIDE;
    use super::super::descent::Descent;
    use super::super::slice::Search;
    use super::super::solid::depth_of;
    use super::super::tests::graph_of;
    use super::super::{place, scene, solid};
    use super::*;
    use crate::geometry::{Bounds, Frame3, Solid};
    use crate::graph::Graph;
    use crate::render::Size;
    use crate::style::{Camera, Colour};

    /// Greatest distance of a point from its place, in samples, before it is rounded to samples.
    const AWAY: f64 = SAMPLES as f64 - std::f64::consts::FRAC_1_SQRT_2;

    #[test]
    fn cells_are_near_to_what_they_stand_for() {
        let corners = Solid::cuboid(&Bounds::new(DVec3::splat(-0.5), DVec3::splat(0.5)));
        let (mut farthest, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        for number in 0..20_000 {
            let part = |step: u32| (f64::from(number) * 0.618_034 * f64::from(step)).fract() - 0.5;
            let turn = DQuat::from_xyzw(part(1), part(2), part(3), part(4));
            let size = 4.01 + (SIDE - 4.01) * (part(5) + 0.5);
            let sign = if number % 2 == 0 { size } else { -size };
            let linear = DMat3::from_quat(turn.normalize()) * sign;
            let cell = Cell::of(&linear, size, size).unwrap();
            let own = cell.turn() * cell.size();
            for corner in corners.corners() {
                let away = (own * *corner - linear * *corner).length();
                farthest = farthest.max(away);
                sum += away;
                count += 1.0;
            }
        }
        assert!(farthest < AWAY && sum < 1.5 * count, "{farthest}, {sum}");
    }

    fn drawn(graph: &Graph<Frame3>, is_turned: bool) -> (Buffer, f64) {
        let parts = scene::parts(graph, None);
        let search = Search {
            parts: &parts,
            start: &scene::start(graph),
            steps: None,
        };
        let camera = Camera::default();
        let placement = place::place(graph, &search, &camera, &[], Size::Long(64), 0.0).unwrap();
        let view = View {
            projection: placement.projection,
            depths: Depths::new(placement.range),
            cuts: &[],
            corner: [0.0; 2],
        };
        let start = scene::start(&scene::seen(graph, &placement.map));
        let end = End {
            steps: 1000,
            detail: SAMPLES as f64,
            unit: graph.unit(),
        };
        let pad = solid::pad(graph);
        let class_by = ClassBy::Nothing;
        let forms = Forms::find(&parts, &start, &end, class_by, &placement, pad, true);
        let turned = Turned::of(&parts, &start, &forms, &end, class_by, &placement);
        let roots = Roots {
            parts: &parts,
            forms: &forms,
            end,
            class_by,
            lit: None,
            inks: &[Colour::BLACK],
            pad,
            overlap: false,
            turned: turned.as_ref().filter(|_| is_turned),
        };
        assert!(turned.is_some());
        let mut buffer = Buffer::new();
        let start = roots.start(&view);
        Descent::default().run(&roots, &view, &mut buffer, &start);
        (buffer, view.depths.steps())
    }

    /// Samples of copies have one of a similar depth within half a pixel of the exact picture. The other way, copies
    /// close gaps that are finer than a pixel.
    #[test]
    fn copies_are_drawn_where_they_belong() {
        const NEAR: usize = SAMPLES / 2;
        for text in [
            include_str!("../../../library/ifs/lotus.yaml"),
            include_str!("../../../library/ifs/romanesco.yaml"),
        ] {
            let graph = graph_of(text);
            let (exact, steps) = drawn(&graph, false);
            let (copied, _) = drawn(&graph, true);
            for (one, other, share) in [(&copied, &exact, 0.02), (&exact, &copied, 0.08)] {
                let (mut ink, mut away) = (0, 0);
                for y in 0..TILE_SIDE {
                    for x in 0..TILE_SIDE {
                        let Some(depth) = depth_of(one.row(y)[x]) else {
                            continue;
                        };
                        ink += 1;
                        let around =
                            |at: usize| at.saturating_sub(NEAR)..(at + NEAR + 1).min(TILE_SIDE);
                        let is_near = around(y).any(|y| {
                            { other.row(y)[around(x)].iter() }
                                .filter_map(|key| depth_of(*key))
                                .any(|own| f64::from(own.abs_diff(depth)) < steps * NEAR as f64)
                        });
                        away += usize::from(!is_near);
                    }
                }
                assert!(
                    ink > 20_000 && (away as f64) < share * ink as f64,
                    "{away} of {ink}"
                );
            }
        }
    }
}
