//! Random iterated function systems, as files.

use kfrac::geometry::{DMat2, DVec2};

/// A generator of pseudorandom numbers (splitmix64; Steele et al. 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a number from 0 to 1.
    pub(crate) fn part(&mut self) -> f64 {
        (self.next() >> 40) as f64 / f64::from(1 << 24)
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() >> 33).unwrap_or(0) % count
    }
}

/// Returns the file of a system of two to eight maps: rotations, reflections, singular values in [0, 1), and
/// translations of up to 1 along each axis.
pub(crate) fn random_system(seed: u64) -> String {
    maps(seed, |random| [random.part(), random.part()])
}

/// Returns the file of a random system of similarities with ratios from 0.05 to 0.85.
pub(crate) fn random_similar_system(seed: u64) -> String {
    maps(seed, |random| [0.05 + 0.8 * random.part(); 2])
}

/// Returns maps whose singular values `values` gives.
fn maps(seed: u64, values: impl Fn(&mut Random) -> [f64; 2]) -> String {
    let mut random = Random(seed);
    let mut text = "maps:\n".to_owned();
    for _ in 0..2 + random.below(7) {
        let turn = |random: &mut Random| DMat2::from_angle(std::f64::consts::TAU * random.part());
        let (last, first) = (turn(&mut random), turn(&mut random));
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let [long, short] = values(&mut random);
        let values = DVec2::new(long, sign * short);
        let [x, y] = [2.0 * random.part() - 1.0, 2.0 * random.part() - 1.0];
        let [[a, b], [c, d]] = (last * DMat2::from_diagonal(values) * first).to_cols_array_2d();
        text += &format!("  - {{matrix: [[{a}, {c}], [{b}, {d}]], shift: [{x}, {y}]}}\n");
    }
    text
}
