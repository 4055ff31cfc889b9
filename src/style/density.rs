//! Pictures of hits: their tones, and how a file has them drawn.

use super::Named;

/// Method by which a system of maps is iterated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Iteration {
    /// All compositions of maps.
    #[default]
    Deterministic,
    /// A random walk, the chaos game.
    Chaos,
}

impl Named for Iteration {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("deterministic", Self::Deterministic),
        ("chaos", Self::Chaos),
    ];
}

/// Hits of pixels as a file has them drawn in a PNG; `None` where it is silent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DensityView {
    /// Method by which a system of maps is drawn.
    pub method: Option<Iteration>,
    /// Number of points of random iteration.
    pub points: Option<u64>,
    /// Mapping of hits to tones. Elements have tones only if there is one.
    pub tone: Option<Tone>,
    /// Exponent: tones are raised to its inverse, so that few hits are shown better the larger it is.
    pub gamma: Option<f64>,
    /// Number of bins of random iteration across a pixel, whose colours are averaged.
    pub oversample: Option<u32>,
    /// Radius in pixels over which a point that is alone in its pixel is spread.
    pub kernel: Option<f64>,
}

setters!(DensityView {
    method: Option<Iteration>,
    points: Option<u64>,
    tone: Option<Tone>,
    gamma: Option<f64>,
    oversample: Option<u32>,
    kernel: Option<f64>,
});

impl DensityView {
    /// Largest number of bins across a pixel.
    pub const MAX_OVERSAMPLE: u32 = 4;

    /// Largest radius of the kernel in pixels.
    pub const MAX_KERNEL: f64 = 16.0;

    /// Largest exponent of tones.
    pub const MAX_GAMMA: f64 = 10.0;
}

/// Mapping of a number of hits to a tone from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Tone {
    /// Logarithmic: log(1 + hits) / log(1 + the largest number of hits of a pixel).
    #[default]
    Log,
    /// Proportional to the largest number of hits of a pixel.
    Linear,
    /// 1 for every pixel that is hit.
    Plain,
}

impl Named for Tone {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("log", Self::Log),
        ("linear", Self::Linear),
        ("plain", Self::Plain),
    ];
}

impl Tone {
    /// Returns the tone of a number of hits, where `most` is the largest number. Hits may be parts of a pixel.
    pub(crate) fn of(self, hits: f64, most: f64) -> f64 {
        if hits == 0.0 {
            return 0.0;
        }
        match self {
            Self::Log => libm::log1p(hits) / libm::log1p(most),
            Self::Linear => hits / most,
            Self::Plain => hits.min(1.0),
        }
    }
}
