//! Axes: maps from values to pixels, with ticks at round numbers.

/// A linear or logarithmic axis along a range of pixels.
pub(super) struct Axis {
    logarithmic: bool,
    /// Value, or its decimal logarithm, at the start of the axis.
    from: f64,
    /// Value, or its decimal logarithm, at the end of the axis.
    to: f64,
    pixels: [f64; 2],
}

/// A tick of an axis.
pub(super) struct Tick {
    /// Position in pixels.
    pub(super) at: f64,
    /// Label, where there is room for one.
    pub(super) label: Option<Label>,
}

/// Label of a tick.
pub(super) enum Label {
    /// A power of ten, by its exponent.
    Power(i32),
    /// A number, and the number of its decimals.
    Number(f64, usize),
}

impl Label {
    /// Returns the text on the baseline, and the superscript.
    pub(super) fn parts(&self) -> (String, String) {
        match *self {
            Self::Power(0) => ("1".into(), String::new()),
            Self::Power(1) => ("10".into(), String::new()),
            Self::Power(exponent) => ("10".into(), exponent.to_string().replace('-', "−")),
            Self::Number(value, decimals) => (format!("{value:.decimals$}"), String::new()),
        }
    }
}

/// Share of the range that is left free on either side.
const MARGIN: f64 = 0.04;

impl Axis {
    /// Returns a logarithmic axis that contains all values, which must be positive.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let mut axis = Self::linear(values.map(libm::log10), pixels);
        axis.logarithmic = true;
        axis
    }

    /// Returns a linear axis that contains all values.
    pub(super) fn linear(values: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        const LEAST: f64 = 0.2;
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let pad = MARGIN * (high - low) + (LEAST - (high - low)).max(0.0) / 2.0;
        Self {
            logarithmic: false,
            from: low - pad,
            to: high + pad,
            pixels,
        }
    }

    fn pixel(&self, place: f64) -> f64 {
        let [from, to] = self.pixels;
        from + (to - from) * (place - self.from) / (self.to - self.from)
    }

    /// Returns the position of a value in pixels.
    pub(super) fn at(&self, value: f64) -> f64 {
        self.pixel(if self.logarithmic {
            libm::log10(value)
        } else {
            value
        })
    }

    /// Returns the position of a value in pixels, clamped to the axis.
    pub(super) fn clamped(&self, value: f64) -> f64 {
        self.at(value.clamp(self.from, self.to))
    }

    pub(super) fn ticks(&self) -> Vec<Tick> {
        if self.logarithmic {
            self.powers()
        } else {
            self.numbers()
        }
    }

    /// Returns ticks at powers of ten, with labels at a readable distance, and at their multiples from 2 to
    /// 9.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "exponents of doubles are small"
    )]
    fn powers(&self) -> Vec<Tick> {
        const MAX_LABELS: f64 = 9.0;
        let (first, last) = (self.from.floor() as i32, self.to.ceil() as i32);
        let every = ((self.to - self.from) / MAX_LABELS).ceil().max(1.0) as i32;
        let few = self.to - self.from < 1.5;
        let mut ticks = Vec::new();
        for exponent in first..=last {
            for digit in 1..=9 {
                let place = f64::from(exponent) + libm::log10(f64::from(digit));
                if place < self.from || place > self.to || every > 2 && digit > 1 {
                    continue;
                }
                let number = || {
                    let decimals = usize::try_from(-exponent).unwrap_or(0);
                    Label::Number(
                        f64::from(digit) * libm::exp10(f64::from(exponent)),
                        decimals,
                    )
                };
                let label = match digit {
                    1 if exponent % every == 0 => Some(Label::Power(exponent)),
                    2 | 5 if few && exponent.abs() < 5 => Some(number()),
                    _ => None,
                };
                ticks.push(Tick {
                    at: self.pixel(place),
                    label,
                });
            }
        }
        ticks
    }

    /// Returns ticks at multiples of 1, 2 or 5 times a power of ten, about five of them.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    fn numbers(&self) -> Vec<Tick> {
        const MOST: f64 = 6.0;
        let rough = (self.to - self.from) / MOST;
        let power = libm::exp10(libm::log10(rough).floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
        let step = steps
            .into_iter()
            .find(|&step| step >= rough)
            .unwrap_or(rough);
        let decimals = (-libm::log10(step).floor()).max(0.0) as usize;
        let first = (self.from / step).ceil();
        let values = (0..=MOST as u32).map(|number| (first + f64::from(number)) * step);
        let inside = values.take_while(|&value| value <= self.to);
        let tick = |value: f64| Tick {
            at: self.pixel(value),
            label: Some(Label::Number(value + 0.0, decimals)),
        };
        inside.map(tick).collect()
    }
}
