//! Validation of the sources of categories.

use std::fs;
use std::path::{Path as FilePath, PathBuf};

use crate::catalogue::Shelf;
use crate::diagnostic::{Place, did_you_mean};
use crate::document::{Law, LawDocument, RandomDocument, SourceDocument, Written, WrittenNumber};
use crate::draws::{Distribution, Variable};
use crate::expression::Program;
use crate::fractal::{Error, Fractal};
use crate::kind::Kind;

use super::csv;
use super::spec::{Checker, MAX_COUNT, Origin};

impl Checker<'_> {
    /// Adds the origins of a source.
    pub(super) fn origins(&mut self, document: &SourceDocument, origins: &mut Vec<Origin>) {
        let count = document
            .count
            .as_ref()
            .map(|count| self.whole(Some(count), 1, 1..=MAX_COUNT, "a number of categories"));
        match document {
            SourceDocument {
                random: Some(random),
                rule: None,
                csv: None,
                library: None,
                ..
            } => {
                let maps = self.maps(random);
                let is_in_space = self.is_in_space(random, &document.place);
                if let Some(params) = document.params.as_ref().and_then(|it| it.first()) {
                    self.error(&params.name.place, "random systems have no parameters", "");
                }
                if let (Some(maps), Some(is_in_space), Some(count)) =
                    (maps, is_in_space, count.unwrap_or(Some(1)))
                {
                    origins.push(Origin::Random {
                        maps,
                        law: random.sigma,
                        is_in_space,
                        count,
                    });
                }
            }
            SourceDocument {
                random: None,
                rule: Some(rule),
                csv: None,
                library: None,
                ..
            } => {
                let family = self.family(rule, document.params.as_deref().unwrap_or_default());
                if let (Some((fractal, laws)), Some(count)) =
                    (family, count.map_or(Some(None), |it| it.map(Some)))
                {
                    let name = FilePath::new(&rule.value).file_stem();
                    let name =
                        name.map_or_else(String::new, |it| it.to_string_lossy().into_owned());
                    let fractal = Box::new(fractal);
                    origins.push(Origin::Family {
                        name,
                        fractal,
                        laws,
                        count,
                    });
                }
            }
            SourceDocument {
                random: None,
                rule: None,
                csv: Some(folder),
                library: None,
                ..
            } => {
                self.refuse_count(document);
                self.tables(folder, origins);
            }
            SourceDocument {
                random: None,
                rule: None,
                csv: None,
                library: Some(kinds),
                ..
            } => {
                self.refuse_count(document);
                for kind in kinds {
                    self.library(kind, origins);
                }
            }
            _ => {
                let message = "a source has one of `random`, `rule`, `csv` and `library`";
                self.error(
                    &document.place.first_line(),
                    message,
                    "{random: {maps: [2, 7]}, count: 1000}",
                );
            }
        }
    }

    /// Refuses a number of categories, and parameters, where files are the categories.
    fn refuse_count(&mut self, document: &SourceDocument) {
        if let Some(count) = &document.count {
            self.error(
                &count.place,
                "each file is a category: their number is given",
                "leave `count` out",
            );
        }
        if let Some(law) = document.params.as_ref().and_then(|it| it.first()) {
            self.error(
                &law.name.place,
                "parameters are those of a `rule`",
                "leave `params` out",
            );
        }
    }

    /// Returns whether random maps are those of space.
    fn is_in_space(&mut self, document: &RandomDocument, place: &Place) -> Option<bool> {
        let Some(number) = &document.space else {
            return Some(false);
        };
        let dimensions = self.whole(Some(number), 2, 2..=3, "a number of dimensions")?;
        if dimensions == 2 {
            return Some(false);
        }
        if document.sigma == Law::Anderson {
            let message = "the law `anderson` is one of maps of the plane";
            let hint = "random: {maps: [2, 7], space: 3, sigma: uniform}";
            self.error(&place.first_line(), message, hint);
            return None;
        }
        self.needs_views(&number.place)?;
        Some(true)
    }

    /// Reports a set in space without views.
    fn needs_views(&mut self, place: &Place) -> Option<()> {
        if !self.has_views {
            let hint = "instances: {count: 12, views: 12}, or views: random";
            self.error(place, "a set in space needs views", hint);
        }
        self.has_views.then_some(())
    }

    fn maps(&mut self, document: &RandomDocument) -> Option<[u32; 2]> {
        let Some(range) = &document.maps else {
            return Some([2, 7]);
        };
        let least = self.whole(Some(&range[0]), 2, 1..=32, "a number of maps");
        let most = self.whole(Some(&range[1]), 7, 1..=32, "a number of maps");
        let (least, most) = (least?, most?);
        if least > most {
            self.error(
                &range[0].place,
                "the least number of maps is above the largest",
                "maps: [2, 7]",
            );
            return None;
        }
        Some([least, most])
    }

    fn family(
        &mut self,
        rule: &Written<String>,
        params: &[LawDocument],
    ) -> Option<(Fractal, Vec<Variable>)> {
        let beside = self.beside(&rule.value);
        let source = match beside.is_file() {
            true => self.catalogue.rule(&beside),
            false => self.catalogue.rule(&rule.value),
        };
        let fractal = source
            .map_err(Error::from)
            .and_then(|source| Fractal::read(&source, self.catalogue));
        let fractal = self.usable(fractal, &rule.place)?;
        let mut laws = Vec::new();
        for LawDocument { name, value } in params {
            let known = fractal.model().metadata().parameters.iter();
            if !known.clone().any(|known| known.name == name.value) {
                let message = format!("{} has no parameter '{}'", rule.value, name.value);
                let hint = did_you_mean(&name.value, known.map(|it| it.name.as_str()));
                self.error(&name.place, message, &hint.unwrap_or_default());
            }
            laws.push(Variable::new(&name.value, self.law(value)?));
        }
        Some((fractal, laws))
    }

    /// Returns a fractal that can be drawn; a mistake in its file is reported at a place.
    fn usable(&mut self, fractal: Result<Fractal, Error>, place: &Place) -> Option<Fractal> {
        match fractal {
            Ok(fractal) => match fractal.model().is_in_space() {
                true => self.needs_views(place).map(|()| fractal),
                false => Some(fractal),
            },
            Err(Error::Invalid(mistakes)) if mistakes.iter().all(|it| it.place().is_none()) => {
                for mistake in mistakes.iter() {
                    self.found.push(mistake.clone().at(place));
                }
                None
            }
            Err(Error::Invalid(mistakes)) => {
                self.found.extend(mistakes);
                None
            }
            Err(error) => {
                self.error(place, error.to_string(), "");
                None
            }
        }
    }

    /// Returns the distribution of a parameter.
    fn law(&mut self, number: &WrittenNumber) -> Option<Distribution> {
        let Some((name, arguments)) = number.value.as_call() else {
            let value = self.constant(number)?;
            return Some(Distribution::Choice(vec![Program::constant(value)]));
        };
        let programs = arguments.iter().map(|it| self.program(number, it));
        let programs: Vec<Program> = programs.collect::<Option<_>>()?;
        match (name, programs.as_slice()) {
            ("uniform", [low, high]) => Some(Distribution::Uniform(low.clone(), high.clone())),
            ("normal", [mean, deviation]) => {
                Some(Distribution::Normal(mean.clone(), deviation.clone()))
            }
            ("choice", [_, ..]) => Some(Distribution::Choice(programs)),
            _ => {
                let hint = "uniform(a, b), normal(mean, deviation) or choice(a, b, ...)";
                self.error(
                    &number.place,
                    format!("'{name}' is no law of a parameter"),
                    hint,
                );
                None
            }
        }
    }

    /// Adds the systems of a folder of tables.
    fn tables(&mut self, folder: &Written<String>, origins: &mut Vec<Origin>) {
        let path = self.beside(&folder.value);
        let files = fs::read_dir(&path).map(|files| {
            let paths = files.flatten().map(|file| file.path());
            let mut paths: Vec<_> = paths
                .filter(|path| {
                    path.extension()
                        .is_some_and(|it| it.eq_ignore_ascii_case("csv"))
                })
                .collect();
            paths.sort();
            paths
        });
        let files = match files {
            Ok(files) if !files.is_empty() => files,
            Ok(_) => {
                let message = format!("there is no .csv file in '{}'", path.display());
                return self.error(&folder.place, message, "");
            }
            Err(error) => {
                let message = format!("'{}' cannot be read: {error}", path.display());
                return self.error(
                    &folder.place,
                    message,
                    "a folder, relative to that of this file",
                );
            }
        };
        for file in files {
            let text = fs::read_to_string(&file).map_err(|error| (1, error.to_string()));
            match text.and_then(|text| csv::read(&text)) {
                Ok(maps) => {
                    let name = file
                        .file_stem()
                        .unwrap_or_default()
                        .to_string_lossy()
                        .into_owned();
                    origins.push(Origin::Table { name, maps });
                }
                Err((line, message)) => {
                    let message = format!("{}:{line}: {message}", file.display());
                    self.error(&folder.place, message, "");
                }
            }
        }
    }

    /// Adds the fractals of a kind in the library.
    fn library(&mut self, kind: &Written<String>, origins: &mut Vec<Origin>) {
        let known = Kind::ALL.into_iter().find(|it| it.name() == kind.value);
        let Some(known) = known else {
            let names = Kind::ALL.map(Kind::name);
            let hint = did_you_mean(&kind.value, names);
            let hint = hint.unwrap_or_else(|| names.join(", "));
            return self.error(
                &kind.place,
                format!("there is no kind '{}'", kind.value),
                &hint,
            );
        };
        let entries = self.catalogue.entries();
        for entry in entries
            .iter()
            .filter(|it| it.shelf == Shelf::Fractals(known))
        {
            let source = self.catalogue.open(entry).map_err(Error::from);
            let fractal = source.and_then(|source| Fractal::read(&source, self.catalogue));
            // Sets in space are left out where there are no views.
            if !self.has_views && fractal.as_ref().is_ok_and(|it| it.model().is_in_space()) {
                continue;
            }
            if let Some(fractal) = self.usable(fractal, &kind.place) {
                origins.push(Origin::Family {
                    name: entry.name.clone(),
                    fractal: Box::new(fractal),
                    laws: Vec::new(),
                    count: None,
                });
            }
        }
    }

    /// Returns a path relative to the folder of the data set's file.
    fn beside(&self, name: &str) -> PathBuf {
        let folder = self.source.path().parent();
        folder.unwrap_or(FilePath::new("")).join(name)
    }
}
