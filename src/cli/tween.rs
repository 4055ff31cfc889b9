//! `--to`: fractals between two.

use std::path::{Path, PathBuf};

use crate::catalogue::Catalogue;
use crate::model::Model;
use crate::style::Named;
use crate::tween::TweenBy;

use super::Failure;
use super::exchanged::ExchangedComponents;
use super::rule::{Loaded, RuleArguments};
use super::{number, picture};

/// Options of the fractal between two.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Tween")]
pub(super) struct TweenArguments {
    /// Draws a fractal between the rule and another one of its kind
    ///
    /// Generators, elements, maps, objects and instances correspond to each other by their order; one that has no counterpart
    /// grows out of a point. Directions, and whether elements are fertile and visible, change half-way.
    #[arg(long, value_name = "RULE2")]
    to: Option<PathBuf>,
    /// Share of the way to the other rule, from 0 to 1
    #[arg(long, value_name = "SHARE", requires = "to", default_value = "0.5", value_parser = number::share, allow_negative_numbers = true)]
    share: f64,
    /// Course of the way: lengths and angles change evenly, or entries of matrices and coordinates
    #[arg(long, value_name = "COURSE", requires = "to", default_value = "polar", value_parser = picture::named::<TweenBy>())]
    by: TweenBy,
}

impl TweenArguments {
    /// Returns the rule between the one that is loaded and the other one, which is loaded too.
    pub(super) fn apply(
        &self,
        mut loaded: Loaded,
        catalogue: &Catalogue,
        quiet: bool,
    ) -> Result<Loaded, Failure> {
        let Some(to) = &self.to else {
            return Ok(loaded);
        };
        let other = load(to, catalogue, quiet)?;
        loaded.model = between(&loaded, &other, self.share, self.by)?;
        loaded.beside.push((other.name, other.document));
        let by = (self.by != TweenBy::default()).then(|| ("by", self.by.name().to_owned()));
        let own = [
            ("to", to.display().to_string()),
            ("share", self.share.to_string()),
        ];
        loaded.made_by = own.into_iter().chain(by).collect();
        Ok(loaded)
    }
}

/// Returns the model at a share of the way between two rules.
pub(super) fn between(
    loaded: &Loaded,
    other: &Loaded,
    share: f64,
    by: TweenBy,
) -> Result<Model, Failure> {
    let model = loaded.model.toward(&other.model, share, by);
    model.map_err(|error| {
        let message = format!("--to leads from {} to {}: {error}", loaded.name, other.name);
        Failure::Usage(message)
    })
}

/// Loads the other rule of a tween.
pub(super) fn load(to: &Path, catalogue: &Catalogue, quiet: bool) -> Result<Loaded, Failure> {
    let named = RuleArguments {
        rule: to.to_owned(),
        set: Vec::new(),
        omit: Vec::new(),
        components: ExchangedComponents::default(),
    };
    named.load(catalogue, quiet)
}
