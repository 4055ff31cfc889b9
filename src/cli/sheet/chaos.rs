//! Sheets of random iteration.

use std::time::Instant;

use crate::figure::sheet::{CellView, write_pixels};
use crate::geometry::Bounds;
use crate::render::{self, Format};
use crate::style::View;

use super::super::chaos::{GameArguments, PlaneGame};
use super::super::labels::labels_of_rules;
use super::super::steps::Several;
use super::super::{Failure, output, readable};
use super::Arguments;
use super::contents::Contents;

impl Arguments {
    /// Draws every individual by random iteration.
    pub(super) fn draw_points(&self, contents: &Contents, start: Instant) -> Result<(), Failure> {
        self.refuse_of_elements()?;
        self.space.refuse_in_plane(contents.first())?;
        let path = self.path("png");
        let chaos: Vec<_> = { contents.individuals.iter() }
            .map(|individual| self.chaos.or(individual.loaded.model.metadata().density))
            .collect();
        let games = contents
            .individuals
            .iter()
            .zip(&chaos)
            .map(|(individual, chaos)| {
                let arguments = GameArguments {
                    chaos,
                    growth: &self.growth,
                    picture: &self.picture,
                    steps: self.steps.as_ref().map(Several::largest),
                    seed: individual.seed,
                };
                let view = self.view(&individual.loaded);
                PlaneGame::new(arguments, &individual.loaded, view, None)
            });
        let mut games = games.collect::<Result<Vec<_>, Failure>>()?;
        if contents.fit == CellView::All {
            let mut all = Bounds::EMPTY;
            for game in &games {
                all.add_all(&game.window(self.size, &path)?);
            }
            let (low, size) = (all.min(), all.size());
            let view = View {
                window: Some([low.x, low.y, size.x, size.y]),
                margin: Some(0.0),
            };
            games = games.into_iter().map(|game| game.in_view(view)).collect();
        }
        let mut options = contents.options(None);
        options.extend(games.iter().take(1).flat_map(PlaneGame::options));
        options.extend(self.options_of_sheet());
        let options = render::Options {
            format: Format::Png,
            style: self.style(contents.first()),
            size: self.size,
            threads: self.growth.threads(),
            labels: labels_of_rules(&contents.rules(), "Random iteration", "sheet", options),
            ..render::Options::default()
        }
        .on_paper();
        let columns = self.columns.or(contents.columns(1));
        let (size, bytes) = output::write(&path, self.growth.quiet, |mut out, progress| {
            let mut pictures = Vec::new();
            for (individual, game) in contents.individuals.iter().zip(&games) {
                let names = match &individual.names[..] {
                    [] => individual.loaded.name.clone(),
                    names => names.join(", "),
                };
                let caption = format!("{names}: {}", game.described());
                pictures.push((caption, game.pixels(self.size, progress, &path)?));
            }
            write_pixels(&pictures, columns, &options, &mut out)
                .map_err(|error| output::explain(error, &path))
        })?;
        let names: Vec<_> = contents.rules().iter().map(|it| it.name.clone()).collect();
        let count = readable::counted(&games.len().into(), "picture");
        let content = format!("{count} of {}", names.join(", "));
        self.report(&path, &content, size, bytes, start);
        Ok(())
    }

    /// Refuses formats and options that points do not have.
    fn refuse_of_elements(&self) -> Result<(), Failure> {
        if self.format_of_pixels()? != Format::Png {
            let message = "--method chaos draws points: write a .png";
            return Err(Failure::Usage(message.into()));
        }
        let of_elements = [("--detail", self.detail.is_some())];
        for (option, is_asked) in self.picture.of_lines().into_iter().chain(of_elements) {
            if is_asked {
                let message =
                    format!("{option} applies to elements, and --method chaos draws points");
                return Err(Failure::Usage(message));
            }
        }
        Ok(())
    }
}
