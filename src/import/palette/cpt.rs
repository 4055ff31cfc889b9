//! Colour palette tables of the Generic Mapping Tools (GMT).

use super::{PaletteError, byte, channels, check, lines, sampled, some, wrong};
use crate::style::Colour;

/// Reads the colours of a table, from its least to its largest value.
pub(super) fn read(text: &str) -> Result<Vec<Colour>, PaletteError> {
    let mut models = text.lines().filter_map(|line| {
        let model = line.trim_start().strip_prefix('#')?.trim_start();
        let model = model.strip_prefix("COLOR_MODEL")?;
        Some(model.trim_start_matches([' ', '=']).trim_end())
    });
    // With a plus, colours between the ends of an interval are interpolated in HSV, too.
    let model = models.find(|it| it.trim_start_matches('+').eq_ignore_ascii_case("hsv"));
    let (is_hsv, is_between) = (model.is_some(), model.is_some_and(|it| it.starts_with('+')));
    let mut stops: Vec<(f64, [f64; 3])> = Vec::new();
    for (number, line) in coloured_lines(text) {
        let words: Vec<_> = line.split_whitespace().collect();
        // Colours of what lies outside, and of missing values.
        if matches!(words[0], "B" | "F" | "N") {
            continue;
        }
        let words = match words.last() {
            Some(&("L" | "U" | "B")) => &words[..words.len() - 1],
            _ => &words[..],
        };
        let half = words.len() / 2;
        if !matches!(words.len(), 4 | 8) {
            let message = "expected two values, each with its colour: '0 0 0 0 1 255 255 255' or '0 red 1 blue'";
            return Err(wrong(number, message));
        }
        let mut ends = Vec::new();
        for part in [&words[..half], &words[half..]] {
            let value = part[0].parse::<f64>().ok().filter(|it| it.is_finite());
            let value =
                value.ok_or_else(|| wrong(number, format!("'{}' is no number", part[0])))?;
            let colour = colour(&part[1..], is_hsv)
                .ok_or_else(|| wrong(number, format!("'{}' is no colour", part[1..].join(" "))))?;
            ends.push((value, colour));
        }
        if ends[0].0 >= ends[1].0 || stops.last().is_some_and(|last| last.0 > ends[0].0) {
            let message = "an interval ends after it begins, and begins where the one before ends";
            return Err(wrong(number, message));
        }
        match is_between
            .then(|| between(&words[..half], &words[half..]))
            .flatten()
        {
            Some(colours) => {
                let (from, to) = (ends[0].0, ends[1].0);
                let shares = (0..=PARTS).map(|part| f64::from(part) / f64::from(PARTS));
                stops.extend(
                    shares
                        .zip(colours)
                        .map(|(share, it)| (from + share * (to - from), it)),
                );
            }
            None => stops.extend(ends),
        }
        check(number, stops.len())?;
    }
    Ok(sampled(&some(stops)?))
}

/// Iterates over the lines without comments, with their numbers, without empty ones. A `#` within a line begins a colour.
fn coloured_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_table: std::collections::BTreeSet<_> = lines(text).map(|(number, _)| number).collect();
    let all = (1..).zip(text.lines());
    let all = all.filter(move |(number, _)| is_table.contains(number));
    all.map(|(number, line)| (number, line.split(';').next().unwrap_or("").trim()))
}

/// Number of parts of an interval whose colours are interpolated in HSV.
const PARTS: u32 = 24;

/// Returns the colours of the parts of an interval, whose ends are in HSV.
fn between(from: &[&str], to: &[&str]) -> Option<Vec<[f64; 3]>> {
    let [from, to] = [from, to].map(|words| {
        let words: Vec<&str> = match words[1..] {
            [word] => word.split(['/', '-']).collect(),
            _ => words[1..].to_vec(),
        };
        let [hue, saturation, value] = words[..] else {
            return None;
        };
        let parts = [hue, saturation, value].map(|it| it.parse::<f64>().ok());
        Some([parts[0]?, parts[1]?, parts[2]?])
    });
    let (from, to) = (from?, to?);
    let shares = (0..=PARTS).map(|part| f64::from(part) / f64::from(PARTS));
    let mixed = |share: f64| [0, 1, 2].map(|at| from[at] + share * (to[at] - from[at]));
    shares.map(|share| of_hsv(mixed(share))).collect()
}

/// Returns a colour of one word or of three numbers, from 0 to 255.
fn colour(words: &[&str], is_hsv: bool) -> Option<[f64; 3]> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|it| it.is_finite());
    let triple = |words: &[&str]| {
        let mut words = words.iter();
        channels(|| number(words.next()?))
    };
    let rgb = |values: [f64; 3]| match is_hsv {
        true => of_hsv(values),
        false => Some(values),
    };
    let in_range = |rgb: &[f64; 3]| rgb.iter().all(|it| (0.0..=255.0).contains(it));
    let found = match *words {
        [word] if word.contains('/') => {
            let parts: Vec<_> = word.split('/').collect();
            (parts.len() == 3).then(|| triple(&parts))?.and_then(rgb)
        }
        [word] if !word.starts_with('#') && word.split('-').count() == 3 => {
            let parts: Vec<_> = word.split('-').collect();
            triple(&parts).and_then(of_hsv)
        }
        [word] => match number(word) {
            Some(grey) => Some([grey; 3]),
            None => {
                let [red, green, blue, _] = Colour::parse(word)?.rgba();
                Some([red, green, blue].map(f64::from))
            }
        },
        _ => triple(words).and_then(rgb),
    };
    found.filter(in_range)
}

/// Returns red, green and blue from 0 to 255, from the hue in degrees, saturation and value from 0 to 1.
fn of_hsv([hue, saturation, value]: [f64; 3]) -> Option<[f64; 3]> {
    let is_share = |it: f64| (0.0..=1.0).contains(&it);
    if !(is_share(saturation) && is_share(value)) {
        return None;
    }
    Some([5.0, 3.0, 1.0].map(|at: f64| {
        let k = (at + hue / 60.0).rem_euclid(6.0);
        let share = value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0);
        f64::from(byte(255.0 * share))
    }))
}

#[cfg(test)]
mod tests {
    use super::of_hsv;

    #[test]
    fn colours_between_the_ends_are_those_of_the_model() {
        let hues = |model: &str| {
            let text = format!("# COLOR_MODEL = {model}\n0 300 1 1 1 0 1 1\n");
            let colours = super::read(&text).unwrap();
            [1, 2, 3, 4].map(|fifth| colours[fifth * (colours.len() - 1) / 5].rgba())
        };
        for (found, [red, green, blue]) in
            hues("+HSV")
                .iter()
                .zip([[0, 0, 255], [0, 255, 255], [0, 255, 0], [255, 255, 0]])
        {
            let near = |at: usize, value: u8| found[at].abs_diff(value) < 16;
            assert!(near(0, red) && near(1, green) && near(2, blue), "{found:?}");
        }
        assert!(hues("HSV").iter().all(|it| it[0] == 255 && it[1] == 0));
    }

    #[test]
    fn hues_are_colours() {
        for (hsv, rgb) in [
            ([0.0, 1.0, 1.0], [255.0, 0.0, 0.0]),
            ([60.0, 1.0, 1.0], [255.0, 255.0, 0.0]),
            ([120.0, 1.0, 0.5], [0.0, 128.0, 0.0]),
            ([240.0, 1.0, 1.0], [0.0, 0.0, 255.0]),
            ([300.0, 0.0, 0.2], [51.0; 3]),
        ] {
            assert_eq!(of_hsv(hsv), Some(rgb));
        }
    }
}
