//! Work of compiling an L-system to a graph, counted before it is done.

use crate::graph::CompileError;
use crate::lsystem::{LSystem, RewriteError, Symbol};

use super::NotCompiled;
use super::kinds::{Kinds, MAX_KINDS};

/// Limit of the work of a graph: the number of modules in the words of all kinds at all steps. The library has systems of
/// some 770,000.
pub(super) const MAX_WORK: u64 = 1 << 21;

/// Limit of the same work for a few steps of which one graph may describe all: the longest words at four steps.
pub(super) const MAX_CLOSED_WORK: u64 = 1 << 19;

/// Limit of the number of modules of the words that replace objects, once for every colour and width that they inherit.
pub(super) const MAX_INHERITED: u64 = MAX_WORK;

/// Number of modules that a word counts beside its own, for the object that it replaces.
pub(super) const OBJECT: u64 = 4;

/// Number of kinds that are not replaced, at some step, which count as a module.
const KEPT: u64 = 8;

/// Returns the number of modules that the words of all kinds hold at all numbers of steps up to `steps`. A module with
/// several actions counts as so many.
pub(super) fn work(words: &LSystem, kinds: &Kinds, steps: u32) -> u64 {
    let actions = |symbol: &Symbol| symbol.meaning.len().max(1) as u64;
    let symbols = words.symbols();
    let length = |word: &[usize]| -> u64 {
        let actions = word
            .iter()
            .map(|&kind| actions(&symbols[kinds.all[kind].symbol]));
        actions.sum()
    };
    let mut work = length(&kinds.axiom).saturating_mul(u64::from(steps) + 1);
    for kind in kinds.all.iter().filter(|kind| kind.is_fertile()) {
        let alternatives = kind.alternatives.iter();
        let modules: u64 = { alternatives }.map(|it| OBJECT + length(&it.word)).sum();
        let levels = steps.saturating_sub(kind.born).into();
        work = work.saturating_add(modules.saturating_mul(levels));
    }
    let kept = (kinds.all.len() as u64).saturating_mul(steps.into()) / KEPT;
    work.saturating_add(kept)
}

/// Returns the work of the graph of a system for some steps, if it is more than the limit.
pub(super) fn excess(words: &LSystem, steps: u32) -> Option<u64> {
    let kinds = Kinds::of(words, steps, MAX_KINDS).ok()?;
    Some(work(words, &kinds, steps)).filter(|work| *work > MAX_WORK)
}

/// Halves a number of steps until the graph takes at most an eighth of the limit, or one step is left. Systems of too many kinds
/// keep theirs.
pub(super) fn soon(words: &LSystem, steps: u32) -> u32 {
    let is_large = |steps| match Kinds::of(words, steps, MAX_KINDS) {
        Ok(kinds) => work(words, &kinds, steps) > MAX_WORK / 8,
        Err(_) => false,
    };
    let mut soon = steps;
    while soon > 1 && is_large(soon) {
        soon /= 2;
    }
    soon
}

/// Returns the error of a graph that is too large, whose word cannot be derived instead.
pub(super) fn large(words: &LSystem, steps: u32, work: u64, word: RewriteError) -> CompileError {
    // The work grows with the steps, at least in proportion but for the axiom.
    let part = u64::from(steps) * MAX_WORK / work.max(1);
    let mut fits = u32::try_from(part).unwrap_or(steps).min(steps);
    while fits > 0 && excess(words, fits).is_some() {
        fits -= fits / 8 + 1;
    }
    CompileError::LargeGraph {
        steps,
        work,
        most: MAX_WORK,
        fits,
        word,
    }
}

/// [Work](crate::work) of a module whose effect is found.
const MODULE: usize = 16;

/// Limit of the work of a graph whose displacements are summed in big integers: in modules of [`SHORT`] bits.
const MAX_LONG: u64 = 1 << 21;

/// Number of bits in which adding a displacement takes as long as reading a module.
const SHORT: u64 = 512;

/// Checks that the work of summing displacements in a number of bits is not more than the limit.
pub(super) fn check_long(
    words: &LSystem,
    kinds: &Kinds,
    steps: u32,
    bits: Option<usize>,
) -> Result<(), NotCompiled> {
    let times = bits.map_or(0, |bits| bits as u64 / SHORT + 1);
    match work(words, kinds, steps).saturating_mul(times) <= MAX_LONG {
        true => Ok(()),
        false => Err(NotCompiled),
    }
}

/// Adds modules to those before, and checks that they are not more than a limit.
pub(super) fn spend(spent: &mut u64, by: u64, most: u64) -> Result<(), NotCompiled> {
    *spent = spent.saturating_add(by);
    match *spent <= most {
        true => Ok(()),
        false => Err(NotCompiled),
    }
}

/// Checks that the work of effects is not more than a limit.
pub(super) fn check(
    words: &LSystem,
    kinds: &Kinds,
    steps: u32,
    most: u64,
) -> Result<(), NotCompiled> {
    let modules = work(words, kinds, steps);
    match modules <= most {
        true => {
            crate::work::count(MODULE * usize::try_from(modules).unwrap_or(usize::MAX / MODULE));
            Ok(())
        }
        false => Err(NotCompiled),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::super::effects::Effects;
    use super::super::tests::system;
    use super::{MAX_KINDS, MAX_LONG, MAX_WORK, SHORT, check_long, excess, work};
    use crate::geometry::Frame2;
    use crate::graph::{CompileError, Graph};

    #[test]
    fn words_count_with_their_steps() {
        let kinds = |text: &str, steps| {
            let system = system(text);
            let kinds = super::Kinds::of(&system, steps, MAX_KINDS).unwrap();
            work(&system, &kinds, steps)
        };
        // The axiom counts at steps 0 to 3, and the word and its object three times.
        let text = "axiom: F\nproductions: {F: F+F}\n";
        assert_eq!(kinds(text, 3), 4 + 3 * (3 + 4));
        // A symbol of two actions counts twice.
        let text = "axiom: F\nproductions: {F: F+F}\nsymbols: {+: [{turn: 1}, {turn: 2}]}\n";
        assert_eq!(kinds(text, 3), 4 + 3 * (4 + 4));
        // Kinds that appear late are replaced less often.
        let text = "axiom: A\nproductions: {A: B, B: F}\n";
        assert_eq!(kinds(text, 3), 4 + 3 * 5 + 2 * 5 + 3 * 3 / 8);
    }

    #[test]
    fn graphs_are_as_large_as_their_work() {
        let word = "F+XF-F-".repeat(20);
        let system = system(&format!(
            "angle: 50\naxiom: X\nproductions: {{X: {word}, F: FX}}\n"
        ));
        // Two steps take twice the words and their objects, the axiom twice, and the four kinds.
        let per_two_steps = 2 * (140 + 4 + 2 + 4) + 2 + 1;
        let most = u32::try_from(2 * MAX_WORK / per_two_steps).unwrap();
        assert_eq!(excess(&system, most), None);
        assert!(Effects::<Frame2>::of_system(&system, 100).is_ok());
        let steps = most + 10;
        let work = excess(&system, steps).unwrap();
        assert!(work > MAX_WORK && work < MAX_WORK + 10 * per_two_steps);
        assert!(Effects::<Frame2>::of_system(&system, steps).is_err());
        let error = Graph::of_lsystem(&system, steps, 0, 1_000_000).unwrap_err();
        assert!(
            matches!(error, CompileError::LargeGraph { work: known, .. } if known == work),
            "{error}"
        );
        let deepest = error.deepest().unwrap();
        assert!(deepest > most - most / 4 && excess(&system, deepest).is_none());
    }

    #[test]
    fn long_sums_count_their_bits() {
        let system = system("axiom: F\nproductions: {F: F+F}\n");
        let kinds = super::Kinds::of(&system, 1000, MAX_KINDS).unwrap();
        let check = |bits| check_long(&system, &kinds, 1000, bits);
        let times = MAX_LONG / work(&system, &kinds, 1000);
        let most = usize::try_from(times * SHORT - 1).unwrap();
        assert_eq!([None, Some(1), Some(most)].map(check), [Ok(()); 3]);
        assert!(check(Some(most + 1)).is_err());
    }

    /// Words inside polygons that only grow longer have no vertices to be counted.
    #[test]
    fn words_inside_polygons_are_not_expanded_without_end() {
        let text = "axiom: '{F+F+FA}'\nproductions: {A: AA}\n";
        let system = system(text);
        for steps in [10, 40] {
            let effects = Effects::<Frame2>::of_system(&system, steps).unwrap();
            assert_eq!(Graph::of_levels(effects, steps).is_ok(), steps == 10);
        }
    }
}
