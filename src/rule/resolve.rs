//! From a rule as written to the validated model: names are looked up, expressions compiled,
//! everything is checked, and all that is wrong is said at once.

use crate::diagnostic::{Diagnostic, Diagnostics, Place, did_you_mean};
use crate::document::{
    BaseElementDocument, Entry, GeneratorDocument, Listed, MoveDocument, Number, PieceDocument,
    Point, RuleDocument, SelectDocument, Setting, WhichPoints, Written,
};
use crate::expression::{Expression, Program, Scope, is_reserved};
use crate::geometry::{DVec2, Direction, Frame};

use super::base_element::arc;
use super::draw::{Distribution, Variable};
use super::{
    BaseElement, Generator, ListedElement, Moment, Move, Parameter, Part, Piece, Placement, Rule,
    Selection,
};

/// Numbers of steps beyond this are refused.
pub(crate) const MOST_STEPS: u32 = 1_000_000;

impl Rule {
    /// Validates a rule as written, with parameters set from outside.
    ///
    /// # Errors
    ///
    /// All that is wrong with it. What is only doubtful comes with the rule.
    pub fn resolve(
        document: &RuleDocument,
        settings: &[Setting],
    ) -> Result<(Self, Diagnostics), Diagnostics> {
        let mut resolver = Resolver::default();
        let rule = resolver.rule(document, settings);
        if resolver.diagnostics.has_errors() {
            return Err(resolver.diagnostics);
        }
        Ok((rule, resolver.diagnostics))
    }
}

#[derive(Default)]
struct Resolver {
    diagnostics: Diagnostics,
    /// The rule's parameters.
    constants: Scope,
    base_elements: Vec<BaseElement>,
    /// Where the base elements were written, to know them again.
    base_element_places: Vec<Place>,
    generator_names: Vec<String>,
}

/// A point of a list, and how it was written.
struct ListedPoint {
    point: Point,
    number: usize,
}

impl Resolver {
    fn error(&mut self, place: &Place, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(message).at(place));
    }

    fn error_with_hint(
        &mut self,
        place: &Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    fn rule(&mut self, document: &RuleDocument, settings: &[Setting]) -> Rule {
        let parameters = self.parameters(document, settings);
        let base = document
            .base_element
            .as_ref()
            .and_then(|document| self.base_element(document));
        if base.is_none() {
            self.base_elements.push(BaseElement::line());
            self.base_element_places
                .push(document.initiator.place.clone());
        }
        self.generator_names = document
            .generators
            .iter()
            .map(|(name, _)| name.value.clone())
            .collect();

        let mut moment = self.constants.clone();
        for (slot, name) in Moment::NAMES.into_iter().enumerate() {
            moment.variable(name, slot);
        }
        let (points, initiator) = self.initiator(document);
        let generators: Vec<_> = document
            .generators
            .iter()
            .map(|(name, generator)| self.generator(&name.value, generator, &moment))
            .collect();
        let selection = self.selection(document, &moment);
        self.check_generators_are_selected(document);
        let steps = document.steps.as_ref().and_then(|number| {
            let value = self.constant(number)?;
            let whole = whole_number(value, MOST_STEPS);
            if whole.is_none() {
                let message = format!("a number of steps is a whole number from 0 to {MOST_STEPS}");
                self.error(&number.place, message);
            }
            whole
        });
        let mut rule = Rule {
            description: document.description.clone(),
            parameters,
            points,
            initiator,
            generators,
            selection: selection.unwrap_or(Selection::Always(0)),
            base_elements: std::mem::take(&mut self.base_elements),
            steps,
            dimension: document
                .dimension
                .as_ref()
                .and_then(|number| self.constant(number)),
            hausdorff_dimension: document
                .hausdorff_dimension
                .as_ref()
                .and_then(|number| self.constant(number)),
            style: document.style.clone(),
            view: document.view,
        };
        rule.initiator.meets_frame = [false; 2];
        rule
    }

    fn parameters(&mut self, document: &RuleDocument, settings: &[Setting]) -> Vec<Parameter> {
        let mut parameters: Vec<Parameter> = Vec::new();
        for written in &document.params {
            let name = &written.name.value;
            let place = &written.name.place;
            if !is_name(name) {
                let message = format!("'{name}' cannot be a parameter's name");
                self.error_with_hint(
                    place,
                    message,
                    "a name has letters, digits and _, and begins with a letter",
                );
            } else if is_reserved(name) || Moment::NAMES.contains(&name.as_str()) {
                let message = format!("'{name}' has a meaning of its own in expressions");
                self.error_with_hint(place, message, "give the parameter another name");
            } else if parameters.iter().any(|parameter| parameter.name == *name) {
                self.error(place, format!("the rule has two parameters named '{name}'"));
            }
            let set = settings.iter().rfind(|setting| setting.name == *name);
            let default = self.constant(&written.value);
            let value = set.map(|setting| setting.value).or(default);
            let min = written
                .min
                .as_ref()
                .and_then(|number| self.constant(number));
            let max = written
                .max
                .as_ref()
                .and_then(|number| self.constant(number));
            // Where a value cannot be told, 1 stands in for it and the mistake has been said.
            let value = value.unwrap_or(1.0);
            let at = if set.is_some() {
                place
            } else {
                &written.value.place
            };
            if let (Some(low), Some(high), Some(number)) = (min, max, &written.min)
                && low > high
            {
                let message = format!(
                    "the limits of '{name}' are upside down: min {low} is above max {high}"
                );
                self.error_with_hint(&number.place, message, format!("min: {high}, max: {low}"));
            }
            match (min, max) {
                (Some(low), _) if value < low => {
                    self.error(
                        at,
                        format!("'{name}' is {value}, below its least value {low}"),
                    );
                }
                (_, Some(high)) if value > high => {
                    self.error(
                        at,
                        format!("'{name}' is {value}, above its largest value {high}"),
                    );
                }
                _ => {}
            }
            self.constants.constant(name, value);
            parameters.push(Parameter {
                name: name.clone(),
                value,
                min,
                max,
                about: written.about.clone(),
            });
        }
        parameters
    }

    /// The program of a number in a scope; 0 where it is wrong, which is said.
    fn program(&mut self, number: &Number, scope: &Scope) -> Program {
        self.compiled(number, |expression| expression.compile(scope))
    }

    fn compiled(
        &mut self,
        number: &Number,
        compile: impl Fn(&Expression) -> Result<Program, crate::expression::ExpressionError>,
    ) -> Program {
        compile(&number.value).unwrap_or_else(|error| {
            let place = number.place.within(error.range.clone());
            let mut diagnostic = Diagnostic::error(error.message).at(&place);
            if let Some(hint) = error.hint {
                diagnostic = diagnostic.hint(hint);
            }
            self.diagnostics.push(diagnostic);
            Program::constant(0.0)
        })
    }

    /// The value of a number that sees parameters only.
    fn constant(&mut self, number: &Number) -> Option<f64> {
        let before = self.diagnostics.len();
        let scope = self.constants.clone();
        let program = self.program(number, &scope);
        let value = program
            .as_constant()
            .filter(|_| self.diagnostics.len() == before)?;
        if value.is_finite() {
            return Some(value);
        }
        self.error(&number.place, "the value of this is not finite");
        None
    }

    fn constant_point(&mut self, point: &Point) -> Option<DVec2> {
        let (x, y) = (self.constant(&point.x), self.constant(&point.y));
        Some(DVec2::new(x?, y?))
    }

    /// The number of a base element, which is made if it is new.
    fn base_element(&mut self, document: &BaseElementDocument) -> Option<usize> {
        let known = self
            .base_element_places
            .iter()
            .position(|place| *place == document.place);
        if known.is_some() {
            return known;
        }
        let before = self.diagnostics.len();
        let outline = self.outline(document);
        let frame = self.base_frame(document);
        if self.diagnostics.len() > before {
            // Something harmless in its place, so that it is not reported again.
            self.base_elements.push(BaseElement::line());
        } else {
            let (start, pieces) = outline?;
            let map = frame?.map.inverse();
            let pieces: Vec<_> = pieces.iter().map(|piece| piece.transformed(&map)).collect();
            let start = map.transform_point2(start);
            match BaseElement::new(start, pieces, document.closed) {
                Some(base_element) => self.base_elements.push(base_element),
                None => {
                    self.error_with_hint(
                        &document.place,
                        "this base element has no extent",
                        "its points must not all be the same",
                    );
                    self.base_elements.push(BaseElement::line());
                }
            }
        }
        self.base_element_places.push(document.place.clone());
        Some(self.base_elements.len() - 1)
    }

    fn outline(&mut self, document: &BaseElementDocument) -> Option<(DVec2, Vec<Piece>)> {
        let mut pieces = document.pieces.iter();
        let start = match pieces.next() {
            Some(PieceDocument::Line(point)) => self.constant_point(point)?,
            Some(PieceDocument::Arc { to, .. } | PieceDocument::Curve { to, .. }) => {
                self.error_with_hint(&to.place, "a base element begins with a point", "- [0, 0]");
                return None;
            }
            None => {
                // A list that is missing or wrong has been reported where it was read.
                self.error_with_hint(
                    &document.place,
                    "a base element needs two points or more",
                    "points: [[0, 0], [1, 0]]",
                );
                return None;
            }
        };
        let mut from = start;
        let mut outline = Vec::new();
        for piece in pieces {
            match piece {
                PieceDocument::Line(to) => outline.push(Piece::Line(self.constant_point(to)?)),
                PieceDocument::Arc { to, through } => {
                    let (end, middle) = (self.constant_point(to)?, self.constant_point(through)?);
                    match arc(from, middle, end) {
                        Some(pieces) => outline.extend(pieces),
                        None => self.error_with_hint(
                            &through.place,
                            "the three points of this arc lie on a line",
                            "write a point for a straight piece",
                        ),
                    }
                }
                PieceDocument::Curve { to, control } => {
                    let end = self.constant_point(to)?;
                    let control: Option<Vec<_>> = control
                        .iter()
                        .map(|point| self.constant_point(point))
                        .collect();
                    outline.push(match control?.as_slice() {
                        [a, b] => Piece::Cubic(*a, *b, end),
                        // A quadratic curve as the cubic that it is.
                        [a] => Piece::Cubic(from.lerp(*a, 2.0 / 3.0), end.lerp(*a, 2.0 / 3.0), end),
                        _ => Piece::Line(end),
                    });
                }
            }
            from = outline.last().map_or(from, Piece::end);
        }
        if outline.is_empty() {
            self.error_with_hint(
                &document.place,
                "a base element needs two points or more",
                "points: [[0, 0], [1, 0]]",
            );
            return None;
        }
        if from == start && outline.len() > 1 {
            let hint = if document.closed {
                "leave out the last point: `closed: true` goes back to the first"
            } else {
                "leave out the last point and write `closed: true`"
            };
            self.error_with_hint(
                &document.place,
                "the first and the last point of this base element coincide",
                hint,
            );
        } else if from == start {
            self.error_with_hint(
                &document.place,
                "the first and the last point of this base element coincide",
                "a base element needs an extent: points: [[0, 0], [1, 0]]",
            );
        }
        Some((start, outline))
    }

    /// The frame that a base element's own coordinates have in the unit frame.
    fn base_frame(&mut self, document: &BaseElementDocument) -> Option<Frame> {
        let mut end = |point: &Option<Point>, default: DVec2| match point {
            Some(point) => self.constant_point(point),
            None => Some(default),
        };
        let (from, to) = (
            end(&document.from, DVec2::ZERO)?,
            end(&document.to, DVec2::X)?,
        );
        if from == to {
            let place = document
                .from
                .as_ref()
                .or(document.to.as_ref())
                .map(|point| &point.place);
            let place = place.unwrap_or(&document.place).clone();
            self.error_with_hint(
                &place,
                "`from` and `to` of this base element coincide",
                "they come to lie on (0, 0) and (1, 0)",
            );
        }
        Some(Frame::between(from, to, Direction::Normal))
    }

    /// The elements of a list; `points` are numbered on from those that are there.
    fn elements(
        &mut self,
        entries: &[Entry],
        closed: bool,
        connected: bool,
        points: &mut Vec<Point>,
        initiator: bool,
    ) -> Vec<ListedElement> {
        let mut elements: Vec<ListedElement> = Vec::new();
        let mut first: Option<ListedPoint> = None;
        let mut last: Option<ListedPoint> = None;
        let add = |points: &mut Vec<Point>, point: &Point| {
            points.push(point.clone());
            ListedPoint {
                point: point.clone(),
                number: points.len() - 1,
            }
        };
        for entry in entries {
            let (from, to, listed) = match entry {
                Entry::Point(point) if last.is_none() => {
                    let start = add(points, point);
                    first = Some(ListedPoint {
                        point: point.clone(),
                        number: start.number,
                    });
                    last = Some(start);
                    continue;
                }
                Entry::Point(point) => (None, point, None),
                Entry::Element(listed) => (listed.from.as_ref(), &listed.to, Some(listed)),
            };
            let mut joined = !elements.is_empty();
            let start = match (from, last.take()) {
                (Some(from), Some(last)) if from.is_written_like(&last.point) => last,
                (Some(from), _) => {
                    joined = false;
                    add(points, from)
                }
                (None, Some(last)) => last,
                // The reader has said that the list does not say where it starts.
                (None, None) => add(points, to),
            };
            if first.is_none() {
                first = Some(ListedPoint {
                    point: start.point.clone(),
                    number: start.number,
                });
            }
            // A chain that comes back to its first point, as written, ends on that very point.
            let end = match &first {
                Some(first) if initiator && to.is_written_like(&first.point) => ListedPoint {
                    point: to.clone(),
                    number: first.number,
                },
                _ => add(points, to),
            };
            let mut element = self.listed_element(listed.map(Box::as_ref));
            element.from = start.number;
            element.to = end.number;
            element.joined = connected && joined && listed.is_none_or(|listed| listed.connected);
            elements.push(element);
            last = Some(end);
        }
        if let (Some(first), Some(last)) = (first, last) {
            let returns = initiator && elements.len() > 1 && last.number == first.number;
            if closed && !returns {
                let mut element = self.listed_element(None);
                (element.from, element.to) = (last.number, first.number);
                element.joined = connected && !elements.is_empty();
                elements.push(element);
            }
            if let Some(element) = elements.first_mut().filter(|_| closed || returns) {
                element.joined = connected && element.from == first.number;
            }
        }
        elements
    }

    fn listed_element(&mut self, listed: Option<&Listed>) -> ListedElement {
        let mut element = ListedElement {
            from: 0,
            to: 0,
            direction: Direction::Normal,
            fertile: true,
            visible: true,
            joined: false,
            generator: None,
            base_element: 0,
        };
        let Some(listed) = listed else { return element };
        element.fertile = listed.fertile;
        element.visible = listed.visible;
        if let Some(number) = &listed.direction
            && let Some(value) = self.constant(number)
        {
            let direction = whole_number(value, 4).and_then(Direction::from_number);
            if direction.is_none() {
                self.error_with_hint(
                    &number.place,
                    "a direction is 1, 2, 3 or 4",
                    "1 normal, 2 y reflected, 3 x reflected, 4 both reflected",
                );
            }
            element.direction = direction.unwrap_or_default();
        }
        if let Some(name) = &listed.generator {
            element.generator = self.generator_named(name);
            if !listed.fertile {
                self.error_with_hint(
                    &name.place,
                    "an infertile element is not replaced",
                    "leave out `use`, or `fertile: false`",
                );
            }
        }
        if let Some(document) = &listed.base_element {
            element.base_element = self.base_element(document).unwrap_or(0);
        }
        element
    }

    fn generator_named(&mut self, name: &Written<String>) -> Option<usize> {
        let found = self
            .generator_names
            .iter()
            .position(|known| *known == name.value);
        if found.is_none() {
            let known = self.generator_names.iter().map(String::as_str);
            let hint = did_you_mean(&name.value, known.clone()).unwrap_or_else(|| {
                format!(
                    "the generators are: {}",
                    known.collect::<Vec<_>>().join(", ")
                )
            });
            self.error_with_hint(
                &name.place,
                format!("there is no generator '{}'", name.value),
                hint,
            );
        }
        found
    }

    fn initiator(&mut self, document: &RuleDocument) -> (Vec<DVec2>, Part) {
        let initiator = &document.initiator;
        let mut written = Vec::new();
        let elements = self.elements(
            &initiator.entries,
            initiator.closed,
            initiator.connected,
            &mut written,
            true,
        );
        let points: Vec<_> = written
            .iter()
            .map(|point| self.constant_point(point).unwrap_or(DVec2::NAN))
            .collect();
        for element in &elements {
            if points[element.from] == points[element.to] {
                let place = &written[element.to].place.clone();
                self.error_with_hint(
                    place,
                    "this element of the initiator has no length",
                    "it ends where it starts",
                );
            }
        }
        let part = Part {
            placement: Placement::Stays,
            elements,
            meets_frame: [false; 2],
        };
        (points, part)
    }

    fn generator(&mut self, name: &str, document: &GeneratorDocument, moment: &Scope) -> Generator {
        let mut scope = moment.clone();
        let variables = self.variables(document, &mut scope);
        let mut written = Vec::new();
        let mut parts = Vec::new();
        let mut ends = Vec::new();
        let mut seeding = Vec::new();
        for part in &document.parts {
            let before = written.len();
            let ring = part.placement.seeds();
            let elements = self.elements(
                &part.entries,
                part.closed,
                part.connected,
                &mut written,
                ring,
            );
            let meets_frame = if ring || !part.connected {
                [false; 2]
            } else {
                let meets =
                    |element: Option<&ListedElement>, point: fn(&ListedElement) -> usize, x| {
                        element.is_some_and(|element| is_written(&written[point(element)], x, 0.0))
                    };
                let first = part.entries.first().is_none_or(|entry| match entry {
                    Entry::Element(listed) => listed.connected,
                    Entry::Point(_) => true,
                });
                [
                    first && meets(elements.first(), |element| element.from, 0.0),
                    meets(elements.last(), |element| element.to, 1.0),
                ]
            };
            if ring {
                seeding.extend(before..written.len());
            } else {
                ends.extend(elements.first().map(|element| (element.from, false)));
                ends.extend(elements.last().map(|element| (element.to, true)));
            }
            parts.push(Part {
                placement: part.placement,
                elements,
                meets_frame,
            });
        }
        // The two ends of what takes the element's place: its first and its last point.
        let first = ends
            .iter()
            .find(|(_, last)| !last)
            .map(|(number, _)| *number);
        let last = ends
            .iter()
            .rfind(|(_, last)| *last)
            .map(|(number, _)| *number);
        let inner = (0..written.len()).filter(|number| {
            seeding.contains(number) || Some(*number) != first && Some(*number) != last
        });
        let inner: Vec<_> = inner.collect();
        let moves = document
            .moves
            .iter()
            .map(|moving| self.moving(moving, &scope, written.len(), &inner))
            .collect();
        let points: Vec<_> = written
            .iter()
            .map(|point| {
                [
                    self.program(&point.x, &scope),
                    self.program(&point.y, &scope),
                ]
            })
            .collect();
        self.doubt_growth(&parts, &points, &written);
        Generator {
            name: name.into(),
            variables,
            points,
            moves,
            parts,
        }
    }

    /// Warns of fertile elements that are not shorter than what they replace.
    fn doubt_growth(&mut self, parts: &[Part], points: &[[Program; 2]], written: &[Point]) {
        let value = |number: usize| {
            let [x, y] = &points[number];
            Some(DVec2::new(x.as_constant()?, y.as_constant()?))
        };
        let relative = parts
            .iter()
            .filter(|part| part.placement != Placement::SeedsAsInitiator);
        for element in relative
            .flat_map(|part| &part.elements)
            .filter(|element| element.fertile)
        {
            let (Some(from), Some(to)) = (value(element.from), value(element.to)) else {
                continue;
            };
            let length = (to - from).length();
            if length >= 1.0 {
                let message = format!(
                    "this element does not shrink: it is {length} times as long as what it replaces"
                );
                let hint = "finite steps can be drawn, but there is no limit set";
                let warning = Diagnostic::warning(message)
                    .at(&written[element.to].place)
                    .hint(hint);
                self.diagnostics.push(warning);
            }
        }
    }

    fn variables(&mut self, document: &GeneratorDocument, scope: &mut Scope) -> Vec<Variable> {
        let mut variables: Vec<Variable> = Vec::new();
        for (name, number) in &document.random {
            if !is_name(&name.value) {
                let message = format!("'{}' cannot be a variable's name", name.value);
                self.error_with_hint(
                    &name.place,
                    message,
                    "a name has letters, digits and _, and begins with a letter",
                );
            } else if is_reserved(&name.value) || scope.contains(&name.value) {
                let message = format!("'{}' already has a meaning here", name.value);
                self.error_with_hint(&name.place, message, "give the variable another name");
            }
            let distribution = self.distribution(number, scope);
            scope.variable(&name.value, Moment::NAMES.len() + variables.len());
            variables.push(Variable::new(&name.value, distribution));
        }
        variables
    }

    fn distribution(&mut self, number: &Number, scope: &Scope) -> Distribution {
        let hint = "uniform(a, b), normal(mean, deviation) or choice(a, b, ...)";
        let Some((name, arguments)) = number.value.as_call() else {
            self.error_with_hint(&number.place, "a distribution is needed here", hint);
            return Distribution::Choice(vec![Program::constant(0.0)]);
        };
        let programs: Vec<_> = arguments
            .iter()
            .map(|argument| self.compiled(number, |_| argument.compile(scope)))
            .collect();
        match (name, programs.as_slice()) {
            ("uniform", [low, high]) => Distribution::Uniform(low.clone(), high.clone()),
            ("normal", [mean, deviation]) => {
                if deviation.as_constant().is_some_and(|value| value < 0.0) {
                    self.error(&number.place, "a standard deviation cannot be negative");
                }
                Distribution::Normal(mean.clone(), deviation.clone())
            }
            ("choice", [_, ..]) => Distribution::Choice(programs),
            _ => {
                let message = format!("{name} does not take {} values", programs.len());
                self.error_with_hint(&number.place, message, hint);
                Distribution::Choice(vec![Program::constant(0.0)])
            }
        }
    }

    fn moving(
        &mut self,
        document: &MoveDocument,
        scope: &Scope,
        count: usize,
        inner: &[usize],
    ) -> Move {
        let zero = || Program::constant(0.0);
        let mut pair = |point: &Option<Point>| {
            point.as_ref().map_or([zero(), zero()], |point| {
                [self.program(&point.x, scope), self.program(&point.y, scope)]
            })
        };
        let (shift, about) = (pair(&document.shift), pair(&document.about));
        let scale = match &document.scale {
            Some([x, y]) => [self.program(x, scope), self.program(y, scope)],
            None => [Program::constant(1.0), Program::constant(1.0)],
        };
        let rotate = document
            .rotate
            .as_ref()
            .map_or_else(zero, |number| self.program(number, scope));
        let points = match &document.points {
            WhichPoints::All => (0..count).collect(),
            WhichPoints::Inner => inner.to_vec(),
            WhichPoints::Numbers(numbers) => {
                let mut points = Vec::new();
                for number in numbers {
                    let Some(value) = self.constant(number) else {
                        continue;
                    };
                    let largest = u32::try_from(count.saturating_sub(1)).unwrap_or(u32::MAX);
                    match whole_number(value, largest) {
                        Some(point) => points.push(point as usize),
                        None => {
                            let message = format!(
                                "there is no point {value}: points are numbered 0 to {largest}"
                            );
                            self.error(&number.place, message);
                        }
                    }
                }
                points
            }
        };
        Move {
            rotate,
            scale,
            shift,
            about,
            points,
        }
    }

    fn selection(&mut self, document: &RuleDocument, moment: &Scope) -> Option<Selection> {
        match document.select.as_ref() {
            None => Some(Selection::Always(0)),
            Some(SelectDocument::ByIndex(names, place)) => {
                if names.is_empty() {
                    self.error_with_hint(
                        place,
                        "there is no generator in this list",
                        "by_index: [gen0, gen1]",
                    );
                }
                let entries: Vec<_> = names
                    .iter()
                    .filter_map(|name| self.generator_named(name))
                    .collect();
                (!entries.is_empty()).then_some(Selection::ByIndex(entries))
            }
            Some(SelectDocument::AtRandom(weights, place)) => {
                let mut entries = Vec::new();
                for (name, number) in weights {
                    let (generator, weight) = (self.generator_named(name), self.constant(number));
                    if weight.is_some_and(|weight| weight < 0.0) {
                        self.error(&number.place, "a weight cannot be negative");
                    }
                    entries.extend(weight.zip(generator));
                }
                let total: f64 = entries.iter().map(|(weight, _)| weight).sum();
                if entries.len() == weights.len() && total <= 0.0 {
                    self.error_with_hint(
                        place,
                        "no generator has a weight above 0",
                        "at_random: {gen0: 3, gen1: 1}",
                    );
                }
                Some(Selection::AtRandom(entries))
            }
            Some(SelectDocument::Cases(written, place)) => {
                let mut cases = Vec::new();
                let mut otherwise = None;
                for (when, name) in written {
                    let generator = self.generator_named(name);
                    if otherwise.is_some() {
                        self.error_with_hint(
                            &name.place,
                            "this case is never reached: the one before has no condition",
                            "put the case without a condition last",
                        );
                        break;
                    }
                    match when {
                        Some(number) => {
                            let condition = self.compiled(number, |e| e.compile_condition(moment));
                            cases.extend(generator.map(|generator| (condition, generator)));
                        }
                        None => otherwise = Some(generator),
                    }
                }
                match otherwise {
                    Some(generator) => Some(Selection::ByCondition {
                        cases,
                        otherwise: generator?,
                    }),
                    None => {
                        let last = written.last().map_or(place, |(_, name)| &name.place);
                        self.error_with_hint(
                            last,
                            "the selection can fall through: its last case has a condition",
                            "end with a case that has none: - {use: NAME}",
                        );
                        None
                    }
                }
            }
        }
    }

    /// Every fertile element needs a generator: one that it names, the selection's, or the only one.
    fn check_generators_are_selected(&mut self, document: &RuleDocument) {
        if document.select.is_some() || document.generators.len() < 2 {
            return;
        }
        let parts = document
            .generators
            .iter()
            .flat_map(|(_, generator)| &generator.parts);
        let lists = parts.map(|part| (&part.entries, part.closed));
        let lists = lists.chain([(&document.initiator.entries, document.initiator.closed)]);
        for (entries, closed) in lists {
            let undecided = entries
                .iter()
                .skip(1)
                .any(|entry| matches!(entry, Entry::Point(_)));
            let element = entries.iter().any(|entry| match entry {
                Entry::Element(listed) => listed.fertile && listed.generator.is_none(),
                Entry::Point(_) => false,
            });
            if undecided || element || closed {
                let (name, _) = &document.generators[1];
                self.error_with_hint(
                    &name.place,
                    "the rule has several generators but does not say which one replaces an element",
                    "select: {by_index: [...]}, select: {at_random: {...}}, select: [{when: ..., use: ...}, {use: ...}], \
                     or `use: NAME` on every fertile element",
                );
                return;
            }
        }
    }
}

/// Whether a point is written as these very numbers.
fn is_written(point: &Point, x: f64, y: f64) -> bool {
    let is = |number: &Number, value: f64| {
        number
            .value
            .compile(&Scope::new())
            .is_ok_and(|program| program.as_constant() == Some(value))
    };
    is(&point.x, x) && is(&point.y, y)
}

fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// A value as a whole number from 0 to `most`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is checked"
)]
fn whole_number(value: f64, most: u32) -> Option<u32> {
    (value >= 0.0 && value <= f64::from(most) && value.fract() == 0.0).then_some(value as u32)
}
