//! Options of pictures in space: the camera, the shading and the light.

use std::fmt;

use crate::geometry::{DVec3, HalfSpace};
use crate::render::space::SpaceOptions;
use crate::style::{Camera, Named, Shade, Slice, SpaceView};

use super::picture::named;
use super::rule::Loaded;
use super::{Failure, number, space};

/// Options of sets in space.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Space")]
pub(super) struct SpaceArguments {
    /// Direction from which a set in space is seen: azimuth and elevation in degrees, or front, side, top or iso
    ///
    /// Azimuth 0 is in front and 90 on the right; elevation 90 is above. [default: 30,25]
    #[arg(long, value_name = "AZ,EL", value_parser = views, allow_hyphen_values = true)]
    from: Option<Views>,
    /// Vector that points upwards in the picture [default: the y axis]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Point in the middle of the picture [default: that of the set]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// Angle of view in degrees, for a picture in perspective [default: parallel]
    #[arg(long, value_name = "DEGREES", value_parser = angle, allow_hyphen_values = true)]
    perspective: Option<f64>,
    /// Part between two planes: the normal, the value on the middle plane, and the thickness
    ///
    /// N·x = VALUE is the middle. Without a thickness, the section itself. Seen along the normal unless --from is
    /// given. For example, --slice "1,1,1=1.5,w=0.01".
    #[arg(long, value_name = "X,Y,Z=VALUE[,w=W]", value_parser = slice, allow_hyphen_values = true)]
    slice: Option<Slice>,
    /// Cut off what lies before a plane: the normal, and the value on the plane; repeatable
    ///
    /// Points with N·x at most VALUE remain. For example, --cut "1,0,0=0.5".
    #[arg(long, value_name = "X,Y,Z=VALUE", value_parser = space::plane, allow_hyphen_values = true)]
    cut: Vec<HalfSpace>,
    /// Shading: depth darkens what is far, cosine lights faces by their normals, relief by the depths around them, both is
    /// depth and cosine [default: depth for systems, both for surfaces]
    #[arg(long, value_name = "HOW", value_parser = named::<Shade>())]
    shade: Option<Shade>,
    /// Direction of the light: azimuth and elevation in degrees [default: 20,50]
    #[arg(long, value_name = "AZ,EL", value_parser = direction, allow_hyphen_values = true)]
    light: Option<[f64; 2]>,
    /// Intensity of what the light does not reach, from 0 to 1 [default: 0.15, and 0 with --shade cosine]
    #[arg(long, value_name = "SHARE", value_parser = number::share, allow_hyphen_values = true)]
    ambient: Option<f64>,
    /// Darken what is enclosed by its surroundings, by the depths of the pixels
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    occlusion: Option<bool>,
    /// Throw the shadows of the light, by a second picture from its direction
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    shadows: Option<bool>,
}

impl SpaceArguments {
    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let vector = |vector: DVec3| vector.to_array().map(|it| it.to_string()).join(",");
        let angles = |angles: [f64; 2]| angles.map(|it| it.to_string()).join(",");
        let plane = |normal: DVec3, value: f64| format!("{}={value}", vector(normal));
        let slab = |slice: Slice| {
            let thickness = slice.thickness.map(|it| format!(",w={it}"));
            plane(slice.normal, slice.offset) + &thickness.unwrap_or_default()
        };
        let all = [
            ("from", self.from.as_ref().map(ToString::to_string)),
            ("up", self.up.map(vector)),
            ("look-at", self.look_at.map(vector)),
            ("perspective", self.perspective.map(|it| it.to_string())),
            ("slice", self.slice.map(slab)),
            ("shade", self.shade.map(|it| it.name().into())),
            ("light", self.light.map(angles)),
            ("ambient", self.ambient.map(|it| it.to_string())),
            ("occlusion", self.occlusion.map(|it| it.to_string())),
            ("shadows", self.shadows.map(|it| it.to_string())),
        ];
        let given = all
            .into_iter()
            .filter_map(|(name, value)| Some((name, value?)));
        let cuts = { self.cut.iter() }.map(|cut| ("cut", plane(cut.normal, cut.distance)));
        given.chain(cuts).collect()
    }

    /// Refuses options of pictures for a file that holds whole elements or points. Options of the camera and the light stand
    /// where the file has them.
    pub(super) fn refuse_for_elements(&self, has_camera: bool) -> Result<(), Failure> {
        let is_seen = |name: &str| has_camera && !["slice", "cut"].contains(&name);
        match self.options().iter().find(|(name, _)| !is_seen(name)) {
            None => Ok(()),
            Some((name, _)) => Err(Failure::Usage(format!(
                "--{name} applies to pictures, and this file holds whole elements or points"
            ))),
        }
    }

    /// Returns whether occlusion is asked for.
    pub(super) fn occludes(&self) -> bool {
        self.occlusion == Some(true)
    }

    /// Returns whether shadows are asked for.
    pub(super) fn has_shadows(&self) -> bool {
        self.shadows == Some(true)
    }

    /// Refuses the options for a set of the plane.
    pub(super) fn refuse_in_plane(&self, loaded: &Loaded) -> Result<(), Failure> {
        match self.options().first() {
            Some((option, _)) => Err(in_plane(option, loaded)),
            None => Ok(()),
        }
    }

    /// Returns the options of a picture, with those of the file that are not given: from one direction.
    pub(super) fn to_options(&self, file: &SpaceView) -> Result<SpaceOptions, Failure> {
        let view = self.view().or(file);
        match self.from.as_ref().map(|views| &views.0[..]) {
            None | Some([_]) => Ok(SpaceOptions::from(&view)),
            Some(_) => Err(Failure::Usage(
                "a picture is seen from one direction: kfrac sheet shows several".into(),
            )),
        }
    }

    /// Returns the options of one picture for each direction, with its name.
    pub(super) fn views(&self, file: &SpaceView) -> Vec<(String, SpaceOptions)> {
        let view = self.view().or(file);
        let default = vec![view.direction()];
        let views = self.from.as_ref().map_or(&default, |views| &views.0);
        let name = |from: &[f64; 2]| {
            let named = Camera::NAMED.iter().find(|(_, angles)| angles == from);
            named.map_or_else(
                || format!("from {},{}", from[0], from[1]),
                |(name, _)| (*name).into(),
            )
        };
        let all = views.iter().map(|from| {
            let from = Some(*from);
            let view = SpaceView {
                from,
                ..view.clone()
            };
            SpaceOptions::from(&view)
        });
        views.iter().map(name).zip(all).collect()
    }

    /// Returns what is given of a view, from the first direction.
    fn view(&self) -> SpaceView {
        let first = |views: &Views| views.0.first().copied();
        SpaceView {
            from: self.from.as_ref().and_then(first),
            up: self.up,
            look_at: self.look_at,
            perspective: self.perspective,
            slice: self.slice,
            cuts: self.cut.clone(),
            shade: self.shade,
            light: self.light,
            ambient: self.ambient,
            occlusion: self.occlusion,
            shadows: self.shadows,
        }
    }
}

/// Directions of view, at least one: azimuth and elevation in degrees.
#[derive(Clone, Debug)]
struct Views(Vec<[f64; 2]>);

/// Formats the directions in the notation of the command line.
impl fmt::Display for Views {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<_> = self.0.iter().flatten().map(f64::to_string).collect();
        f.write_str(&all.join(","))
    }
}

/// Returns the error of an option of space that is given for a set of the plane.
pub(super) fn in_plane(option: &str, loaded: &Loaded) -> Failure {
    Failure::Usage(format!(
        "--{option} applies to sets in space, and {} lies in the plane",
        loaded.name
    ))
}

/// Parses directions: each an azimuth and an elevation, or the name of a view.
fn views(text: &str) -> Result<Views, String> {
    let angle = |text: &str| text.parse::<f64>().ok().filter(|angle| angle.abs() <= 1e6);
    let wrong = "write azimuth and elevation in degrees, as 30,25, or front, side, top or iso";
    let mut views = Vec::new();
    let mut parts = text.split(',').map(str::trim);
    while let Some(part) = parts.next() {
        let named = Camera::NAMED.iter().find(|(name, _)| *name == part);
        let angles = match named {
            Some((_, angles)) => Some(*angles),
            None => angle(part)
                .zip(parts.next().and_then(angle))
                .map(<[f64; 2]>::from),
        };
        views.push(angles.ok_or(wrong)?);
    }
    Ok(Views(views))
}

/// Parses one direction.
pub(super) fn direction(text: &str) -> Result<[f64; 2], String> {
    match views(text)?.0[..] {
        [direction] => Ok(direction),
        _ => Err("write one direction".into()),
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers = text
        .split(',')
        .map(|number| number.trim().parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let are_finite = numbers.iter().all(|number| number.is_finite());
    numbers.try_into().ok().filter(|_| are_finite)
}

fn point(text: &str) -> Result<DVec3, String> {
    let point = numbers::<3>(text).map(DVec3::from_array);
    point.ok_or_else(|| "a point in space is X,Y,Z".into())
}

fn vector(text: &str) -> Result<DVec3, String> {
    let vector = point(text).map_err(|_| "a vector in space is X,Y,Z")?;
    match vector.try_normalize() {
        Some(_) => Ok(vector),
        None => Err("a vector upwards has a length".into()),
    }
}

/// Parses a slab, as a plane and its thickness.
fn slice(text: &str) -> Result<Slice, String> {
    let slab = || {
        let (plane, thickness) = match text.split_once(",w=") {
            Some((plane, width)) => {
                let [width] = numbers::<1>(width)?;
                (plane, Some(Some(width).filter(|width| *width > 0.0)?))
            }
            None => (text, None),
        };
        let HalfSpace { normal, distance } = space::plane(plane).ok()?;
        Some(Slice::new(normal, distance).thickness(thickness))
    };
    let wrong = "a slice is its normal and a value, and maybe a thickness above 0: 0,0,1=0.5 or 0,0,1=0.5,w=0.01";
    slab().ok_or_else(|| wrong.into())
}

fn angle(text: &str) -> Result<f64, String> {
    let angle = text.parse::<f64>().ok();
    let angle = angle.filter(|angle| (1.0..=150.0).contains(angle));
    angle.ok_or_else(|| "an angle of view is a number of degrees from 1 to 150".into())
}
