//! Values of parameters on the command line: one, or several that form a family.

mod written;

use crate::document::Setting;
use crate::expression::{Expression, PARTS};
use crate::family::ParameterRange;

#[cfg(feature = "studio")]
pub(crate) use written::value;
pub(super) use written::{assignment, ranges};

use super::Failure;
use super::animate::Moment;

/// Parameter with its values. A complex parameter has one part each for the real and the imaginary values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Assignment {
    /// Name of the parameter.
    name: String,
    parts: Vec<ParameterPart>,
}

/// Real parameter, or one of the two parts of a complex one, with its values.
#[derive(Clone, Debug, PartialEq)]
struct ParameterPart {
    name: String,
    values: Values,
    /// Source expression, if there is a single value.
    written: Option<Expression>,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    One(f64),
    Several(Vec<f64>),
    /// First and last value of a range.
    Range([f64; 2]),
    /// Coordinate of a point that moves once around a circle, counter-clockwise from the right: centre, radius, and whether
    /// it is the imaginary one.
    Circle(f64, f64, bool),
}

/// Returns a coordinate of a point on a circle after a share of the way around it.
fn on_circle(centre: f64, radius: f64, is_imaginary: bool, share: f64) -> f64 {
    let angle = std::f64::consts::TAU * share;
    let unit = match is_imaginary {
        false => libm::cos(angle),
        true => libm::sin(angle),
    };
    centre + radius * unit
}

impl From<Setting> for Assignment {
    fn from(setting: Setting) -> Self {
        let part = ParameterPart {
            name: setting.name.clone(),
            values: Values::One(setting.value),
            written: setting.written,
        };
        Self {
            name: setting.name,
            parts: vec![part],
        }
    }
}

impl Assignment {
    /// Returns the name of the parameter.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Returns the settings of a parameter that has a single value.
    pub(super) fn settings(&self) -> Result<Vec<Setting>, Failure> {
        let settings: Option<Vec<_>> = self.parts.iter().map(ParameterPart::setting).collect();
        settings.ok_or_else(|| {
            let message = format!(
                "--set {}: several values are for `kfrac sheet`, which draws them side by side, and for `kfrac grow`, which draws a file \
                 for each",
                self.name
            );
            Failure::Usage(message)
        })
    }
}

/// Ranges of a real parameter, or of both parts of a complex one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ranges {
    /// The ranges as written.
    pub(super) written: String,
    /// Name of the parameter.
    pub(super) name: String,
    pub(super) axes: Vec<ParameterRange>,
}

/// Parameter that changes in the course of a film, or one that does not.
pub(super) struct Track<'a>(&'a ParameterPart);

impl Assignment {
    /// Iterates over the parameters.
    pub(super) fn tracks(&self) -> impl Iterator<Item = Track<'_>> {
        self.parts.iter().map(Track)
    }
}

impl Track<'_> {
    /// Returns whether the value changes.
    pub(super) fn changes(&self) -> bool {
        !matches!(self.0.values, Values::One(_))
    }

    /// Returns the setting at a moment, as on the command line.
    pub(super) fn at(&self, moment: &Moment) -> String {
        let value = match &self.0.values {
            Values::One(value) => return format!("{}={value}", self.0.name),
            Values::Several(values) => moment.between(values, true),
            Values::Range(ends) => moment.between(ends, false),
            Values::Circle(centre, radius, is_imaginary) => {
                on_circle(*centre, *radius, *is_imaginary, moment.share())
            }
        };
        format!("{}={}", self.0.name, plain(value))
    }
}

impl ParameterPart {
    fn setting(&self) -> Option<Setting> {
        match self.values {
            Values::One(value) => Some(Setting {
                written: self.written.clone(),
                ..self.with(value)
            }),
            Values::Several(_) | Values::Range(_) | Values::Circle(..) => None,
        }
    }

    fn with(&self, value: f64) -> Setting {
        Setting {
            name: self.name.clone(),
            value,
            written: None,
            place: None,
        }
    }

    /// Returns one setting for each value of a family, `samples` for a range, and `None` for a single value.
    fn several(&self, samples: u32) -> Option<Vec<Setting>> {
        let values = match &self.values {
            Values::One(_) => return None,
            Values::Several(values) => values.clone(),
            Values::Range([first, last]) => {
                let most = samples.max(2) - 1;
                let value = |sample: u32| match sample {
                    0 => *first,
                    _ if sample == most => *last,
                    _ => plain(first + (last - first) * f64::from(sample) / f64::from(most)),
                };
                (0..=most).map(value).collect()
            }
            // The first value is not repeated at the end.
            Values::Circle(centre, radius, is_imaginary) => (0..samples)
                .map(|sample| f64::from(sample) / f64::from(samples))
                .map(|share| plain(on_circle(*centre, *radius, *is_imaginary, share)))
                .collect(),
        };
        Some(values.into_iter().map(|value| self.with(value)).collect())
    }
}

/// Rounds away the last digits, which are rounding errors: 0.56, not 0.5599999999999999.
pub(super) fn plain(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// Settings of the members of a family.
#[derive(Clone, Debug)]
pub(super) struct Family {
    /// Settings that all members share.
    fixed: Vec<Setting>,
    /// Independent choices: the settings of each alternative.
    choices: Vec<Vec<Vec<Setting>>>,
}

impl Family {
    /// Returns the family of assignments, with `samples` values for a range. Parameters with several values vary
    /// together, and must have the same number of them; in a grid, every assignment varies on its own.
    pub(super) fn of(
        assignments: &[Assignment],
        samples: u32,
        is_grid: bool,
    ) -> Result<Self, Failure> {
        let mut fixed = Vec::new();
        let mut choices: Vec<Vec<Vec<Setting>>> = Vec::new();
        for assignment in assignments {
            let mut is_new = is_grid;
            for part in &assignment.parts {
                let Some(several) = part.several(samples) else {
                    fixed.extend(part.setting());
                    continue;
                };
                let mut swept = choices.iter().flat_map(|choice| &choice[0]);
                if swept.any(|it| it.name == part.name) {
                    let message = format!("--set {0}: {0} is swept already", part.name);
                    return Err(Failure::Usage(message));
                }
                if is_new || choices.is_empty() {
                    choices.push(vec![Vec::new(); several.len()]);
                    is_new = false;
                }
                let Some(choice) = choices.last_mut() else {
                    continue;
                };
                if choice.len() != several.len() {
                    let message = format!(
                        "--set {}: {} values do not match the {} of {}, with which they vary together; in a grid of \
                         `kfrac sheet --grid`, parameters vary independently",
                        part.name,
                        several.len(),
                        choice.len(),
                        choice[0][0].name
                    );
                    return Err(Failure::Usage(message));
                }
                for (alternative, setting) in choice.iter_mut().zip(several) {
                    alternative.push(setting);
                }
            }
        }
        Ok(Self { fixed, choices })
    }

    /// Returns whether there is a single member, because no parameter has several values.
    pub(super) fn is_single(&self) -> bool {
        self.choices.is_empty()
    }

    /// Returns the settings that all members share.
    pub(super) fn fixed(&self) -> &[Setting] {
        &self.fixed
    }

    /// Returns the number of alternatives of each independent choice.
    pub(super) fn counts(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.choices.iter().map(Vec::len)
    }

    /// Returns the settings of each member that vary. The first choice changes from one member to the next.
    pub(super) fn members(&self) -> Vec<Vec<Setting>> {
        let first = vec![Vec::new()];
        self.choices.iter().rev().fold(first, |members, choice| {
            let all = { members.iter() }
                .flat_map(|own| choice.iter().map(|more| [more.as_slice(), own].concat()));
            all.collect()
        })
    }

    /// Returns the names of the parameters that vary.
    pub(super) fn names(&self) -> Vec<&str> {
        let settings = self.choices.iter().flat_map(|choice| &choice[0]);
        settings.map(|setting| setting.name.as_str()).collect()
    }

    /// Returns the assignments of the parameters that vary, as on the command line.
    pub(super) fn written(&self) -> Vec<String> {
        let list = |choice: &[Vec<Setting>], number: usize| {
            let values = choice
                .iter()
                .map(|settings| settings[number].value.to_string());
            values.collect::<Vec<_>>().join(",")
        };
        let is_grid = self.choices.len() > 1;
        let all = self.choices.iter().flat_map(|choice| {
            let names = choice[0].iter().map(|setting| &setting.name).enumerate();
            let each = names.map(|(number, name)| format!("{name}={}", list(choice, number)));
            // Both parts of a complex parameter are one choice.
            let whole = choice[0][0].name.strip_suffix(PARTS[0]);
            match whole.filter(|_| is_grid && choice[0].len() == 2) {
                Some(name) => {
                    let value = |it: &Vec<Setting>| format!("[{},{}]", it[0].value, it[1].value);
                    let values: Vec<_> = choice.iter().map(value).collect();
                    vec![format!("{name}={}", values.join(","))]
                }
                None => each.collect(),
            }
        });
        all.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Family, assignment};

    #[test]
    fn values_are_one_or_several() {
        let values = |text: &str| {
            let family = Family::of(&[assignment(text).unwrap()], 3, false).unwrap();
            let all = [family.fixed(), &family.members().concat()].concat();
            all.iter().map(|it| it.value).collect::<Vec<_>>()
        };
        assert_eq!(values("a=180/4"), [45.0]);
        assert_eq!(values("a=max(1, 2)"), [2.0]);
        assert_eq!(values("a=10,20,30"), [10.0, 20.0, 30.0]);
        assert_eq!(values("a=0..90"), [0.0, 45.0, 90.0]);
        for wrong in ["a", "a=", "a=1,", "a=1..", "a=1/0", "a=x,2"] {
            assert!(assignment(wrong).is_err(), "{wrong}");
        }
        let varied = |texts: &[&str], is_grid: bool| {
            let all: Vec<_> = texts.iter().map(|text| assignment(text).unwrap()).collect();
            let family = Family::of(&all, 3, is_grid).ok()?;
            let members = family.members().into_iter();
            let values = members.map(|own| own.iter().map(|it| it.value).collect());
            Some((
                values.collect::<Vec<Vec<f64>>>(),
                family.written().join(" "),
            ))
        };
        let together = |texts: &[&str]| Some(varied(texts, false)?.0);
        let path = together(&["re=0..1", "c=7", "im=5,6,8"]).unwrap();
        assert_eq!(path, [[0.0, 5.0], [0.5, 6.0], [1.0, 8.0]]);
        assert_eq!(together(&["re=1,2", "im=1,2,3"]), None);
        assert_eq!(together(&["re=1,2", "re=1,2"]), None);
        let path = [[0.0, 5.0], [0.5, 6.0], [1.0, 7.0]];
        assert_eq!(together(&["s=[0, 5]..[1, 7]"]).unwrap(), path);
        assert_eq!(together(&["s=[0,5],[1/2,max(6,1)], [1,7]"]).unwrap(), path);
        assert_eq!(together(&["s=[0,5],[1/2,6],[1,7]", "s.re=0..1"]), None);
        assert_eq!(values("s=[max(1, 2), 3]"), [2.0, 3.0]);
        assert_eq!(values("s=1/(1 - i)"), [0.5, 0.5]);
        assert_eq!(together(&["s=5*i..1 + 7*i"]).unwrap(), path);
        assert_eq!(together(&["s=5*i,1/2 + 6*i,1 + 7*i"]).unwrap(), path);
        let (grid, written) = varied(&["a=1,2", "c=7", "s=[0,5]..[1,7]"], true).unwrap();
        assert_eq!(written, "a=1,2 s=[0,5],[0.5,6],[1,7]");
        let all = [
            [1.0, 0.0, 5.0],
            [2.0, 0.0, 5.0],
            [1.0, 0.5, 6.0],
            [2.0, 0.5, 6.0],
            [1.0, 1.0, 7.0],
            [2.0, 1.0, 7.0],
        ];
        assert_eq!(grid, all);
        assert_eq!(varied(&["a=1,2", "a=1,2,3"], true), None);
        for wrong in [
            "s=[1]",
            "s=[1,2",
            "s=[1,2,3]",
            "s=[1,2]..3",
            "s=[1,2]..[3,4]..[5,6]",
            "s=[1,2],",
            "s=i/0",
            "s=x + i",
            "s=sqrt(i)",
        ] {
            assert!(assignment(wrong).is_err(), "{wrong}");
        }
    }
}
