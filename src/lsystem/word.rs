//! Words of an L-system in compact form.

use crate::draws::Path;

use super::{LSystem, Module};

/// A word: a sequence of modules in compact storage.
///
/// Guarantee: there are as many arguments as the symbols take, all finite, and as many paths as modules, or
/// none where the system is deterministic.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Word {
    /// Indices of the symbols.
    pub(super) symbols: Vec<u32>,
    /// Arguments of all modules, one after the other.
    pub(super) arguments: Vec<f64>,
    pub(super) paths: Vec<Path>,
}

impl Word {
    /// Returns the axiom of a system; its paths start from `seed`.
    #[must_use]
    pub fn axiom(system: &LSystem, seed: u64) -> Self {
        let mut word = Self::default();
        let root = Path::of_seed(seed);
        let draws = !system.is_deterministic();
        for (position, Module { symbol, arguments }) in (0..).zip(&system.axiom) {
            word.symbols.push(number(*symbol));
            word.arguments.extend(arguments);
            if draws {
                word.paths.push(root.child(position));
            }
        }
        word
    }

    /// Returns the number of modules.
    #[must_use]
    pub fn len(&self) -> usize {
        self.symbols.len()
    }

    /// Returns whether the word has no modules.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.symbols.is_empty()
    }

    /// Iterates over the modules: the indices of their symbols, with their arguments.
    pub fn modules<'a>(&'a self, system: &'a LSystem) -> impl Iterator<Item = (usize, &'a [f64])> {
        let mut rest = &self.arguments[..];
        self.symbols.iter().map(move |&symbol| {
            let symbol = symbol as usize;
            let (own, behind) = rest.split_at(system.symbols[symbol].arity);
            rest = behind;
            (symbol, own)
        })
    }

    /// Returns whether a symbol of the word draws lines or polygons.
    pub(super) fn draws(&self, system: &LSystem) -> bool {
        let mut modules = self.modules(system);
        modules.any(|(symbol, _)| system.symbols[symbol].draws() > 0)
    }

    /// Formats the word as text: `F[+A(1, 0.5)]`.
    #[must_use]
    pub fn to_text(&self, system: &LSystem) -> String {
        let mut text = String::new();
        for (symbol, arguments) in self.modules(system) {
            text.push(system.symbols[symbol].character);
            if !arguments.is_empty() {
                let values: Vec<_> = arguments.iter().map(ToString::to_string).collect();
                text.push_str(&format!("({})", values.join(", ")));
            }
        }
        text
    }
}

/// Converts a symbol's index to the integer that words store, saturating: a file has fewer symbols.
pub(super) fn number(symbol: usize) -> u32 {
    u32::try_from(symbol).unwrap_or(u32::MAX)
}
