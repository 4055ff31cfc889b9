//! Sprites of runs of elements.

use crate::fast_hash::FastSet;
use crate::geometry::{DAffine2, DMat2, Direction};
use crate::grow::Run;
use crate::render::contribution::Painted;
use crate::render::png::coverage::{SpritePaint, SpriteSheet};
use crate::render::png::raster::PlacedSprite;
use crate::render::scene::Scene;

use super::{Key, LARGEST, LINEAR, MIN_IN_RUN, Of, Sprites, outline, whole};

/// Numbers of steps per pixel, along either axis, and maximum numbers of elements of a run: the first of
/// these for which there are enough runs is used. For strokes there are half as many steps, in the last two
/// as many as pens have; for outlines of more than four pieces, proportionally fewer elements, but at least
/// `FEW_ELEMENTS`.
const GRIDS: &[(f64, u64)] = &[
    (128.0, 128),
    (128.0, 64),
    (64.0, 64),
    (32.0, 64),
    (32.0, 16),
];

/// Corresponding numbers if elements have unequal lengths.
const UNEVEN_GRIDS: &[(f64, u64)] = &[(128.0, 64), (128.0, 16), (64.0, 16)];
/// Minimum of the maximum number of elements of a run.
const FEW_ELEMENTS: u64 = 8;

/// Maximum number of orientations.
const MAX_SIDES: usize = 1 << 8;

/// Runs that are drawn as sprites.
pub(super) struct Runs {
    /// Maximum number of elements of a run.
    pub(super) longest: u64,
    /// Cost of an element, in simple ones.
    worth: u64,
    phases: f64,
}

impl Runs {
    /// Creates the runs of a scene if many are congruent; `worth` is the cost of an element, in simple ones.
    pub(super) fn of(scene: &Scene<'_>, paint: &SpritePaint, worth: u64) -> Option<Self> {
        let Scene { graph, .. } = scene;
        // Lines of unequal lengths are drawn as fast one by one.
        let is_filled = paint.pen.is_none() || paint.outlines;
        let grids = match graph.even_lengths() {
            Some(_) => GRIDS,
            None if is_filled && graph.is_plain() && graph.is_similar() => UNEVEN_GRIDS,
            None => return None,
        };
        let part = if paint.pen.is_none() { 1.0 } else { 0.5 };
        let grids = grids.iter();
        let mut grids =
            grids.map(|&(phases, longest)| (phases * part, (longest / worth).max(FEW_ELEMENTS)));
        let (phases, longest) = grids.find(|(phases, longest)| {
            let sides = sides(scene, *longest).unwrap_or(u64::MAX);
            let runs = scene.elements / longest / sides;
            let places = whole(phases * phases).unsigned_abs();
            runs >= places.saturating_mul(scene.uses)
        })?;
        Some(Self {
            longest,
            worth,
            phases,
        })
    }
}

impl Sprites<'_> {
    /// Returns the sprite of the part of a run that is painted.
    pub(in crate::render) fn of(
        &self,
        scene: &Scene<'_>,
        run: &Run<'_>,
        painted: Painted,
    ) -> Option<PlacedSprite> {
        let Runs { worth, phases, .. } = *self.runs.as_ref()?;
        let map = scene.canvas.map(run.map());
        let radius = self.reach.radii[run.object()];
        let reach = self.reach.pixels(scene, radius, run.frame().stretch());
        if run.count() * worth < MIN_IN_RUN || 2.0 * reach > LARGEST {
            return None;
        }
        let key = Key {
            of: Of::Run(run.number()),
            linear: map.matrix2.to_cols_array().map(|part| whole(part * LINEAR)),
            painted: painted.since(run.born()),
        };
        self.put(&key, map.translation, phases, |phase| {
            #[expect(clippy::cast_precision_loss, reason = "steps in a small picture")]
            let linear = DMat2::from_cols_array(&key.linear.map(|part| part as f64 / LINEAR));
            let draw = |map: DAffine2, sheet: &mut SpriteSheet| {
                let mut points = Vec::new();
                let moved = run.moved_to(map);
                let elements = moved.elements();
                let painted = elements.filter(|element| painted.has(scene, element));
                painted.for_each(|element| outline(scene, &element, &mut points, sheet));
            };
            self.drawn(linear, phase, (linear * scene.graph.middle(), reach), draw)
        })
    }
}

/// Returns the number of objects by orientation after the last step. If elements are replaced down to a
/// length instead, returns approximately the number of objects by orientation and length that become runs of
/// at most `longest_run` elements. `None` if there are too many.
fn sides(scene: &Scene<'_>, longest_run: u64) -> Option<u64> {
    /// Steps in which orientations and lengths are quantised.
    const TURNS: f64 = 1e9;
    let Scene { graph, growth, .. } = scene;
    let shortest = scene.culling.shortest().filter(|&shortest| shortest > 0.0);
    // A shorter element becomes at most such a run, if it fills an area.
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let long = shortest.map_or(0.0, |shortest| shortest * (longest_run as f64).sqrt());
    let turned = |map: &DMat2| *map * (1.0 / map.x_axis.length());
    let start = graph.initiator(0).instances.iter();
    let start = start.map(|instance| (DMat2::IDENTITY, Direction::Normal, instance));
    let mut state = start.collect::<Vec<_>>();
    let (mut runs, mut sides) = (FastSet::default(), Vec::new());
    for step in 0..=growth.steps {
        let mut known = FastSet::default();
        sides.clear();
        for (linear, direction, instance) in state.drain(..) {
            let linear = linear * instance.frame.map().matrix2;
            let direction = direction * instance.frame.direction();
            let length = linear.x_axis.length();
            let size = shortest.map_or(0.0, |_| libm::log2(length));
            let turn = turned(&linear).to_cols_array();
            let [a, b, c, d] = turn.map(|part| whole(part * TURNS));
            let size = whole(size * TURNS);
            let key = (instance.object, [a, b, c, d, size], direction.is_reversed());
            if step == growth.steps || length < long {
                runs.insert(key);
            } else if known.insert(key) {
                sides.push((instance.object, linear, direction));
            }
            if sides.len().max(runs.len()) > MAX_SIDES {
                return None;
            }
        }
        state.extend(sides.iter().flat_map(|&(object, linear, direction)| {
            let children = graph.children(object);
            children.map(move |(_, instance)| (linear, direction, instance))
        }));
    }
    Some(runs.len().max(1) as u64)
}
