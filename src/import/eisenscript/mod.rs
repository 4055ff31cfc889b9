//! EisenScript, the language of Structure Synth by M. Hvidtfeldt Christensen (`.es`).
//!
//! Rules call each other and primitives under transformations of the unit cube, `rule r md 10 { { x 1 rz 5 } r box }`, in
//! loops such as `10 * { x 1 }`. x points to the right, y up and z towards the viewer, and angles turn by the right-hand rule,
//! as in kfrac. Turns, scalings and reflections are about the centre of the cube. The language is described on the pages of
//! Structure Synth; where they are silent, its sources are followed.
//!
//! A program becomes a structure in space with an object for each rule. Calls are counted by levels: those that `md` leaves, or
//! the generations that `maxdepth` and `maxobjects` leave, as derived by [`derive`]. Alternatives with weights are drawn here,
//! once. [`colour`] has the changes of colours, whose spaces differ.

mod colour;
mod derive;
mod lex;
mod loops;
mod mesh;
mod motion;
mod parse;
mod program;
mod write;

use std::path::Path;
use std::sync::Arc;

use crate::build::written::Entries;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::random::{Pcg, mix};

use super::Imported;
use super::document::{Heading, file_of};
use colour::{Changes, Factors, hsv};
use derive::{Derivation, End};
use program::{Alternative, Loop, Primitive, Program, Target};

/// Reads a program as one entry with the name of its file; a text without words has no entries.
pub(super) fn read(source: &Arc<Source>) -> (Vec<Imported>, Diagnostics) {
    let stem = file_of(source).and_then(Path::file_stem);
    let stem = stem.map_or_else(|| "program".into(), |stem| stem.to_string_lossy());
    let mut found = Diagnostics::default();
    let seed = seed_of(source.text());
    let words = lex::words(source, Pcg::new(mix(seed), 1), &mut found);
    let place = words.first().map(|word| word.place.clone());
    let first = found.iter().next().and_then(Diagnostic::place).cloned();
    let Some(place) = place.or(first) else {
        return (Vec::new(), Diagnostics::default());
    };
    let program = parse::program(&words, Pcg::new(mix(seed), 2), &mut found);
    let program = program.filter(|_| !found.has_errors());
    let own = program.and_then(|program| converted(&program, &place, &mut found));
    let heading = Heading {
        name: &stem,
        place: &place,
        about: "",
        origin: "for Structure Synth",
    };
    (vec![heading.imported(own, found)], Diagnostics::default())
}

/// Returns the seed that a text sets, or 0.
fn seed_of(text: &str) -> u64 {
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut settings = words
        .windows(3)
        .rev()
        .filter(|it| it[0].eq_ignore_ascii_case("set") && it[1].eq_ignore_ascii_case("seed"));
    settings
        .find_map(|it| it[2].parse::<i32>().ok())
        .map_or(0, |seed| seed.unsigned_abs().into())
}

fn converted(program: &Program, place: &Place, found: &mut Diagnostics) -> Option<Entries> {
    let too_large = "this program is too large";
    let large = || Diagnostic::error(too_large).at(place);
    let large = || large().hint("`set maxdepth` and `md` limit it");
    let mut derivation = Derivation::new(program, Pcg::new(mix(program.settings.seed), 3));
    let Ok(end) = derivation.build() else {
        found.push(large());
        return None;
    };
    let (generations, message) = match end {
        End::Complete => (None, None),
        End::Generations(generations) => (Some(generations), None),
        End::Objects(generations) => {
            let most = program.settings.objects;
            let message = format!(
                "`maxobjects`, {most}, ends the construction after generation {generations}"
            );
            (Some(generations), Some(message))
        }
        End::Draws(generations) => {
            let message = format!("after generation {generations}, more draws are too large");
            (Some(generations), Some(message))
        }
    };
    found.extend(message.map(|message| Diagnostic::warning(message).at(place)));
    for rule in &derivation.drawn {
        let rule = &program.rules[*rule];
        let place = &program.alternatives[rule.alternatives[0]].place;
        let count = rule.alternatives.len();
        let message = format!(
            "the {count} alternatives of '{}' are drawn here, once",
            rule.name
        );
        let drawn = Diagnostic::warning(message).at(place);
        found.push(drawn.hint("`set seed` draws others"));
    }
    check(program, found);
    match write::structure(&mut derivation, generations) {
        Ok(Some(entries)) => return Some(entries),
        Ok(None) => found.push(Diagnostic::error("this program draws nothing").at(place)),
        Err(derive::TooLarge) => found.push(large()),
    }
    None
}

/// Warns of what is drawn otherwise.
fn check(program: &Program, found: &mut Diagnostics) {
    let reached = program.reached([program::TOP]);
    let all = program.alternatives.iter().zip(&reached);
    let actions = || {
        let reached = all.clone().filter(|(_, is_reached)| **is_reached);
        reached.flat_map(|(alternative, _)| &alternative.actions)
    };
    let loops = || actions().flat_map(|action| &action.loops);
    let mut changes = Changes::default();
    loops().for_each(|it| changes.add(&it.colouring));
    changes.check(found);
    // Changes of colours that an absolute colour does not end here; greys have no hue that changes.
    let drifting = { actions() }.filter(|it| it.loops.iter().any(|it| it.colouring.tints()));
    let turns =
        |it: &Loop| it.colouring.blend.is_none() && it.colouring.factors == Factors::default();
    let only_turn = { drifting.clone() }.all(|action| action.loops.iter().all(turns));
    let drifting =
        drifting.flat_map(|action| program.alternatives_of(action.target).iter().copied());
    let below = program.reached(drifting);
    for (alternative, _) in program.alternatives.iter().zip(below).filter(|(_, it)| *it) {
        let loops = alternative.actions.iter().flat_map(|action| &action.loops);
        for it in loops {
            let changes = |colour| !only_turn || hsv(colour)[1] > 0.0;
            if it.colouring.absolute.is_some_and(changes)
                && let Some(place) = it.colouring.places.first()
            {
                let message = "this colour goes on changing with those of its surroundings";
                found.push(Diagnostic::warning(message).at(place));
            }
        }
    }
    let sphere = Target::Primitive(Primitive::Sphere);
    let has_sphere = |alternative: &Alternative| {
        let targets = alternative.actions.iter().map(|action| action.target);
        targets.chain(alternative.successor).any(|it| it == sphere)
    };
    let has_sphere: Vec<_> = program.alternatives.iter().map(has_sphere).collect();
    if !has_sphere.contains(&true) {
        return;
    }
    let leads = |alternative| {
        let below = program.reached([alternative]);
        below.iter().zip(&has_sphere).any(|(a, b)| *a && *b)
    };
    let leads: Vec<_> = (0..program.alternatives.len()).map(leads).collect();
    let stretched = { actions() }.find(|action| {
        let mut below = program.alternatives_of(action.target).iter();
        !action.loops.iter().all(|it| it.motion.is_similarity())
            && (action.target == sphere || below.any(|it| leads[*it]))
    });
    if let Some(action) = stretched {
        let message = "spheres become ellipsoids where they are scaled unequally";
        found.push(Diagnostic::warning(message).at(&action.place));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
