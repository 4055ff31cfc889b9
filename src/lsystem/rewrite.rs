//! Rewriting of words, step by step, within limits of length and work.

use crate::draws::{Path, pick_by_weight};
use crate::expression::Program;

use crate::readable::grouped;
use crate::work;

use super::surroundings::Surroundings;
use super::word::number;
use super::{LSystem, Word};

/// Limits of the number of modules, and of arguments, in a word that is stored: where few elements are allowed, and where
/// many are.
const STORED: [u64; 2] = [3_000_000, 25_000_000];

/// Limit of the modules of a stored word for each element that it may draw.
const STORED_PER_ELEMENT: u64 = 3;

/// Limit of the modules of a word for each element that it may draw.
const MODULES_PER_ELEMENT: u64 = 100;

/// Returns the limit of the modules of a word: `most`, or less where few elements are allowed.
pub(super) fn most_modules(most: u64, max_elements: u64) -> u64 {
    most.min(max_elements.saturating_mul(MODULES_PER_ELEMENT))
}

/// Returns the limit of the modules, and of the arguments, of a word that is stored.
fn most_stored(max_elements: u64) -> u64 {
    let [least, most] = STORED;
    let stored = max_elements
        .saturating_mul(STORED_PER_ELEMENT)
        .clamp(least, most);
    most_modules(stored, max_elements)
}

/// Limits of the modules, productions and contexts examined in all steps together: where few elements are allowed, and
/// where many are.
const WORK: [u64; 2] = [20_000_000, 1_000_000_000];

/// [Work](work) of a module or production that is examined.
const LOOK: usize = 2;

/// Limit of the work for each element that a word may draw.
const WORK_PER_ELEMENT: u64 = 50;

/// Work of a draw, in modules that are examined.
const DRAW: u64 = 4;

/// Returns the limit of the modules, productions and contexts examined in all steps together.
pub(super) fn most_work(max_elements: u64) -> u64 {
    let [least, most] = WORK;
    max_elements
        .saturating_mul(WORK_PER_ELEMENT)
        .clamp(least, most)
}

/// Limit of the successors' modules that a forecast examines.
const MAX_FORECAST: usize = 100_000_000;

/// An error that prevents a word from being rewritten.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RewriteError {
    /// A word exceeds a limit.
    #[error("the word of step {step} has more than {} {what}{}", grouped(&(*most).into()), deepest(*step))]
    TooLong {
        /// Step whose word is too long.
        step: u32,
        /// The limit.
        most: u64,
        /// Unit of the limit: modules, arguments or elements.
        what: &'static str,
    },
    /// Rewriting exceeds the limit of work.
    #[error("writing the word of step {step} takes too long{}", deepest(*step))]
    TooMuchWork {
        /// Step at which the limit was met.
        step: u32,
    },
    /// An argument is infinite or NaN.
    #[error("step {step} makes an argument of '{character}' that is not finite")]
    NotFinite {
        /// Step that makes the argument.
        step: u32,
        /// Symbol of the module that gets the argument.
        character: char,
        /// Index of the production.
        production: usize,
    },
}

/// Returns the end of a message, which names the step before a failing one as the deepest; empty for step 0.
fn deepest(step: u32) -> String {
    let before = step.checked_sub(1);
    before.map_or_else(String::new, |step| format!("; step {step} is the deepest"))
}

/// Returns an error if one of several counts of the word of a step is larger than its limit.
pub(super) fn check_length(
    step: u32,
    counts: &[(u64, u64, &'static str)],
) -> Result<(), RewriteError> {
    match counts.iter().find(|(count, most, _)| count > most) {
        Some(&(_, most, what)) => Err(RewriteError::TooLong { step, most, what }),
        None => Ok(()),
    }
}

impl LSystem {
    /// Returns the word after a number of steps.
    ///
    /// # Errors
    ///
    /// Returns an error if a word has more than 25 million modules or arguments, more than 3 million and 3 for each element
    /// allowed, or more than 100 for each, if it draws more than `max_elements` lines and polygons, if rewriting takes too much work, or if an
    /// argument is not finite.
    /// Where lengths of words can be predicted, too long a word is reported before any rewriting.
    pub fn word(&self, steps: u32, seed: u64, max_elements: u64) -> Result<Word, RewriteError> {
        let most = most_stored(max_elements);
        if let Some(error) = self.too_long(steps, most, max_elements) {
            return Err(error);
        }
        self.rewritten(steps, seed, max_elements, most_work(max_elements))
    }

    fn rewritten(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
        max_work: u64,
    ) -> Result<Word, RewriteError> {
        let mut word = Word::axiom(self, seed);
        let mut rewriter = Rewriter::new(self);
        for step in 1..=steps {
            let mut next = Word::default();
            rewriter.step(&word, &mut next, (step, max_elements, max_work), |_| {})?;
            // Without draws, a word that a step leaves unchanged never changes again.
            if next.symbols == word.symbols
                && next.arguments == word.arguments
                && self.is_deterministic()
            {
                break;
            }
            word = next;
        }
        Ok(word)
    }

    /// Returns the words before and after the last of some steps, of which there is at least one.
    ///
    /// # Errors
    ///
    /// As for [`LSystem::word`].
    pub(super) fn replaced(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
    ) -> Result<Replaced, RewriteError> {
        let most = most_stored(max_elements);
        if let Some(error) = self.too_long(steps, most, max_elements) {
            return Err(error);
        }
        let max_work = most_work(max_elements);
        let before = self.rewritten(steps.saturating_sub(1), seed, max_elements, max_work)?;
        let (mut after, mut ends) = (Word::default(), Vec::new());
        let limits = (steps, max_elements, max_work);
        Rewriter::new(self).step(&before, &mut after, limits, |end| ends.push(end))?;
        Ok(Replaced {
            before,
            after,
            ends,
        })
    }

    /// Returns the deepest step, up to `steps`, whose word draws something within the limits. If no such word
    /// draws, returns the first step that draws where that can be predicted without rewriting, and otherwise
    /// the deepest step whose word is within the limits.
    #[must_use]
    pub fn deepest(&self, steps: u32, max_elements: u64) -> u32 {
        let word = |steps| self.word(steps, 0, max_elements);
        let (mut deepest, mut last) = (steps, word(steps));
        if let Err(
            RewriteError::TooLong { step, .. }
            | RewriteError::TooMuchWork { step }
            | RewriteError::NotFinite { step, .. },
        ) = &last
        {
            deepest = step.saturating_sub(1);
            last = word(deepest);
        }
        for step in (0..=deepest).rev() {
            if step < deepest {
                last = word(step);
            }
            if last.as_ref().is_ok_and(|word| word.draws(self)) {
                return step;
            }
        }
        let first = self.lengths().and_then(|mut lengths| {
            (0..=steps).find(|_| {
                let draws = lengths.count().1 > 0;
                lengths.advance();
                draws
            })
        });
        first.unwrap_or(deepest)
    }

    /// Returns the error of the first step whose word is too long, as far as lengths can be predicted without
    /// rewriting.
    pub(super) fn too_long(
        &self,
        steps: u32,
        max_modules: u64,
        max_elements: u64,
    ) -> Option<RewriteError> {
        let mut lengths = self.lengths()?;
        let successors = self.productions.iter().map(|p| p.successor.len());
        let work = self.symbols.len() + successors.sum::<usize>();
        let soon = u32::try_from(MAX_FORECAST / work.max(1)).unwrap_or(u32::MAX);
        for step in 0..=steps.min(soon) {
            let (modules, elements) = lengths.count();
            let modules = (modules, max_modules, "modules");
            let too_long = check_length(step, &[modules, (elements, max_elements, "elements")]);
            if too_long.is_err() || !lengths.advance() {
                return too_long.err();
            }
        }
        None
    }

    /// Returns the index of the production that replaces a module; `None` if the module is kept.
    ///
    /// For the index of a production, `weight` returns its weight if it fits by contexts and condition, else
    /// `None`. Without a path the first production that fits is chosen.
    pub(crate) fn chosen(
        &self,
        symbol: usize,
        path: Option<Path>,
        mut weight: impl FnMut(usize) -> Option<f64>,
    ) -> Option<usize> {
        let candidates = &self.symbols[symbol].productions;
        let mut fitting = candidates.iter().copied().enumerate();
        let (at, first) = fitting.find(|(_, number)| weight(*number).is_some())?;
        let production = &self.productions[first];
        let Some(path) = path.filter(|_| production.weight.is_some()) else {
            return Some(first);
        };
        let mut drawn = Vec::new();
        for &number in &candidates[at..] {
            let other = &self.productions[number];
            if other.weight.is_some()
                && other.has_context() == production.has_context()
                && let Some(weight) = weight(number)
            {
                // A NaN counts as 0.
                drawn.push((number, weight.max(0.0)));
            }
        }
        let weights = drawn.iter().map(|(_, weight)| *weight);
        drawn
            .get(pick_by_weight(path, weights))
            .map(|(number, _)| *number)
    }
}

impl LSystem {
    /// Appends the arguments of a module of a production's successor, evaluated with the arguments that the
    /// production sees. Returns the [work](Program::work) of that.
    ///
    /// # Errors
    ///
    /// Returns an error if an argument is not finite.
    pub(super) fn evaluate(
        &self,
        (production, position): (usize, usize),
        slots: &[f64],
        step: u32,
        arguments: &mut Vec<f64>,
    ) -> Result<u64, RewriteError> {
        let mut work = 0;
        let template = &self.productions[production].successor[position];
        for argument in &template.arguments {
            let value = argument.eval(slots);
            if !value.is_finite() {
                return Err(RewriteError::NotFinite {
                    step,
                    character: self.symbols[template.symbol].character,
                    production,
                });
            }
            arguments.push(value);
            work += argument.work() as u64;
        }
        Ok(work)
    }
}

/// A word, and the one that replaces it.
pub(super) struct Replaced {
    pub(super) before: Word,
    pub(super) after: Word,
    /// Numbers of the modules that replace each module and those before it.
    pub(super) ends: Vec<usize>,
}

/// Selection of the productions that replace modules, with a count of its work.
pub(super) struct Rewriter<'s> {
    system: &'s LSystem,
    /// Arguments that the production chosen last sees, and its variables.
    pub(super) slots: Vec<f64>,
    /// The number of modules and productions examined so far, and the work of their formulas.
    pub(super) work: u64,
}

impl Drop for Rewriter<'_> {
    fn drop(&mut self) {
        work::count(LOOK * usize::try_from(self.work).unwrap_or(usize::MAX / LOOK));
    }
}

impl<'s> Rewriter<'s> {
    pub(super) fn new(system: &'s LSystem) -> Self {
        Self {
            system,
            slots: Vec::new(),
            work: 0,
        }
    }

    /// Returns the production that replaces a module, if one does; `around` holds the surroundings of the
    /// word and the module's position, where productions have contexts.
    pub(super) fn choose(
        &mut self,
        (symbol, arguments): (usize, &[f64]),
        path: Option<Path>,
        around: Option<(&Surroundings<'_>, u32)>,
    ) -> Option<usize> {
        let system = self.system;
        let (slots, work) = (&mut self.slots, &mut self.work);
        *work += 1;
        let mut fits = |number: usize| {
            *work += 1;
            let production = &system.productions[number];
            slots.clear();
            match around {
                None => slots.extend(arguments),
                Some((around, at)) => {
                    let fits = around.fits_left(at, &production.left, slots) && {
                        slots.extend(arguments);
                        around.fits_right(at, &production.right, slots)
                    };
                    if !fits {
                        return None;
                    }
                }
            }
            let formulas = production.condition.iter().chain(&production.weight);
            *work += formulas.map(Program::work).sum::<usize>() as u64;
            let condition = production.condition.as_ref();
            let holds = condition.is_none_or(|condition| condition.holds(slots));
            let weight = production.weight.as_ref();
            holds.then(|| weight.map_or(1.0, |weight| weight.eval(slots)))
        };
        let chosen = system.chosen(symbol, path, &mut fits)?;
        // The slots must hold the arguments that the chosen production sees.
        fits(chosen);
        if let Some(path) = path {
            for variable in &system.productions[chosen].variables {
                let drawn = variable.draw(path, slots);
                slots.push(drawn);
                *work += DRAW;
            }
        }
        Some(chosen)
    }

    /// Appends the word that replaces another to `next`, and gives the length of that after each module to `replaced`.
    fn step(
        &mut self,
        word: &Word,
        next: &mut Word,
        (step, max_elements, max_work): (u32, u64, u64),
        mut replaced: impl FnMut(usize),
    ) -> Result<(), RewriteError> {
        let system = self.system;
        let surroundings = (!system.is_context_free()).then(|| Surroundings::new(system, word));
        let (mut elements, mut looked) = (0, 0);
        let most = most_stored(max_elements);
        for (at, module) in (0u32..).zip(word.modules(system)) {
            let path = word.paths.get(at as usize).copied();
            let around = surroundings.as_ref().map(|around| (around, at));
            let from = next.len();
            if let Some(chosen) = self.choose(module, path, around) {
                let successor = &system.productions[chosen].successor;
                for (position, template) in successor.iter().enumerate() {
                    next.symbols.push(number(template.symbol));
                    let arguments = &mut next.arguments;
                    self.work +=
                        system.evaluate((chosen, position), &self.slots, step, arguments)?;
                    next.paths
                        .extend(path.map(|path| path.child(number(position))));
                }
            } else {
                let (symbol, arguments) = module;
                next.symbols.push(number(symbol));
                next.arguments.extend(arguments);
                next.paths.extend(path);
            }
            let looks = surroundings.as_ref().map_or(0, Surroundings::looks);
            self.work += looks - looked;
            looked = looks;
            if self.work > max_work {
                return Err(RewriteError::TooMuchWork { step });
            }
            let new = &next.symbols[from..];
            let draws = new
                .iter()
                .map(|symbol| system.symbols[*symbol as usize].draws());
            elements += draws.sum::<u64>();
            let modules = (next.symbols.len() as u64, most, "modules");
            let arguments = (next.arguments.len() as u64, most, "arguments");
            let elements = (elements, max_elements, "elements");
            check_length(step, &[modules, arguments, elements])?;
            replaced(next.symbols.len());
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::RewriteError;
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;
    use crate::model::Model;

    /// Long contexts and many productions exhaust the limit of work.
    #[test]
    fn too_much_work_is_given_up() {
        let [word, left] = [900, 400].map(|count| "F".repeat(count));
        for productions in [
            format!("['{left} < F -> F', 'F > {left} -> F']"),
            "['F : 1 > 2 -> F', 'F -> F+']".into(),
        ] {
            let text = format!("kind: lsystem\naxiom: {word}\nproductions: {productions}\n");
            let source = Source::new("test.yaml", text);
            let document = Document::read(&source, &Catalogue::embedded()).unwrap();
            let Model::LSystem(system) = document.resolve(&[]).unwrap().0 else {
                panic!("this is an L-system");
            };
            let step = 1;
            let error = system.rewritten(1, 0, 10_000, 1_000).unwrap_err();
            assert_eq!(error, RewriteError::TooMuchWork { step });
            assert!(system.rewritten(1, 0, 10_000, 1_000_000).is_ok());
        }
    }
}
