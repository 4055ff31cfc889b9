//! Blend modes.

use super::Named;

/// Mixing of the colours of elements that overlap (W3C, Compositing and Blending). Connected lines of one colour are one element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Blend {
    /// Successive elements of one colour are one area: where they overlap, a colour that is not opaque does not add up.
    #[default]
    Joined,
    /// Each element covers those before it.
    Normal,
    /// Channels are multiplied: darker.
    Multiply,
    /// Channels are added: lighter. PDF has no such mode, and mixes by [`Blend::Screen`].
    Add,
    /// Differences from white are multiplied: lighter.
    Screen,
}

impl Named for Blend {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("joined", Self::Joined),
        ("normal", Self::Normal),
        ("multiply", Self::Multiply),
        ("add", Self::Add),
        ("screen", Self::Screen),
    ];
}
