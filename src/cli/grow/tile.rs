//! `kfrac grow --tile`: wallpapers and friezes of a picture.

use crate::fractal::{Copies, Goal, Repetition};
use crate::style::Named;
use crate::symmetry::TilingGroup;

use super::super::rule::Loaded;
use super::super::{Failure, number, picture};
use super::Arguments;

/// Options of tilings.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Tiling")]
pub(super) struct TileArguments {
    /// Wallpaper or frieze group under which the picture is repeated without end
    ///
    /// The set keeps its size, and its box is inscribed in a fundamental domain of the group: boxes of copies touch and do
    /// not overlap. Without --size and --view, the picture is one period of about 1024 pixels, whose opposite edges
    /// continue each other.
    #[arg(long, value_name = "GROUP", value_parser = picture::named::<TilingGroup>())]
    tile: Option<TilingGroup>,
    /// With --tile: factor of the distance of copies; below 1 they may overlap [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = factor, requires = "tile")]
    cell: Option<f64>,
    /// With --tile: number of periods that the picture shows along both axes [default: 1]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of periods", 1..=100_u32), requires = "tile")]
    repeat: Option<u32>,
}

/// Parses the factor of a cell.
fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok();
    let factor = factor.filter(|factor| Repetition::CELLS.contains(factor));
    let (least, most) = Repetition::CELLS.into_inner();
    factor.ok_or_else(|| format!("expected a factor from {least} to {most}"))
}

impl TileArguments {
    /// Returns whether a tiling is requested.
    pub(super) fn is_asked(&self) -> bool {
        self.tile.is_some()
    }

    /// Returns whether the number of periods is given.
    pub(super) fn has_periods(&self) -> bool {
        self.repeat.is_some()
    }

    /// Refuses a tiling of a set in space.
    pub(super) fn refuse_in_space(&self, loaded: &Loaded) -> Result<(), Failure> {
        match self.tile {
            Some(_) => Err(Failure::Usage(format!(
                "--tile repeats sets of the plane, and {} lies in space",
                loaded.name
            ))),
            None => Ok(()),
        }
    }

    /// Returns the options that are given, with their values.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let tile = self.tile.map(|group| ("tile", group.name().to_owned()));
        let cell = self.cell.map(|factor| ("cell", factor.to_string()));
        let repeat = self.repeat.map(|count| ("repeat", count.to_string()));
        tile.into_iter().chain(cell).chain(repeat).collect()
    }

    /// Returns the repetition that is requested.
    fn repetition(&self) -> Option<Repetition> {
        let group = Repetition::from(self.tile?);
        let spaced = group.cell(self.cell.unwrap_or(1.0));
        Some(spaced.periods(self.repeat.unwrap_or(1)))
    }
}

impl Arguments {
    /// Returns the copies of a set in the picture, if they are asked for.
    pub(super) fn copies(&self, loaded: &Loaded, goal: Goal) -> Result<Option<Copies>, Failure> {
        let Some(repetition) = self.tile.repetition() else {
            return Ok(None);
        };
        let steps = match goal {
            Goal::Steps(steps, _) => Some(steps),
            Goal::Detail(_) => None,
        };
        let graph = loaded.compile(goal.steps())?;
        let view = self.view(loaded.model.metadata());
        let growth = (steps, self.growth.seed.first());
        let copies = repetition.copies(&graph, growth, &view, self.size.size);
        Ok(Some(copies.map_err(anyhow::Error::new)?))
    }
}
