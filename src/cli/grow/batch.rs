//! A picture for each of several seeds, numbers of steps or values of parameters, in files named by a template.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::catalogue::Catalogue;
use crate::document::Setting;

use super::super::Failure;
use super::super::family::Family;
use super::super::number::Several;
use super::super::rule::name_of;
use super::super::template::{Placeholder, Template};
use super::Arguments;
use super::plan::Plan;

/// Largest number of pictures.
const MOST: usize = 10_000;

/// Returns the arguments of each picture that is asked for: one for all combinations of values, numbers of steps and
/// seeds. Parameters with several values are varied together.
pub(super) fn pictures(all: &Arguments) -> Result<Vec<Arguments>, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let family = Family::of(&all.rule.set, all.samples, false)?;
    let varied: Vec<_> = { family.names().into_iter() }
        .map(|name| Placeholder::Value(name.to_owned()))
        .collect();
    let members = family.members();
    let steps: Vec<_> = match &all.steps {
        Some(steps) => steps.as_slice().iter().copied().map(Some).collect(),
        None => vec![None],
    };
    let seeds = all.growth.seed.as_slice();
    let count = members
        .len()
        .saturating_mul(steps.len())
        .saturating_mul(seeds.len());
    if count > MOST {
        return usage(format!(
            "no more than {MOST} pictures are drawn at once, and {count} are asked for"
        ));
    }
    let mut axes: Vec<&[Placeholder]> = vec![&varied];
    axes.extend((steps.len() > 1).then_some(&[STEPS][..]));
    axes.extend((seeds.len() > 1).then_some(&[SEED][..]));
    let output = template("--output", all.output.as_deref())?;
    let depth = template("--depth", all.depth.as_deref())?;
    if count > 1 {
        if all.watch || all.open {
            return usage("--watch and --open are for a single picture".into());
        }
        let named = [("--output", &output), ("--depth", &depth)];
        for (option, template) in named {
            let is_needed = option == "--output" || all.depth.is_some();
            let places: Vec<_> = { template.iter() }
                .flat_map(Template::placeholders)
                .collect();
            let lacks = |axis: &&&[Placeholder]| {
                !axis.is_empty() && !axis.iter().any(|place| places.contains(&place))
            };
            if is_needed && axes.iter().any(|axis| lacks(&axis)) {
                return usage(format!(
                    "{count} pictures need names that differ: write {option} '{}'",
                    proposed(all, option, &axes)
                ));
            }
        }
    }
    let mut pictures = Vec::with_capacity(count);
    for own in &members {
        let settings: Vec<_> = family.fixed().iter().chain(own).cloned().collect();
        for &steps in &steps {
            for &seed in seeds {
                let path = |template: &Option<Template>, given: &Option<PathBuf>| match template {
                    Some(template) => named(template, &settings, steps, seed).map(Some),
                    None => Ok(given.clone()),
                };
                let mut picture = all.clone();
                picture.output = path(&output, &all.output)?;
                picture.depth = path(&depth, &all.depth)?;
                picture.growth.seed = Several::one(seed);
                picture.steps = steps.map(Several::one);
                if !own.is_empty() {
                    picture.rule.set = settings.iter().cloned().map(Into::into).collect();
                }
                pictures.push(picture);
            }
        }
    }
    let mut paths = HashSet::new();
    let all = pictures.iter().flat_map(|it| [&it.output, &it.depth]);
    if let Some(path) = all.flatten().find(|path| !paths.insert(*path)) {
        return usage(format!(
            "two files would have the name '{}'",
            path.display()
        ));
    }
    Ok(pictures)
}

const SEED: Placeholder = Placeholder::Number('s');
const STEPS: Placeholder = Placeholder::Number('n');

/// Returns the template of an option, unless its path is none.
fn template(option: &str, path: Option<&Path>) -> Result<Option<Template>, Failure> {
    let Some(name) = path.and_then(Path::to_str) else {
        return Ok(None);
    };
    let wrong = |message| {
        Failure::Usage(format!(
            "{option} {name}: {message}; write %s or %03s for the seed, %n for the number of steps, %{{angle}} for the value \
             of a parameter, and %% for a percent sign"
        ))
    };
    Template::parse(name, "sn").map(Some).map_err(wrong)
}

/// Returns a template for an option whose names differ in all that varies.
fn proposed(all: &Arguments, option: &str, axes: &[&[Placeholder]]) -> String {
    let rule = name_of(&all.rule.rule).to_string_lossy();
    let mut name = rule.replace('%', "%%");
    if option == "--depth" {
        name += "-depth";
    }
    for place in axes.iter().filter_map(|axis| axis.first()) {
        name += &match place {
            Placeholder::Number(letter) => format!("-%{letter}"),
            Placeholder::Value(name) => format!("-%{{{name}}}"),
        };
    }
    let extension = all.output.as_deref().and_then(Path::extension);
    let extension = extension.map_or("svg".into(), |it| it.to_string_lossy());
    format!("{name}.{extension}")
}

/// Returns the name of a picture.
fn named(
    template: &Template,
    settings: &[Setting],
    steps: Option<u32>,
    seed: u64,
) -> Result<PathBuf, Failure> {
    let filled = template.fill(|place| match place {
        Placeholder::Number('n') => {
            let missing = || "'%n' in a name needs --steps".to_owned();
            Ok(steps.ok_or_else(missing)?.to_string())
        }
        Placeholder::Number(_) => Ok(seed.to_string()),
        Placeholder::Value(name) => {
            // Later settings replace earlier ones.
            let setting = settings.iter().rev().find(|setting| setting.name == *name);
            let missing = || format!("'%{{{name}}}' in a name needs --set {name}=VALUE");
            Ok(setting.ok_or_else(missing)?.value.to_string())
        }
    });
    Ok(filled.map_err(Failure::Usage)?.into())
}

/// Draws several pictures of a rule, which is read once. Arguments that contradict each other or the rule are reported before
/// the first is drawn.
pub(super) fn run(pictures: &[Arguments], catalogue: &Catalogue) -> Result<(), Failure> {
    let Some(first) = pictures.first() else {
        return Ok(());
    };
    let plans: Vec<_> = pictures.iter().map(Plan::of).collect::<Result<_, _>>()?;
    let document = first.rule.document(catalogue)?;
    for picture in pictures {
        picture.resolve(document.clone(), catalogue, true)?;
    }
    for (number, (picture, plan)) in pictures.iter().zip(&plans).enumerate() {
        let start = Instant::now();
        let quiet = picture.growth.quiet || number > 0;
        let loaded = picture.resolve(document.clone(), catalogue, quiet)?;
        let (path, summary, bytes) = picture.grow(plan, loaded)?;
        picture.report(&path, &summary, bytes, start);
    }
    Ok(())
}
