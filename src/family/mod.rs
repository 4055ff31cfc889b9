//! Families of iterated function systems of the plane, and maps of their parameters.
//!
//! A [`Family`] has the maps of a system as functions of one or two of its parameters. A [`ParameterPlane`] is a rectangle
//! of values of these parameters, which is divided into pixels, and [`ParameterMap::compute`] determines a [`Property`] of
//! the attractor at the centre of each: whether it is connected, its similarity dimension, or the area that it covers at
//! most. For {s z + 1, s z − 1} with complex s, the map of [`Property::Connected`] is the Mandelbrot set for pairs of linear
//! maps (Barnsley & Harrington 1985).
//!
//! ```
//! use kfrac::catalogue::Catalogue;
//! use kfrac::document::Document;
//! use kfrac::family::{Family, MapOptions, ParameterMap, ParameterPlane, ParameterRange, PlaneValue, Property};
//!
//! let catalogue = Catalogue::embedded();
//! let document = Document::read(&catalogue.rule("complex-pair").unwrap(), &catalogue).unwrap();
//! let axes = ["s.re", "s.im"].map(|name| ParameterRange { name: name.into(), from: -1.0, to: 1.0 });
//! let family = Family::of(&document, &[], &["s.re".into(), "s.im".into()]).unwrap();
//! let plane = ParameterPlane::new(axes.into(), [65, 65]).unwrap();
//! let map = ParameterMap::compute(&family, &plane, &MapOptions::new(Property::Connected)).unwrap();
//! // The attractor for s = 0 has two points.
//! assert_eq!(map.value(32, 32), PlaneValue::Number(1.0));
//! ```

mod paint;
mod plane;
mod property;
mod system;

pub use paint::{Legend, LegendEntry};
pub use plane::{MapOptions, ParameterMap, ParameterPlane, ParameterRange, PlaneError};
pub use property::{PlaneValue, Property};
pub use system::{Family, FamilyError, FamilyMember};
