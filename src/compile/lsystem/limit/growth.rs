//! Growth of the displacements of variables: the ratio of one step, and the proportions that they approach.
//!
//! Directions recur after some steps, a *period*, and displacements at multiples of the period follow from each other by
//! one linear map. Krylov's method finds their recurrence of least order, whose characteristic polynomial has a root for
//! every rate of growth that takes part. If one root λ is larger than all others, displacements approach λᵐ v, or
//! mᵏλᵐ v if it is a multiple one; the polynomial without one factor x − λ, applied to the first displacements, is
//! proportional to v. Roots of one absolute value become one if the period is extended by the order of their quotients,
//! if these are roots of unity; otherwise nothing recurs.

use std::collections::BTreeMap;

use crate::geometry::Frame2;
use crate::lsystem::TurtleFrame;

use super::NoGrowth;
use super::budget::Budget;
use super::number::{Complex, Number, Numbers, log2};
use super::polynomial::{Polynomial, SAME, largest};
use super::turns::{Effects, Reader, Reading, STEP, Turn, Turned, Variable};

/// Limit of the number of steps before and within the period.
const MAX_STEPS: usize = 1 << 10;

/// Limit of the number of displacements that are stored.
const MAX_STORED: usize = 1 << 15;

/// Limit of the order of recurrences.
const MAX_ORDER: usize = 48;

/// Largest order of roots of unity that are tried.
const MAX_TURNS: u32 = 720;

/// Readings of words at all steps.
pub(super) struct Steps<F: TurtleFrame = Frame2> {
    /// Effects of all variables by step.
    effects: Vec<Effects<F::Heading>>,
    /// Readings of all variables other than the line by step, one more than of effects: the last returns to the period's
    /// first effects.
    readings: Vec<Vec<Reading<F::Heading>>>,
    /// First step of the period.
    pub(super) first: usize,
    /// Number of steps of the period.
    pub(super) period: usize,
}

impl<F: TurtleFrame> Steps<F> {
    /// Reads words until all directions recur.
    pub(super) fn of(reader: &Reader<'_, F>) -> Result<Self, NoGrowth> {
        let effects = |readings: &[Reading<F::Heading>]| -> Effects<F::Heading> {
            let line = [(Turn::none::<F>(), true)].into_iter();
            let others = readings.iter().map(|it| (it.turn, !it.parts.is_empty()));
            line.chain(others).collect()
        };
        let key = |(turn, draws): &(Turn<F::Heading>, bool)| {
            let heading = F::key(reader.compass, turn.heading);
            (heading, turn.mirrored, turn.scale.to_bits(), *draws)
        };
        let mut steps = Self {
            effects: Vec::new(),
            readings: vec![reader.kept()?],
            first: 0,
            period: 0,
        };
        let mut known = BTreeMap::new();
        for step in 0..MAX_STEPS {
            let now = effects(&steps.readings[step]);
            let keys: Vec<_> = now.iter().map(key).collect();
            if let Some(first) = known.insert(keys, step) {
                (steps.first, steps.period) = (first, step - first);
                return Ok(steps);
            }
            steps.readings.push(reader.replaced(&now)?);
            steps.effects.push(now);
        }
        Err(NoGrowth::Turns)
    }

    /// Returns the number of a step that is equal to a step.
    fn equal(&self, step: usize, least: usize) -> usize {
        let last = self.effects.len() - 1 + least;
        match step > last {
            true => {
                self.first + least + (step - self.first - least) % (last + 1 - self.first - least)
            }
            false => step,
        }
    }

    /// Returns the effects of all variables at a step.
    pub(super) fn effects(&self, step: usize) -> &Effects<F::Heading> {
        &self.effects[self.equal(step, 0)]
    }

    /// Returns the reading of a variable other than the line at a step.
    pub(super) fn reading(&self, step: usize, variable: Variable) -> &Reading<F::Heading> {
        &self.readings[self.equal(step, 1)][variable - 1]
    }

    /// Returns the number of terms of the displacements of some variables at a step.
    pub(super) fn terms(&self, step: usize, variables: &[Variable]) -> usize {
        let others = variables.iter().filter(|it| **it != STEP);
        others.map(|it| self.reading(step, *it).sums.len()).sum()
    }

    /// Iterates over the steps of the period, each as the one that replaces the step before it.
    fn recurring(&self) -> impl Iterator<Item = usize> {
        self.first + 1..=self.first + self.period
    }

    /// Returns the variables whose displacements decide where parts are drawn in the limit.
    pub(super) fn relevant(&self, reader: &Reader<'_, F>) -> Result<Vec<Variable>, NoGrowth> {
        let mut relevant = vec![false; reader.fertile.len() + 1];
        let mut places = |reading: &Reading<F::Heading>| {
            let terms = reading.terms_of_parts();
            terms.for_each(|it| relevant[it.of] = true);
        };
        let mut draws = false;
        for step in self.recurring() {
            let axiom = reader.read(&reader.kinds.axiom, Some(self.effects(step)))?;
            draws |= !axiom.parts.is_empty();
            places(&axiom);
            self.readings[self.equal(step, 1)]
                .iter()
                .for_each(&mut places);
        }
        if !draws {
            return Err(NoGrowth::Empty);
        }
        let mut open: Vec<Variable> = (0..relevant.len()).filter(|&it| relevant[it]).collect();
        while let Some(variable) = open.pop() {
            if variable == STEP {
                continue;
            }
            for step in self.recurring() {
                let reading = self.reading(step, variable);
                for term in reading.terms(reading.end) {
                    if !std::mem::replace(&mut relevant[term.of], true) {
                        open.push(term.of);
                    }
                }
            }
        }
        Ok((0..relevant.len()).filter(|&it| relevant[it]).collect())
    }
}

/// Growth of displacements.
pub(super) struct Growth {
    /// Number of steps of the period.
    pub(super) period: usize,
    /// Factor of one step.
    pub(super) ratio: Complex,
    /// Whether the factor is 1.
    pub(super) is_one: bool,
    /// Displacements that are approached at the steps of the period, each divided by the power of the ratio; `None` for
    /// variables that decide no place.
    pub(super) ways: Vec<Vec<Option<Complex>>>,
}

/// Displacements of the relevant variables, and their conjugates if any variable is mirrored.
type Places = Vec<Number>;

/// Displacements of relevant variables, step by step.
struct Course<'s, 'r> {
    steps: &'s Steps,
    relevant: Vec<Variable>,
    mirrors: bool,
    numbers: &'r mut Numbers,
    budget: &'s Budget,
    /// Places of all steps from the first of the period.
    places: Vec<Places>,
}

impl Growth {
    pub(super) fn of(
        steps: &mut Steps,
        reader: &Reader<'_>,
        numbers: &mut Numbers,
    ) -> Result<Self, NoGrowth> {
        let budget = &reader.budget;
        let relevant = steps.relevant(reader)?;
        let mirrored = |reading: &Reading| reading.sums.iter().any(|it| it.turn.mirrored);
        let mirrors = { steps.readings.iter().flatten() }.any(mirrored);
        loop {
            let mut course = Course {
                steps,
                relevant: relevant.clone(),
                mirrors,
                numbers,
                budget,
                places: Vec::new(),
            };
            let polynomial = course.recurrence()?;
            let rest = polynomial.iter().skip_while(|it| it.is_zero()).cloned();
            let rest: Polynomial = rest.collect();
            if rest.len() < 2 {
                return Err(NoGrowth::Slow);
            }
            let largest = largest(&rest, course.numbers).ok_or(NoGrowth::Size)?;
            match extension(&largest.roots, mirrors, course.numbers.bits())? {
                1 => {
                    let [root] = &largest.roots[..] else {
                        return Err(NoGrowth::Size);
                    };
                    if largest.multiplicity > 1 && is_unit(root, course.numbers.bits()) {
                        return Err(NoGrowth::Slow);
                    }
                    return Ok(course.grown(&polynomial, root));
                }
                times => steps.period *= times as usize,
            }
        }
    }
}

/// Returns the number of times by which the period must be extended for the roots to be equal: to a positive number if
/// variables are mirrored, and to 1 if they are no larger.
fn extension(roots: &[Complex], mirrors: bool, bits: usize) -> Result<u32, NoGrowth> {
    let one = Complex::real(1.0, bits);
    let [first, others @ ..] = roots else {
        return Err(NoGrowth::Size);
    };
    let mut quotients: Vec<Complex> = others.iter().map(|root| root.over(first)).collect();
    // With its conjugate among the roots, the first becomes real.
    let is_real = (first - &first.conjugate()).log2() <= first.log2() + SAME;
    if is_unit(first, bits) {
        quotients.push(first.clone());
    } else if mirrors && is_real && first.re < one.im {
        quotients.push(Complex::real(-1.0, bits));
    }
    let order = |quotient: &Complex| {
        let mut power = one.clone();
        (1..=MAX_TURNS).find(|_| {
            power = &power * quotient;
            (&power - &one).log2() <= 0.5 * SAME
        })
    };
    let mut times = 1;
    for quotient in &quotients {
        let order = order(quotient).ok_or(NoGrowth::Directions)?;
        times *= order / common(times, order);
        if times > MAX_TURNS {
            return Err(NoGrowth::Size);
        }
    }
    Ok(times)
}

/// Returns whether a number has the absolute value 1.
fn is_unit(number: &Complex, bits: usize) -> bool {
    log2(&(number.norm() - Complex::real(1.0, bits).re)) <= SAME
}

fn common(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { common(b, a % b) }
}

impl Course<'_, '_> {
    /// Returns the polynomial of the recurrence of least order of the places at multiples of the period.
    fn recurrence(&mut self) -> Result<Polynomial, NoGrowth> {
        // Rows of an echelon form, each with its pivot and its combination of places.
        let mut rows: Vec<(usize, Places, Polynomial)> = Vec::new();
        loop {
            let order = rows.len();
            self.advance(order * self.steps.period)?;
            let mut place = self.places[order * self.steps.period].clone();
            let mut combined = vec![self.numbers.real(0.0); order];
            combined.push(self.numbers.real(1.0));
            // Each row takes two operations for every number.
            self.budget.spend(2 * order * (place.len() + order))?;
            for (pivot, row, combination) in &rows {
                let factor = self.numbers.over(&place[*pivot], &row[*pivot]);
                let reduce = |from: &mut Places, by: &[Number]| {
                    for (number, inner) in from.iter_mut().zip(by) {
                        let product = self.numbers.times(&factor, inner);
                        *number = self.numbers.minus(number, &product);
                    }
                };
                reduce(&mut place, row);
                reduce(&mut combined, combination);
            }
            let others = place.iter().enumerate().filter(|(_, it)| !it.is_zero());
            let size = |(_, number): &(usize, &Number)| number.value.log2();
            let Some((pivot, _)) = others.max_by(|a, b| size(a).total_cmp(&size(b))) else {
                return Ok(combined);
            };
            if order >= MAX_ORDER {
                return Err(NoGrowth::Size);
            }
            rows.push((pivot, place, combined));
        }
    }

    /// Computes the places up to a step after the first one of the period.
    fn advance(&mut self, last: usize) -> Result<(), NoGrowth> {
        let width = self.relevant.len() * if self.mirrors { 2 } else { 1 };
        if (last + 1).saturating_mul(width) > MAX_STORED {
            return Err(NoGrowth::Size);
        }
        if self.places.is_empty() {
            let mut places = Vec::new();
            for step in 0..=self.steps.first {
                places = self.next(step, &places)?;
            }
            self.places.push(places);
        }
        while self.places.len() <= last {
            let step = self.steps.first + self.places.len();
            let next = self.next(step, &self.places[self.places.len() - 1].clone())?;
            self.places.push(next);
        }
        Ok(())
    }

    /// Returns the places at a step, given those before it.
    fn next(&mut self, step: usize, before: &[Number]) -> Result<Places, NoGrowth> {
        let steps = self.steps;
        // Each term takes two products and a sum.
        let each = 3 * if self.mirrors { 2 } else { 1 };
        self.budget
            .spend(each * steps.terms(step, &self.relevant))?;
        let mut next = Vec::new();
        for mirrored in [false, true] {
            if mirrored && !self.mirrors {
                break;
            }
            for variable in self.relevant.clone() {
                if variable == STEP {
                    next.push(self.numbers.real(1.0));
                    continue;
                }
                let mut sum = self.numbers.real(0.0);
                let reading = steps.reading(step, variable);
                for term in reading.terms(reading.end) {
                    let way = self.term(term, mirrored, before);
                    sum = self.numbers.plus(&sum, &way);
                }
                next.push(sum);
            }
        }
        Ok(next)
    }

    /// Returns a term of a sum, or its conjugate, given the places one step before.
    fn term(&mut self, term: &Turned, mirrored: bool, before: &[Number]) -> Number {
        let Turn { heading, scale, .. } = term.turn;
        let heading = match mirrored {
            true => self.numbers.compass().back(heading),
            false => heading,
        };
        let direction = self.numbers.direction(heading);
        let scaled = match scale == 1.0 {
            true => direction,
            false => self.numbers.times(&direction, &self.numbers.real(scale)),
        };
        // Lines do not change.
        if term.of == STEP {
            return scaled;
        }
        let Ok(place) = self.relevant.binary_search(&term.of) else {
            return self.numbers.real(0.0);
        };
        let conjugate = self.mirrors && mirrored != term.turn.mirrored;
        let place = if conjugate {
            place + self.relevant.len()
        } else {
            place
        };
        match before.get(place) {
            Some(place) => self.numbers.times(&scaled, place),
            None => scaled,
        }
    }

    /// Returns the growth at the rate of a root.
    fn grown(&self, polynomial: &Polynomial, root: &Complex) -> Growth {
        let bits = self.numbers.bits();
        // The quotient of the polynomial and x − root, from the highest coefficient to the lowest.
        let mut factors = Vec::new();
        let mut last = Complex::real(0.0, bits);
        for factor in polynomial.iter().skip(1).rev() {
            last = &(&last * root) + &factor.value;
            factors.push(last.clone());
        }
        factors.reverse();
        let one = Complex::real(1.0, bits);
        let is_one = (root - &one).log2() <= SAME;
        let period = self.steps.period;
        let approached = |phase: usize, place: usize| {
            let mut sum = Complex::real(0.0, bits);
            for (number, factor) in factors.iter().enumerate() {
                let place = self
                    .places
                    .get(number * period + phase)
                    .map(|it| &it[place].value);
                sum = place.map_or(sum.clone(), |place| &sum + &(factor * place));
            }
            sum
        };
        let all = 0..self.relevant.len();
        let mut ways: Vec<Vec<Complex>> = (0..period)
            .map(|phase| all.clone().map(|place| approached(phase, place)).collect())
            .collect();
        let ratio = self.ratio(root, is_one, &ways);
        let mut power = one;
        for ways in &mut ways {
            for way in ways {
                *way = way.over(&power);
            }
            power = &power * &ratio;
        }
        let unit = if is_one {
            factors
                .iter()
                .fold(Complex::real(0.0, bits), |sum, it| &sum + it)
        } else {
            let longest = ways
                .iter()
                .flatten()
                .max_by(|a, b| a.log2().total_cmp(&b.log2()));
            longest.cloned().unwrap_or(power)
        };
        for way in ways.iter_mut().flatten() {
            *way = way.over(&unit);
        }
        let count = self.steps.effects[0].len();
        let spread = |ways: Vec<Complex>| {
            let mut all = vec![None; count];
            for (way, variable) in ways.into_iter().zip(&self.relevant) {
                all[*variable] = Some(way);
            }
            all
        };
        Growth {
            period,
            ratio,
            is_one,
            ways: ways.into_iter().map(spread).collect(),
        }
    }

    /// Returns the factor of one step: of the roots of the factor of the period, the positive one or, if no variable is
    /// mirrored, the one that leads from the first step to the next.
    fn ratio(&self, root: &Complex, is_one: bool, ways: &[Vec<Complex>]) -> Complex {
        let bits = self.numbers.bits();
        if is_one {
            return Complex::real(1.0, bits);
        }
        let [first, second, ..] = ways else {
            return root.clone();
        };
        let size = root.log2();
        #[expect(clippy::cast_possible_truncation, reason = "exponents are small")]
        let exponent = size.floor() as isize;
        let near = root.near(exponent);
        let angle = libm::atan2(near.y, near.x);
        #[expect(clippy::cast_precision_loss, reason = "periods are short")]
        let period = ways.len() as f64;
        let step = std::f64::consts::TAU / period;
        let sizes = first
            .iter()
            .zip(second)
            .map(|(a, b)| (a.log2() + b.log2(), a, b));
        let longest = sizes.max_by(|a, b| a.0.total_cmp(&b.0));
        let mut turn = angle / period;
        if let Some((_, a, b)) = longest.filter(|it| it.0.is_finite() && !self.mirrors) {
            let quotient = b.over(a);
            let near = quotient.near(0);
            let wanted = libm::atan2(near.y, near.x);
            turn += libm::round((wanted - turn) / step) * step;
        }
        let length = libm::exp2(size / period);
        let near = crate::geometry::DVec2::new(libm::cos(turn), libm::sin(turn)) * length;
        let degree = u32::try_from(ways.len()).unwrap_or(1);
        root.root(degree, near, bits)
    }
}
