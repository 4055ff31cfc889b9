//! Displacements of the turtle in big integers.
//!
//! The displacement of a word is the sum of those of its modules and may be much shorter than they are;
//! the loss of precision in doubles then grows with every step. If it becomes too large, displacements
//! are summed again in integer multiples of 2^-bits, and every effect receives the position nearest to
//! the exact one.

use std::collections::BTreeMap;

use dashu_int::IBig;

use crate::expression::{Precision, leading};
use crate::geometry::{DVec2, Frame2, Frame3};
use crate::lsystem::{Action, Axis, Compass, TurtleFrame};

use super::effects::{Effect, Effects};
use super::far::Far;
use super::state::{Pose, TurtleState};

/// Limit of the number of bits that a double may lose.
const MAX_LOST: i32 = 20;

/// Number of bits of a big integer that must be correct.
const RIGHT: i32 = 64;

/// Vector in integer multiples of a unit.
pub(super) type Vector = [IBig; 2];

/// Displacement of a kind after some steps.
#[derive(Clone)]
struct Displacement {
    /// Sum, in multiples of 2^-bits.
    place: Vector,
    /// Sum of the lengths of the displacements that are added.
    sum: Far,
    /// Approximate number of roundings, each as a length of 1 at the scale at which it occurred.
    rounded: Far,
}

/// Turtle with its displacement.
struct Turtle {
    pose: Pose,
    displacement: Displacement,
    saved: Vec<(Pose, Displacement)>,
}

impl Turtle {
    fn new(pose: Pose) -> Self {
        let displacement = Displacement {
            place: [IBig::ZERO, IBig::ZERO],
            sum: Far::ZERO,
            rounded: Far::ZERO,
        };
        Self {
            pose,
            displacement,
            saved: Vec::new(),
        }
    }
}

/// Frames of a turtle whose displacements are summed.
pub(super) trait SummedFrame: TurtleFrame {
    /// The sums.
    type Sums: Sums<Self>;
}

impl SummedFrame for Frame2 {
    type Sums = Displacements;
}

impl SummedFrame for Frame3 {
    type Sums = ();
}

/// Displacements that are summed beside the effects, more precisely than in doubles.
pub(super) trait Sums<F: TurtleFrame>: Sized {
    /// Creates the displacements for no steps; `bits` is the precision of the sums, if they are not doubles.
    fn new(compass: Compass, bits: Option<usize>) -> Self;

    /// Returns the number of bits that is required instead, if too many have been lost.
    fn too_few(&self) -> Option<usize>;

    /// Advances to the effects of the next number of steps, and corrects their positions.
    fn advance(&mut self, effects: &Effects<F>, left: u32, level: &mut [Option<Box<Effect<F>>>]);
}

/// Doubles suffice.
impl<F: TurtleFrame> Sums<F> for () {
    fn new(_: Compass, _: Option<usize>) {}

    fn too_few(&self) -> Option<usize> {
        None
    }

    fn advance(&mut self, _: &Effects<F>, _: u32, _: &mut [Option<Box<Effect<F>>>]) {}
}

/// Displacements of all kinds for the number of steps that has been processed.
pub(super) struct Displacements {
    compass: Compass,
    /// Precision of the sums; `None` if doubles suffice.
    precision: Option<Precision>,
    directions: BTreeMap<u64, Vector>,
    known: Vec<Option<Displacement>>,
    /// Number of bits lost, of doubles and of big integers.
    lost: [i32; 2],
}

impl Sums<Frame2> for Displacements {
    fn new(compass: Compass, bits: Option<usize>) -> Self {
        Self {
            compass,
            precision: bits.map(Precision::new),
            directions: BTreeMap::new(),
            known: Vec::new(),
            lost: [0; 2],
        }
    }

    fn too_few(&self) -> Option<usize> {
        let [double, long] = self.lost;
        let enough = match &self.precision {
            None => double <= MAX_LOST,
            Some(precision) => {
                i64::try_from(precision.bits()).is_ok_and(|bits| i64::from(long + RIGHT) <= bits)
            }
        };
        let bits = usize::try_from(long.saturating_add(2 * RIGHT)).unwrap_or_default();
        (!enough).then_some(bits)
    }

    fn advance(&mut self, effects: &Effects, left: u32, level: &mut [Option<Box<Effect>>]) {
        let known = std::mem::take(&mut self.known);
        let mut next = Vec::with_capacity(level.len());
        for (kind, effect) in level.iter_mut().enumerate() {
            let exact = effect.as_mut().filter(|effect| effect.is_exact);
            next.push(exact.and_then(|effect| {
                let displacement = self.follow(effects, (kind, left), &known)?;
                self.correct(effect, &displacement);
                Some(displacement)
            }));
        }
        self.known = next;
    }
}

impl Displacements {
    fn correct(&mut self, effect: &mut Effect, displacement: &Displacement) {
        if let Some(precision) = &self.precision {
            effect.state.pose.place = Far::of_long(&displacement.place, precision.bits());
        }
        let Some(drawn) = &mut effect.drawn else {
            return;
        };
        drawn.size = drawn.size_of(&effect.state.pose);
        let longest = displacement.sum.plus(displacement.rounded);
        for (lost, sum) in self.lost.iter_mut().zip([displacement.sum, longest]) {
            *lost = (*lost).max(sum.bits_beyond(drawn.reach));
        }
    }

    /// Returns the displacement of the successor of a kind, given those of all kinds with one step less; `None` unless
    /// the kind has exactly one successor.
    fn follow(
        &mut self,
        effects: &Effects,
        (kind, left): (usize, u32),
        known: &[Option<Displacement>],
    ) -> Option<Displacement> {
        let [only] = effects.kinds.all[kind].alternatives.as_slice() else {
            return None;
        };
        let mut turtle = Turtle::new(TurtleState::SAME.pose);
        for &kind in &only.word {
            let of = &effects.kinds.all[kind];
            if left > 1 && of.is_fertile() {
                self.go(&mut turtle, known.get(kind)?.as_ref()?);
                let effect = effects.of(kind, left - 1).ok()?;
                turtle.pose = turtle.pose.then(self.compass, &effect.state.pose);
                continue;
            }
            for action in &effects.system.symbols()[of.symbol].meaning {
                self.act(&mut turtle, action, &of.arguments)?;
            }
        }
        Some(turtle.displacement)
    }

    /// Returns the ends of the lines that a word draws from a pose without being replaced, and its
    /// displacement.
    pub(super) fn lines(
        &mut self,
        effects: &Effects,
        word: &[usize],
        start: Pose,
    ) -> Option<(Vec<[Vector; 2]>, Vector)> {
        let mut turtle = Turtle::new(start);
        let mut lines = Vec::new();
        for &kind in word {
            let of = &effects.kinds.all[kind];
            for action in &effects.system.symbols()[of.symbol].meaning {
                let from = turtle.displacement.place.clone();
                self.act(&mut turtle, action, &of.arguments)?;
                if matches!(action, Action::Draw(_)) && turtle.displacement.place != from {
                    lines.push([from, turtle.displacement.place.clone()]);
                }
            }
        }
        Some((lines, turtle.displacement.place))
    }

    /// Applies an action, as far as it affects the position of the turtle.
    fn act(&mut self, turtle: &mut Turtle, action: &Action, arguments: &[f64]) -> Option<()> {
        match action {
            Action::Draw(steps) | Action::Move(steps) | Action::Glide(steps) => {
                let step = self.step(steps.eval(arguments));
                self.go(turtle, &step);
            }
            Action::Turn(angle) => {
                let angle = angle.eval(arguments);
                turtle.pose.turn(self.compass, Axis::Up, angle);
            }
            Action::Push => turtle
                .saved
                .push((turtle.pose, turtle.displacement.clone())),
            Action::Pop => (turtle.pose, turtle.displacement) = turtle.saved.pop()?,
            Action::Reflect => turtle.pose.mirrored ^= true,
            Action::Scale(factor) => turtle.pose.scale *= factor.eval(arguments),
            // The doubles know which branches are cut off.
            Action::Cut => return None,
            _ => {}
        }
        Some(())
    }

    /// Returns the displacement of some steps ahead.
    fn step(&self, steps: f64) -> Displacement {
        let bits = self.precision.as_ref().map_or(0, Precision::bits);
        let length = Far::of_length(steps);
        Displacement {
            place: [times(&(IBig::ONE << bits), steps), IBig::ZERO],
            sum: length,
            rounded: Far::of_length(1.0),
        }
    }

    /// Adds a displacement, relative to the current pose.
    fn go(
        &mut self,
        Turtle {
            pose, displacement, ..
        }: &mut Turtle,
        next: &Displacement,
    ) {
        let scaled = |far: Far| far.times(pose.scale).length();
        displacement.sum = displacement.sum.plus(scaled(next.sum));
        let rounded = scaled(next.rounded).plus(Far::of_length(1.0));
        displacement.rounded = displacement.rounded.plus(rounded);
        let Some(precision) = &mut self.precision else {
            return;
        };
        let (compass, bits) = (self.compass, precision.bits());
        let [cosine, sine] = &*self
            .directions
            .entry(pose.heading)
            .or_insert_with(|| precision.direction(compass.fraction(pose.heading)));
        let [x, y] = &next.place;
        let y = if pose.mirrored { -y } else { y.clone() };
        let turned = [x * cosine - &y * sine, x * sine + y * cosine];
        for (sum, along) in displacement.place.iter_mut().zip(turned) {
            *sum += times(&(along >> bits), pose.scale);
        }
    }
}

/// Multiplies an integer by a double, rounding down.
fn times(number: &IBig, factor: f64) -> IBig {
    /// Number of bits of a double's mantissa.
    const DIGITS: i32 = 53;
    if factor == 1.0 {
        return number.clone();
    }
    let (mantissa, exponent) = libm::frexp(factor);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "it is a whole number of 53 bits"
    )]
    let mantissa = libm::ldexp(mantissa, DIGITS) as i64;
    let (product, shift) = (number * mantissa, exponent - DIGITS);
    let by = shift.unsigned_abs() as usize;
    if shift < 0 {
        product >> by
    } else {
        product << by
    }
}

impl Far {
    /// Converts a vector in multiples of 2^-`bits`.
    fn of_long(vector: &Vector, bits: usize) -> Self {
        let (near, dropped) = leading(vector.iter());
        let near: Vec<f64> = near.collect();
        let power = |by: usize| i32::try_from(by).unwrap_or(i32::MAX);
        Self::new(DVec2::from_slice(&near)).shifted(power(dropped) - power(bits))
    }
}
