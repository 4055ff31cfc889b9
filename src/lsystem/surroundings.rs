//! Matching of contexts on the tree that brackets make of a word.

use std::cell::Cell;

use super::{Context, LSystem, Word};

/// Sentinel for the absence of a module.
const NONE: u32 = u32::MAX;

/// The neighbours of every module of a word in its tree. Built in linear time with an explicit stack,
/// independent of the depth of brackets.
pub(super) struct Surroundings<'a> {
    system: &'a LSystem,
    word: &'a Word,
    /// For each module, the position of its first argument.
    arguments: Vec<u32>,
    /// For each module, the previous one on the path from the root.
    before: Vec<u32>,
    /// For each module, the next module or bracket.
    next: Vec<u32>,
    /// For each module, the next module or bracket after the branches that follow it.
    ahead: Vec<u32>,
    /// For each opening bracket, its closing one.
    end: Vec<u32>,
    /// The number of modules compared with contexts.
    looks: Cell<u64>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Bracketing {
    Module,
    Ignored,
    Open,
    Close,
}

impl<'a> Surroundings<'a> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "words have fewer modules and arguments than a u32 counts"
    )]
    pub(super) fn new(system: &'a LSystem, word: &'a Word) -> Self {
        let count = word.len();
        let kinds: Vec<Bracketing> = { system.symbols.iter() }
            .map(|symbol| match symbol {
                symbol if symbol.is_push() => Bracketing::Open,
                symbol if symbol.is_pop() => Bracketing::Close,
                symbol if symbol.ignored => Bracketing::Ignored,
                _ => Bracketing::Module,
            })
            .collect();
        let kind = |at: u32| kinds[word.symbols[at as usize] as usize];
        let mut all = Self {
            system,
            word,
            arguments: Vec::with_capacity(count),
            before: Vec::with_capacity(count),
            next: vec![NONE; count],
            ahead: vec![NONE; count],
            end: vec![NONE; count],
            looks: Cell::new(0),
        };
        let mut argument = 0;
        let mut last = NONE;
        let mut open = Vec::new();
        for (at, &symbol) in (0..).zip(&word.symbols) {
            all.arguments.push(argument as u32);
            argument += system.symbols[symbol as usize].arity;
            all.before.push(last);
            match kind(at) {
                Bracketing::Module => last = at,
                Bracketing::Ignored => {}
                Bracketing::Open => open.push((at, last)),
                Bracketing::Close => {
                    if let Some((opening, before)) = open.pop() {
                        all.end[opening as usize] = at;
                        last = before;
                    }
                }
            }
        }
        let mut next = NONE;
        for at in (0..count as u32).rev() {
            let here = at as usize;
            all.next[here] = next;
            let is_branch = next != NONE && kind(next) == Bracketing::Open;
            let over = is_branch.then(|| all.end[next as usize]);
            all.ahead[here] = over.map_or(next, |end| all.ahead[end as usize]);
            if kind(at) != Bracketing::Ignored {
                next = at;
            }
        }
        all
    }

    /// Returns the arguments of a module.
    pub(super) fn arguments(&self, at: u32) -> &'a [f64] {
        let at = at as usize;
        let start = self.arguments[at] as usize;
        let symbol = &self.system.symbols[self.word.symbols[at] as usize];
        &self.word.arguments[start..start + symbol.arity]
    }

    /// Returns the number of modules compared with contexts so far.
    pub(super) fn looks(&self) -> u64 {
        self.looks.get()
    }

    fn is(&self, at: u32, symbol: usize) -> bool {
        self.looks.set(self.looks.get() + 1);
        at != NONE && self.word.symbols[at as usize] as usize == symbol
    }

    /// Returns whether a left context fits a module; appends the arguments of the context to `slots`.
    pub(super) fn fits_left(&self, at: u32, left: &[usize], slots: &mut Vec<f64>) -> bool {
        let mut found = at;
        for &symbol in left.iter().rev() {
            found = self.before[found as usize];
            if !self.is(found, symbol) {
                return false;
            }
        }
        let mut found = at;
        let start = slots.len();
        for _ in left {
            found = self.before[found as usize];
            let before = slots.len();
            slots.extend(self.arguments(found));
            // The arguments of the nearest module come last.
            let added = slots.len() - before;
            slots[start..].rotate_right(added);
        }
        true
    }

    /// Returns whether a right context fits behind a module; appends the arguments of the context to `slots`.
    pub(super) fn fits_right(&self, at: u32, right: &[Context], slots: &mut Vec<f64>) -> bool {
        let mut behind = at;
        let mut rest = right;
        while let Some((first, others)) = rest.split_first() {
            match first {
                Context::Symbol(symbol) => {
                    behind = self.ahead[behind as usize];
                    if !self.is(behind, *symbol) {
                        return false;
                    }
                    slots.extend(self.arguments(behind));
                    rest = others;
                }
                Context::Open => {
                    let inner = inside(others);
                    let Some(end) = self.branch(behind, inner, slots) else {
                        return false;
                    };
                    behind = end;
                    rest = &others[inner.len() + 1..];
                }
                // Brackets of contexts are balanced, and their content has been matched.
                Context::Close => rest = others,
            }
        }
        true
    }

    /// Returns the end of the first branch behind a module that a context fits.
    fn branch(&self, behind: u32, inner: &[Context], slots: &mut Vec<f64>) -> Option<u32> {
        let mut behind = behind;
        loop {
            let opening = self.next[behind as usize];
            // Only an opening bracket has an end.
            let end = (opening != NONE).then(|| self.end[opening as usize])?;
            if end == NONE {
                return None;
            }
            let before = slots.len();
            self.looks.set(self.looks.get() + 1);
            if self.fits_right(opening, inner, slots) {
                return Some(end);
            }
            slots.truncate(before);
            behind = end;
        }
    }
}

/// Returns the part of a context up to the unmatched closing bracket.
fn inside(context: &[Context]) -> &[Context] {
    let mut depth = 0;
    let end = context.iter().position(|part| {
        match part {
            Context::Open => depth += 1,
            Context::Close => depth -= 1,
            Context::Symbol(_) => {}
        }
        depth < 0
    });
    &context[..end.unwrap_or(context.len())]
}
