//! Drifts: changes of hue, saturation, lightness and opacity that add up from the scene inwards.

/// Change of the colours of an instance and of its contents, relative to the colours that they have without it, as in
/// Context Free. A drift inside another starts where that one ends.
///
/// Colours are those of CSS's `hsl()`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Degrees that are added to the hue.
    pub hue: f64,
    /// Change of the saturation, from −1 to 1: the share of the way to 1, or, if negative, to 0.
    pub saturation: f64,
    /// Change of the lightness, from −1, black, to 1, white: the share of the way there.
    pub lightness: f64,
    /// Change of the opacity, from −1 to 1: the share of the way to 1, or, if negative, to 0.
    pub opacity: f64,
}

impl Drift {
    /// Returns the drift that makes a share of the changes.
    pub(crate) fn times(self, share: f64) -> Self {
        Self::of(self.changes().map(|change| change * share))
    }

    /// Returns all changes: of hue, saturation, lightness and opacity.
    pub(crate) fn changes(self) -> [f64; 4] {
        [self.hue, self.saturation, self.lightness, self.opacity]
    }

    /// Returns the drift of some changes.
    pub(crate) fn of([hue, saturation, lightness, opacity]: [f64; 4]) -> Self {
        Self {
            hue,
            saturation,
            lightness,
            opacity,
        }
    }
}

/// Product of drifts: a turn of the hue, and a map x ↦ scale · x + shift for each other part of a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriftProduct {
    /// Turn of the hue in degrees, from 0 inclusive to 360 exclusive.
    hue: f32,
    /// Scale and shift of saturation, lightness and opacity.
    parts: [[f32; 2]; 3],
}

impl DriftProduct {
    /// Identity.
    pub(super) const NONE: Self = Self {
        hue: 0.0,
        parts: [[1.0, 0.0]; 3],
    };

    /// Creates the product of a single drift.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a single precision is finer than a colour's"
    )]
    pub(super) fn of(drift: Drift) -> Self {
        let [hue, parts @ ..] = drift.changes();
        let part = |change: f64| [1.0 - change.abs(), change.max(0.0)].map(|it| it as f32);
        // Tiny negative turns round to 360.
        let hue = Some(hue.rem_euclid(360.0) as f32).filter(|hue| *hue < 360.0);
        Self {
            hue: hue.unwrap_or(0.0),
            parts: parts.map(part),
        }
    }

    /// Returns the product of this drift and one inside it.
    #[inline]
    pub(super) fn then(self, inner: Self) -> Self {
        let mut both = inner;
        both.hue += self.hue;
        if both.hue >= 360.0 {
            both.hue -= 360.0;
        }
        for ([scale, shift], [outer, by]) in both.parts.iter_mut().zip(self.parts) {
            *shift += *scale * by;
            *scale *= outer;
        }
        both
    }

    /// Applies the drift to red, green, blue and opacity, each from 0 to 1.
    pub(super) fn on(self, rgba: [f32; 4]) -> [f32; 4] {
        if self == Self::NONE {
            return rgba;
        }
        let [red, green, blue, opacity] = rgba;
        let colour = colorgrad::Color::new(red, green, blue, opacity);
        let [hue, parts @ ..] = colour.to_hsla();
        let mut drifted = parts;
        for (part, [scale, shift]) in drifted.iter_mut().zip(self.parts) {
            *part = (scale * *part + shift).clamp(0.0, 1.0);
        }
        let [saturation, lightness, opacity] = drifted;
        colorgrad::Color::from_hsla(hue + self.hue, saturation, lightness, opacity).to_array()
    }

    /// Returns the bit patterns of all fields, as a key.
    pub(super) fn bits(self) -> [u32; 7] {
        let [[a, b], [c, d], [e, f]] = self.parts;
        [self.hue, a, b, c, d, e, f].map(f32::to_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::{Drift, DriftProduct};

    fn close(a: [f32; 4], b: [f32; 4]) {
        for (a, b) in a.into_iter().zip(b) {
            assert!((a - b).abs() < 1e-6, "{a} and {b}");
        }
    }

    #[test]
    fn parts_move_towards_their_ends() {
        let red = [1.0, 0.0, 0.0, 1.0];
        let drifted = |changes| DriftProduct::of(Drift::of(changes)).on(red);
        close(drifted([120.0, 0.0, 0.0, 0.0]), [0.0, 1.0, 0.0, 1.0]);
        close(drifted([-120.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 1.0, 1.0]);
        close(drifted([0.0, -0.5, 0.0, 0.0]), [0.75, 0.25, 0.25, 1.0]);
        close(drifted([0.0, 0.0, 0.5, 0.0]), [1.0, 0.5, 0.5, 1.0]);
        close(drifted([0.0, 0.0, -0.5, -0.25]), [0.5, 0.0, 0.0, 0.75]);
        close(drifted([0.0, 0.0, 1.0, 1.0]), [1.0; 4]);
        // Black has a hue of 0 and no saturation, as in Context Free.
        let of_black = DriftProduct::of(Drift::of([60.0, 1.0, 0.5, 0.0])).on([0.0, 0.0, 0.0, 1.0]);
        close(of_black, [1.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn products_are_associative_and_the_inner_drift_is_done_last() {
        let [a, b, c] = [
            [200.0, 0.3, -0.2, 0.1],
            [170.0, -0.6, 0.4, -0.5],
            [-35.0, 0.25, 0.1, -0.1],
        ]
        .map(|changes| DriftProduct::of(Drift::of(changes)));
        let colour = [0.2, 0.7, 0.4, 0.5];
        close(a.then(b).then(c).on(colour), a.then(b.then(c)).on(colour));
        close(a.then(b).on(colour), b.on(a.on(colour)));
        for both in [a.then(DriftProduct::NONE), DriftProduct::NONE.then(a)] {
            assert_eq!(both, a);
        }
        assert_eq!(DriftProduct::NONE.on(colour), colour);
        let turn = |hue: f64| DriftProduct::of(Drift::of([hue, 0.0, 0.0, 0.0]));
        assert_eq!(turn(-1e-9), DriftProduct::NONE);
        assert_eq!(turn(200.0).then(turn(160.0)), DriftProduct::NONE);
    }
}
