//! Stamps: what runs of small elements cover, drawn once for all that lie alike.
//!
//! Where the maps of a graph turn elements to a few sides only, or all of a step to the same, runs are
//! equal but for where they stand; so are filled elements of a few lengths. In pictures to a detail they
//! are put on a grid that is some ten times as fine as the detail: of 1/128 of a pixel if there are enough
//! of them, else of 1/64, and half as fine for lines, whose pens stand on a grid of 1/16. That moves them by
//! no more than 1/128 of a pixel, lines by 1/64. What a run covers is worked out on the grid, so it hangs on
//! nothing but the run, whoever draws it first.
//!
//! Compared with drawing every element, pixels differ by less than 1.6/255 in the mean, and a single one
//! by no more than 40/255, which are ten of the samples that tell its coverage.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

use crate::geometry::{DAffine2, DMat2, DVec2, Direction};
use crate::grow::{Element, Run};
use crate::mix::{MixMap, MixSet};
use crate::rule::Piece;

use super::hidden::Hidden;
use super::png::{Sheet, Stamp};
use super::scene::Scene;
use super::surface::{FINE, Position, Stamped, Stencil, position};

/// Places to a pixel, along either axis, and the most elements of a run: the first of these for which
/// there are enough runs. For lines half as many places; of outlines that have more than four pieces as
/// many fewer elements, but no less than few.
const GRIDS: [(f64, u64); 3] = [(128.0, 128), (128.0, 64), (64.0, 64)];

/// The same where elements are not equally long.
const UNEVEN_GRIDS: [(f64, u64); 3] = [(128.0, 64), (128.0, 16), (64.0, 16)];
const FEW_ELEMENTS: u64 = 8;

/// Steps to a pixel in which linear parts are told apart.
const LINEAR: f64 = 4096.0;

/// Fewer elements than this are drawn one by one, in a run and in a picture; likewise.
const FEWEST_IN_RUN: u64 = 4;
const FEWEST_IN_PICTURE: u64 = 1 << 20;

/// Larger runs are drawn one by one, in pixels.
const LARGEST: f64 = 32.0;

/// How often a stamp should be used.
const USES: u64 = 3;

/// More sides than this are too many.
const MOST_SIDES: usize = 1 << 8;

/// What is kept of all stamps: no more bytes than this.
const MOST_MEMORY: usize = 1 << 26;

/// Tables that are locked apart.
const TABLES: u64 = 64;

/// What runs have in common that cover the same but for where they stand.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    run: u64,
    linear: [i64; 4],
    painted: Painted,
}

/// The stamps of runs that are alike, by place in a pixel; none where nothing could be drawn.
type Places = [OnceLock<Option<Arc<Stamp>>>];

/// What of a run is painted.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Painted {
    All,
    /// What is born in some steps: from the first to the last.
    Steps(u32, u32),
    /// The objects of a class.
    Class(u64),
}

/// The stamps of a pass.
pub(super) struct Stamps {
    stencil: Stencil,
    hidden: Arc<Hidden>,
    /// The most elements of a run, and how many plain ones one of them is worth.
    pub(super) longest_run: u64,
    worth: u64,
    phases: f64,
    tables: Vec<RwLock<MixMap<Key, Arc<Places>>>>,
    bytes: AtomicUsize,
}

impl Stamps {
    /// Those of a scene, if many of its runs lie alike.
    pub(super) fn new(scene: &Scene<'_>, stencil: Stencil, hidden: Arc<Hidden>) -> Option<Self> {
        let Scene { graph, .. } = scene;
        let drawn = graph.objects().iter().filter(|object| object.visible);
        let pieces = drawn.map(|object| graph.base_elements()[object.base_element].pieces().len());
        let worth = (pieces.max().unwrap_or(0) as u64 / 4).max(1);
        let is_large =
            scene.is_to_detail && scene.elements.saturating_mul(worth) >= FEWEST_IN_PICTURE;
        if !is_large || graph.coats() {
            return None;
        }
        // Lines that are not equally long are drawn as soon one by one.
        let is_filled = stencil.pen.is_none();
        let grids = match graph.even_lengths() {
            Some(_) => GRIDS,
            None if is_filled && graph.is_plain() && graph.is_similar() => UNEVEN_GRIDS,
            None => return None,
        };
        let part = if is_filled { 1.0 } else { 0.5 };
        let grids = grids.into_iter();
        let mut grids =
            grids.map(|(phases, longest)| (phases * part, (longest / worth).max(FEW_ELEMENTS)));
        let (phases, longest_run) = grids.find(|(phases, longest_run)| {
            let sides = sides(scene, *longest_run).unwrap_or(u64::MAX);
            let runs = scene.elements / longest_run / sides;
            let places = whole(phases * phases).unsigned_abs();
            runs >= places.saturating_mul(USES)
        })?;
        Some(Self {
            stencil,
            hidden,
            longest_run,
            worth,
            phases,
            tables: (0..TABLES).map(|_| RwLock::default()).collect(),
            bytes: AtomicUsize::new(0),
        })
    }

    /// What of a run is painted, by a stamp.
    pub(super) fn of(&self, scene: &Scene<'_>, run: &Run<'_>, painted: Painted) -> Option<Stamped> {
        let map = scene.canvas.map(run.map());
        let reach = self
            .hidden
            .reach(scene, run.object(), run.frame().stretch());
        if run.count() * self.worth < FEWEST_IN_RUN || 2.0 * reach > LARGEST {
            return None;
        }
        let grid = map.translation * self.phases;
        let place = [grid.x, grid.y].map(whole);
        let phases = whole(self.phases);
        let key = Key {
            run: run.number(),
            linear: map.matrix2.to_cols_array().map(|part| whole(part * LINEAR)),
            painted: match painted {
                // From its own on, so that those of other steps are the same.
                Painted::Steps(first, last) => {
                    let [first, last] = [first, last].map(|step| step.saturating_sub(run.born()));
                    Painted::Steps(first, last)
                }
                painted => painted,
            },
        };
        let pixel = place.map(|place| place.div_euclid(phases));
        let phase = place.map(|place| place.rem_euclid(phases));
        let drawn = || {
            let stamp = self.drawn(scene, run, painted, reach, (&key, phase));
            stamp.map(Arc::new)
        };
        let number = usize::try_from(phase[0] + phases * phase[1]).ok()?;
        let places = self.places(&key);
        let known = places.as_deref().map(|places| &places[number]);
        let stamp = known.and_then(OnceLock::get).cloned().unwrap_or_else(|| {
            let stamp = drawn();
            let bytes = stamp.as_ref().map_or(0, |stamp| size_of_val(&*stamp.cells));
            if let Some(known) = known.filter(|_| self.take(bytes + size_of::<Stamp>())) {
                let _ = known.set(stamp.clone());
            }
            stamp
        });
        let stamp = stamp?;
        Some(Stamped { stamp, pixel })
    }

    /// The stamps of a key, if there is memory for them.
    fn places(&self, key: &Key) -> Option<Arc<Places>> {
        let table = &self.tables[usize::try_from(key.run % TABLES).unwrap_or(0)];
        let known = table.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(places) = known.get(key) {
            return Some(Arc::clone(places));
        }
        drop(known);
        let count = usize::try_from(whole(self.phases * self.phases)).ok()?;
        if !self.take(count * size_of::<OnceLock<Option<Arc<Stamp>>>>()) {
            return None;
        }
        let made = || (0..count).map(|_| OnceLock::new()).collect();
        let mut table = table.write().unwrap_or_else(PoisonError::into_inner);
        Some(Arc::clone(table.entry(key.clone()).or_insert_with(made)))
    }

    /// Takes memory; whether there was any left.
    fn take(&self, bytes: usize) -> bool {
        self.bytes.fetch_add(bytes, Ordering::Relaxed) < MOST_MEMORY
    }

    /// Draws the stamp of a key for a place in a pixel.
    fn drawn(
        &self,
        scene: &Scene<'_>,
        run: &Run<'_>,
        painted: Painted,
        reach: f64,
        (key, phase): (&Key, [i64; 2]),
    ) -> Option<Stamp> {
        #[expect(clippy::cast_precision_loss, reason = "places in a small picture")]
        let [linear, phase] = [
            key.linear.map(|part| part as f64 / LINEAR),
            [phase[0], phase[1], 0, 0].map(|part| part as f64 / self.phases),
        ];
        let linear = DMat2::from_cols_array(&linear);
        let phase = DVec2::new(phase[0], phase[1]);
        // All of it comes to lie on the sheet, with a pixel on every side.
        let reach = reach + 2.0;
        let corner = phase + linear * scene.graph.middle() - reach;
        let pixel = [-corner.x, -corner.y].map(whole);
        #[expect(clippy::cast_precision_loss, reason = "places in a small picture")]
        let shift = DVec2::new(pixel[0] as f64, pixel[1] as f64);
        let side = u32::try_from(whole(2.0 * reach) + 2).ok()?;
        let mut sheet = Sheet::new([side; 2], self.stencil.pen.clone());
        let moved = run.moved_to(DAffine2 {
            matrix2: linear,
            translation: phase + shift,
        });
        let mut points = Vec::new();
        let mut draw = |element: Element| {
            outline(scene, &element, &mut points, &mut sheet);
        };
        match painted {
            Painted::All => moved.elements().for_each(draw),
            Painted::Steps(first, last) => {
                let born = moved.born_in(first..=last);
                born.for_each(|(_, element)| draw(element));
            }
            Painted::Class(class) => {
                let of = |element: &Element| {
                    let object = &scene.graph.objects()[element.object];
                    scene.classes.of_object(object) == Some(class)
                };
                moved.chosen(of).for_each(|(_, element)| draw(element));
            }
        }
        sheet.into_stamp(pixel)
    }
}

/// Draws an element on a sheet, whose pixels its frame is told in.
fn outline(scene: &Scene<'_>, element: &Element, points: &mut Vec<Position>, sheet: &mut Sheet) {
    let object = &scene.graph.objects()[element.object];
    if !object.visible {
        return;
    }
    let base_element = &scene.graph.base_elements()[object.base_element];
    let is_closed = base_element.is_closed();
    let map = &element.frame.map;
    let fine = |point: DVec2| position(map.transform_point2(point) * FINE);
    points.clear();
    let coarse = scene.coarse.get().and_then(Option::as_ref);
    let stretch = element.frame.stretch();
    let corners =
        coarse.and_then(|coarse| coarse.corners(scene.graph, object.base_element, stretch));
    if let Some(corners) = corners {
        points.extend(corners.iter().map(|corner| fine(*corner)));
    } else {
        let mut at = fine(base_element.start());
        points.push(at);
        for piece in base_element.pieces() {
            match *piece {
                Piece::Line(end) => points.push(fine(end)),
                Piece::Cubic(a, b, end) => {
                    let curve = [at, fine(a), fine(b), fine(end)];
                    Sheet::add_curve(points, curve, is_closed);
                }
            }
            at = fine(piece.end());
        }
        if is_closed {
            points.pop();
        }
    }
    if is_closed {
        sheet.polygon(points);
    } else {
        sheet.line(points);
    }
}

/// How many objects turned to how many sides there are after the last step; where elements are replaced
/// down to a length instead, about how many of how many lengths become runs of so many elements. `None` if
/// they are too many.
fn sides(scene: &Scene<'_>, longest_run: u64) -> Option<u64> {
    /// Turns and lengths are told apart by so many steps.
    const TURNS: f64 = 1e9;
    let Scene { graph, growth, .. } = scene;
    let shortest = scene.sight.shortest().filter(|&shortest| shortest > 0.0);
    // What is shorter becomes no more than such a run if it fills an area.
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let long = shortest.map_or(0.0, |shortest| shortest * (longest_run as f64).sqrt());
    let turned = |map: &DMat2| *map * (1.0 / map.x_axis.length());
    let start = graph.initiator(0).instances.iter();
    let start = start.map(|instance| (DMat2::IDENTITY, Direction::Normal, instance));
    let mut standing = start.collect::<Vec<_>>();
    let (mut runs, mut sides) = (MixSet::default(), Vec::new());
    for step in 0..=growth.steps {
        let mut known = MixSet::default();
        sides.clear();
        for (linear, direction, instance) in standing.drain(..) {
            let linear = linear * instance.frame.map.matrix2;
            let direction = direction * instance.frame.direction;
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
            if sides.len().max(runs.len()) > MOST_SIDES {
                return None;
            }
        }
        standing.extend(sides.iter().flat_map(|&(object, linear, direction)| {
            let children = graph.children(object);
            children.map(move |(_, instance)| (linear, direction, instance))
        }));
    }
    Some(runs.len().max(1) as u64)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn whole(value: f64) -> i64 {
    (value + 0.5).floor() as i64
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;

    use crate::catalogue::Catalogue;
    use crate::document::Document;
    use crate::grow::Growth;
    use crate::parallel::with_team;
    use crate::render::layout::Layout;
    use crate::render::png::Png;
    use crate::render::scene::Scene;
    use crate::render::{Detail, Drawing, Options, Size};

    fn drawn(scene: &Scene<'_>, threads: usize) -> Vec<u8> {
        with_team(NonZero::new(threads).unwrap(), |team| {
            let mut png = Png::begin(scene.size(), scene.background(), team).unwrap();
            scene.draw(&mut png, team).unwrap();
            png.into_pixels().0.take()
        })
    }

    /// The largest difference of pixels, the mean one, and that of the means.
    fn difference(a: &[u8], b: &[u8]) -> (u8, f64, f64) {
        let differences = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
        let sum = |values: &mut dyn Iterator<Item = u8>| values.map(f64::from).sum::<f64>();
        let mean = sum(&mut differences.clone()) / a.len() as f64;
        let [all, others] = [a, b].map(|all| sum(&mut all.iter().copied()));
        let of_means = (all - others) / a.len() as f64;
        (differences.max().unwrap(), mean, of_means.abs())
    }

    #[test]
    fn stamps_cover_what_elements_do() {
        let catalogue = Catalogue::embedded();
        for name in [
            "carpet",
            "t-square",
            "terdragon",
            "terdragon-rose",
            "twindragon-ifs",
            "square-filled",
            "pentaflake",
            // All of a step is turned alike; of two lengths.
            "complex-pair",
            "snowflake-tiles",
        ] {
            let source = catalogue.rule(name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let model = document.resolve(&[]).unwrap().0;
            let graph = model.compile(30).unwrap();
            let options = Options {
                size: Size::Long(128),
                detail: Some(Detail {
                    pixels: 0.5,
                    decides_steps: true,
                }),
                ..Options::of(model.heading())
            };
            let growth = Growth::steps(30);
            let layout = Layout::find(&graph, &growth, &options).unwrap();
            let mut scene = Scene::new(&layout.survey, &layout.growth, layout.canvas);
            // As if there were so many that they are worth it.
            scene.elements = u64::MAX;
            scene.is_to_detail = false;
            let one_by_one = drawn(&scene, 1);
            scene.is_to_detail = true;
            let stamped = drawn(&scene, 1);
            // The squares of some stand on the grid.
            let shows = stamped != one_by_one || ["square-filled", "t-square"].contains(&name);
            assert!(shows, "{name}: nothing is stamped");
            assert!(stamped == drawn(&scene, 3), "{name} on three threads");
            let (most, mean, of_means) = difference(&stamped, &one_by_one);
            let is_near = most <= 40 && mean < 1.6 && of_means < 0.5;
            assert!(is_near, "{name}: {most}, {mean}, {of_means}");
        }
    }
}
