//! Assignment of colours to pens.

use std::num::NonZero;

use crate::style::{Colour, similar};

/// Number of pens of a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pens {
    /// One pen for each colour if there are at most [`Pens::FEW`], otherwise one for all.
    #[default]
    Few,
    /// One pen for each colour.
    Each,
    /// At most this many pens: similar colours share one.
    AtMost(NonZero<usize>),
}

impl Pens {
    /// Largest number of colours that have their own pens by default.
    pub const FEW: usize = 8;

    /// Returns the maximum number of pens for a number of colours.
    fn most(self, colours: usize) -> usize {
        match self {
            Self::Few if colours > Self::FEW => 1,
            Self::Few | Self::Each => colours,
            Self::AtMost(most) => most.get(),
        }
    }
}

/// Assigns colours, each with the amount it draws, to pens. Returns the colour of each pen, which is the
/// member nearest to the mean, and the numbers of its members. Pens are in the order of their first members.
pub(super) fn shared(colours: &[(Colour, u64)], pens: Pens) -> Vec<(Colour, Vec<usize>)> {
    similar(colours, pens.most(colours.len()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::Palette;

    fn along(palette: &str, count: usize) -> Vec<(Colour, u64)> {
        let palette = Palette::named(palette).unwrap();
        #[expect(clippy::cast_precision_loss, reason = "few colours")]
        let place = |number: usize| number as f64 / (count - 1) as f64;
        let colours = (0..count).map(|number| (palette.at(place(number)), 100));
        colours.collect()
    }

    #[test]
    fn pens_follow_a_palette() {
        for palette in ["viridis", "sunset", "magma", "earth-to-leaf"] {
            let colours = along(palette, 64);
            for most in [1, 2, 3, 5, 8, 16] {
                let pens = Pens::AtMost(NonZero::new(most).unwrap());
                let shared = shared(&colours, pens);
                assert_eq!(shared.len(), most, "{palette}");
                // The pens partition the palette into intervals, none of which is nearly the whole.
                let order: Vec<_> = shared.iter().flat_map(|pen| pen.1.clone()).collect();
                assert_eq!(order, (0..64).collect::<Vec<_>>(), "{palette} of {most}");
                let largest = shared.iter().map(|pen| pen.1.len()).max().unwrap();
                assert!(largest <= (3 * 64 / most).min(64), "{palette} of {most}");
            }
        }
    }

    #[test]
    fn few_colours_keep_their_pens_and_many_share_one() {
        assert_eq!(shared(&along("viridis", 8), Pens::Few).len(), 8);
        assert_eq!(shared(&along("viridis", 9), Pens::Few).len(), 1);
        assert_eq!(shared(&along("viridis", 64), Pens::Each).len(), 64);
        assert_eq!(shared(&[], Pens::Few), []);
        let reds = ["#f00", "#e00", "#00f", "#f10"].map(|text| (Colour::parse(text).unwrap(), 1));
        let two = shared(&reds, Pens::AtMost(NonZero::new(2).unwrap()));
        let members: Vec<_> = two.iter().map(|pen| pen.1.as_slice()).collect();
        assert_eq!(members, [&[0, 1, 3][..], &[2]]);
        assert_eq!(two[1].0, reds[2].0);
    }

    #[test]
    fn very_many_colours_come_to_an_end() {
        let colours = along("turbo", 3000);
        let shared = shared(&colours, Pens::AtMost(NonZero::new(4).unwrap()));
        assert_eq!(shared.len(), 4);
        assert_eq!(shared.iter().map(|pen| pen.1.len()).sum::<usize>(), 3000);
    }
}
