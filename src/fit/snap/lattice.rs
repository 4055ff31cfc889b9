//! Numbers of the complex plane in which the shifts of known systems lie: sums of few roots of unity, divided by a small
//! number.

use crate::geometry::DVec2;

/// A set of sums Σ a_k ζ^k / d over the powers of a root of unity ζ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lattice {
    /// Gaussian numbers, ζ = i.
    Fourth,
    /// Eisenstein numbers.
    Sixth,
    /// ζ of 45 degrees.
    Eighth,
    /// ζ of 36 degrees.
    Tenth,
    /// ζ of 30 degrees.
    Twelfth,
}

impl Lattice {
    pub(super) const ALL: [Self; 5] = [
        Self::Fourth,
        Self::Sixth,
        Self::Eighth,
        Self::Tenth,
        Self::Twelfth,
    ];

    /// Returns the step of the angles of maps, in degrees.
    pub(super) fn angle(self) -> f64 {
        match self {
            Self::Fourth | Self::Eighth => 45.0,
            Self::Sixth | Self::Twelfth => 30.0,
            Self::Tenth => 36.0,
        }
    }

    /// Returns the number of powers that are independent, their angle in degrees, the denominators, and the largest
    /// value of a sum.
    fn shape(self) -> (usize, f64, &'static [u8], i32) {
        match self {
            Self::Fourth => (2, 90.0, &[1, 2, 3, 4, 5, 6, 8, 9, 10, 12], 2),
            Self::Sixth => (2, 60.0, &[1, 2, 3, 4, 6, 7, 9, 12], 2),
            Self::Eighth => (4, 45.0, &[1, 2], 1),
            Self::Tenth => (4, 36.0, &[1], 3),
            Self::Twelfth => (4, 30.0, &[1, 2, 3], 1),
        }
    }

    /// Returns the numbers with their complexity, the simplest first.
    pub(super) fn numbers(self) -> Vec<(DVec2, usize)> {
        let (powers, angle, denominators, most) = self.shape();
        let roots: Vec<DVec2> = (0..4)
            .map(|power| {
                let angle = (f64::from(power) * angle).to_radians();
                DVec2::new(libm::cos(angle), libm::sin(angle))
            })
            .collect();
        let mut numbers: Vec<(DVec2, usize)> = Vec::new();
        for &denominator in denominators {
            let limit = most * i32::from(denominator);
            let range = |is_used: bool| if is_used { -limit..=limit } else { 0..=0 };
            for a in range(true) {
                for b in range(true) {
                    for c in range(powers > 2) {
                        for d in range(powers > 2) {
                            let pairs = [a, b, c, d].into_iter().zip(&roots);
                            let sum: DVec2 = pairs.map(|(k, &root)| f64::from(k) * root).sum();
                            let terms = [a, b, c, d].map(i32::unsigned_abs).iter().sum::<u32>();
                            let size = usize::from(denominator) * usize::from(denominator);
                            let complexity = size * 3 + terms as usize;
                            let number = sum / f64::from(denominator);
                            if number.length() <= 3.0 {
                                numbers.push((number, complexity));
                            }
                        }
                    }
                }
            }
        }
        numbers.sort_by_key(|number| number.1);
        numbers
    }
}
