//! Plain strings: chains of lines of one length.
//!
//! A line that is traversed backwards, or that is mirrored, is another symbol: its production is the same
//! chain backwards, or with all turns inverted.

use crate::build::written::Entries;
use crate::document::node::Value;
use crate::geometry::DVec2;

use super::super::number;
use super::super::structure::{PlacedObject, Structure};
use super::{degrees, letter, letter_of, turn};

/// Relative tolerance of comparisons.
const ROUNDING: f64 = 1e-9;

/// Limit of the number of parts of a turn.
const MAX_PARTS: i32 = 360;

/// A symbol: the object that replaces a line, and the traversal of the line.
#[derive(Clone, Copy, PartialEq)]
struct Symbol {
    object: usize,
    backwards: bool,
    mirrored: bool,
}

/// A line of a chain in order of traversal: its vector and its symbol.
struct ChainLine {
    along: DVec2,
    symbol: Symbol,
}

pub(super) fn write(structure: &Structure) -> Option<Entries> {
    let scene = chain(&structure.scene, None)?;
    let frame = Some([DVec2::ZERO, DVec2::X]);
    let chains: Option<Vec<_>> = { &structure.objects }
        .iter()
        .map(|object| chain(object, frame))
        .collect();
    let chains = chains?;
    let all_lines = structure
        .instances()
        .all(|placed| placed.visible && structure.shapes[placed.shape].is_line());
    let equal = |lines: &[ChainLine], length: f64| {
        { lines.iter() }.all(|line| (line.along.length() - length).abs() <= ROUNDING * length)
    };
    let length = chains.first()?.first()?.along.length();
    let first = scene.first()?.along;
    let all_equal =
        equal(&scene, first.length()) && chains.iter().all(|lines| equal(lines, length));
    if !all_lines || !all_equal {
        return None;
    }
    // The turtle starts at the origin, along the first line of the scene.
    if !starts_at_origin(&structure.scene, &scene) {
        return None;
    }
    let turns = |lines: &[ChainLine], start: DVec2| -> Vec<f64> {
        let turned = lines.iter().map(|line| turn(start, line.along));
        turned.map(|angle| angle / std::f64::consts::TAU).collect()
    };
    let scene_turns = turns(&scene, first);
    let mut all: Vec<Vec<f64>> = chains.iter().map(|lines| turns(lines, DVec2::X)).collect();
    // Strings may begin along their first line if all of them turn by the same angle at first.
    let offset = all[0][0];
    let shifted: Vec<Vec<f64>> = all
        .iter()
        .map(|turns| turns.iter().map(|turn| turn - offset).collect())
        .collect();
    let any_mirrored =
        { scene.iter().chain(chains.iter().flatten()) }.any(|line| line.symbol.mirrored);
    let of = |all: &[Vec<f64>]| parts(all.iter().flatten().chain(&scene_turns).copied());
    let parts = match (of(&all), of(&shifted).filter(|_| !any_mirrored)) {
        (Some(plain), Some(turned)) if plain <= turned => plain,
        (_, Some(turned)) => {
            all = shifted;
            turned
        }
        (plain, None) => plain?,
    };
    let mut writer = Writer {
        parts,
        symbols: scene.first().map(|line| line.symbol).into_iter().collect(),
    };
    let plain = Symbol {
        object: 0,
        backwards: false,
        mirrored: false,
    };
    let axiom = writer.string(&scene, &scene_turns, plain)?;
    // The final heading does not matter in the axiom.
    let axiom = axiom.trim_end_matches(['+', '-']).to_owned();
    let mut productions = Entries::default();
    let mut done = 0;
    while let Some(&symbol) = writer.symbols.get(done) {
        let string = writer.string(&chains[symbol.object], &all[symbol.object], symbol)?;
        productions = productions.add(letter(done).ok()?, Value::Text(string));
        done += 1;
    }
    // F draws by default.
    let drawn = (1..done).try_fold(Entries::default(), |entries, number| {
        Some(entries.add(letter(number).ok()?, Value::Text("draw".into())))
    })?;
    let heading = degrees(DVec2::X, first);
    let starts = (heading != 0.0).then(|| number::value(heading));
    let longer = (first.length() - 1.0).abs() > ROUNDING;
    Some(
        Entries::default()
            .set("angle", Value::Text(format!("360/{parts}")))
            .set_some("heading", starts)
            .set_some("length", longer.then(|| number::value(first.length())))
            .set("axiom", Value::Text(axiom))
            .set("productions", productions.value())
            .set_some("symbols", (!drawn.is_empty()).then(|| drawn.value())),
    )
}

/// Returns instances as a chain that starts and ends at `ends`, if given; `None` if they form no chain.
fn chain(placed: &[PlacedObject], ends: Option<[DVec2; 2]>) -> Option<Vec<ChainLine>> {
    let near = |a: DVec2, b: DVec2, size: f64| (a - b).length() <= ROUNDING * size;
    let ways = [false, true].map(|backwards| {
        let mut at: Option<DVec2> = ends.map(|[start, _]| start);
        let mut lines = Vec::new();
        for (number, placed) in placed.iter().enumerate() {
            let (from, to) = (
                placed.map.translation,
                placed.map.transform_point2(DVec2::X),
            );
            let size = (to - from).length();
            let follows = |point: DVec2| at.is_none_or(|at| near(at, point, size));
            // Without a given start, the first line may be traversed either way.
            let backwards = match (at, follows(from), follows(to)) {
                (None, ..) => number == 0 && backwards,
                (_, true, _) => false,
                (_, _, true) => true,
                _ => return None,
            };
            let (from, to) = if backwards { (to, from) } else { (from, to) };
            at = Some(to);
            lines.push(ChainLine {
                along: to - from,
                symbol: Symbol {
                    object: placed.object?,
                    backwards,
                    mirrored: placed.map.matrix2.determinant() < 0.0,
                },
            });
        }
        let arrives = ends.is_none_or(|[_, end]| at.is_some_and(|at| near(at, end, 1.0)));
        arrives.then_some(lines)
    });
    ways.into_iter().flatten().next()
}

/// Returns whether the first line of a chain starts at the origin.
fn starts_at_origin(placed: &[PlacedObject], chain: &[ChainLine]) -> bool {
    let (Some(placed), Some(line)) = (placed.first(), chain.first()) else {
        return false;
    };
    let end = if line.symbol.backwards {
        DVec2::X
    } else {
        DVec2::ZERO
    };
    placed.map.transform_point2(end).length() <= ROUNDING
}

/// Returns the least number of parts of a turn, from 3, of which all turns are multiples.
fn parts(turns: impl Iterator<Item = f64> + Clone) -> Option<i32> {
    (3..=MAX_PARTS).find(|&parts| {
        turns.clone().all(|turn| {
            let units = turn * f64::from(parts);
            (units - units.round()).abs() <= ROUNDING
        })
    })
}

struct Writer {
    parts: i32,
    /// Symbols met so far, in the order of their letters.
    symbols: Vec<Symbol>,
}

impl Writer {
    /// Returns the string of a chain for a symbol that traverses it.
    fn string(&mut self, lines: &[ChainLine], turns: &[f64], of: Symbol) -> Option<String> {
        let mut string = String::new();
        let mut heading = 0;
        let numbers: Vec<usize> = if of.backwards {
            (0..lines.len()).rev().collect()
        } else {
            (0..lines.len()).collect()
        };
        for number in numbers {
            #[expect(clippy::cast_possible_truncation, reason = "there are few parts")]
            let units = (turns[number] * f64::from(self.parts)).round() as i32;
            let wanted = if of.mirrored { -units } else { units };
            self.turn(&mut string, wanted - heading);
            heading = wanted;
            let inner = lines[number].symbol;
            let symbol = Symbol {
                object: inner.object,
                backwards: inner.backwards != of.backwards,
                mirrored: inner.mirrored != of.mirrored,
            };
            string.push(letter_of(&mut self.symbols, symbol).ok()?);
        }
        self.turn(&mut string, -heading);
        Some(string)
    }

    /// Appends a turn in the shorter direction.
    fn turn(&self, string: &mut String, units: i32) {
        let left = units.rem_euclid(self.parts);
        let right = self.parts - left;
        let (turn, count) = if left <= right {
            ("+", left)
        } else {
            ("-", right)
        };
        string.push_str(&turn.repeat(usize::try_from(count).unwrap_or_default()));
    }
}
