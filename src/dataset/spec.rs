//! Validation of data sets.

use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::chaos::points_of_text;
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source, did_you_mean};
use crate::document::{DatasetDocument, Framing, Law, Mode, PictureDocument, WrittenNumber};
use crate::draws::{Path, Variable};
use crate::expression::{Expression, Program, Scope};
use crate::fractal::Fractal;
use crate::style::Palette;

use super::maps::WeightedMap;
use super::picture::Colouring;
use super::random::uniform;
use super::vary::Weights;

/// Largest side of a picture, in pixels.
const MAX_SIZE: u32 = 16_384;

/// Largest number of points of a picture.
const MAX_POINTS: u64 = 1_000_000_000;

/// Largest number of categories, and of pictures of a category.
pub(super) const MAX_COUNT: u32 = 100_000_000;

/// A validated data set.
#[derive(Debug)]
pub(super) struct Spec {
    pub(super) seed: u64,
    pub(super) origins: Vec<Origin>,
    pub(super) instances: u32,
    pub(super) weights: Weights,
    pub(super) flips: bool,
    /// Directions from which sets in space are seen.
    pub(super) views: Option<Views>,
    pub(super) size: u32,
    pub(super) points: u64,
    pub(super) mode: Mode,
    pub(super) colouring: Colouring,
    pub(super) fit: Framing,
    pub(super) fill: f64,
}

/// Directions from which sets in space are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Views {
    /// A direction that is uniform on the sphere for each picture.
    Random,
    /// A number of directions evenly around the set, in which every variation is seen.
    Around(u32),
}

impl Views {
    /// Elevation of views around a set, in degrees.
    const ELEVATION: f64 = 30.0;

    fn parse(text: &str) -> Option<Self> {
        match text {
            "random" => Some(Self::Random),
            number => {
                let number = number.parse().ok();
                number
                    .filter(|it| (1..=MAX_COUNT).contains(it))
                    .map(Self::Around)
            }
        }
    }

    /// Returns the number of the variation that a picture shows.
    pub(super) fn variation(self, instance: u32) -> u32 {
        match self {
            Self::Random => instance,
            Self::Around(count) => instance / count,
        }
    }

    /// Returns the direction of a picture, by azimuth and elevation in degrees.
    pub(super) fn direction(self, instance: u32, path: Path) -> [f64; 2] {
        match self {
            Self::Random => {
                let mut random = path.random("view");
                let azimuth = 360.0 * random.unit();
                let height = uniform(&mut random, -1.0, 1.0);
                [azimuth, libm::asin(height).to_degrees()]
            }
            Self::Around(count) => {
                let turn = f64::from(instance % count) / f64::from(count);
                [360.0 * turn, Self::ELEVATION]
            }
        }
    }
}

/// Origin of consecutive categories.
#[derive(Debug)]
pub(super) enum Origin {
    /// Systems that are drawn at random, with the least and the largest number of maps.
    Random {
        maps: [u32; 2],
        law: Law,
        is_in_space: bool,
        count: u32,
    },
    /// Members of a family, with the laws of their parameters; one category whose pictures draw them if there is no count.
    Family {
        name: String,
        fractal: Box<Fractal>,
        laws: Vec<Variable>,
        count: Option<u32>,
    },
    /// A system from a table.
    Table {
        name: String,
        maps: Vec<WeightedMap>,
    },
}

impl Origin {
    /// Returns the number of categories.
    pub(super) fn count(&self) -> u32 {
        match self {
            Self::Random { count, .. } => *count,
            Self::Family { count, .. } => count.unwrap_or(1),
            Self::Table { .. } => 1,
        }
    }
}

impl Spec {
    pub(super) fn read(source: &Arc<Source>, catalogue: &Catalogue) -> Result<Self, Diagnostics> {
        let document = DatasetDocument::read(source)?;
        let mut checker = Checker {
            catalogue,
            source,
            has_views: false,
            found: Diagnostics::default(),
        };
        let spec = checker.spec(&document);
        match spec {
            Some(spec) if !checker.found.has_errors() => Ok(spec),
            _ => Err(checker.found.without_repeats()),
        }
    }
}

pub(super) struct Checker<'a> {
    pub(super) catalogue: &'a Catalogue,
    pub(super) source: &'a Arc<Source>,
    /// Whether there are views of sets in space.
    pub(super) has_views: bool,
    pub(super) found: Diagnostics,
}

impl Checker<'_> {
    pub(super) fn error(&mut self, place: &Place, message: impl Into<String>, hint: &str) {
        let error = Diagnostic::error(message).at(place);
        self.found.push(if hint.is_empty() {
            error
        } else {
            error.hint(hint)
        });
    }

    fn spec(&mut self, document: &DatasetDocument) -> Option<Spec> {
        if document.kind != "dataset" {
            let message = format!("'{}' is no data set", document.kind);
            self.error(&document.place.first_line(), message, "kind: dataset");
        }
        let seed = self.whole(document.seed.as_ref(), 0, 0..=u32::MAX, "a seed");
        let views = document.instances.as_ref().and_then(|it| it.views.as_ref());
        let views = views.map(|text| {
            let views = Views::parse(&text.value);
            if views.is_none() {
                let message = format!("'{}' is no choice of views", text.value);
                self.error(
                    &text.place,
                    message,
                    "views: random, or a number of them such as views: 12",
                );
            }
            views
        });
        self.has_views = views.is_some();
        let mut origins = Vec::new();
        let systems = { document.categories.as_ref() }.and_then(|it| it.systems.as_ref());
        for source in systems.into_iter().flatten() {
            self.origins(source, &mut origins);
        }
        let instances = document.instances.as_ref();
        let count = instances.and_then(|it| it.count.as_ref());
        let count = self.whole(count, 1, 1..=MAX_COUNT, "a number of pictures");
        let weights = instances.and_then(|it| it.weights.as_ref());
        let weights = weights.map(|text| {
            Weights::parse(&text.value)
                .map_err(|error| self.found.push(error.at(&text.place)))
                .ok()
        });
        let fill = document.accept.as_ref().and_then(|it| it.fill.as_ref());
        let fill = match fill {
            None => Some(0.0),
            Some(number) => self.constant(number).filter(|fill| {
                let fits = (0.0..1.0).contains(fill);
                if !fits {
                    self.error(
                        &number.place,
                        "a fill is a share from 0 to 1",
                        "accept: {fill: 0.2}",
                    );
                }
                fits
            }),
        };
        let spec = Spec {
            seed: seed?.into(),
            origins,
            instances: count?,
            weights: weights.unwrap_or(Some(Weights::None))?,
            flips: instances.is_some_and(|it| it.flips),
            views: views.unwrap_or_default(),
            size: 256,
            points: 100_000,
            mode: Mode::default(),
            colouring: Colouring::default(),
            fit: Framing::default(),
            fill: fill?,
        };
        match &document.picture {
            Some(picture) => self.picture(picture, spec),
            None => Some(spec),
        }
    }

    fn picture(&mut self, document: &PictureDocument, spec: Spec) -> Option<Spec> {
        let size = self.whole(
            document.size.as_ref(),
            256,
            1..=MAX_SIZE,
            "a side in pixels",
        );
        let points = match &document.points {
            None => Some(spec.points),
            Some(text) => match points_of_text(&text.value) {
                Ok(points) if points <= MAX_POINTS => Some(points),
                Ok(_) => {
                    self.error(&text.place, "a picture has at most 1G points", "");
                    None
                }
                Err(message) => {
                    self.error(&text.place, message, "points: 100k");
                    None
                }
            },
        };
        let colouring = match document.colour.as_ref() {
            None => Some(Colouring::Grey),
            Some(text) => match text.value.as_str() {
                "gray" | "grey" => Some(Colouring::Grey),
                "hsv" => Some(Colouring::Hsv),
                name => match Palette::named(name) {
                    Ok(palette) => Some(Colouring::Palette(palette)),
                    Err(_) => {
                        let message = format!("there is no palette '{name}'");
                        let names = ["gray", "hsv"].into_iter().chain(Palette::names());
                        let hint = did_you_mean(name, names);
                        let hint = hint
                            .unwrap_or_else(|| "gray, hsv, or a palette such as viridis".into());
                        self.error(&text.place, message, &hint);
                        None
                    }
                },
            },
        };
        Some(Spec {
            size: size?,
            points: points?,
            mode: document.mode,
            colouring: colouring?,
            fit: document.fit,
            ..spec
        })
    }

    /// Evaluates a whole number within limits, or returns the value of one that is left out.
    pub(super) fn whole(
        &mut self,
        number: Option<&WrittenNumber>,
        absent: u32,
        limits: std::ops::RangeInclusive<u32>,
        what: &str,
    ) -> Option<u32> {
        let Some(number) = number else {
            return Some(absent);
        };
        let value = self.constant(number)?;
        let fits = value.fract() == 0.0
            && (f64::from(*limits.start())..=f64::from(*limits.end())).contains(&value);
        if !fits {
            let (least, most) = (limits.start(), limits.end());
            let message = format!("{what} is a whole number from {least} to {most}, not {value}");
            self.error(&number.place, message, "");
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number within limits"
        )]
        Some(value as u32)
    }

    /// Evaluates an expression without parameters.
    pub(super) fn constant(&mut self, number: &WrittenNumber) -> Option<f64> {
        self.program(number, &number.value)?.as_constant()
    }

    pub(super) fn program(&mut self, number: &WrittenNumber, part: &Expression) -> Option<Program> {
        let compiled = part.compile(&Scope::default());
        compiled
            .map_err(|mistake| self.found.push(mistake.at(&number.place)))
            .ok()
    }
}
