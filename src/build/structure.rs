//! Builder of instancing structures.

use crate::diagnostic::Diagnostics;
use crate::document::Document;
use crate::document::node::Value;
use crate::instancing::Instancing;
use crate::metadata::{Description, Parameter};
use crate::model::Kind;
use crate::style::{Colour, Style, View};

use super::metadata::of_all_kinds;
use super::written::{self, Entries, colour_text, sequence};
use super::{NumberText, PointText, SetBuilder, built, read};

/// Transforms in the order of application.
#[derive(Clone, Debug, Default)]
struct Transforms(Vec<Value>);

impl Transforms {
    fn with(mut self, key: &str, value: Value) -> Self {
        self.0.push(Entries::default().set(key, value).value());
        self
    }

    fn add_to(self, entries: Entries) -> Entries {
        let list = (!self.0.is_empty()).then(|| sequence(self.0));
        entries.set_some("transform", list)
    }
}

/// Defines the methods that append a transform.
macro_rules! transforms {
    () => {
        fn transformed(self, key: &str, value: Value) -> Self {
            Self {
                transforms: self.transforms.with(key, value),
                ..self
            }
        }

        /// Appends a scaling about (0, 0) by a factor.
        pub fn scale(self, factor: impl Into<NumberText>) -> Self {
            self.transformed("scale", factor.into().0)
        }

        /// Appends a scaling about (0, 0) along x and y, by one factor each.
        pub fn scales(self, factors: impl Into<PointText>) -> Self {
            self.transformed("scale", factors.into().0)
        }

        /// Appends a rotation about (0, 0) by an angle in degrees, counter-clockwise.
        pub fn rotate(self, angle: impl Into<NumberText>) -> Self {
            self.transformed("rotate", angle.into().0)
        }

        /// Appends a translation.
        pub fn translate(self, shift: impl Into<PointText>) -> Self {
            self.transformed("translate", shift.into().0)
        }

        /// Appends a linear map, given by the rows of its matrix.
        pub fn matrix(self, rows: [impl Into<PointText>; 2]) -> Self {
            self.transformed("matrix", sequence(rows.map(|row| row.into().0)))
        }
    };
}

/// An instance of an object or of a set.
#[derive(Clone, Debug)]
#[must_use]
pub struct InstanceBuilder {
    entries: Entries,
    tint: Entries,
    transforms: Transforms,
}

impl InstanceBuilder {
    /// Creates an instance of an object by its name, with its level if it has one: `A(n - 1)`.
    pub fn of(object: impl Into<String>) -> Self {
        Self {
            entries: Entries::default().set("object", Value::Text(object.into())),
            tint: Entries::default(),
            transforms: Transforms::default(),
        }
    }

    transforms!();

    fn tinted(self, key: &str, value: Value) -> Self {
        Self {
            tint: self.tint.set(key, value),
            ..self
        }
    }

    /// Tints the content of the instance with a colour; `alpha` is the strength of the tint, from 0 to
    /// 1.
    pub fn tint(self, colour: Colour, alpha: impl Into<NumberText>) -> Self {
        self.tinted("color", colour_text(colour))
            .tinted("alpha", alpha.into().0)
    }

    /// Adds degrees to the hue of the content.
    pub fn hue(self, degrees: impl Into<NumberText>) -> Self {
        self.tinted("hue", degrees.into().0)
    }

    /// Moves the saturation of the content a share of the way to 1, or to 0 if the share is negative.
    pub fn saturation(self, share: impl Into<NumberText>) -> Self {
        self.tinted("saturation", share.into().0)
    }

    /// Moves the lightness of the content a share of the way to white, or to black if the share is negative.
    pub fn lightness(self, share: impl Into<NumberText>) -> Self {
        self.tinted("lightness", share.into().0)
    }

    /// Moves the opacity of the content a share of the way to 1, or to 0 if the share is negative.
    pub fn opacity(self, share: impl Into<NumberText>) -> Self {
        self.tinted("opacity", share.into().0)
    }
}

impl From<SetBuilder> for InstanceBuilder {
    fn from(set: SetBuilder) -> Self {
        Self {
            entries: set.0,
            tint: Entries::default(),
            transforms: Transforms::default(),
        }
    }
}

/// An object: a union of instances.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct UnionBuilder {
    instances: Vec<Value>,
    transforms: Transforms,
}

impl UnionBuilder {
    /// Creates an empty union.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends an instance.
    pub fn with(mut self, instance: impl Into<InstanceBuilder>) -> Self {
        let InstanceBuilder {
            entries,
            tint,
            transforms,
        } = instance.into();
        let tint = (!tint.is_empty()).then(|| tint.value());
        let entries = entries.set_some("tint", tint);
        self.instances.push(transforms.add_to(entries).value());
        self
    }

    transforms!();

    fn entries(self) -> Entries {
        let union = Entries::default().set("union", sequence(self.instances));
        self.transforms.add_to(union)
    }

    fn value(self) -> Value {
        self.entries().value()
    }
}

impl From<InstanceBuilder> for UnionBuilder {
    fn from(instance: InstanceBuilder) -> Self {
        Self::new().with(instance)
    }
}

/// Builder of an instancing structure. Setting a key again replaces its value. Names of objects, with
/// their levels, must be unique.
#[derive(Clone, Debug)]
#[must_use = "a structure is made by `build` or `document`"]
pub struct StructureBuilder {
    entries: Entries,
    parameters: Entries,
    variables: Entries,
    objects: Entries,
}

impl StructureBuilder {
    /// Creates a structure with a scene, but without objects.
    pub fn new(scene: impl Into<UnionBuilder>) -> Self {
        let kind = Value::Text(Kind::Instancing.name().into());
        Self {
            entries: Entries::default()
                .set("kind", kind)
                .set("scene", scene.into().value()),
            parameters: Entries::default(),
            variables: Entries::default(),
            objects: Entries::default(),
        }
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self {
            entries: self.entries.set(key, value),
            ..self
        }
    }

    /// Adds an object: `A`, `A(n)` for all levels, or `A(0)` for a single level.
    pub fn object(self, name: impl Into<String>, union: impl Into<UnionBuilder>) -> Self {
        Self {
            objects: self.objects.add(name, union.into().value()),
            ..self
        }
    }

    /// Adds an object that is one of several unions, drawn at random by their weights for every instance.
    pub fn object_at_random<W: Into<NumberText>, U: Into<UnionBuilder>>(
        self,
        name: impl Into<String>,
        alternatives: impl IntoIterator<Item = (W, U)>,
    ) -> Self {
        let alternatives = alternatives.into_iter().map(|(weight, union)| {
            let union: UnionBuilder = union.into();
            union.entries().set("weight", weight.into().0).value()
        });
        let object = Entries::default().set("at_random", sequence(alternatives));
        Self {
            objects: self.objects.add(name, object.value()),
            ..self
        }
    }

    /// Adds a random variable, which is drawn whenever an object is replaced from `uniform(a, b)`, `normal(mean,
    /// deviation)` or `choice(a, b, ...)`; transforms of instances in objects may use it.
    pub fn random(self, name: impl Into<String>, distribution: impl Into<NumberText>) -> Self {
        Self {
            variables: self.variables.add(name, distribution.into().0),
            ..self
        }
    }

    /// Sets the set that is drawn in place of objects that are not replaced yet.
    pub fn initial(self, set: SetBuilder) -> Self {
        self.set("initial", set.0.value())
    }

    of_all_kinds!();

    /// Returns the structure as a document.
    ///
    /// # Errors
    ///
    /// Returns all mistakes that [`Document::read`] finds.
    pub fn document(&self) -> Result<Document, Diagnostics> {
        read(
            &self.entries,
            &[
                ("params", &self.parameters),
                ("random", &self.variables),
                ("objects", &self.objects),
            ],
        )
    }

    /// Returns the validated structure.
    ///
    /// # Errors
    ///
    /// Returns all mistakes: unknown objects, loops that do not contract, and so on.
    pub fn build(&self) -> Result<Instancing, Diagnostics> {
        built(&self.document()?)
    }
}
