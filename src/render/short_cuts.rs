//! Short cuts of PNG pictures, each of which can be switched off.
//!
//! Every short cut leaves out work that would not change the pixels, or hardly. `cargo bench --locked --bench short_cuts`
//! measures each.
//!
//! Processor seconds of pictures of 2048 pixels to a detail of half a pixel, on one thread, with all short cuts
//! and without one of them (the less of two runs, which differ by up to a tenth; built without link-time
//! optimisation; bold where that is at least 15 % more):
//!
//! | fractal | all | `Prepass` | `Contribution` | `LevelOfDetail` | `SegmentBatches` | `RunSprites` | `ColonySprites` |
//! |---|---|---|---|---|---|---|---|
//! | gosper | 0.57 | **1.83** | 0.59 | 0.44 | 0.54 | **0.69** | 0.54 |
//! | dragon | 0.28 | **0.55** | 0.29 | 0.29 | 0.29 | 0.25 | 0.29 |
//! | dragon-wreath | 0.54 | **1.65** | 0.54 | **1.79** | 0.54 | 0.53 | 0.52 |
//! | random-tree | 1.29 | 1.34 | **6.17** | 1.32 | 1.33 | 1.33 | 1.33 |
//! | self-seeding-square | 0.64 | **1.03** | 0.64 | 0.64 | 0.65 | 0.65 | 0.65 |
//! | quadric-koch-18 | 0.94 | **1.18** | 0.94 | 0.94 | 0.93 | 0.94 | 0.94 |
//! | pentaflake | 0.70 | **0.93** | 0.73 | 0.69 | 0.74 | **3.71** | 0.67 |
//! | terdragon-rose | 1.16 | **11.86** | 1.31 | **2.41** | 1.28 | **5.24** | 1.17 |
//! | mandala | 1.18 | 1.16 | 1.19 | 1.29 | 1.16 | 1.13 | **13.83** |
//! | h-tree | 1.40 | **1.72** | 1.42 | 1.41 | 1.41 | 1.40 | 1.41 |
//! | h-tree of one colour, 20 steps | 0.34 | **0.42** | 0.34 | 0.34 | **0.54** | 0.34 | 0.34 |

/// Way to draw the pixels of a PNG with less work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShortCut {
    /// The bounding box, the classes of colour and the numbers of elements come from the graph instead of a
    /// walk, where the graph determines them. Applies to all formats.
    Prepass,
    /// Subtrees without elements of the painted class are left out of a walk. Applies to all formats.
    Contribution,
    /// Outlines lose the vertices that do not show.
    LevelOfDetail,
    /// Short thin lines of relative width that lie close to each other are drawn as one box.
    SegmentBatches,
    /// Congruent runs of elements share a sprite.
    RunSprites,
    /// Congruent seeded fractals share a sprite.
    ColonySprites,
}

impl ShortCut {
    /// All short cuts.
    pub const ALL: [Self; 6] = [
        Self::Prepass,
        Self::Contribution,
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
