//! The look of a picture: steps, seed, parameters, style and view, as arguments of `kfrac grow`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::answer::Refusal;
use super::film::Film;
use super::view::View;

/// Everything that a picture depends on besides the text of its rule and its size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Look {
    /// Number of steps; that of the file, or the proposed one, if `None`.
    pub(super) steps: Option<u32>,
    /// Length in pixels below which elements are not replaced.
    pub(super) detail: Option<f64>,
    /// Seed of random draws.
    #[serde(with = "decimal")]
    pub(super) seed: u64,
    /// Values of parameters, as `--set` takes them.
    pub(super) set: BTreeMap<String, String>,
    /// Other options of `grow`, by their names: colours, widths, palettes, camera, light, density.
    pub(super) options: BTreeMap<String, String>,
    /// Part of the plane; the whole set if `None`.
    pub(super) view: Option<View>,
    /// Whether the steps grow with the magnification.
    pub(super) follows: bool,
    /// Key frames of the parameters.
    pub(super) film: Film,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            steps: None,
            detail: None,
            seed: 0,
            set: BTreeMap::new(),
            options: BTreeMap::new(),
            view: None,
            follows: true,
            film: Film::default(),
        }
    }
}

/// Seeds are 64 bits long, and numbers of pages 53: they are texts there.
mod decimal {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(seed: &u64, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(seed)
    }

    pub(super) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<u64, D::Error> {
        let text = String::deserialize(from)?;
        let seed = text.trim().parse();
        seed.map_err(|_| {
            D::Error::custom("a seed is a whole number from 0 to 18446744073709551615")
        })
    }
}

/// Options of the plane and of space.
const BOTH: [&str; 6] = [
    "stroke",
    "fill",
    "background",
    "color-by",
    "palette",
    "color-range",
];
/// Options of the plane alone.
const PLANE: [&str; 5] = ["stroke-width", "cap", "join", "margin", "turn"];
/// Options of space alone.
const SPACE: [&str; 11] = [
    "from",
    "zoom",
    "up",
    "look-at",
    "perspective",
    "shade",
    "light",
    "ambient",
    "occlusion",
    "shadows",
    "slice",
];
/// Options of random iteration.
const DENSITY: [&str; 6] = ["method", "points", "tone", "gamma", "oversample", "kernel"];

impl Look {
    /// Returns the arguments of everything but rule, size and view, for a set of the plane or of space.
    pub(super) fn arguments(&self, is_in_space: bool) -> Vec<String> {
        let is_chaos = self.is_density();
        let mut all: Vec<String> = { self.set.iter() }
            .map(|(name, value)| format!("--set={name}={value}"))
            .collect();
        let mut add = |name: &str, value: &dyn std::fmt::Display| {
            all.push(format!("--{name}={value}"));
        };
        if !is_chaos {
            self.steps.iter().for_each(|steps| add("steps", steps));
            self.detail.iter().for_each(|detail| add("detail", detail));
        }
        if self.seed != 0 {
            add("seed", &self.seed);
        }
        for (name, value) in &self.options {
            let name = name.as_str();
            let applies = BOTH.contains(&name)
                || PLANE.contains(&name) && !is_in_space && !(is_chaos && name != "margin")
                || SPACE.contains(&name) && is_in_space
                || DENSITY.contains(&name) && (is_chaos || name == "method");
            if applies {
                add(name, value);
            }
        }
        all
    }

    /// Returns the angle by which a set of the plane is turned, in degrees.
    pub(super) fn turn(&self) -> f64 {
        let given = self.options.get("turn").and_then(|it| it.parse().ok());
        given
            .filter(|turn: &f64| turn.is_finite() && !self.is_density())
            .unwrap_or(0.0)
    }

    /// Returns whether points of random iteration are drawn.
    pub(super) fn is_density(&self) -> bool {
        self.options
            .get("method")
            .is_some_and(|method| method == "chaos")
    }

    /// Refuses options that the studio does not have, and texts without bounds.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        const LONG: usize = 500;
        let known = |name: &String| {
            let name = name.as_str();
            BOTH.contains(&name)
                || PLANE.contains(&name)
                || SPACE.contains(&name)
                || DENSITY.contains(&name)
        };
        if let Some(other) = self.options.keys().find(|name| !known(name)) {
            return Err(Refusal::wrong(format!(
                "the studio has no option '{other}'"
            )));
        }
        let all = self.set.iter().chain(&self.options);
        let is_long = |(name, value): (&String, &String)| name.len() + value.len() > LONG;
        if self.set.len() > LONG || all.clone().any(is_long) {
            return Err(Refusal::wrong("a value is too long"));
        }
        self.film.check()?;
        match &self.view {
            Some(view) => view.check(),
            None => Ok(()),
        }
    }
}
