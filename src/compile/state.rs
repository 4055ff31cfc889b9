//! Class and state of an element, which together determine its subtree, and the dependences of a rule.

use std::hash::{Hash, Hasher};

use crate::expression::{Dependence, Program, gcd};
use crate::instancing::Tint;
use crate::rule::{
    ElementContext, Generator, ListedElement, Placement, Rule, RuleFrame, Selection,
};

/// Properties of an element that do not depend on place and time: elements of one class in one state have
/// equal subtrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Class {
    pub(super) base_element: usize,
    pub(super) visible: bool,
    pub(super) fertile: bool,
    /// Generator that the element names.
    pub(super) generator: Option<usize>,
    /// Generator that lists it; `None` for the initiator.
    pub(super) origin: Option<usize>,
    pub(super) tint: TintKey,
}

/// Tint, compared by its bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct TintKey(pub(super) Option<Tint>);

impl TintKey {
    fn bits(self) -> Option<[u64; 6]> {
        self.0.map(Tint::bits)
    }
}

impl PartialEq for TintKey {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Eq for TintKey {}

impl Hash for TintKey {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.bits().hash(state);
    }
}

impl Class {
    pub(super) fn of(element: &ListedElement, origin: Option<usize>) -> Self {
        Self {
            base_element: element.base_element,
            visible: element.visible,
            fertile: element.fertile,
            generator: element.generator.filter(|_| element.fertile),
            origin,
            tint: TintKey(element.tint),
        }
    }
}

/// State of an element. Fields on which the rule does not depend keep their defaults.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct ElementState {
    pub(super) age: u32,
    pub(super) step: u32,
    /// Bits of the relative length.
    pub(super) length: u64,
    /// Whether it is traversed backwards; set only if the order matters.
    pub(super) reversed: bool,
    /// Numbers of elements of each kind before it in its fractal, modulo m.
    pub(super) preceding: Vec<u32>,
}

/// Properties on which the growth of a rule depends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dependences {
    pub(super) age: bool,
    pub(super) step: bool,
    pub(super) length: bool,
    /// Modulus of the index; 1 if the index is irrelevant.
    pub(super) modulus: u32,
    /// Whether the selection of a generator depends on an index that has to be counted.
    pub(super) index_is_free: bool,
    /// Whether a walk counts indices, for the selection or for points that depend on them.
    pub(super) counts_index: bool,
}

/// Largest modulus up to which indices are resolved.
const LARGEST_MODULUS: u32 = 64;

impl Dependences {
    /// Returns the dependences of a graph whose walks count indices: nothing is resolved.
    pub(super) fn counted() -> Self {
        Self {
            age: false,
            step: false,
            length: false,
            modulus: 1,
            index_is_free: true,
            counts_index: true,
        }
    }

    pub(super) fn of<F: RuleFrame>(rule: &Rule<F>) -> Self {
        let mut all = Self {
            age: false,
            step: false,
            length: false,
            modulus: 1,
            index_is_free: false,
            counts_index: false,
        };
        if let Selection::ByIndex(entries) = rule.selection() {
            all.count_modulo(u32::try_from(entries.len()).unwrap_or(u32::MAX));
        }
        for program in rule.selection().programs() {
            all.add(program);
            match program.dependence(ElementContext::INDEX) {
                Dependence::None => {}
                Dependence::Modulo(modulus) => all.count_modulo(modulus),
                Dependence::Free => all.index_is_free = true,
            }
        }
        let selects_by_length = all.length;
        for program in rule.generators().iter().flat_map(Generator::programs) {
            all.add(program);
            match program.dependence(ElementContext::INDEX) {
                Dependence::None => {}
                // Random points are computed for each element, as are points that would require too many
                // states.
                Dependence::Modulo(modulus)
                    if !rule.is_random() && all.common(modulus) <= LARGEST_MODULUS =>
                {
                    all.count_modulo(modulus);
                }
                _ => all.counts_index = true,
            }
        }
        if rule.is_random() || all.counts_index {
            // A length that is not fixed is known only for each element.
            all.length = false;
            all.index_is_free |= selects_by_length && all.modulus > 1;
        }
        // A seed that is placed as the initiator runs backwards or not, depending on its root.
        let resets = rule
            .generators()
            .iter()
            .flat_map(|generator| generator.parts())
            .any(|part| part.placement == Placement::SeedsAsInitiator);
        let reversed = rule
            .initiator()
            .elements
            .iter()
            .any(|element| element.direction.is_reversed());
        if all.modulus > 1 && (all.length || resets && reversed) {
            all.index_is_free = true;
        }
        all.counts_index |= all.index_is_free;
        all
    }

    fn add(&mut self, program: &Program) {
        let depends = |slot| program.dependence(slot) != Dependence::None;
        self.age |= depends(ElementContext::AGE);
        self.step |= depends(ElementContext::STEP);
        self.length |= depends(ElementContext::LENGTH);
    }

    /// Returns whether the number of states may grow with the number of steps.
    pub(super) fn on_time(&self) -> bool {
        self.age || self.step || self.length
    }

    fn count_modulo(&mut self, modulus: u32) {
        self.modulus = self.common(modulus);
        self.index_is_free |= self.modulus > LARGEST_MODULUS;
    }

    /// Returns the least common multiple of the current modulus and another.
    fn common(&self, modulus: u32) -> u32 {
        let [own, other] = [self.modulus, modulus].map(u64::from);
        u32::try_from(own / gcd(own, other) * other).unwrap_or(u32::MAX)
    }
}
