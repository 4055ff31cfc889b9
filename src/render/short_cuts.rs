//! Short cuts of PNG pictures, each of which can be switched off.
//!
//! Every short cut leaves out work that would not change the pixels, or hardly. `cargo bench --bench short_cuts`
//! measures each.

/// Way to draw the pixels of a PNG with less work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShortCut {
    /// The bounding box, the classes of colour and the numbers of elements come from the graph instead of a
    /// walk, where the graph determines them. Applies to all formats.
    Prepass,
    /// Subtrees without elements of the painted class are left out of a walk. Applies to all formats.
    Contribution,
    /// Elements are left out where everything is covered already.
    Occlusion,
    /// Outlines lose the vertices that do not show.
    LevelOfDetail,
    /// Short thin lines close to each other are drawn as one box.
    SegmentBatches,
    /// Congruent runs of elements share a sprite.
    RunSprites,
    /// Congruent seeded fractals share a sprite.
    ColonySprites,
}

impl ShortCut {
    /// All short cuts.
    pub const ALL: [Self; 7] = [
        Self::Prepass,
        Self::Contribution,
        Self::Occlusion,
        Self::LevelOfDetail,
        Self::SegmentBatches,
        Self::RunSprites,
        Self::ColonySprites,
    ];
}

/// Set of short cuts; all by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortCuts(u16);

impl Default for ShortCuts {
    fn default() -> Self {
        Self(u16::MAX)
    }
}

impl ShortCuts {
    /// Returns the set without a short cut.
    #[must_use]
    pub fn without(self, short_cut: ShortCut) -> Self {
        Self(self.0 & !(1 << short_cut as u16))
    }

    /// Returns whether a short cut is in the set.
    #[inline]
    pub(super) fn has(self, short_cut: ShortCut) -> bool {
        self.0 & (1 << short_cut as u16) != 0
    }
}
