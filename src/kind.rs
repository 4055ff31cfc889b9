//! The four kinds of models and files.

/// Declares the kinds of fractals: the name of a kind in files, the folder of its files in libraries,
/// its noun, and its full name with the article.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident: $name:literal, $folder:literal, $noun:literal, $full:literal;)*) => {
        /// Kind of a model and of its file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Kind { $($(#[$doc])* $kind,)* }

        impl Kind {
            /// All kinds, in the order in which they are listed and in which names are looked up.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$kind),*];

            /// Returns the value of `kind:` in files of the kind.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$kind => $name,)* }
            }

            /// Returns the kind with a [name](Self::name).
            #[must_use]
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|kind| kind.name() == name)
            }

            /// Returns the name of the folder of such files in a library.
            #[must_use]
            pub const fn folder(self) -> &'static str {
                match self { $(Self::$kind => $folder,)* }
            }

            /// Returns the noun for such a fractal, for use in messages.
            #[must_use]
            pub const fn noun(self) -> &'static str {
                match self { $(Self::$kind => $noun,)* }
            }

            /// Returns the full name with its article, for use in messages.
            #[must_use]
            pub const fn full_name(self) -> &'static str {
                match self { $(Self::$kind => $full,)* }
            }
        }
    };
}

kinds! {
    /// Production rule.
    Rule: "rule", "rules", "rule", "a production rule";
    /// Iterated function system.
    Ifs: "ifs", "ifs", "system", "an iterated function system";
    /// Structure of objects that instance each other.
    Instancing: "instancing", "instancing", "structure", "an instancing structure";
    /// L-system.
    LSystem: "lsystem", "lsystems", "L-system", "an L-system";
}
