//! Parameters that nothing uses: most are misspelt.

use std::collections::HashSet;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Source, did_you_mean};

use super::{
    BaseElementDocument, Entry, Number, PieceDocument, Point, RuleDocument, SelectDocument,
    WhichPoints,
};

/// More parameters than this are not compared with others.
const MOST_COMPARED: usize = 100;

/// Warns of the parameters in a rule's own file that no expression of the rule uses; the others
/// are its parents' and components', which other rules may use.
pub(super) fn parameters<'a>(
    rule: &'a RuleDocument,
    source: &'a Arc<Source>,
) -> impl Iterator<Item = Diagnostic> + 'a {
    let mut used = HashSet::new();
    visit(rule, &mut |number| {
        used.extend(number.value.names().into_iter().map(|(name, _)| name));
    });
    let names = rule.params.iter().map(|parameter| &parameter.name);
    let (used, unused): (Vec<_>, Vec<_>) = names.partition(|name| used.contains(&*name.value));
    let unused = unused
        .into_iter()
        .filter(|name| Arc::ptr_eq(name.place.source(), source));
    unused.enumerate().map(move |(number, name)| {
        let known = used.iter().map(|name| name.value.as_str());
        let meant = did_you_mean(&name.value, known.filter(|_| number < MOST_COMPARED));
        let hint = meant.unwrap_or_else(|| "leave it out, or use it in an expression".into());
        let message = format!("nothing uses the parameter '{}'", name.value);
        Diagnostic::warning(message).at(&name.place).hint(hint)
    })
}

/// Calls `f` for every number of a rule.
fn visit<'a>(rule: &'a RuleDocument, f: &mut impl FnMut(&'a Number)) {
    for parameter in &rule.params {
        f(&parameter.value);
        parameter.min.iter().chain(&parameter.max).for_each(&mut *f);
    }
    visit_entries(&rule.initiator.entries, f);
    for (_, generator) in &rule.generators {
        generator.random.iter().for_each(|(_, number)| f(number));
        for moving in &generator.moves {
            moving.rotate.iter().for_each(&mut *f);
            moving.scale.iter().flatten().for_each(&mut *f);
            visit_points(moving.shift.iter().chain(&moving.about), f);
            if let WhichPoints::Numbers(numbers) = &moving.points {
                numbers.iter().for_each(&mut *f);
            }
        }
        for part in &generator.parts {
            visit_entries(&part.entries, f);
        }
    }
    match &rule.select {
        Some(SelectDocument::Cases(cases, _)) => {
            cases
                .iter()
                .filter_map(|(when, _)| when.as_ref())
                .for_each(&mut *f);
        }
        Some(SelectDocument::AtRandom(weights, _)) => {
            weights.iter().for_each(|(_, weight)| f(weight));
        }
        Some(SelectDocument::ByIndex(..)) | None => {}
    }
    rule.base_element
        .iter()
        .for_each(|base| visit_base_element(base, f));
    let numbers = [&rule.steps, &rule.dimension, &rule.hausdorff_dimension];
    numbers.into_iter().flatten().for_each(f);
}

fn visit_entries<'a>(entries: &'a [Entry], f: &mut impl FnMut(&'a Number)) {
    for entry in entries {
        match entry {
            Entry::Point(point) => visit_points([point], f),
            Entry::Element(listed) => {
                visit_points(listed.from.iter().chain([&listed.to]), f);
                listed.direction.iter().for_each(&mut *f);
                listed
                    .base_element
                    .iter()
                    .for_each(|base| visit_base_element(base, f));
            }
        }
    }
}

fn visit_base_element<'a>(base: &'a BaseElementDocument, f: &mut impl FnMut(&'a Number)) {
    for piece in &base.pieces {
        match piece {
            PieceDocument::Line(to) => visit_points([to], f),
            PieceDocument::Arc { to, through } => visit_points([to, through], f),
            PieceDocument::Curve { to, control } => {
                visit_points([to].into_iter().chain(control), f)
            }
        }
    }
    visit_points(base.from.iter().chain(&base.to), f);
}

fn visit_points<'a>(points: impl IntoIterator<Item = &'a Point>, f: &mut impl FnMut(&'a Number)) {
    for point in points {
        f(&point.x);
        f(&point.y);
    }
}
