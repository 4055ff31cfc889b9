//! Lengths of words without rewriting, by powers of the system's matrix.

use super::LSystem;

/// Lengths of the words of a system in which the successor of a symbol never depends on anything else, by
/// powers of its matrix (Prusinkiewicz & Lindenmayer 1990, section 1.10). Counts saturate at 2⁶⁴ − 1.
pub(super) struct Lengths<'s> {
    system: &'s LSystem,
    /// The number of modules of each symbol.
    counts: Vec<u64>,
}

impl LSystem {
    /// Returns the lengths of the words, from the axiom's; `None` if a production that is tried first has a
    /// context, a condition or a weight.
    pub(super) fn lengths(&self) -> Option<Lengths<'_>> {
        let is_plain = |numbers: &Vec<usize>| match numbers.as_slice() {
            [] => true,
            [first, ..] => {
                let first = &self.productions[*first];
                !first.has_context() && first.condition.is_none() && first.weight.is_none()
            }
        };
        if !{ &self.symbols }
            .iter()
            .all(|symbol| is_plain(&symbol.productions))
        {
            return None;
        }
        let mut counts = vec![0; self.symbols.len()];
        for module in &self.axiom {
            counts[module.symbol] += 1;
        }
        Some(Lengths {
            system: self,
            counts,
        })
    }
}

impl Lengths<'_> {
    /// Returns the number of modules, and of the lines and polygons that they draw at most.
    pub(super) fn count(&self) -> (u64, u64) {
        let all = self.counts.iter().zip(&self.system.symbols);
        all.fold((0, 0), |(modules, elements), (&count, symbol)| {
            let drawn = count.saturating_mul(symbol.draws());
            (
                modules.saturating_add(count),
                elements.saturating_add(drawn),
            )
        })
    }

    /// Advances to the next word; returns `false` if no module was replaced.
    pub(super) fn advance(&mut self) -> bool {
        let mut next = vec![0u64; self.counts.len()];
        let mut changes = false;
        for (symbol, &count) in self.counts.iter().enumerate() {
            if count == 0 {
                continue;
            }
            match self.system.symbols[symbol].productions.first() {
                None => next[symbol] = next[symbol].saturating_add(count),
                Some(&production) => {
                    changes = true;
                    for template in &self.system.productions[production].successor {
                        let new = &mut next[template.symbol];
                        *new = new.saturating_add(count);
                    }
                }
            }
        }
        self.counts = next;
        changes
    }
}
