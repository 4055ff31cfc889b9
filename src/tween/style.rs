//! Styles between two.

use crate::style::{Colour, Style, Width};

use super::Tween;

/// Returns the style between two: colours that both have, and widths of one unit, change evenly.
pub(super) fn tween(tween: Tween, both: [&Style; 2]) -> Style {
    let [a, b] = both;
    let nearer = tween.pick(both);
    let colour = |of: fn(&Style) -> Option<Colour>| match both.map(of) {
        [Some(a), Some(b)] => Some(colour(tween, [a, b])),
        _ => of(nearer),
    };
    let width = match (a.width, b.width) {
        (Width::Pixels(a), Width::Pixels(b)) => Width::Pixels(tween.between([a, b])),
        (Width::Relative(a), Width::Relative(b)) => Width::Relative(tween.between([a, b])),
        _ => nearer.width,
    };
    Style {
        stroke: colour(|it| it.stroke),
        fill: colour(|it| it.fill),
        background: colour(|it| it.background),
        width,
        ..nearer.clone()
    }
}

/// Returns the colour between two, evenly in sRGB.
pub(super) fn colour(tween: Tween, both: [Colour; 2]) -> Colour {
    let [a, b] = both.map(Colour::rgba);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between two bytes"
    )]
    let part = |at: usize| tween.between([f64::from(a[at]), f64::from(b[at])]).round() as u8;
    Colour::of_rgba(std::array::from_fn(part))
}
