//! Contents of a sheet: the individuals that it shows, of one or several rules, values of parameters, and seeds.

use crate::catalogue::Catalogue;
use crate::document::Setting;
use crate::figure::sheet::CellView;
use crate::fractal::Goal;
use crate::model::Model;

use super::super::family::Family;
use super::super::growth::Seeds;
use super::super::rule::Loaded;
use super::super::steps::{self, Several};
use super::super::{Failure, light, readable};
use super::{Arguments, DrawnSheet};

/// Largest number of pictures of a sheet.
const MAX_PICTURES: usize = 10_000;

/// Rule with the values of its parameters and a seed, which has one or several pictures.
pub(super) struct Individual {
    /// Number of the rule.
    pub(super) rule: usize,
    /// Parts of its caption.
    pub(super) names: Vec<String>,
    pub(super) loaded: Loaded,
    pub(super) seed: u64,
    /// Steps of its pictures; `None` if a detail decides them, and in space for those of the rule.
    pub(super) steps: Option<Several>,
}

/// Individuals of a sheet, at least one.
pub(super) struct Contents {
    pub(super) individuals: Vec<Individual>,
    family: Family,
    seeds: Seeds,
    /// Number of rules.
    rules: usize,
    /// Steps that are given.
    steps: Option<Several>,
    /// Numbers of rules, of values of each parameter that varies, of seeds and of steps that are given.
    counts: Vec<usize>,
    pub(super) fit: CellView,
}

impl Contents {
    /// Loads all individuals. The pictures are in the order of rules, values, seeds and steps, of which the last ones change
    /// first.
    pub(super) fn load(arguments: &Arguments, catalogue: &Catalogue) -> Result<Self, Failure> {
        let (rules, growth) = (arguments.rules(), &arguments.growth);
        let family = Family::of(&arguments.rule.set, arguments.samples, arguments.grid)?;
        if arguments.grid && family.counts().count() < 2 {
            let message = "--grid has columns and rows for two parameters with several values: --set A=0..1 --set B=0..1";
            return Err(Failure::Usage(message.into()));
        }
        let (seeds, steps) = (growth.seed.clone(), arguments.steps.clone());
        let step_count = steps.as_ref().map_or(1, |steps| steps.as_slice().len());
        let mut counts = vec![rules.len()];
        counts.extend(family.counts().rev());
        counts.extend([seeds.as_slice().len(), step_count]);
        let all = counts
            .iter()
            .fold(1, |all: usize, &more| all.saturating_mul(more));
        if all > MAX_PICTURES {
            let message = format!("a sheet has no more than {MAX_PICTURES} pictures");
            return Err(Failure::Usage(message));
        }
        let mut individuals = Vec::new();
        for (number, rule) in rules.iter().enumerate() {
            for (settings, loaded) in rule.load_family(&family, catalogue, growth.quiet)? {
                for &seed in seeds.as_slice() {
                    let mut names = Vec::new();
                    names.extend((rules.len() > 1).then(|| loaded.name.clone()));
                    names.extend(settings.iter().map(caption));
                    names.extend((seeds.as_slice().len() > 1).then(|| format!("seed {seed}")));
                    individuals.push(Individual {
                        rule: number,
                        names,
                        loaded: loaded.clone().grown(growth).seeded(seed),
                        seed,
                        steps: steps.clone(),
                    });
                }
            }
        }
        let in_space = |it: &&Individual| it.loaded.model.is_in_space();
        let solid = individuals.iter().find(in_space);
        let flat = individuals.iter().find(|it| !in_space(it));
        if let (Some(solid), Some(flat)) = (solid, flat) {
            return Err(Failure::Usage(format!(
                "{} lies in space and {} in the plane: a sheet shows sets of one of them",
                solid.loaded.name, flat.loaded.name
            )));
        }
        let fit = match rules.len() {
            1 => CellView::All,
            _ => CellView::Each,
        };
        Ok(Self {
            individuals,
            family,
            seeds,
            rules: rules.len(),
            steps,
            counts,
            fit: arguments.fit.unwrap_or(fit),
        })
    }

    /// Returns the contents of a sheet of the plane: with the steps of all pictures, and with common coordinates if all
    /// pictures have one scale.
    pub(super) fn in_plane(mut self, arguments: &Arguments) -> Result<Self, Failure> {
        let is_one = self.individuals.len() == 1;
        if self.fit == CellView::All && !is_one {
            let place = self.first().place()?;
            for individual in &mut self.individuals {
                individual.loaded = individual.loaded.clone().within(place);
            }
        }
        if let (None, Some(detail)) = (&arguments.steps, arguments.detail) {
            for individual in &mut self.individuals {
                individual.loaded = individual.loaded.clone().led(Model::of_detail);
                let goal = Goal::asked(None, Some(detail), &individual.loaded)?;
                individual.steps = match goal {
                    Goal::Detail(_) => None,
                    Goal::Steps(step, _) => Some(Several::range(step, step)),
                };
            }
        } else if arguments.steps.is_none() {
            // All individuals of a rule have one step.
            let mut chosen: Option<(usize, Several)> = None;
            for individual in &mut self.individuals {
                let steps = match chosen.take() {
                    Some((rule, steps)) if rule == individual.rule => steps,
                    _ => {
                        let step = steps::choose(None, &individual.loaded)?;
                        match is_one {
                            true => Several::range(0, step.min(steps::MAX_CELLS - 1)),
                            false => Several::range(step, step),
                        }
                    }
                };
                individual.steps = Some(steps.clone());
                chosen = Some((individual.rule, steps));
            }
        }
        Ok(self)
    }

    /// Returns the first individual.
    pub(super) fn first(&self) -> &Loaded {
        &self.individuals[0].loaded
    }

    /// Returns one individual of each rule.
    pub(super) fn rules(&self) -> Vec<&Loaded> {
        let of_rule = self.individuals.len() / self.rules;
        let firsts = self.individuals.iter().step_by(of_rule);
        firsts.map(|individual| &individual.loaded).collect()
    }

    /// Returns the largest step of a picture.
    pub(super) fn last_step(&self) -> u32 {
        let steps = self.individuals.iter().filter_map(|it| it.steps.as_ref());
        steps.map(Several::largest).max().unwrap_or_default()
    }

    /// Returns the steps that all individuals have, none of which is above `last`; `None` if rules have different ones.
    pub(super) fn steps_up_to(&self, last: u32) -> Option<Several> {
        let is_common = self.rules == 1 || self.steps.is_some();
        let first = self.individuals.first().filter(|_| is_common)?;
        first.steps_up_to(last)
    }

    /// Returns the caption of a picture, without its number of elements.
    pub(super) fn caption(&self, individual: &Individual, goal: Goal) -> String {
        let steps = individual.steps.as_ref();
        let is_one = steps.is_none_or(|steps| steps.as_slice().len() == 1);
        let has_step = self.rules > 1 || !is_one || individual.names.is_empty();
        let step = match goal {
            Goal::Steps(step, _) => has_step.then(|| format!("step {step}")),
            Goal::Detail(_) => individual.names.is_empty().then(|| goal.described()),
        };
        let names: Vec<_> = individual.names.iter().cloned().chain(step).collect();
        names.join(", ")
    }

    /// Describes the pictures in the labels of a sheet up to a step.
    pub(super) fn shown(&self, last: u32) -> String {
        let mut shown = match self.steps_up_to(last) {
            Some(steps) if steps.as_slice().len() > 1 => format!("Steps {steps}"),
            Some(steps) => format!("Step {steps}"),
            None => "Pictures".into(),
        };
        let mut each = Vec::new();
        if !self.family.is_single() {
            each.push(format!("values of {}", self.family.names().join(" and ")));
        }
        if self.seeds.as_slice().len() > 1 {
            each.push(format!("the seeds {}", self.seeds));
        }
        if !each.is_empty() {
            shown += &format!(" for {}", each.join(" and "));
        }
        shown
    }

    /// Returns the number of pictures in a row of a grid: the last of several numbers above 1 of rules, values, seeds,
    /// steps and directions of view. The result is `None` if no more than one of them is above 1.
    pub(super) fn columns(&self, views: usize) -> Option<u32> {
        let counts = self.counts.iter().copied().chain([views]);
        let several: Vec<_> = counts.filter(|&count| count > 1).collect();
        match several[..] {
            [_, .., columns] => u32::try_from(columns).ok(),
            _ => None,
        }
    }

    /// Returns the options that determine the pictures, with their values; `steps` are those of all individuals.
    pub(super) fn options(&self, steps: Option<&Several>) -> Vec<(&'static str, String)> {
        let sets = self.family.written().into_iter().map(|set| ("set", set));
        let steps = steps.map(|steps| ("steps", steps.to_string()));
        sets.chain(steps).collect()
    }

    /// Returns a note if the pictures are drawn up to a smaller step than asked for, so that they are light.
    pub(super) fn note_of_lighter(&self, drawn: u32) -> Option<String> {
        if drawn == self.last_step() {
            return None;
        }
        let (all, fewer) = (self.steps_up_to(self.last_step()), self.steps_up_to(drawn));
        let (drawn, more) = match all.zip(fewer) {
            Some((all, fewer)) if all.as_slice().len() == 1 => (
                format!("step {fewer} is drawn instead of {all}"),
                format!("--steps {all} draws it"),
            ),
            Some((all, fewer)) => (
                format!("steps {fewer} are drawn instead of {all}"),
                format!("--steps {all} draws them"),
            ),
            None => (
                format!("steps above {drawn} are not drawn"),
                "a .png shows them".into(),
            ),
        };
        Some(light::note(&drawn, &more))
    }

    /// Describes the pictures of a sheet that has been drawn.
    pub(super) fn counted(&self, drawn: &DrawnSheet) -> String {
        let count = |what: &str| readable::counted(&drawn.cells.into(), what);
        let names: Vec<_> = self.rules().iter().map(|it| it.name.clone()).collect();
        let is_one_step = self
            .steps_up_to(drawn.step)
            .is_some_and(|it| it.as_slice().len() == 1);
        match self.seeds.as_slice() {
            [_] if self.individuals.len() == 1 => {
                format!("{} of {}", count("approximant"), names[0])
            }
            [_] if self.rules == 1 && is_one_step => {
                let parameters = self.family.names().join(" and ");
                format!("{} of {parameters} at step {}", count("value"), drawn.step)
            }
            _ => format!("{} of {}", count("picture"), names.join(", ")),
        }
    }
}

impl Individual {
    /// Returns the steps of the pictures, none of which is above `last`; `None` if a detail decides them.
    fn steps_up_to(&self, last: u32) -> Option<Several> {
        let steps = self.steps.as_ref()?;
        Some(match steps.as_slice() {
            _ if steps.largest() <= last => steps.clone(),
            [_] => Several::range(last, last),
            _ => Several::range(0, last),
        })
    }

    /// Returns the goals of the pictures, with no step above `last`, for a detail in pixels.
    pub(super) fn goals_up_to(&self, last: u32, detail: Option<f64>) -> Vec<Goal> {
        match (self.steps_up_to(last), detail) {
            (None, Some(pixels)) => vec![Goal::Detail(pixels)],
            (None, None) => vec![Goal::Steps(last, None)],
            (Some(steps), _) => {
                let steps = steps.as_slice().iter();
                steps.map(|&step| Goal::Steps(step, detail)).collect()
            }
        }
    }
}

/// Returns the caption of a setting, with a value of six digits.
fn caption(setting: &Setting) -> String {
    let value = format!("{:.6}", setting.value);
    let value = value.trim_end_matches('0').trim_end_matches('.');
    format!("{} = {value}", setting.name)
}
