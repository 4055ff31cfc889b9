//! Walks by few maps that differ by translations: sets in space that consist of equal copies, all turned alike.

use crate::geometry::{DAffine3, DVec3};

use super::ClassBy;
use super::alias::FewAliases;
use super::course::Course;
use super::depth::{Lens, Nearest, Spot};
use super::random::LANES;
use super::real::Real;
use super::walkers::Walk;

/// Largest number of maps: a power of two.
const MOST: usize = FewAliases::MOST;

/// Few affine maps of one linear part, any of which may follow. The arithmetic is that of arbitrary maps.
pub(super) struct Alike<'a, T> {
    lens: Lens<'a, T>,
    choice: FewAliases,
    /// Columns of the linear part.
    linear: [[T; 3]; 3],
    /// Coordinates of the translations, by map.
    translations: [[T; MOST]; 3],
    /// Coordinates of the walkers.
    places: [[T; LANES]; 3],
    has_classes: bool,
}

impl<'a, T: Real> Alike<'a, T> {
    /// Creates walkers of a game in which any map may follow any; `None` where its maps are many or have several linear
    /// parts.
    pub(super) fn new(course: &Course<'_, DAffine3>, lens: Lens<'a, T>) -> Option<Self> {
        let maps: Vec<DAffine3> = course.maps.iter().copied().collect::<Option<_>>()?;
        let linear = maps.first()?.matrix3;
        if maps.len() > MOST || maps.iter().any(|map| map.matrix3 != linear) {
            return None;
        }
        let mut translations = [[T::ZERO; MOST]; 3];
        for (number, map) in maps.iter().enumerate() {
            for (axis, along) in map.translation.to_array().into_iter().enumerate() {
                translations[axis][number] = T::of(along);
            }
        }
        Some(Self {
            lens,
            choice: course.choice.few()?,
            linear: linear.to_cols_array_2d().map(|column| column.map(T::of)),
            translations,
            places: [[T::ZERO; LANES]; 3],
            has_classes: course.classes != ClassBy::One,
        })
    }
}

impl<T: Real> Walk<DAffine3, Nearest> for Alike<'_, T> {
    fn put(&mut self, lane: usize, point: DVec3) {
        for (places, along) in self.places.iter_mut().zip(point.to_array()) {
            places[lane] = T::of(along);
        }
    }

    #[inline(always)]
    fn step(&mut self, words: &[u32; LANES], spots: &mut [Spot; LANES]) {
        let mut maps = self.choice.choose(words);
        // Copies, which cannot overlap what is written, let the loops be vectorised.
        let [x, y, z] = self.places;
        let [first, second, third] = self.linear;
        let mut moved = [[T::ZERO; LANES]; 3];
        for axis in 0..3 {
            let translations = self.translations[axis];
            for lane in 0..LANES {
                let turned = first[axis] * x[lane] + second[axis] * y[lane] + third[axis] * z[lane];
                moved[axis][lane] = turned + translations[maps[lane] as usize % MOST];
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
    use crate::chaos::tally::Tally;
    use crate::chaos::walkers::{Any, run};
    use crate::chaos::{DepthWindow, Game, Seen, WeightedMaps};
    use crate::geometry::DMat3;
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
        course: &Course<'_, DAffine3>,
        bins: usize,
        mut walk: impl Walk<DAffine3, Nearest>,
    ) -> Nearest {
        let all = Mutex::new(None);
        let fresh = || Nearest {
            keys: vec![u32::MAX; bins],
            hits: vec![0; bins],
        };
        let mut tally = Tally::new(&fresh, &all, None, None);
        run(course, 0, &mut walk, &mut tally).unwrap();
        tally.finish();
        all.into_inner().unwrap().unwrap()
    }

    fn compare<T: Real>(window: &DepthWindow<'_>, classes: ClassBy, cuts: &[[T; 4]]) {
        let game = Game {
            points: 100_000,
            classes,
            ..Game::default()
        };
        let [system, other] = [false, true].map(sponge);
        let course = Course::new(&system, window.to_window, 1.0, &game);
        let lens = Lens::<T>::new(window, cuts);
        let alike = Alike::new(&course, lens).unwrap();
        let any = Any::<_, _, true>::new(&course, 0, lens);
        let bins = 200 * 200 + 1;
        let (alike, any) = (drawn(&course, bins, alike), drawn(&course, bins, any));
        assert!(alike == any);
        assert!(alike.hits.iter().filter(|hits| **hits > 0).count() > 1_000);
        let course = Course::new(&other, window.to_window, 1.0, &game);
        assert!(Alike::new(&course, lens).is_none());
    }

    #[test]
    fn walks_are_those_by_arbitrary_maps() {
        let turn = DMat3::from_rotation_y(0.5) * DMat3::from_rotation_x(0.4) * 80.0;
        let central = Seen::Central {
            focus: 300.0,
            middle: [100.0; 2],
        };
        for (seen, classes) in [
            (Seen::Parallel, ClassBy::Map { ago: 0 }),
            (central, ClassBy::One),
        ] {
            let window = DepthWindow {
                to_window: DAffine3::from_mat3_translation(turn, DVec3::new(40.0, 60.0, -300.0)),
                seen,
                range: [-500.0, 0.0],
                steps: 1 << 20,
                size: [200, 200],
                within: &[],
            };
            compare::<f32>(&window, classes, &[]);
            compare::<f64>(&window, classes, &[[0.0, 0.0, 1.0, -280.0]]);
        }
    }
}
