//! What files of all kinds say.

/// The methods of a builder for the keys that files of all kinds have.
macro_rules! of_all_kinds {
    () => {
        /// Adds a parameter, which expressions know by its name.
        pub fn parameter(self, parameter: Parameter) -> Self {
            let Parameter {
                name,
                value,
                min,
                max,
                about,
            } = parameter;
            let number = |value| Number::from(value).0;
            let entries = Entries::default()
                .set("value", number(value))
                .set_some("min", min.map(number))
                .set_some("max", max.map(number))
                .set_some("about", about.map(Value::Text));
            Self {
                parameters: self.parameters.add(name, entries.value()),
                ..self
            }
        }

        /// The number of steps that the file proposes.
        pub fn steps(self, steps: u32) -> Self {
            self.set("steps", Value::Number(f64::from(steps)))
        }

        /// The published similarity dimension.
        pub fn dimension(self, dimension: impl Into<Number>) -> Self {
            self.set("dimension", dimension.into().0)
        }

        /// The published Hausdorff dimension, where it differs from the similarity dimension.
        pub fn hausdorff_dimension(self, dimension: impl Into<Number>) -> Self {
            self.set("hausdorff_dimension", dimension.into().0)
        }

        /// Title, source and the like.
        pub fn description(mut self, description: &Description) -> Self {
            self.entries = written::description(self.entries, description);
            self
        }

        /// How it is drawn.
        pub fn style(self, style: &Style) -> Self {
            self.set("style", written::style(style).value())
        }

        /// What part of the plane is drawn.
        pub fn view(self, view: &View) -> Self {
            self.set("view", written::view(view).value())
        }
    };
}

pub(super) use of_all_kinds;
