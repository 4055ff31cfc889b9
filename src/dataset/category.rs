//! Categories of a data set, and their pictures.

use std::num::NonZero;
use std::sync::OnceLock;

use crate::chaos::{ChaosMap, Game};
use crate::document::{Framing, Law, Mode};
use crate::draws::{Path, Variable};
use crate::fractal::Fractal;
use crate::geometry::{Affine, DAffine2, DAffine3, DVec3};
use crate::ifs::Ifs;
use crate::measure::exact::{Effort, GraphDirectedSystem, Hausdorff, dimensions_within};
use crate::model::Model;
use crate::random::Pcg;
use crate::render::Levels;
use crate::render::space::SpaceOptions;
use crate::style::{Camera, Style, View};

use super::maps::{Attractor, Drawable, Maps, WeightedMap, weighted};
use super::picture::Plain;
use super::random::{anderson, below, by_coefficients};
use super::spec::{Origin, Spec};
use super::{DatasetError, path_of};

/// Number of systems that are drawn for a category before it is given up.
const MAX_ATTEMPTS: u32 = 10_000;

/// Side and points of the picture that decides whether a system is accepted, as in the search for FractalDB.
const TRIAL: (u32, u64) = (512, 100_000);

/// A category: a class of pictures.
#[derive(Debug)]
pub struct Category {
    number: u32,
    name: String,
    subject: Subject,
    attempts: u32,
    dimension: OnceLock<Option<Hausdorff>>,
}

/// A picture with its label.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Example {
    /// Number of the category: the class.
    pub category: u32,
    /// Number of the picture in the category.
    pub instance: u32,
    /// The picture.
    pub picture: Levels,
    /// Values that the picture was drawn with.
    pub label: Label,
}

/// Values that a picture was drawn with.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Label {
    /// Maps of the system, after variation; `None` for other fractals.
    pub maps: Option<Maps>,
    /// Parameters of the file, with their values.
    pub parameters: Vec<(String, f64)>,
    /// Flip: 0 none, 1 from top to bottom, 2 from left to right, 3 both.
    pub flip: u8,
    /// Azimuth and elevation of the viewer of a set in space, in degrees, as of [`Camera::from`].
    pub from: Option<[f64; 2]>,
}

/// Set of which a category is.
#[derive(Clone, Debug)]
enum Subject {
    /// A system of maps, any of which may follow any.
    Maps(Maps),
    /// Any other fractal.
    Fractal(Box<Fractal>),
    /// A family whose members the pictures draw.
    Family(Box<Fractal>, Vec<Variable>),
}

impl Category {
    /// Finds a category.
    pub(super) fn find(spec: &Spec, number: u32) -> Result<Self, DatasetError> {
        let mut first = 0;
        let found = spec.origins.iter().find_map(|origin| {
            let local = number - first;
            first += origin.count();
            (number < first).then_some((origin, local))
        });
        let Some((origin, local)) = found else {
            return Err(DatasetError::Index {
                index: number.into(),
                len: first.into(),
            });
        };
        let (name, subject, attempts) = match origin {
            Origin::Random {
                maps,
                law,
                is_in_space,
                ..
            } => {
                let (maps, attempts) = match (is_in_space, law) {
                    (false, Law::Anderson) => {
                        let (maps, attempts) = drawn(spec, number, *maps, anderson)?;
                        (Maps::Plane(maps), attempts)
                    }
                    (false, Law::Uniform) => {
                        let (maps, attempts) = drawn(spec, number, *maps, by_coefficients)?;
                        (Maps::Plane(maps), attempts)
                    }
                    (true, _) => {
                        let (maps, attempts) = drawn(spec, number, *maps, by_coefficients)?;
                        (Maps::Space(maps), attempts)
                    }
                };
                (String::new(), Subject::Maps(maps), attempts)
            }
            Origin::Table { name, maps } => {
                let maps = Maps::Plane(maps.clone());
                (name.clone(), Subject::Maps(maps), 1)
            }
            Origin::Family {
                name,
                fractal,
                laws,
                count,
            } => {
                let subject = match (count, laws.is_empty()) {
                    (None, false) => Subject::Family(fractal.clone(), laws.clone()),
                    _ => Subject::of(member(
                        fractal,
                        laws,
                        path_of(spec, number).child(0),
                        number,
                    )?),
                };
                let name = match count {
                    Some(count) if *count > 1 => format!("{name}-{local}"),
                    _ => name.clone(),
                };
                (name, subject, 1)
            }
        };
        Ok(Self {
            number,
            name: match name.as_str() {
                "" => format!("{number:05}"),
                name => format!("{number:05}-{name}"),
            },
            subject,
            attempts,
            dimension: OnceLock::new(),
        })
    }

    /// Returns the number of the category.
    #[must_use]
    pub fn number(&self) -> u32 {
        self.number
    }

    /// Returns the name: the number with five digits, and the name of the file, if there is one. Names sort as numbers do, up
    /// to 99,999.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of systems that were drawn until one was accepted; 1 for others.
    #[must_use]
    pub fn attempts(&self) -> u32 {
        self.attempts
    }

    /// Returns the maps before variation; `None` for other fractals.
    #[must_use]
    pub fn maps(&self) -> Option<&Maps> {
        match &self.subject {
            Subject::Maps(maps) => Some(maps),
            _ => None,
        }
    }

    /// Returns the parameters of the file with their values; empty where the pictures draw them.
    #[must_use]
    pub fn parameters(&self) -> Vec<(String, f64)> {
        match &self.subject {
            Subject::Fractal(fractal) => parameters(fractal),
            _ => Vec::new(),
        }
    }

    /// Returns the dimension of the set before variation, as far as it is decided in a moment.
    #[must_use]
    pub fn dimension(&self) -> Option<&Hausdorff> {
        let found = self.dimension.get_or_init(|| match &self.subject {
            Subject::Maps(maps) => dimension(maps),
            Subject::Fractal(fractal) => fractal.info().ok()?.dimension,
            Subject::Family(..) => None,
        });
        found.as_ref()
    }

    /// Works out what a picture shows, and its label.
    pub(super) fn prepare(&self, spec: &Spec, instance: u32) -> Result<Prepared, DatasetError> {
        let views = spec.views.filter(|_| self.subject.is_in_space());
        let variation = views.map_or(instance, |views| views.variation(instance));
        let path = path_of(spec, self.number).child(1).child(variation);
        let failed = |reason: &str| DatasetError::Picture {
            category: self.number,
            instance,
            reason: reason.into(),
        };
        let subject = match &self.subject {
            Subject::Family(fractal, laws) => {
                &Subject::of(member(fractal, laws, path, self.number)?)
            }
            subject => subject,
        };
        let coefficients = match subject {
            Subject::Maps(Maps::Space(_)) => DAffine3::COEFFICIENTS,
            _ => DAffine2::COEFFICIENTS,
        };
        let round = variation as usize / spec.weights.period(coefficients);
        // Patterns, colours and directions are drawn for each picture.
        let own = path_of(spec, self.number).child(1).child(instance);
        let from = views.map(|views| views.direction(instance, own));
        let mut label = Label {
            flip: match spec.flips {
                true => u8::try_from(round % 4).unwrap_or(0),
                false => 0,
            },
            from,
            ..Label::default()
        };
        let diverges = || failed("its walks diverge");
        let weights = spec.weights;
        let shown = match subject {
            Subject::Maps(Maps::Plane(maps)) => {
                let varied = weights.vary(maps, variation, path, DAffine2::IDENTITY);
                let (maps, attractor) = varied.ok_or_else(diverges)?;
                label.maps = Some(Maps::Plane(maps));
                Shown::Plane(attractor)
            }
            Subject::Maps(Maps::Space(maps)) => {
                let varied = weights.vary(maps, variation, path, seen(from.unwrap_or_default()));
                let (maps, attractor) = varied.ok_or_else(diverges)?;
                label.maps = Some(Maps::Space(maps));
                Shown::Space(attractor)
            }
            Subject::Fractal(fractal) | Subject::Family(fractal, _) => {
                label.parameters = parameters(fractal);
                Shown::Fractal(fractal.clone())
            }
        };
        Ok(Prepared {
            category: self.number,
            instance,
            path,
            own,
            shown,
            label,
        })
    }
}

/// Contents of a picture.
enum Shown {
    Plane(Attractor<DAffine2>),
    Space(Attractor<DAffine3>),
    Fractal(Box<Fractal>),
}

/// A picture that is not drawn yet.
pub(super) struct Prepared {
    category: u32,
    instance: u32,
    /// Path of the draws of the variation.
    path: Path,
    /// Path of the draws of the picture.
    own: Path,
    shown: Shown,
    pub(super) label: Label,
}

impl Prepared {
    /// Draws the picture.
    pub(super) fn draw(self, spec: &Spec) -> Result<Example, DatasetError> {
        let Self {
            category,
            instance,
            path,
            own,
            shown,
            label,
        } = self;
        let failed = |reason: String| DatasetError::Picture {
            category,
            instance,
            reason,
        };
        let no_size = || failed("it has no size".into());
        let plain = match shown {
            Shown::Plane(attractor) => plain(&attractor, spec, path).ok_or_else(no_size)?,
            Shown::Space(attractor) => plain(&attractor, spec, path).ok_or_else(no_size)?,
            Shown::Fractal(fractal) => {
                let drawn = drawing(&fractal, spec, label.from, path);
                drawn.map_err(|error| failed(error.to_string()))?
            }
        };
        let plain = match spec.mode {
            Mode::Patch3 => plain.patterned(own),
            _ => plain,
        };
        let picture = { plain.flipped(label.flip) }.coloured(&spec.colouring, own);
        Ok(Example {
            category,
            instance,
            picture: picture.ok_or_else(|| failed("it has no pixels".into()))?,
            label,
        })
    }
}

impl Label {
    /// Returns the dimension of the system that was drawn, as far as it is decided in a moment; `None` for other fractals.
    #[must_use]
    pub fn dimension(&self) -> Option<Hausdorff> {
        dimension(self.maps.as_ref()?)
    }
}

impl Subject {
    fn of(fractal: Fractal) -> Self {
        let maps = match fractal.model() {
            Model::Ifs(system) => plain_maps(system.ifs()).map(Maps::Plane),
            Model::IfsInSpace(system) => plain_maps(system.ifs()).map(Maps::Space),
            _ => None,
        };
        maps.map_or_else(|| Self::Fractal(Box::new(fractal)), Self::Maps)
    }

    fn is_in_space(&self) -> bool {
        match self {
            Self::Maps(maps) => matches!(maps, Maps::Space(_)),
            Self::Fractal(fractal) | Self::Family(fractal, _) => fractal.model().is_in_space(),
        }
    }
}

/// Returns the maps of a system any of which may follow any, with their weights; `None` for others.
fn plain_maps<M: ChaosMap>(ifs: &Ifs<M>) -> Option<Vec<WeightedMap<M>>> {
    let is_plain = !ifs.is_recurrent() && ifs.condensation().is_empty();
    is_plain.then(|| {
        let maps = ifs.maps().iter().zip(ifs.weights());
        let maps = maps.map(|(map, weight)| WeightedMap::new(map.affine, *weight));
        maps.collect()
    })
}

/// Returns the rotation to the coordinates of the view from a direction, by azimuth and elevation in degrees.
fn seen(from: [f64; 2]) -> DAffine3 {
    // A camera without an upward vector has a rotation from every direction.
    let rotation = Camera::default().from(from).rotation();
    rotation.map_or(DAffine3::IDENTITY, |it| Affine::new(it, DVec3::ZERO))
}

/// Draws systems until one is accepted; returns it with the number of systems. A system in space is accepted by the view from
/// the front.
fn drawn<M: Drawable>(
    spec: &Spec,
    category: u32,
    [least, most]: [u32; 2],
    law: impl Fn(&mut Pcg, u32) -> Vec<M>,
) -> Result<(Vec<WeightedMap<M>>, u32), DatasetError> {
    let (size, points) = TRIAL;
    for attempt in 0..MAX_ATTEMPTS {
        let path = path_of(spec, category).child(0).child(attempt);
        let mut random = path.random("system");
        let count = least + below(&mut random, most - least + 1);
        let maps = weighted(law(&mut random, count));
        let Some(attractor) = Attractor::of(&maps, M::IDENTITY) else {
            continue;
        };
        let is_full = spec.fill == 0.0 || {
            let hits = attractor.hits(size, Framing::Box, &game(points, path));
            hits.is_some_and(|it| share(&it) >= spec.fill)
        };
        if is_full {
            return Ok((maps, attempt + 1));
        }
    }
    let attempts = MAX_ATTEMPTS;
    Err(DatasetError::NoSystem { category, attempts })
}

/// Returns the share of pixels that are hit.
fn share(counts: &[u32]) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    let [hit, all] = [
        counts.iter().filter(|hits| **hits > 0).count(),
        counts.len(),
    ]
    .map(|it| it as f64);
    hit / all
}

/// Returns the game of a picture; pictures are shared between threads, and points are not.
fn game<P>(points: u64, path: Path) -> Game<'static, P> {
    Game {
        points,
        seed: path.random("points").bits(),
        threads: NonZero::<usize>::MIN,
        ..Game::default()
    }
}

/// Returns a member of a family, with parameters drawn at a path.
fn member(
    fractal: &Fractal,
    laws: &[Variable],
    path: Path,
    category: u32,
) -> Result<Fractal, DatasetError> {
    let settings = laws.iter().map(|law| (law.name(), law.draw(path, &[])));
    let member = fractal.clone().set_all(settings.collect::<Vec<_>>());
    member.map_err(|error| DatasetError::Picture {
        category,
        instance: 0,
        reason: error.to_string(),
    })
}

fn parameters(fractal: &Fractal) -> Vec<(String, f64)> {
    let parameters = fractal.model().metadata().parameters.iter();
    parameters.map(|it| (it.name.clone(), it.value)).collect()
}

/// Draws the attractor of a system of maps; `None` if it has no size.
fn plain<M: Drawable>(attractor: &Attractor<M>, spec: &Spec, path: Path) -> Option<Plain> {
    let hits = attractor.hits(spec.size, spec.fit, &game(spec.points, path))?;
    Some(Plain::of_hits(&hits, spec.size, spec.mode))
}

/// Draws a fractal that is no plain system of maps, in space from a direction.
fn drawing(
    fractal: &Fractal,
    spec: &Spec,
    from: Option<[f64; 2]>,
    path: Path,
) -> Result<Plain, crate::Error> {
    let size = (spec.size, spec.size);
    let style = fractal.model().metadata().style.clone();
    let space = SpaceOptions::from(&fractal.model().space_view());
    let space = space.camera(Camera::default().from(from.unwrap_or_default()));
    let fractal = fractal
        .clone()
        .space(space)
        .threads(NonZero::<usize>::MIN)
        .seed(path.random("points").bits())
        .style(Style {
            background: None,
            ..style
        })
        .view(View {
            margin: Some(0.0),
            ..fractal.model().metadata().view
        });
    if let Model::Ifs(_) = fractal.model()
        && let Ok(histogram) = fractal.histogram(spec.points, size)
    {
        return Ok(Plain::of_hits(histogram.counts(0), spec.size, spec.mode));
    }
    Ok(Plain::of_pixels(&fractal.pixels(size)?, spec.mode))
}

/// Returns the dimension of a system of maps.
fn dimension(maps: &Maps) -> Option<Hausdorff> {
    let system = match maps {
        Maps::Plane(maps) => GraphDirectedSystem::plane(maps.iter().map(|it| (0, 0, it.map))),
        Maps::Space(maps) => GraphDirectedSystem::space(maps.iter().map(|it| (0, 0, it.map))),
    }?;
    Some(dimensions_within(&system, Effort::Quick)?.hausdorff)
}
