//! Errors of fits.

/// A reason for which a picture cannot be fitted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// No pixel belongs to the shape.
    #[error("no pixel of the picture belongs to the shape")]
    Empty,
    /// All pixels belong to the shape.
    #[error("all pixels of the picture belong to the shape: there is no background")]
    Full,
    /// A single pixel belongs to the shape.
    #[error(
        "a single pixel of the picture belongs to the shape: any system that contracts to it would do"
    )]
    OnePixel,
    /// The picture has too many pixels.
    #[error("the picture has {width} x {height} pixels, more than 2^26, or 2^15 on a side")]
    TooLarge {
        /// Width of the picture.
        width: usize,
        /// Height of the picture.
        height: usize,
    },
    /// There are not as many values as pixels.
    #[error("there are {values} values for {width} x {height} pixels")]
    Values {
        /// Number of values.
        values: usize,
        /// Width of the picture.
        width: usize,
        /// Height of the picture.
        height: usize,
    },
    /// No branch point of the skeleton is the place of a copy.
    #[error(
        "no copy of the shape lies at a branch point of its skeleton: name branch points, or take another method"
    )]
    NoCopies,
    /// The maps of a candidate do not contract.
    #[error("the maps do not contract in any norm of ellipses")]
    DoesNotContract,
    /// The number of maps is out of range.
    #[error("{0} maps: a system has 2 to 32")]
    Maps(usize),
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}
