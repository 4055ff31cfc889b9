//! Short cuts of PNG pictures, each of which can be switched off.
//!
//! Every short cut leaves out work that would not change the pixels, or hardly. `cargo bench --bench short_cuts`
//! measures each.
//!
//! Processor seconds of pictures of 2048 pixels to a detail of half a pixel, on one thread, with all short cuts
//! and without one of them (the less of two runs; built without link-time optimisation; two runs differ by some percent):
//!
//! | fractal | all | `Prepass` | `Contribution` | `LevelOfDetail` | `SegmentBatches` | `RunSprites` | `ColonySprites` |
//! |---|---|---|---|---|---|---|---|
//! | gosper | 0.57 | **1.83** | 0.59 | 0.44 | 0.54 | **0.69** | 0.54 |
//! | dragon-wreath | 0.61 | **1.72** | 0.61 | **1.59** | 0.61 | 0.62 | 0.61 |
//! | h-tree | 1.53 | **1.85** | 1.54 | 1.61 | 1.59 | 1.61 | 1.54 |
//! | random-tree | 1.50 | 1.47 | **7.19** | 1.48 | 1.50 | 1.48 | 1.48 |
//! | self-seeding-square | 0.66 | **1.07** | 0.66 | 0.66 | 0.65 | 0.64 | 0.66 |
//! | quadric-koch-18 | 0.91 | **1.17** | 0.93 | 0.94 | 0.94 | 0.93 | 0.91 |
//! | ternary-tree | 0.91 | 0.90 | 0.88 | 0.90 | 0.92 | 0.93 | 0.93 |
//! | terdragon-rose | 1.10 | **11.74** | 1.13 | **2.20** | 1.10 | **5.68** | 1.10 |
//! | mandala | 1.20 | 1.22 | 1.28 | **1.39** | 1.20 | 1.23 | **14.70** |

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
