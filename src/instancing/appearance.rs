//! Appearance of instances: tints composed by Hart's equations, drifts of colours, and stroke widths.

use crate::style::Colour;

use super::Tint;
use super::drift::DriftProduct;

/// Change of the width of strokes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thickness {
    /// Multiplies the width by a factor.
    Times(f64),
    /// Sets the width to a multiple of the style's, regardless of the enclosing instances.
    Set(f64),
}

/// Appearance: tints composed from the outside in, the outermost on top (Hart 1992, section 5), the drift of the
/// colours that result, and the width of strokes, for which the innermost setting applies.
///
/// Guarantee: composition is associative up to rounding, and [`Appearance::NONE`] is its identity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    /// Red, green and blue from 0 to 1, each multiplied by `alpha`.
    colour: [f32; 3],
    /// Coverage, from 0 to 1.
    alpha: f32,
    /// Factor of the width of strokes.
    width: f32,
    /// Whether the factor applies to the style's width, regardless of the enclosing instances.
    sets_width: bool,
    /// Whether the colour replaces that of the contents, unaffected by the tints of enclosing instances.
    paints: bool,
    /// Drift of the colour that the tints yield.
    drift: DriftProduct,
}

impl Appearance {
    /// Identity: neither tint nor drift nor change of width.
    pub const NONE: Self = Self {
        colour: [0.0; 3],
        alpha: 0.0,
        width: 1.0,
        sets_width: false,
        paints: false,
        drift: DriftProduct::NONE,
    };

    /// Creates the appearance of a single tint.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a single precision is finer than a colour's"
    )]
    pub fn of(tint: Tint) -> Self {
        let [red, green, blue, _] = tint.colour.rgba();
        let alpha = tint.alpha as f32;
        Self {
            colour: [red, green, blue].map(|value| alpha * f32::from(value) / 255.0),
            alpha,
            drift: DriftProduct::of(tint.drift),
            ..Self::NONE
        }
    }

    /// Creates an appearance that changes the width of strokes only.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a single precision is finer than a stroke's width"
    )]
    pub fn of_thickness(thickness: Thickness) -> Self {
        let (width, sets_width) = match thickness {
            Thickness::Times(width) => (width, false),
            Thickness::Set(width) => (width, true),
        };
        Self {
            width: width as f32,
            sets_width,
            ..Self::NONE
        }
    }

    /// Creates an appearance with an opaque colour for all contents that have no paint of their own;
    /// tints of enclosing instances do not apply to it.
    #[must_use]
    pub fn of_paint(colour: Colour) -> Self {
        Self {
            paints: true,
            ..Self::of(Tint::cover(colour, 1.0))
        }
    }

    /// Returns the appearance without its colours: the width of strokes only.
    pub(crate) fn without_colour(self) -> Self {
        Self {
            width: self.width,
            sets_width: self.sets_width,
            ..Self::NONE
        }
    }

    /// Returns the bit patterns of all fields, as a key.
    pub(crate) fn bits(self) -> ([u32; 6], [u32; 7]) {
        let [red, green, blue] = self.colour.map(f32::to_bits);
        let flags = u32::from(self.sets_width) | u32::from(self.paints) << 1;
        let (alpha, width) = (self.alpha.to_bits(), self.width.to_bits());
        ([red, green, blue, alpha, width, flags], self.drift.bits())
    }

    /// Returns the width of strokes as a multiple of the style's.
    #[inline]
    #[must_use]
    pub fn width(self) -> f64 {
        f64::from(self.width)
    }

    /// Composes this appearance with one inside it: c = c_o + (1 − α_o) α_i c_i and α = α_o + α_i (1 −
    /// α_o), equations (9) and (10) of the paper. The inner drift starts from the outer one.
    #[inline]
    #[must_use]
    pub fn over(self, inner: Self) -> Self {
        let outer = if inner.paints { Self::NONE } else { self };
        let rest = 1.0 - outer.alpha;
        let mut colour = outer.colour;
        for (outer, inner) in colour.iter_mut().zip(inner.colour) {
            *outer += rest * inner;
        }
        Self {
            colour,
            alpha: outer.alpha + rest * inner.alpha,
            paints: self.paints || inner.paints,
            width: if inner.sets_width {
                inner.width
            } else {
                self.width * inner.width
            },
            sets_width: self.sets_width || inner.sets_width,
            drift: outer.drift.then(inner.drift),
        }
    }

    /// Applies the appearance to a colour, rounded to 8 bits a channel.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    pub fn on(self, colour: Colour) -> Colour {
        let whole = |value: f32| (255.0 * value + 0.5) as u8;
        let own = Self::of(Tint::cover(colour, colour.opacity()));
        let Self { colour, alpha, .. } = self.over(own);
        let [red, green, blue] = colour.map(|value| if alpha > 0.0 { value / alpha } else { 0.0 });
        let drifted = self.drift.on([red, green, blue, alpha]);
        Colour::of_rgba(drifted.map(whole))
    }
}

#[cfg(test)]
mod tests {
    use super::{Appearance, Thickness, Tint};
    use crate::instancing::Drift;
    use crate::style::Colour;

    fn appearance(rgb: [u8; 3], alpha: f64) -> Appearance {
        let [red, green, blue] = rgb;
        let colour = Colour::of_rgba([red, green, blue, 255]);
        Appearance::of(Tint::cover(colour, alpha))
    }

    #[test]
    fn the_equations_are_those_of_the_paper() {
        // Half is red, half of the remaining half is blue, and the last quarter is black.
        let both = appearance([255, 0, 0], 0.5).over(appearance([0, 0, 255], 0.5));
        assert_eq!(both.colour, [0.5, 0.0, 0.25]);
        assert_eq!(both.alpha, 0.75);
        assert_eq!(both.on(Colour::BLACK).rgba(), [128, 0, 64, 255]);
        let white = Colour::grey(255);
        assert_eq!(both.on(white).rgba(), [191, 64, 128, 255]);
        // A transparent colour stays transparent in the share that no tint covers.
        let clear = Colour::of_rgba([0, 255, 0, 0]);
        assert_eq!(both.on(clear).rgba(), [170, 0, 85, 191]);
    }

    #[test]
    fn coats_are_associative_and_nothing_changes_nothing() {
        let [a, b, c] = [
            appearance([200, 17, 99], 0.3),
            appearance([12, 250, 0], 0.6),
            appearance([0, 40, 255], 0.45),
        ];
        let (left, right) = (a.over(b).over(c), a.over(b.over(c)));
        assert!((left.alpha - right.alpha).abs() < 1e-6);
        for (left, right) in left.colour.iter().zip(right.colour) {
            assert!((left - right).abs() < 1e-6);
        }
        assert_eq!(Appearance::NONE.over(a), a);
        assert_eq!(a.over(Appearance::NONE), a);
        let [half, wide] =
            [Thickness::Times(0.5), Thickness::Set(3.0)].map(Appearance::of_thickness);
        for (outer, inner, width) in [(half, half, 0.25), (wide, half, 1.5), (half, wide, 3.0)] {
            let both = a.over(outer).over(inner);
            assert_eq!(both.width(), width);
            assert_eq!(a.over(outer.over(inner)), both);
            assert_eq!(
                half.over(both).width(),
                if outer == inner { 0.125 } else { width }
            );
        }
        let teal = Colour::of_rgba([0, 128, 127, 77]);
        assert_eq!(Appearance::NONE.on(teal), teal);
    }
    #[test]
    fn drifts_change_what_tints_yield() {
        let warmer = Appearance::of(Tint {
            drift: Drift {
                hue: 60.0,
                ..Drift::default()
            },
            ..Tint::cover(Colour::BLACK, 0.0)
        });
        let red = appearance([255, 0, 0], 1.0);
        for both in [warmer.over(red), red.over(warmer)] {
            assert_eq!(both.on(Colour::BLACK).rgba(), [255, 255, 0, 255]);
        }
        let twice = warmer.over(red).over(warmer);
        assert_eq!(twice.on(Colour::BLACK).rgba(), [0, 255, 0, 255]);
        // A paint is not affected by what lies around it.
        let paint = Appearance::of_paint(Colour::of_rgba([255, 0, 0, 255]));
        assert_eq!(
            warmer.over(paint).on(Colour::BLACK).rgba(),
            [255, 0, 0, 255]
        );
    }
}
