//! Resolution of the selection of generators.

use crate::diagnostic::listed;
use crate::document::{CaseDocument, Entry, RuleDocument, SelectDocument, Written, WrittenNumber};
use crate::expression::Scope;

use super::{OfRule, ResolvedFrame};
use crate::diagnostic::Place;
use crate::resolve::{MAX_MISTAKES, Resolver};
use crate::rule::Selection;

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    pub(super) fn generator_named(&mut self, name: &Written<String>) -> Option<usize> {
        let found = self.kind.generator_numbers.get(&name.value).copied();
        if found.is_none()
            && !self.incomplete
            && !self.kind.generator_names.is_empty()
            && self.mistakes < MAX_MISTAKES
        {
            let known = self.kind.generator_names.iter().map(String::as_str);
            let hint = self
                .suggestion(&name.value, known.clone())
                .unwrap_or_else(|| format!("the generators are: {}", listed(known)));
            let message = format!("there is no generator '{}'", name.value);
            self.error_with_hint(&name.place, message, hint);
        }
        found
    }

    pub(super) fn selection(
        &mut self,
        document: &RuleDocument,
        moment: &Scope,
    ) -> Option<Selection> {
        match document.select.as_ref() {
            None => Some(Selection::Always(0)),
            Some(SelectDocument::ByIndex(names, _)) => {
                let entries = names.iter().map(|name| self.generator_named(name));
                let entries: Vec<_> = entries.collect();
                entries
                    .into_iter()
                    .collect::<Option<_>>()
                    .map(Selection::ByIndex)
            }
            Some(SelectDocument::AtRandom(weights, place)) => self.at_random(weights, place),
            Some(SelectDocument::Cases(cases, _)) => self.cases(cases, moment),
        }
    }

    fn at_random(
        &mut self,
        weights: &[(Written<String>, WrittenNumber)],
        place: &Place,
    ) -> Option<Selection> {
        let mut entries = Vec::new();
        let mut none = true;
        for (name, number) in weights {
            let (generator, weight) = (self.generator_named(name), self.constant(number));
            none &= weight == Some(0.0);
            if weight.is_some_and(|weight| weight < 0.0) {
                let hint = "0 is the least: such a generator is never selected";
                self.error_with_hint(&number.place, "a weight cannot be negative", hint);
            }
            entries.extend(weight.zip(generator));
        }
        if none {
            let message = "no generator has a weight above 0";
            self.error_with_hint(place, message, "at_random: {gen0: 3, gen1: 1}");
        }
        (entries.len() == weights.len()).then_some(Selection::AtRandom(entries))
    }

    fn cases(&mut self, written: &[CaseDocument], moment: &Scope) -> Option<Selection> {
        let mut cases = Vec::new();
        let mut otherwise = None;
        for CaseDocument {
            when,
            generator: name,
            ..
        } in written
        {
            let generator = name.as_ref().and_then(|name| self.generator_named(name));
            let condition = when.as_ref().map(|when| self.condition(when, moment));
            match (condition, otherwise) {
                (condition, None) => match condition {
                    Some(condition) => cases.extend(generator.map(|it| (condition, it))),
                    None => otherwise = Some(generator),
                },
                (_, Some(_)) => {
                    if let Some(name) = name {
                        let message = "this case is never reached: the one before has no condition";
                        let hint = "put the case without a condition last";
                        self.error_with_hint(&name.place, message, hint);
                    }
                }
            }
        }
        let last = written.last().and_then(|case| case.when.as_ref());
        if let (None, Some(when)) = (otherwise, last) {
            let message = "the selection can fall through: its last case has a condition";
            let hint = "end with a case that has none: - {use: NAME}";
            self.error_with_hint(&when.place, message, hint);
        }
        Some(Selection::ByCondition {
            cases,
            otherwise: otherwise??,
        })
    }

    /// Reports fertile elements without a generator if there are several generators and no selection.
    pub(super) fn check_generators_are_selected(&mut self, document: &RuleDocument) {
        let [_, (second, _), ..] = document.generators.as_slice() else {
            return;
        };
        if document.select.is_some() || self.incomplete {
            return;
        }
        let parts = document
            .generators
            .iter()
            .flat_map(|(_, generator)| &generator.parts)
            .map(|part| (&part.entries, part.closed, &part.place));
        let initiator = &document.initiator;
        let lists = parts.chain([(&initiator.entries, initiator.closed, &initiator.place)]);
        let mut undecided: Option<Place> = None;
        let mut some_decide = false;
        for (entries, closed, place) in lists {
            for (number, entry) in entries.iter().enumerate() {
                let place = match entry {
                    Entry::Element(listed) => {
                        some_decide |= listed.generator.is_some();
                        let open = listed.fertile && listed.generator.is_none();
                        open.then_some(&listed.place)
                    }
                    Entry::Point(point) => (number > 0).then_some(&point.place),
                };
                undecided = undecided.or_else(|| place.cloned());
            }
            undecided = undecided.or_else(|| closed.then(|| place.clone()));
        }
        let Some(undecided) = undecided else { return };
        let hint = "select: {by_index: [...]}, select: {at_random: {...}}, \
                    select: [{when: ..., use: ...}, {use: ...}], or `use: NAME` on every fertile \
                    element";
        if some_decide {
            let message = "no selection among the generators that replace this element";
            self.error_with_hint(&undecided, message, hint);
        } else {
            let message = "the rule has several generators and no selection among them";
            self.error_with_hint(&second.place, message, hint);
        }
    }
}
