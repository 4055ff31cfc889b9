//! Words that are read without being stored: where no production has a context, the descendants of a module
//! depend on its ancestors alone.

use crate::draws::Path;

use super::rewrite::{RewriteError, Rewriter, check_length, most_modules, most_work};
use super::word::number;
use super::{LSystem, Word};

/// Limit of the number of modules in a word that is read.
const MAX_MODULES: u64 = 200_000_000;

impl LSystem {
    /// Reads the modules of the word after a number of steps, in order: `read` gets the symbol's index and
    /// the arguments. Without contexts the word is not stored.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`LSystem::word`]. Without contexts the limit is 200 million modules.
    pub fn read(
        &self,
        steps: u32,
        seed: u64,
        max_elements: u64,
        mut read: impl FnMut(usize, &[f64]),
    ) -> Result<(), RewriteError> {
        if !self.is_context_free() {
            let word = self.word(steps, seed, max_elements)?;
            for (symbol, arguments) in word.modules(self) {
                read(symbol, arguments);
            }
            return Ok(());
        }
        if let Some(error) = self.unreadable(steps, max_elements) {
            return Err(error);
        }
        let axiom = Word::axiom(self, seed);
        let mut expander = Expander::new(self, max_elements);
        expander.expand(&axiom, steps, read).or_else(|error| {
            // The first step whose word cannot be read.
            expander.rewriter = Rewriter::new(self);
            (0..steps).try_for_each(|step| expander.expand(&axiom, step, |_, _| {}))?;
            Err(error)
        })
    }

    /// Returns the error of the first step whose word is too long to be read, as far as that is predicted.
    pub(crate) fn unreadable(&self, steps: u32, max_elements: u64) -> Option<RewriteError> {
        let most = most_modules(MAX_MODULES, max_elements);
        self.too_long(steps, most, max_elements)
    }
}

struct Expander<'s> {
    system: &'s LSystem,
    rewriter: Rewriter<'s>,
    max_elements: u64,
    /// The modules being replaced, from the axiom's down to the one that the next module descends from.
    ancestors: Vec<Ancestor>,
    /// Arguments that the ancestors' productions see, one after the other.
    slots: Vec<f64>,
    modules: u64,
    elements: u64,
}

/// A module that is being replaced.
struct Ancestor {
    production: usize,
    /// Position in the successor of the next module to read.
    position: usize,
    path: Option<Path>,
    /// Position in the expander's slots of the arguments that the production sees.
    slots: usize,
}

impl<'s> Expander<'s> {
    fn new(system: &'s LSystem, max_elements: u64) -> Self {
        Self {
            system,
            rewriter: Rewriter::new(system),
            max_elements,
            ancestors: Vec::new(),
            slots: Vec::new(),
            modules: 0,
            elements: 0,
        }
    }

    /// Reads the word that an axiom becomes after a number of steps.
    fn expand(
        &mut self,
        axiom: &Word,
        steps: u32,
        mut read: impl FnMut(usize, &[f64]),
    ) -> Result<(), RewriteError> {
        self.ancestors.clear();
        self.slots.clear();
        (self.modules, self.elements) = (0, 0);
        let mut own = Vec::new();
        for (at, (symbol, arguments)) in axiom.modules(self.system).enumerate() {
            own.clear();
            own.extend(arguments);
            let mut next = Some((symbol, axiom.paths.get(at).copied()));
            while let Some((symbol, path)) = next {
                self.module(symbol, &own, path, steps, &mut read)?;
                next = self.next(&mut own)?;
            }
        }
        Ok(())
    }

    /// Reads a module if it belongs to the last word, or pushes the production that replaces it.
    fn module(
        &mut self,
        symbol: usize,
        arguments: &[f64],
        path: Option<Path>,
        steps: u32,
        read: &mut impl FnMut(usize, &[f64]),
    ) -> Result<(), RewriteError> {
        let is_last = self.ancestors.len() == steps as usize;
        let fits = (!is_last).then(|| self.rewriter.choose((symbol, arguments), path, None));
        if let Some(production) = fits.flatten() {
            self.ancestors.push(Ancestor {
                production,
                position: 0,
                path,
                slots: self.slots.len(),
            });
            self.slots.extend(&self.rewriter.slots);
        } else {
            self.modules += 1;
            self.elements += self.system.symbols[symbol].draws();
            read(symbol, arguments);
        }
        let step = steps;
        let most = most_modules(MAX_MODULES, self.max_elements);
        let modules = (self.modules, most, "modules");
        check_length(
            step,
            &[modules, (self.elements, self.max_elements, "elements")],
        )?;
        if self.rewriter.work > most_work(self.max_elements) {
            return Err(RewriteError::TooMuchWork { step });
        }
        Ok(())
    }

    /// Returns the next module of the successors being read, and writes its arguments; `None` at the end.
    fn next(
        &mut self,
        arguments: &mut Vec<f64>,
    ) -> Result<Option<(usize, Option<Path>)>, RewriteError> {
        let system = self.system;
        loop {
            let step = number(self.ancestors.len());
            let Some(last) = self.ancestors.last_mut() else {
                return Ok(None);
            };
            let (production, position) = (last.production, last.position);
            last.position += 1;
            if let Some(template) = system.productions[production].successor.get(position) {
                arguments.clear();
                let slots = &self.slots[last.slots..];
                let work = system.evaluate((production, position), slots, step, arguments)?;
                self.rewriter.work += work;
                let path = last.path.map(|path| path.child(number(position)));
                return Ok(Some((template.symbol, path)));
            }
            self.slots.truncate(last.slots);
            self.ancestors.pop();
        }
    }
}
