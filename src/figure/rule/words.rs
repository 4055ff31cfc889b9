//! Text of figures: the selection, random functions and seed parts of a rule in words.

use crate::diagnostic::Place;
use crate::document::{
    CaseDocument, GeneratorDocument, MoveDocument, RotateDocument, RuleDocument, SelectDocument,
    WhichPoints, WrittenPoint,
};
use crate::expression::{Dependence, Expression};
use crate::metadata::Parameter;
use crate::rule::{ElementContext, Generator, Placement, RuleFrame};

/// Limit of the number of points that are described one by one.
const MAX_POINTS: usize = 6;

/// Describes the selection, line by line; returns nothing where there is only one generator.
pub(super) fn selection(document: &RuleDocument) -> Vec<String> {
    match &document.select {
        None if document.generators.len() > 1 => vec!["every side names its own".into()],
        None => Vec::new(),
        Some(SelectDocument::Cases(cases, _)) => {
            let line = |case: &CaseDocument| {
                let name = case
                    .generator
                    .as_ref()
                    .map_or("?", |name| name.value.as_str());
                match &case.when {
                    Some(when) => format!("{}: {name}", when.value),
                    None if cases.len() == 1 => format!("always: {name}"),
                    None => format!("otherwise: {name}"),
                }
            };
            cases.iter().map(line).collect()
        }
        Some(SelectDocument::ByIndex(names, _)) => {
            let names: Vec<_> = names.iter().map(|name| name.value.as_str()).collect();
            match names.as_slice() {
                [one] => vec![format!("always: {one}")],
                [odd, even] => vec![format!("odd i: {odd}"), format!("even i: {even}")],
                several => vec![format!("in turn: {}", several.join(", "))],
            }
        }
        Some(SelectDocument::AtRandom(_, _)) => Vec::new(),
    }
}

/// Describes the shares of a selection by weight, line by line.
pub(super) fn shares<F: RuleFrame>(
    generators: &[Generator<F>],
    weights: &[(f64, usize)],
) -> Vec<String> {
    let total: f64 = weights.iter().map(|(weight, _)| weight).sum();
    let share = |&(weight, generator): &(f64, usize)| {
        let percent = number((1000.0 * weight / total).round() / 10.0);
        format!("{percent} %: {}", generators[generator].name())
    };
    std::iter::once("at random:".into())
        .chain(weights.iter().map(share))
        .collect()
}

/// Description of a generator.
#[derive(Default)]
pub(super) struct Description {
    /// Lines of text.
    pub(super) lines: Vec<String>,
    /// Indices of the points that the text names by number.
    pub(super) named: Vec<usize>,
}

/// Describes a generator: its random function, the points that depend on the moment, and its seed parts.
pub(super) fn generator<F: RuleFrame>(
    generator: &Generator<F>,
    document: &GeneratorDocument,
    moment: &ElementContext,
) -> Description {
    let mut description = Description::default();
    for (name, distribution) in &document.random {
        let drawn = self::distribution(&distribution.value);
        description.lines.push(format!("{}: {drawn}", name.value));
    }
    let slots = ElementContext::NAMES.len() + generator.variables.len();
    let varies = |&number: &usize| {
        let mut programs = generator.points[number].as_ref().iter();
        programs.any(|it| (0..slots).any(|slot| it.dependence(slot) != Dependence::None))
    };
    // Vectors and angles follow the points.
    let is_end = |number: &usize| {
        let mut elements = generator.elements();
        elements.any(|element| element.from == *number || element.to == *number)
    };
    let ends = (0..generator.points.len()).filter(is_end);
    let varying: Vec<_> = ends.filter(varies).collect();
    for &number in varying.iter().take(MAX_POINTS) {
        let point = &generator.origin.points[number];
        let mut numbers = vec![&point.x, &point.y];
        numbers.extend(point.z.as_deref());
        let numbers: Vec<_> = { numbers.iter() }.map(|it| written(&it.place)).collect();
        let numbers = numbers.join(", ");
        description.lines.push(format!("p{number} = ({numbers})"));
        description.named.push(number);
    }
    if let Some(more @ 1..) = varying.len().checked_sub(MAX_POINTS) {
        description
            .lines
            .push(format!("and {more} more points that vary"));
    }
    for (written, moving) in document.moves.iter().zip(&generator.moves) {
        description
            .lines
            .push(self::moving(written, &moving.points));
        if let WhichPoints::Numbers(_) = written.points {
            description.named.extend_from_slice(&moving.points);
        }
    }
    description.named.sort_unstable();
    description.named.dedup();
    description.lines.extend(seeds(generator));
    let depends = |slot: &usize| {
        let mut programs = generator.programs();
        programs.any(|program| program.dependence(*slot) != Dependence::None)
    };
    let slots = (0..ElementContext::NAMES.len()).filter(depends);
    let values =
        slots.map(|slot| format!("{} = {}", ElementContext::NAMES[slot], moment.slots()[slot]));
    let values: Vec<_> = values.collect();
    if !values.is_empty() {
        description
            .lines
            .push(format!("drawn for {}", values.join(", ")));
    }
    description
}

fn distribution(expression: &Expression) -> String {
    match expression.as_call() {
        Some(("uniform", [low, high])) => format!("uniform from {low} to {high}"),
        Some(("normal", [mean, deviation])) => {
            format!("normal with mean {mean}, deviation {deviation}")
        }
        Some(("by_edge", [inner])) => format!("for each edge, {}", distribution(inner)),
        Some((_, values)) => {
            let values: Vec<_> = values.iter().map(ToString::to_string).collect();
            format!("one of {}", values.join(", "))
        }
        None => expression.to_string(),
    }
}

/// Returns an expression as written in a file, without the quotes that the file needs.
fn written(place: &Place) -> String {
    let text = place.text();
    match Expression::parse(text) {
        Ok(expression) => expression.to_string(),
        Err(_) => text.trim_matches(['"', '\'']).into(),
    }
}

fn moving(moving: &MoveDocument, points: &[usize]) -> String {
    let subject = match &moving.points {
        WhichPoints::Inner => "all points but the ends".into(),
        WhichPoints::All => "all points".into(),
        WhichPoints::Numbers(_) => {
            let names = points.iter().map(|number| format!("p{number}"));
            names.collect::<Vec<_>>().join(", ")
        }
    };
    let pair = |point: &WrittenPoint| match &point.z {
        Some(z) => format!("({}, {}, {})", point.x.value, point.y.value, z.value),
        None => format!("({}, {})", point.x.value, point.y.value),
    };
    let about = moving.about.as_ref();
    let about = about.map_or(String::new(), |point| format!(" about {}", pair(point)));
    let mut verbs = Vec::new();
    if let Some([first, others @ ..]) = moving.scale.as_deref() {
        let is_one = others.iter().all(|other| other.value == first.value);
        let factors = if is_one {
            first.value.to_string()
        } else {
            let factors = [first].into_iter().chain(others);
            let factors: Vec<_> = factors.map(|factor| factor.value.to_string()).collect();
            format!("({})", factors.join(", "))
        };
        verbs.push(format!("scaled by {factors}"));
    }
    match &moving.rotate {
        Some(RotateDocument::Angle(angle)) => {
            verbs.push(format!("turned by {}°", bound(&angle.value)));
        }
        Some(RotateDocument::Turns(turns)) => verbs.extend(turns.iter().map(|turn| {
            let angle = bound(&turn.angle.value);
            format!("turned by {angle}° around {}", pair(&turn.axis))
        })),
        None => {}
    }
    if let Some(last) = verbs.last_mut() {
        last.push_str(&about);
    }
    if let Some(shift) = moving.translate.as_ref().or(moving.shift.as_ref()) {
        verbs.push(format!("shifted by {}", pair(shift)));
    }
    format!("{subject}: {}", verbs.join(", "))
}

/// Returns an expression in a form that a unit can follow: in parentheses unless it is simple.
fn bound(expression: &Expression) -> String {
    let text = expression.to_string();
    let is_simple = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    if text.trim_start_matches('-').chars().all(is_simple) {
        text
    } else {
        format!("({text})")
    }
}

/// Describes the seed parts, line by line.
fn seeds<F: RuleFrame>(generator: &Generator<F>) -> Vec<String> {
    let parts = generator.parts();
    let mut lines = Vec::new();
    for placement in [Placement::Seeds, Placement::SeedsAsInitiator] {
        let of = (1usize..).zip(parts);
        let of = of.filter(|(_, part)| part.placement == placement);
        let numbers: Vec<_> = of.map(|(number, _)| number.to_string()).collect();
        let subject = match (numbers.len(), parts.len()) {
            (0, _) => continue,
            (1, 1) => "it seeds a new fractal".into(),
            (1, _) => format!("part {} seeds a new fractal", numbers[0]),
            (2, 2) => "both parts seed new fractals".into(),
            (some, all) if some == all => "all parts seed new fractals".into(),
            _ => format!("parts {} seed new fractals", numbers.join(", ")),
        };
        let how = match placement {
            Placement::SeedsAsInitiator => {
                ", as large and as upright as the initiator, measured from where the side begins"
            }
            _ => "",
        };
        lines.push(format!("{subject}{how}"));
    }
    lines
}

/// Formats parameters as "angle = 45, ratio = 0.5".
pub(super) fn parameters(parameters: &[Parameter]) -> String {
    let values = parameters.iter();
    let values = values.map(|it| format!("{} = {}", it.name, number(it.value)));
    values.collect::<Vec<_>>().join(", ")
}

/// Formats a number with six significant digits.
fn number(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse::<f64>();
    rounded.unwrap_or(value).to_string()
}
