//! Systems of maps in files of numbers: a row a, b, c, d, e, f, p for each map.

use crate::geometry::DAffine2;

use super::maps::{Drawable, WeightedMap};

/// Largest number of maps.
const MAX_MAPS: usize = 256;

/// Reads the rows of a system.
///
/// # Errors
///
/// Returns the number of the line, from 1, and what is wrong with it.
pub(super) fn read(text: &str) -> Result<Vec<WeightedMap>, (usize, String)> {
    let mut maps = Vec::new();
    for (number, line) in text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
    {
        let wrong = |message: String| (number + 1, message);
        let values = line.split(',').map(|value| value.trim().parse::<f64>());
        let values: Result<Vec<f64>, _> = values.collect();
        let values = values.map_err(|_| wrong("a value is no number".into()))?;
        let count = values.len();
        let row: [f64; 7] = values.try_into().map_err(|_| {
            wrong(format!(
                "a row has 7 numbers, a, b, c, d, e, f and p, not {count}"
            ))
        })?;
        if !row.iter().all(|value| value.is_finite()) || row[6] < 0.0 {
            return Err(wrong("numbers are finite, and p is not negative".into()));
        }
        if maps.len() == MAX_MAPS {
            return Err(wrong(format!("a system has at most {MAX_MAPS} maps")));
        }
        maps.push(WeightedMap::new(
            DAffine2::of_coefficients(&row[..6]),
            row[6],
        ));
    }
    if maps.iter().all(|map| map.weight == 0.0) {
        return Err((1, "there is no map with a weight".into()));
    }
    Ok(maps)
}

#[cfg(test)]
mod tests {
    use super::read;
    use crate::dataset::Maps;

    #[test]
    fn rows_are_maps() {
        let maps = read("0.5,0,0,0.5,0,0,0.25\n\n 1e-1, 2, 3, 4, 5, 6, 7 \r\n").unwrap();
        assert_eq!(
            Maps::Plane(maps).rows(),
            [
                [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.25],
                [0.1, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
            ]
        );
    }

    #[test]
    fn mistakes_have_their_lines() {
        let line = |text| read(text).unwrap_err().0;
        assert_eq!(line("1,2,3,4,5,6,7\n1,2,3"), 2);
        assert_eq!(line("\n1,2,3,4,5,6,x"), 2);
        assert_eq!(line("1,2,3,4,5,6,-7"), 1);
        assert_eq!(line("1,2,3,4,5,inf,7"), 1);
        assert_eq!(line(""), 1);
    }
}
