//! Options, results and errors of pictures in space.

use crate::chaos::GameError;
use crate::geometry::HalfSpace;
use crate::render::{NoRoom, Picture, Pixels};
use crate::style::{Camera, CameraError, ColorBy, Light, Named, Shade, Slice, SpaceView};

use super::DepthMap;
use super::camera::Sight;

/// Error of drawing in space.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpaceError {
    /// The camera is not valid.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// There is no room for the picture, or nothing to draw.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// Colours in space, or those of a format, do not distinguish this property.
    #[error(
        "colours by {} are not for this set in space: there, they are by step, tint, normal, the maps of a system, or, of a rule, by \
         generator, direction, age, index or fractal",
        .0.name()
    )]
    ColorBy(ColorBy),
    /// Colours differ from face to face, and instances of one object share theirs.
    #[error(
        "colours by normal differ from face to face, and nested instances of an object share theirs: a .ply holds them"
    )]
    FaceColours,
    /// The graph does not determine the extent of the set.
    #[error("the extent of the set is not known: no bound is found by which its maps contract")]
    NoBounds,
    /// All elements are points or lines, and the file holds faces.
    #[error(
        "it consists of points and lines, which have no faces, and the file holds faces: tubes along lines have some"
    )]
    NoFaces,
    /// There are more faces than a format can count, or than are held in memory.
    #[error("there are more than {limit} {what}")]
    TooManyFaces {
        /// Name of what is counted.
        what: &'static str,
        /// The limit.
        limit: u64,
    },
    /// A file that meshes and nodes make would be too large.
    #[error(
        "the file would have some {:.0} MB, more than {} MB: fewer steps are smaller, and a .usda holds any number",
        .bytes / 1e6, .limit / 1_000_000
    )]
    TooLarge {
        /// Approximate size in bytes.
        bytes: f64,
        /// The limit.
        limit: u64,
    },
    /// Slices and cuts leave nothing. The set lies between the two values along the first one's normal.
    #[error(
        "the slice or cut leaves nothing of the set, which lies between {:.6} and {:.6} along its normal",
        .0[0], .0[1]
    )]
    NothingLeft([f64; 2]),
    /// The chaos game cannot be played.
    #[error(transparent)]
    Game(#[from] GameError),
}

/// Options of pictures in space, beside those of all pictures.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SpaceOptions {
    /// Direction of view and projection.
    pub camera: Camera,
    /// Shading; depth cueing by default, and in vector formats depth cueing and light.
    pub shade: Option<Shade>,
    /// Light for relief.
    pub light: Light,
    /// Slab to which the picture is confined.
    pub slice: Option<Slice>,
    /// Half-spaces to which the picture is confined: what lies before their planes is cut off.
    pub cuts: Vec<HalfSpace>,
    /// Whether what is enclosed by its surroundings is darker: ambient occlusion, from the depths of the pixels.
    pub occlusion: bool,
    /// Whether the set throws shadows on itself.
    pub shadows: bool,
    /// Whether the depths of the pixels are kept, in [`SpacePicture::depths`].
    pub keeps_depths: bool,
}

setters!(SpaceOptions {
    camera: Camera,
    shade: Option<Shade>,
    light: Light,
    slice: Option<Slice>,
    cuts: Vec<HalfSpace>,
    occlusion: bool,
    shadows: bool,
    keeps_depths: bool,
});

impl SpaceOptions {
    /// Returns the half-spaces to which the picture is confined; `pixel` is the thickness of a section.
    pub(super) fn within(&self, pixel: f64) -> Vec<HalfSpace> {
        let slice = self.slice.iter();
        let slabs = slice.flat_map(|slice| slice.half_spaces(slice.thickness.unwrap_or(pixel)));
        slabs.chain(self.cuts.iter().copied()).collect()
    }

    /// Returns whether the picture is confined to no half-spaces.
    #[cfg(feature = "cli")]
    pub(crate) fn is_whole(&self) -> bool {
        self.slice.is_none() && self.cuts.is_empty()
    }

    /// Returns whether the colours of pixels, or the caller, need depths.
    pub(super) fn needs_depths(&self, has_faces: bool) -> bool {
        self.shade.unwrap_or_default().has_relief(has_faces)
            || self.occlusion
            || self.shadows
            || self.keeps_depths
    }
}

impl From<&SpaceView> for SpaceOptions {
    fn from(view: &SpaceView) -> Self {
        Self {
            camera: view.camera(),
            shade: view.shade,
            light: view.light(),
            slice: view.slice,
            cuts: view.cuts.clone(),
            occlusion: view.occlusion.unwrap_or_default(),
            shadows: view.shadows.unwrap_or_default(),
            keeps_depths: false,
        }
    }
}

/// A picture of a set in space.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SpacePicture {
    /// The pixels.
    pub pixels: Pixels,
    /// The depths of the pixels, if they are [kept](SpaceOptions::keeps_depths).
    pub depths: Option<DepthMap>,
    /// Description of the picture.
    pub picture: Picture,
    /// Its middle, and the directions in which it moves.
    #[cfg_attr(
        not(feature = "cli"),
        expect(dead_code, reason = "the studio moves pictures by it")
    )]
    pub(crate) sight: Sight,
}
