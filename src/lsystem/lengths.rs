use super::LSystem;

/// How long the words of a system become, where what replaces a symbol never depends on anything else:
/// powers of its matrix (Prusinkiewicz & Lindenmayer 1990, section 1.10). Counts beyond 2⁶⁴ stay there.
pub(super) struct Lengths<'s> {
    system: &'s LSystem,
    /// How many there are of each symbol.
    counts: Vec<u64>,
}

impl LSystem {
    /// The lengths of its words; `None` if they depend on arguments, on contexts or on what is drawn.
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
    /// The number of modules, and of those that the turtle draws.
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

    /// Goes on to the next word; `false` if it is the same.
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
