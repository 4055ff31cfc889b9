//! Walks by few maps in space, whose coefficients all walkers look up at once.

use crate::geometry::{DAffine3, DVec3};

use super::ClassBy;
use super::alias::FewAliases;
use super::course::Course;
use super::depth::{Lens, Nearest, Spot};
use super::lookup::{ENTRIES, LookUp};
use super::random::LANES;
use super::real::Real;
use super::walkers::Walk;

/// Few affine maps, any of which may follow; if they are `ALIKE`, of one linear part, as of sets that consist of equal
/// copies, all turned alike. The arithmetic is that of arbitrary maps.
pub(super) struct Few<'a, T, F, const ALIKE: bool> {
    lens: Lens<'a, T>,
    choice: FewAliases,
    /// Coordinates of the columns of the linear parts and of the translations, by map.
    columns: [[[T; ENTRIES]; 3]; 4],
    look_up: F,
    /// Coordinates of the walkers.
    places: [[T; LANES]; 3],
    has_classes: bool,
}

impl<'a, T: Real, F: LookUp, const ALIKE: bool> Few<'a, T, F, ALIKE> {
    /// Creates walkers of a game in which any map may follow any; `None` where its maps are many, or not alike as they
    /// must be.
    pub(super) fn new(
        course: &Course<'_, DAffine3>,
        lens: Lens<'a, T>,
        look_up: F,
    ) -> Option<Self> {
        let maps: Vec<DAffine3> = course.maps.iter().copied().collect::<Option<_>>()?;
        let linear = maps.first()?.matrix3;
        let is_alike = maps.iter().all(|map| map.matrix3 == linear);
        if maps.len() > ENTRIES || ALIKE && !is_alike {
            return None;
        }
        let mut columns = [[[T::ZERO; ENTRIES]; 3]; 4];
        for (number, map) in maps.iter().enumerate() {
            let linear = &map.matrix3;
            let parts = [linear.x_axis, linear.y_axis, linear.z_axis, map.translation];
            for (column, part) in columns.iter_mut().zip(parts) {
                for (table, value) in column.iter_mut().zip(part.to_array()) {
                    table[number] = T::of(value);
                }
            }
        }
        Some(Self {
            lens,
            choice: course.choice.few()?,
            columns,
            look_up,
            places: [[T::ZERO; LANES]; 3],
            has_classes: course.classes != ClassBy::One,
        })
    }
}

impl<T: Real, F: LookUp, const ALIKE: bool> Walk<DAffine3, Nearest> for Few<'_, T, F, ALIKE> {
    fn put(&mut self, lane: usize, point: DVec3) {
        for (places, along) in self.places.iter_mut().zip(point.to_array()) {
            places[lane] = T::of(along);
        }
    }

    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], spots: &mut [Spot; LANES]) {
        let mut maps = self.choice.choose(words, self.look_up);
        // Copies, which cannot overlap what is written, let the loops be vectorised.
        let [x, y, z] = self.places;
        let mut moved = [[T::ZERO; LANES]; 3];
        for (axis, moved) in moved.iter_mut().enumerate() {
            let mut columns = [[T::ZERO; LANES]; 4];
            for (number, column) in columns.iter_mut().enumerate() {
                let table = &self.columns[number][axis];
                *column = match ALIKE && number < 3 {
                    true => [table[0]; LANES],
                    false => T::look_up(table, &maps, self.look_up),
                };
            }
            let [first, second, third, translations] = columns;
            for lane in 0..LANES {
                let turned = first[lane] * x[lane] + second[lane] * y[lane] + third[lane] * z[lane];
                moved[lane] = turned + translations[lane];
            }
        }
        self.places = moved;
        if !self.has_classes {
            maps = [0; LANES];
        }
        self.lens.see(moved, &maps, spots);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::chaos::lookup::one_by_one;
    use crate::chaos::tally::{Cancelled, Tally};
    use crate::chaos::walkers::{Any, run};
    use crate::chaos::{DepthWindow, Game, Seen, WeightedMaps, depth};
    use crate::geometry::{DMat3, HalfSpace};
    use crate::ifs::{Definition, Ifs, Map};

    /// Returns maps by a third to the corners and edges of a cube, turned about an axis, with unequal weights; the first one has
    /// another linear part if it is `other`.
    fn sponge(other: bool) -> WeightedMaps<DAffine3> {
        let turned = DMat3::from_rotation_z(0.1) / 3.0;
        let mut maps = Vec::new();
        for place in 0..27 {
            let at = [place % 3, place / 3 % 3, place / 9].map(f64::from);
            if at.iter().filter(|it| **it == 1.0).count() < 2 {
                let linear = match other && maps.is_empty() {
                    true => DMat3::from_rotation_x(0.3) / 4.0,
                    false => turned,
                };
                let map = DAffine3::from_mat3_translation(linear, DVec3::from(at) / 3.0);
                maps.push(Map::new(map).weighing(1.0 + at[0]));
            }
        }
        let definition = Definition {
            maps,
            ..Definition::default()
        };
        WeightedMaps::of(&Ifs::new(definition).unwrap()).unwrap()
    }

    /// Draws a wave.
    fn drawn(
        window: &DepthWindow<'_>,
        walk: impl FnOnce(&mut Tally<'_, Nearest>) -> Result<(), Cancelled>,
    ) -> Nearest {
        let [width, height] = window.size;
        let all = Mutex::new(None);
        let fresh = || Nearest::new((width * height + 1) as usize, true);
        let mut tally = Tally::new(&fresh, &all, None, None);
        walk(&mut tally).unwrap();
        tally.finish();
        all.into_inner().unwrap().unwrap()
    }

    /// Method by which a wave of a game is walked.
    type Wave = fn(
        &Course<'_, DAffine3>,
        &DepthWindow<'_>,
        u64,
        &mut Tally<'_, Nearest>,
    ) -> Result<(), Cancelled>;

    /// Compares the methods of one precision, and `wave`, with the walk by arbitrary maps.
    fn compare<T: Real>(window: &DepthWindow<'_>, classes: ClassBy, wave: Wave) {
        let game = Game {
            points: 100_000,
            classes,
            ..Game::default()
        };
        let cuts = depth::cuts_of::<T>(window);
        let lens = Lens::new(window, &cuts);
        for other in [false, true] {
            let system = sponge(other);
            let course = Course::new(&system, window.to_window, 1.0, &game);
            let mut any = Any::<_, _, true>::new(&course, 0, lens);
            let any = drawn(window, |tally| run(&course, 0, &mut any, tally));
            let mut few = Few::<_, _, false>::new(&course, lens, one_by_one).unwrap();
            assert!(drawn(window, |tally| run(&course, 0, &mut few, tally)) == any);
            let alike = Few::<_, _, true>::new(&course, lens, one_by_one);
            assert_eq!(alike.is_none(), other);
            if let Some(mut alike) = alike {
                assert!(drawn(window, |tally| run(&course, 0, &mut alike, tally)) == any);
            }
            // By the vectors that the processor has.
            assert!(drawn(window, |tally| wave(&course, window, 0, tally)) == any);
            assert!(any.hits.iter().filter(|hits| **hits > 0).count() > 1_000);
        }
    }

    #[test]
    fn walks_are_those_by_arbitrary_maps() {
        let turn = DMat3::from_rotation_y(0.5) * DMat3::from_rotation_x(0.4) * 80.0;
        let central = Seen::Central {
            focus: 300.0,
            middle: [100.0; 2],
        };
        let within = [HalfSpace {
            normal: DVec3::Z,
            distance: -280.0,
        }];
        for (seen, classes) in [
            (Seen::Parallel, ClassBy::Map { ago: 0 }),
            (central, ClassBy::One),
        ] {
            let mut window = DepthWindow {
                to_window: DAffine3::from_mat3_translation(turn, DVec3::new(40.0, 60.0, -300.0)),
                seen,
                range: [-500.0, 0.0],
                steps: 1 << 20,
                size: [200, 200],
                within: &[],
            };
            compare::<f32>(&window, classes, depth::walk_single);
            window.within = &within;
            compare::<f64>(&window, classes, depth::walk_double);
        }
    }
}
