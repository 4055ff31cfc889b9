//! Variations of a system: the pictures of a category.

use crate::diagnostic::Diagnostic;
use crate::draws::Path;

use super::maps::{Attractor, Drawable, WeightedMap};
use super::random::uniform;

/// Number of halvings of a variation whose walks diverge, before it is given up.
const HALVINGS: u32 = 8;

/// Factors of the coefficients of maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Weights {
    /// No variation.
    #[default]
    None,
    /// One coefficient of all maps at a time, times 1 − 2s, 1 − s, 1 + s or 1 + 2s, and none: 25 variations in the plane, or 49 in
    /// space, that follow each other (Kataoka et al. 2020, with s = 0.4).
    Steps(f64),
    /// Every coefficient of every map, by a factor uniform from 1 − s to 1 + s.
    Jitter(f64),
}

impl Weights {
    /// Reads `none`, `fractaldb`, `fractaldb(step)` or `jitter(spread)`.
    ///
    /// # Errors
    ///
    /// Returns a message if the text is none of these, or the number lies outside 0 to 1.
    pub fn parse(text: &str) -> Result<Self, Diagnostic> {
        let wrong = || {
            Diagnostic::error(format!("'{text}' is no variation of systems")).hint(
                "none, fractaldb, fractaldb(0.4) or jitter(0.1), with a number above 0, up to 1",
            )
        };
        let (name, number) = match text.trim().split_once('(') {
            Some((name, rest)) => {
                let number = rest.strip_suffix(')').ok_or_else(wrong)?;
                let number: f64 = number.trim().parse().map_err(|_| wrong())?;
                if !(number > 0.0 && number <= 1.0) {
                    return Err(wrong());
                }
                (name.trim(), Some(number))
            }
            None => (text.trim(), None),
        };
        match (name, number) {
            ("none", None) => Ok(Self::None),
            ("fractaldb", step) => Ok(Self::Steps(step.unwrap_or(0.4))),
            ("jitter", Some(spread)) => Ok(Self::Jitter(spread)),
            _ => Err(wrong()),
        }
    }

    /// Returns the number of variations after which they repeat, if they do, for maps with a number of coefficients.
    pub(super) fn period(self, coefficients: usize) -> usize {
        match self {
            Self::Steps(_) => 1 + FACTORS.len() * coefficients,
            _ => 1,
        }
    }

    /// Returns a varied system and its attractor, as it is `seen`. A variation whose walks diverge is taken nearer to none, by
    /// halves.
    pub(super) fn vary<M: Drawable>(
        self,
        maps: &[WeightedMap<M>],
        variation: u32,
        path: Path,
        seen: M,
    ) -> Option<(Vec<WeightedMap<M>>, Attractor<M>)> {
        let factors = self.factors(maps.len(), M::COEFFICIENTS, variation, path);
        let mut share = 1.0;
        for _ in 0..=HALVINGS {
            let varied: Vec<_> = { maps.iter().zip(&factors) }
                .map(|(map, factors)| {
                    let mut row = map.map.coefficients();
                    for (value, factor) in row.iter_mut().zip(factors) {
                        *value *= 1.0 + share * (factor - 1.0);
                    }
                    WeightedMap::new(M::of_coefficients(&row), map.weight)
                })
                .collect();
            if let Some(attractor) = Attractor::of(&varied, seen) {
                return Some((varied, attractor));
            }
            share /= 2.0;
        }
        Some((maps.to_vec(), Attractor::of(maps, seen)?))
    }

    /// Returns the factors of the coefficients for every map.
    fn factors(
        self,
        maps: usize,
        coefficients: usize,
        variation: u32,
        path: Path,
    ) -> Vec<Vec<f64>> {
        match self {
            Self::None => vec![vec![1.0; coefficients]; maps],
            Self::Steps(step) => {
                let variation = variation as usize % self.period(coefficients);
                vec![steps(coefficients, variation, step); maps]
            }
            Self::Jitter(spread) => {
                let mut random = path.random("weights");
                let mut factor = || uniform(&mut random, 1.0 - spread, 1.0 + spread);
                let mut factors = || (0..coefficients).map(|_| factor()).collect();
                (0..maps).map(|_| factors()).collect()
            }
        }
    }
}

/// Steps by which a coefficient is changed.
const FACTORS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

/// Returns the factors of a variation from 0 on: none first, then each coefficient in turn.
fn steps(coefficients: usize, variation: usize, step: f64) -> Vec<f64> {
    let mut factors = vec![1.0; coefficients];
    if let Some(changed) = variation.checked_sub(1) {
        let by = FACTORS[changed % FACTORS.len()];
        factors[changed / FACTORS.len()] = 1.0 + by * step;
    }
    factors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::maps::weighted;
    use crate::dataset::random::{anderson, by_coefficients};
    use crate::geometry::DAffine2;
    use crate::random::Pcg;

    #[test]
    fn variations_are_read() {
        let read = |text| Weights::parse(text).ok();
        assert_eq!(read("none"), Some(Weights::None));
        assert_eq!(read("fractaldb"), Some(Weights::Steps(0.4)));
        assert_eq!(read(" fractaldb( 0.1 )"), Some(Weights::Steps(0.1)));
        assert_eq!(read("jitter(0.2)"), Some(Weights::Jitter(0.2)));
        for wrong in [
            "",
            "jitter",
            "jitter(2)",
            "jitter(-1)",
            "jitter(0.1",
            "more(1)",
            "none(1)",
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn steps_change_one_coefficient() {
        let all: Vec<_> = (0..25).map(|it| steps(6, it, 0.4)).collect();
        assert_eq!(all[0], [1.0; 6]);
        let changed = |factors: &Vec<f64>| factors.iter().filter(|it| **it != 1.0).count();
        assert!(all[1..].iter().all(|factors| changed(factors) == 1));
        let mut values: Vec<_> = all[1..5].iter().map(|factors| factors[0]).collect();
        values.sort_by(f64::total_cmp);
        for (value, expected) in values.iter().zip([0.2, 0.6, 1.4, 1.8]) {
            assert!((value - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn varied_systems_can_be_drawn() {
        let mut random = Pcg::new(1, 1);
        let whole = DAffine2::IDENTITY;
        for round in 0..20 {
            let maps = weighted(anderson(&mut random, 2 + round % 6));
            for instance in 0..25 {
                let path = Path::of_seed(instance.into());
                let (varied, _) = Weights::Steps(0.4)
                    .vary(&maps, instance, path, whole)
                    .unwrap();
                assert_eq!(varied.len(), maps.len());
                let (jittered, _) = Weights::Jitter(0.1)
                    .vary(&maps, instance, path, whole)
                    .unwrap();
                for (one, other) in jittered.iter().zip(&maps) {
                    let [one, other] = [one, other].map(|it| it.map.coefficients());
                    for (a, b) in one.iter().zip(other) {
                        assert!((a - b).abs() <= 0.1 * b.abs() + 1e-15);
                    }
                }
            }
        }
        // Some of these diverge, and are never drawn.
        let drawn = (0..200).filter(|_| {
            let maps: Vec<DAffine2> = by_coefficients(&mut random, 3);
            Attractor::of(&weighted(maps), whole).is_some()
        });
        assert!((1..200).contains(&drawn.count()));
    }
}
