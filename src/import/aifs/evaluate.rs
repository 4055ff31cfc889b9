//! Evaluation of the definitions of a block, and of those that it inherits.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::Place;

use super::affine::{Affine, MAX_DIMENSION};
use super::blocks::{Block, Definition};
use super::functions;
use super::syntax::{Expression, Kind, Operator, Parsed};
use super::value::{NO_DIMENSION, Term, Value, composed, united, wrong, wrong_with};

/// Largest depth of expressions within each other, through the names of variables too.
const MAX_DEPTH: usize = 200;

/// Definitions that hold in a block: its own, and those of its ancestors.
pub(super) struct Scope<'a> {
    /// The block, its parent, the parent of that, and so on.
    chain: &'a [&'a Block],
    /// Names in the order of their definitions, those of ancestors first.
    pub(super) names: Vec<&'a str>,
    /// Names of sets: definitions that refer to themselves, and those that depend on them.
    pub(super) sets: BTreeSet<&'a str>,
    /// Dimension of the maps; 0 until it is known.
    pub(super) dimension: usize,
    known: BTreeMap<&'a str, Value<'a>>,
    depth: usize,
    /// Number of multiplications that may still be done.
    budget: &'a Cell<u64>,
}

impl<'a> Scope<'a> {
    pub(super) fn new(chain: &'a [&'a Block], budget: &'a Cell<u64>) -> Parsed<Self> {
        let definitions = chain.iter().rev().flat_map(|block| &block.definitions);
        let mut known = BTreeSet::new();
        let names = definitions.map(|definition| &definition.name[..]);
        let names: Vec<_> = names
            .filter(|name| !name.starts_with('$') && known.insert(*name))
            .collect();
        let mut scope = Self {
            chain,
            names,
            sets: BTreeSet::new(),
            dimension: 0,
            known: BTreeMap::new(),
            depth: 0,
            budget,
        };
        scope.spend(16 * scope.names.len() as u64, &chain[0].place)?;
        scope.sets = scope.dependent_on_cycles();
        let Some(dimension) = scope.definition("$dim") else {
            return wrong_with(
                "the dimension of this block is not stated",
                &chain[0].place,
                "$dim=2 is that of the plane",
            );
        };
        let value = scope.expression(dimension)?;
        let whole = scope.evaluate(value)?.whole(&value.place)?;
        let known = usize::try_from(whole).ok();
        match known.filter(|it| (1..=MAX_DIMENSION).contains(it)) {
            Some(dimension) => scope.dimension = dimension,
            None => {
                let message = format!("{whole} is no dimension from 1 to {MAX_DIMENSION}");
                return wrong(message, &value.place);
            }
        }
        Ok(scope)
    }

    /// Returns the definition of a name, or of a setting that begins with `$`.
    pub(super) fn definition(&self, name: &str) -> Option<&'a Definition> {
        self.chain.iter().find_map(|block| block.definition(name))
    }

    /// Returns the place of the name of a definition, or that of the block.
    pub(super) fn place_of(&self, name: &str) -> Place {
        let definition = self.definition(name);
        definition
            .map_or(&self.chain[0].place, |it| &it.place)
            .clone()
    }

    /// Returns the matrix by rows of a map.
    pub(super) fn linear_part(&mut self, name: &str, place: &Place) -> Parsed<Vec<f64>> {
        let Some(definition) = self.definition(name) else {
            return wrong(format!("there is no matrix '{name}'"), place);
        };
        let value = self.named(&definition.name, place)?;
        Ok(value.map(self.dimension, &definition.place)?.matrix)
    }

    /// Returns the expression of a definition, or the mistake in its form.
    pub(super) fn expression(&self, definition: &'a Definition) -> Parsed<&'a Expression> {
        match &definition.expression {
            Some(Ok(expression)) => Ok(expression),
            Some(Err(mistake)) => Err(mistake.clone()),
            None => wrong("this is no expression", &definition.value),
        }
    }

    /// Returns the first mistake in the form of a definition.
    pub(super) fn check(&self) -> Parsed<()> {
        let mut definitions = self.names.iter().filter_map(|name| self.definition(name));
        definitions.try_for_each(|it| self.expression(it).map(drop))
    }

    /// Returns the names from which a cycle is reached: those that remain after names that depend on no other name are
    /// taken away, over and over (Kahn 1962).
    fn dependent_on_cycles(&self) -> BTreeSet<&'a str> {
        let mut users: BTreeMap<&str, Vec<&'a str>> = BTreeMap::new();
        let mut open: BTreeMap<&'a str, usize> = BTreeMap::new();
        for name in &self.names {
            let mut used = BTreeSet::new();
            if let Some(Ok(expression)) =
                self.definition(name).and_then(|it| it.expression.as_ref())
            {
                expression.names(&mut |name| {
                    used.insert(name);
                });
            }
            used.retain(|used| self.definition(used).is_some());
            open.insert(name, used.len());
            for used in used {
                users.entry(used).or_default().push(name);
            }
        }
        let done = open.iter().filter(|(_, count)| **count == 0);
        let mut done: Vec<&str> = done.map(|(name, _)| *name).collect();
        while let Some(name) = done.pop() {
            open.remove(name);
            for user in users.get(name).into_iter().flatten() {
                if let Some(count) = open.get_mut(user) {
                    *count -= 1;
                    if *count == 0 {
                        done.push(user);
                    }
                }
            }
        }
        open.into_keys().collect()
    }

    /// Returns the images of sets that a set consists of.
    pub(super) fn set(&mut self, name: &str) -> Parsed<Vec<Term<'a>>> {
        let Some(definition) = self.definition(name) else {
            return wrong(format!("there is no set {name}"), &self.chain[0].place);
        };
        let expression = self.expression(definition)?;
        let value = self.evaluate(expression)?;
        let terms = value.terms(self.dimension, &expression.place)?;
        match terms.iter().find(|term| term.set.is_none()) {
            Some(map) => wrong_with(
                "a map stands where a set is expected",
                &map.place,
                format!("a map of a set is a product, such as f*{name}"),
            ),
            None => Ok(terms),
        }
    }

    pub(super) fn evaluate(&mut self, expression: &'a Expression) -> Parsed<Value<'a>> {
        let place = &expression.place;
        if self.depth == MAX_DEPTH {
            return wrong(format!("this nests more than {MAX_DEPTH} levels"), place);
        }
        self.depth += 1;
        let value = self.value(expression);
        self.depth -= 1;
        match &value {
            Ok(Value::Number(number)) if !number.is_finite() => {
                wrong("this number is not finite", place)
            }
            Ok(Value::Union(_)) if self.dimension == 0 => wrong(NO_DIMENSION, place),
            Ok(Value::Union(terms)) if !terms.iter().all(|term| term.map.is_finite()) => {
                wrong("this map is not finite", place)
            }
            _ => value,
        }
    }

    fn value(&mut self, expression: &'a Expression) -> Parsed<Value<'a>> {
        let place = &expression.place;
        match &expression.kind {
            Kind::Number(number) => Ok(Value::Number(*number)),
            Kind::Name(name) => self.named(name, place),
            Kind::List(items) => {
                let items = items.iter().map(|item| self.evaluate(item));
                Ok(Value::List(items.collect::<Parsed<_>>()?))
            }
            Kind::Call(name, arguments) => {
                let values = arguments.iter().map(|item| self.evaluate(item));
                let values = values.collect::<Parsed<Vec<_>>>();
                functions::call(name, values, self.dimension, place)
            }
            Kind::Element(list, indices) => {
                let mut value = self.evaluate(list)?;
                for index in indices {
                    let at = self.evaluate(index)?.whole(&index.place)?;
                    value = functions::element(value, at, &index.place)?;
                }
                Ok(value)
            }
            Kind::Minus(inner) => match self.evaluate(inner)? {
                Value::Number(number) => Ok(Value::Number(-number)),
                other => self.product(Value::Number(-1.0), place, other, &inner.place),
            },
            Kind::Power(base, exponent) => {
                let value = self.evaluate(base)?;
                let exponent_value = self.evaluate(exponent)?;
                self.power(value, &base.place, &exponent_value, &exponent.place)
            }
            Kind::Product(factors) => {
                let mut factors = factors.iter();
                let mut product = match factors.next() {
                    Some((_, first)) => (self.evaluate(first)?, &first.place),
                    None => (Value::Number(1.0), place),
                };
                for (operator, factor) in factors {
                    let value = self.evaluate(factor)?;
                    let value = self.joined(product, *operator, (value, &factor.place))?;
                    product = (value, place);
                }
                Ok(product.0)
            }
            Kind::Sum(terms) => {
                let mut terms = terms.iter();
                let mut sum = match terms.next() {
                    Some((_, first)) => (self.evaluate(first)?, &first.place),
                    None => (Value::Number(0.0), place),
                };
                for (operator, term) in terms {
                    let value = self.evaluate(term)?;
                    sum = (self.added(sum, *operator, (value, &term.place))?, place);
                }
                Ok(sum.0)
            }
            Kind::Union(parts) => {
                let mut all = Vec::new();
                for part in parts {
                    let terms = self.evaluate(part)?.terms(self.dimension, &part.place)?;
                    all = united(all, terms)?;
                }
                Ok(Value::Union(all))
            }
        }
    }

    fn named(&mut self, name: &'a str, place: &Place) -> Parsed<Value<'a>> {
        if let Some(set) = self.sets.get(name) {
            return Ok(Value::Union(vec![Term {
                map: Affine::scaling(self.dimension, 1.0),
                set: Some(*set),
                place: place.clone(),
            }]));
        }
        if let Some(value) = self.known.get(name) {
            let value = value.clone();
            let size = match &value {
                Value::Number(_) => 1,
                Value::List(items) => items.len(),
                Value::Union(terms) => terms.len() * self.dimension * self.dimension,
            };
            self.spend(size as u64, place)?;
            return Ok(value);
        }
        let Some(definition) = self.definition(name).filter(|_| !name.starts_with('$')) else {
            return functions::constant(name, place);
        };
        let value = self
            .expression(definition)
            .and_then(|it| self.evaluate(it))?;
        self.known.insert(&definition.name, value.clone());
        Ok(value)
    }

    fn joined(
        &mut self,
        (a, a_place): (Value<'a>, &Place),
        operator: Operator,
        (b, b_place): (Value<'a>, &Place),
    ) -> Parsed<Value<'a>> {
        match (operator, &a, &b) {
            (Operator::Over, Value::Number(a), Value::Number(b)) => Ok(Value::Number(a / b)),
            (Operator::Modulo, a, b) => {
                let (a, b) = (a.number(a_place)?, b.number(b_place)?);
                let whole = libm::floor(a / b);
                Ok(Value::Number(if b == 0.0 { a } else { a - b * whole }))
            }
            (Operator::Over, ..) => {
                let inverse = self.power(b, b_place, &Value::Number(-1.0), b_place)?;
                self.product(a, a_place, inverse, b_place)
            }
            _ => self.product(a, a_place, b, b_place),
        }
    }

    fn product(
        &mut self,
        a: Value<'a>,
        a_place: &Place,
        b: Value<'a>,
        b_place: &Place,
    ) -> Parsed<Value<'a>> {
        if let (Value::Number(a), Value::Number(b)) = (&a, &b) {
            return Ok(Value::Number(a * b));
        }
        let then = a.terms(self.dimension, a_place)?;
        let first = b.terms(self.dimension, b_place)?;
        let pairs = (then.len() as u64).saturating_mul(first.len() as u64);
        self.spend(pairs.saturating_mul(self.cost()), b_place)?;
        composed(&first, &then, a_place).map(Value::Union)
    }

    fn added(
        &mut self,
        (a, a_place): (Value<'a>, &Place),
        operator: Operator,
        (b, b_place): (Value<'a>, &Place),
    ) -> Parsed<Value<'a>> {
        let sign = if operator == Operator::Minus {
            -1.0
        } else {
            1.0
        };
        match (&a, &b) {
            (Value::Number(a), Value::Number(b)) => Ok(Value::Number(a + sign * b)),
            (Value::List(some), Value::List(others)) if some.len() == others.len() => {
                let (a, b) = (a.numbers(a_place)?, b.numbers(b_place)?);
                let sums = a.iter().zip(b).map(|(a, b)| Value::Number(a + sign * b));
                Ok(Value::List(sums.collect()))
            }
            _ => {
                for (value, place) in [(&a, a_place), (&b, b_place)] {
                    if value.is_translation(self.dimension) {
                        return wrong_with(
                            "a translation is not added to a map",
                            place,
                            "[1, 0]*f moves the image of a map f by [1, 0]",
                        );
                    }
                }
                let a = a.map(self.dimension, a_place)?;
                let b = b.map(self.dimension, b_place)?;
                self.spend(self.cost(), b_place)?;
                let sum = a.plus(&Affine::scaling(self.dimension, sign).after(&b));
                Ok(self.term(sum, a_place))
            }
        }
    }

    fn power(
        &mut self,
        base: Value<'a>,
        place: &Place,
        exponent: &Value<'a>,
        exponent_place: &Place,
    ) -> Parsed<Value<'a>> {
        if let Value::Number(base) = base {
            let exponent = exponent.number(exponent_place)?;
            return Ok(Value::Number(libm::pow(base, exponent)));
        }
        let exponent = exponent.whole(exponent_place)?;
        if let (Value::Union(terms), true) = (&base, exponent > 0)
            && terms.len() != 1
        {
            let mut power = base.clone();
            for _ in 1..exponent.min(64) {
                power = self.product(base.clone(), place, power, place)?;
            }
            return Ok(power);
        }
        let map = base.map(self.dimension, place)?;
        self.spend(64 * self.cost(), place)?;
        let map = match exponent < 0 {
            false => Some(map),
            true => map.inverse(),
        };
        match map {
            Some(map) => Ok(self.term(map.power(exponent.unsigned_abs()), place)),
            None => wrong("this map has no inverse", place),
        }
    }

    /// Returns a map as a value.
    fn term(&self, map: Affine, place: &Place) -> Value<'a> {
        Value::Union(vec![Term {
            map,
            set: None,
            place: place.clone(),
        }])
    }

    /// Returns the number of multiplications in a product of two maps.
    fn cost(&self) -> u64 {
        (self.dimension as u64).pow(3) + 16
    }

    /// Subtracts a number of multiplications from those that may be done.
    fn spend(&self, count: u64, place: &Place) -> Parsed<()> {
        match self.budget.get().checked_sub(count) {
            Some(rest) => {
                self.budget.set(rest);
                Ok(())
            }
            None => wrong("this file takes too many multiplications of maps", place),
        }
    }
}
