//! Metadata methods that all builders share.

/// Defines the methods for the keys that files of all kinds have.
macro_rules! of_all_kinds {
    () => {
        /// Adds a parameter, which expressions refer to by its name.
        pub fn parameter(self, parameter: Parameter) -> Self {
            let Parameter {
                name,
                value,
                min,
                max,
                about,
            } = parameter;
            let number = |value| NumberText::from(value).0;
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

        /// Sets the number of steps that the file proposes.
        pub fn steps(self, steps: u32) -> Self {
            self.set("steps", Value::Number(f64::from(steps)))
        }

        /// Sets the published similarity dimension.
        pub fn dimension(self, dimension: impl Into<NumberText>) -> Self {
            self.set("dimension", dimension.into().0)
        }

        /// Sets the published Hausdorff dimension, where it differs from the similarity dimension.
        pub fn hausdorff_dimension(self, dimension: impl Into<NumberText>) -> Self {
            self.set("hausdorff_dimension", dimension.into().0)
        }

        /// Sets title, description, source and tags.
        pub fn description(mut self, description: &Description) -> Self {
            self.entries = written::description(self.entries, description);
            self
        }

        /// Sets the style.
        pub fn style(self, style: &Style) -> Self {
            self.set("style", written::style(style).value())
        }

        /// Sets the group under whose isometries the picture is repeated, in the plane.
        pub fn symmetry(self, symmetry: &crate::Symmetry) -> Self {
            self.set("symmetry", written::symmetry(symmetry))
        }

        /// Sets how hits of pixels are drawn in a PNG.
        pub fn density(self, density: &crate::style::DensityView) -> Self {
            self.set("density", written::density(density).value())
        }

        /// Sets the view: the window and the margin.
        pub fn view(self, view: &View) -> Self {
            self.set("view", written::view(view).value())
        }
    };
}

pub(super) use of_all_kinds;
