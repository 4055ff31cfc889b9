//! Cameras in the coordinates of a set, for programs that draw it themselves.

use crate::geometry::{DAffine3, DVec3, Frame3};
use crate::graph::Graph;
use crate::render::{Options, RenderError};

use super::buffer::SAMPLES;
use super::camera::Projection;
use super::slice::Search;
use super::{SpaceOptions, place, scene};

/// Camera that sees what a picture of a set shows.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Eye {
    /// Position of the viewer; of a parallel projection, a point from which all of the set lies ahead.
    pub(in crate::render) location: DVec3,
    /// Vector to the middle of the picture, in perspective at distance 1.
    pub(in crate::render) ahead: DVec3,
    /// Vectors along the sides of the picture, to the right and upwards: in perspective, of a picture at distance 1.
    pub(in crate::render) sides: [DVec3; 2],
    pub(in crate::render) is_parallel: bool,
    /// Vector towards the light.
    pub(in crate::render) light: DVec3,
    /// Distance beyond which nothing of the set lies.
    pub(in crate::render) far: f64,
    /// Width and height in pixels.
    pub(in crate::render) size: [u32; 2],
}

impl Eye {
    /// Returns the camera of a picture of approximant `steps`.
    pub(in crate::render) fn of(
        graph: &Graph<Frame3>,
        steps: u32,
        options: &Options,
        space: &SpaceOptions,
    ) -> Result<Self, RenderError> {
        let search = Search {
            parts: &scene::parts(graph, Some(steps)),
            start: &scene::start(graph),
            steps: Some(steps),
        };
        let margin = options.view.pad();
        let placement = place::place(graph, &search, &space.camera, &[], options.size, margin)?;
        let inverse: DAffine3 = placement.map.inverse();
        let linear = inverse.matrix3;
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let samples = SAMPLES as f64;
        let [width, height] = placement.size.map(|side| f64::from(side) * samples);
        let [far, near] = placement.range;
        let eye = match placement.projection {
            Projection::Parallel => {
                let before = DVec3::new(width / 2.0, height / 2.0, near + width.max(height));
                Self {
                    location: inverse.transform_point3(before),
                    ahead: linear * DVec3::NEG_Z,
                    sides: [
                        linear * (DVec3::X * width),
                        linear * (DVec3::NEG_Y * height),
                    ],
                    is_parallel: true,
                    light: space.light.towards(),
                    far: (linear * (DVec3::Z * (before.z - far))).length(),
                    size: placement.size,
                }
            }
            Projection::Central { focus, middle } => {
                let [x, y] = [width / 2.0 - middle[0], height / 2.0 - middle[1]];
                let side = |side: DVec3| linear * (side / focus);
                Self {
                    location: inverse.transform_point3(DVec3::ZERO),
                    ahead: linear * DVec3::new(x / focus, y / focus, -1.0),
                    sides: [side(DVec3::X * width), side(DVec3::NEG_Y * height)],
                    is_parallel: false,
                    light: space.light.towards(),
                    far: -far,
                    size: placement.size,
                }
            }
        };
        Ok(eye)
    }
}
