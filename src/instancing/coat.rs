use crate::style::Colour;

use super::Tint;

/// What becomes of the widths of strokes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thickness {
    /// They are so many times as wide.
    Times(f64),
    /// They are so many times as wide as the style says, whatever they stand in.
    Set(f64),
}

/// Tints that lie over each other, the outermost on top (Hart 1992, section 5), and what becomes of the
/// widths of strokes, of which the innermost is set last.
///
/// Guarantee: putting coats over each other is associative but for rounding, and [`Coat::NONE`] changes
/// nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// Red, green and blue from 0 to 1, each times `alpha`.
    colour: [f32; 3],
    /// How much it covers, from 0 to 1.
    alpha: f32,
    /// So many times as wide strokes are.
    width: f32,
    /// Whether they are, whatever they stand in.
    sets_width: bool,
    /// Whether what is inside has this colour, and not one over its own.
    paints: bool,
}

impl Coat {
    /// Nothing has been tinted.
    pub const NONE: Self = Self {
        colour: [0.0; 3],
        alpha: 0.0,
        width: 1.0,
        sets_width: false,
        paints: false,
    };

    /// A single tint.
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
            ..Self::NONE
        }
    }

    /// Nothing is tinted, but strokes have another width.
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

    /// Another colour for all that has none of its own inside.
    #[must_use]
    pub fn of_paint(colour: Colour) -> Self {
        Self {
            paints: true,
            ..Self::of(Tint { colour, alpha: 1.0 })
        }
    }

    /// The same without its colours.
    pub(crate) fn without_colour(self) -> Self {
        Self {
            width: self.width,
            sets_width: self.sets_width,
            ..Self::NONE
        }
    }

    /// What tells it from others.
    pub(crate) fn bits(self) -> [u32; 6] {
        let [red, green, blue] = self.colour.map(f32::to_bits);
        let flags = u32::from(self.sets_width) | u32::from(self.paints) << 1;
        let (alpha, width) = (self.alpha.to_bits(), self.width.to_bits());
        [red, green, blue, alpha, width, flags]
    }

    /// So many times as wide as the style says strokes are.
    #[inline]
    #[must_use]
    pub fn width(self) -> f64 {
        f64::from(self.width)
    }

    /// This coat with another one under it: c = c_o + (1 − α_o) α_i c_i and α = α_o + α_i (1 − α_o), the
    /// paper's equations (9) and (10).
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
        }
    }

    /// The colour of what this coat lies on, to whole values.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    pub fn on(self, colour: Colour) -> Colour {
        let whole = |value: f32| (255.0 * value + 0.5) as u8;
        let own = Self::of(Tint {
            colour,
            alpha: colour.opacity(),
        });
        let Self { colour, alpha, .. } = self.over(own);
        let rgb = colour.map(|value| if alpha > 0.0 { value / alpha } else { 0.0 });
        let [red, green, blue] = rgb.map(whole);
        Colour::of_rgba([red, green, blue, whole(alpha)])
    }
}

#[cfg(test)]
mod tests {
    use super::{Coat, Thickness, Tint};
    use crate::style::Colour;

    fn coat(rgb: [u8; 3], alpha: f64) -> Coat {
        let [red, green, blue] = rgb;
        let colour = Colour::of_rgba([red, green, blue, 255]);
        Coat::of(Tint { colour, alpha })
    }

    #[test]
    fn the_equations_are_those_of_the_paper() {
        // Half red, then half of the half that is left blue, then a quarter of black.
        let both = coat([255, 0, 0], 0.5).over(coat([0, 0, 255], 0.5));
        assert_eq!(both.colour, [0.5, 0.0, 0.25]);
        assert_eq!(both.alpha, 0.75);
        assert_eq!(both.on(Colour::BLACK).rgba(), [128, 0, 64, 255]);
        let white = Colour::grey(255);
        assert_eq!(both.on(white).rgba(), [191, 64, 128, 255]);
        // What is transparent stays so where nothing covers it.
        let clear = Colour::of_rgba([0, 255, 0, 0]);
        assert_eq!(both.on(clear).rgba(), [170, 0, 85, 191]);
    }

    #[test]
    fn coats_are_associative_and_nothing_changes_nothing() {
        let [a, b, c] = [
            coat([200, 17, 99], 0.3),
            coat([12, 250, 0], 0.6),
            coat([0, 40, 255], 0.45),
        ];
        let (left, right) = (a.over(b).over(c), a.over(b.over(c)));
        assert!((left.alpha - right.alpha).abs() < 1e-6);
        for (left, right) in left.colour.iter().zip(right.colour) {
            assert!((left - right).abs() < 1e-6);
        }
        assert_eq!(Coat::NONE.over(a), a);
        assert_eq!(a.over(Coat::NONE), a);
        let [half, wide] = [Thickness::Times(0.5), Thickness::Set(3.0)].map(Coat::of_thickness);
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
        assert_eq!(Coat::NONE.on(teal), teal);
    }
}
