//! Plan of a film: the arguments of `kfrac grow` for every frame.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;

use crate::catalogue::Catalogue;
use crate::fractal::Goal;
use crate::model::Model;
use crate::parallel::all_cores;
use crate::render::Spares;
use crate::style::{ColorBy, Named};
use crate::tween::TweenBy;
use crate::zoom::Factor;

use super::super::family::Assignment;
use super::super::rule::Loaded;
use super::super::{Failure, grow, tween};
use super::frames::Frames;
use super::timeline::{Ease, Keys, Moment, Timeline};
use super::{Arguments, Several, endless, fit};

/// Film whose frames are known.
pub(super) struct Film<'a> {
    pub(super) frames: Frames<'a>,
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
}

/// Magnifications of a film.
#[derive(Clone, Debug)]
pub(super) enum Zooms {
    One(Factor),
    Range([Factor; 2]),
    /// Period of the address.
    Loop,
}

impl Zooms {
    /// Parses a magnification, two of them, or `loop`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let factor = |text: &str| text.trim().parse::<Factor>().map_err(|it| it.to_string());
        match text.split_once("..") {
            _ if text == "loop" => Ok(Self::Loop),
            Some((first, last)) => Ok(Self::Range([factor(first)?, factor(last)?])),
            None => factor(text).map(Self::One),
        }
    }
}

/// Course of the magnification, and of the turn that belongs to it.
struct Course {
    /// Decimal logarithms at the start and at the end.
    digits: [f64; 2],
    /// Degrees at the start and at the end.
    turn: [f64; 2],
    /// Number of steps by which a zoom without end goes on.
    steps: Option<f64>,
}

impl Course {
    fn of(arguments: &Arguments, loaded: &Loaded) -> Result<Option<Self>, Failure> {
        let digits = |factor: &Factor| factor.log2() * std::f64::consts::LOG10_2;
        Ok(match &arguments.zoom {
            None => None,
            Some(Zooms::One(factor)) => Some(Self {
                digits: [digits(factor); 2],
                turn: [0.0; 2],
                steps: None,
            }),
            Some(Zooms::Range([first, last])) => Some(Self {
                digits: [digits(first), digits(last)],
                turn: [0.0; 2],
                steps: None,
            }),
            Some(Zooms::Loop) => {
                let period = endless::period(arguments, loaded)?;
                Some(Self {
                    digits: period.digits,
                    turn: [0.0, period.turn],
                    steps: Some(period.steps),
                })
            }
        })
    }

    /// Returns the factor at a share of the way, with 15 digits.
    fn factor(&self, share: f64) -> String {
        let digits = self.digits[0] + (self.digits[1] - self.digits[0]) * share;
        let whole = digits.floor();
        let mantissa = libm::exp10(digits - whole);
        if (0.0..6.0).contains(&whole) {
            return format!(
                "{}",
                super::super::family::plain(mantissa * libm::exp10(whole))
            );
        }
        format!("{mantissa:.14}e{whole}")
    }
}

/// Returns the rule half-way to another one, and an error if there is no tween between them.
pub(super) fn half_way(
    arguments: &Arguments,
    loaded: &Loaded,
    other: &Loaded,
) -> Result<Model, Failure> {
    let by = arguments.others.value("by").and_then(TweenBy::from_name);
    tween::between(loaded, other, 0.5, by.unwrap_or_default())
}

/// Returns the film of arguments. `half_way` is the rule in the middle of a tween.
pub(super) fn film<'a>(
    arguments: &Arguments,
    loaded: &Loaded,
    half_way: Option<Model>,
    catalogue: &'a Catalogue,
    path: &Path,
) -> Result<Film<'a>, Failure> {
    check(arguments, loaded)?;
    let timeline = timeline(arguments);
    timeline.check()?;
    let course = Course::of(arguments, loaded)?;
    let mut common = common(arguments);
    common.extend(half_way.and_then(|model| steps_of(arguments, model)));
    let ranges = color_ranges(arguments, loaded, course.as_ref());
    let frame = |number: u32| {
        let moment = timeline.moment(number);
        let mut own = at(arguments, &moment, course.as_ref());
        let range = ranges.as_ref().map(|range| range.at(&moment));
        own.extend(range);
        [common.as_slice(), &own].concat()
    };
    let mut frames = Frames {
        runs: grow::Runs::new(Arc::clone(&loaded.document), catalogue),
        arguments: (0..timeline.count()).map(frame).collect(),
        threads: arguments.threads.unwrap_or_else(all_cores),
        drawn: AtomicU32::new(0),
        spares: Spares::kept(),
    };
    let size = fit::fit(arguments, loaded, &mut frames, path)?;
    Ok(Film { frames, size })
}

/// Returns the number of steps of a tween as an option, if neither steps nor a detail are given and the rule in its
/// middle has such a number.
fn steps_of(arguments: &Arguments, half_way: Model) -> Option<String> {
    let is_given = arguments.steps.is_some() || arguments.others.gives("detail");
    let steps = match half_way.is_in_space() {
        true => half_way.metadata().steps,
        false => Some(half_way).and_then(|model| {
            let goal = Goal::choose(&model, None, None, |steps| model.compile(steps));
            match goal.ok()? {
                Goal::Steps(steps, _) => Some(steps),
                Goal::Detail(_) => None,
            }
        }),
    };
    steps
        .filter(|_| !is_given && arguments.zoom.is_none())
        .map(|steps| format!("--steps={steps}"))
}

/// Refuses options that exclude each other, and films in which nothing changes.
fn check(arguments: &Arguments, loaded: &Loaded) -> Result<(), Failure> {
    let is_in_space = loaded.model.is_in_space();
    let wrong = |message: String| Err(Failure::Usage(message));
    if is_in_space && arguments.turn.is_some() {
        return wrong(format!(
            "--turn turns sets of the plane, and {} lies in space: --from turns it",
            loaded.name
        ));
    }
    if !is_in_space && arguments.from.is_some() {
        return wrong(format!(
            "--from applies to sets in space, and {} lies in the plane: --turn turns it",
            loaded.name
        ));
    }
    if matches!(arguments.zoom, Some(Zooms::Loop)) && arguments.turn.is_some() {
        return wrong("--zoom loop turns the picture by itself: leave out --turn".into());
    }
    if arguments.zoom.is_none() && arguments.others.gives("at") {
        return wrong("--at is the centre of --zoom: --zoom 1 shows what lies about it".into());
    }
    if arguments.zoom.is_some()
        && arguments
            .steps
            .as_ref()
            .is_some_and(|it| it.as_slice().len() > 1)
    {
        return wrong("--zoom draws whole steps: give one number of --steps, or none".into());
    }
    let swept = { arguments.set.iter() }
        .flat_map(Assignment::tracks)
        .any(|it| it.changes());
    let several = |it: &Several| it.as_slice().len() > 1;
    let changes = [
        swept,
        arguments.steps.as_ref().is_some_and(several),
        arguments.seed.as_slice().len() > 1,
        !matches!(arguments.zoom, None | Some(Zooms::One(_))),
        arguments.turn.as_ref().is_some_and(Keys::changes),
        arguments.from.iter().flatten().any(Keys::changes),
        arguments.to.is_some(),
        arguments.draw,
    ];
    match changes.contains(&true) {
        true => Ok(()),
        false => wrong(
            "nothing changes in the film: give a range to --set, --steps, --zoom, --seed, --turn or --from, or --to or --draw"
                .into(),
        ),
    }
}

pub(super) fn timeline(arguments: &Arguments) -> Timeline {
    let seeds = u32::try_from(arguments.seed.as_slice().len()).unwrap_or(u32::MAX);
    let is_endless = matches!(arguments.zoom, Some(Zooms::Loop));
    let is_even = arguments.is_loop || arguments.draw || arguments.zoom.is_some() || seeds > 1;
    let default = if is_even { Ease::Linear } else { Ease::InOut };
    Timeline {
        frames: arguments
            .frames
            .unwrap_or(if seeds > 1 { seeds } else { 60 }),
        is_loop: arguments.is_loop || is_endless,
        bounces: arguments.bounce,
        hold: arguments.hold,
        ease: arguments.ease.unwrap_or(default),
        is_smooth: arguments.smooth,
    }
}

/// Returns the arguments of all frames: the rule, and options that do not change.
fn common(arguments: &Arguments) -> Vec<String> {
    let mut common = vec![arguments.rule.display().to_string()];
    common.extend_from_slice(arguments.others.arguments());
    common.extend(["--threads=1", "--output=-"].map(String::from));
    common
}

/// Returns the steps of the first and the last colour in frames that differ in their steps, unless they are given: elements
/// keep their colours as growth goes on, and in a zoom without end, colours go along with the magnification.
fn color_ranges(
    arguments: &Arguments,
    loaded: &Loaded,
    course: Option<&Course>,
) -> Option<ColorRanges> {
    let style = &loaded.model.metadata().style;
    let given = arguments.others.value("color-by");
    let color_by = given.and_then(ColorBy::from_name).unwrap_or(style.color_by);
    let is_by_steps = matches!(color_by, ColorBy::Step | ColorBy::Age);
    let has_range = arguments.others.gives("color-range") || style.color_range.is_some();
    if has_range || !is_by_steps {
        return None;
    }
    if let Some((steps, [first, last])) = course.and_then(|it| Some((it.steps?, it.digits))) {
        let detail = arguments.others.value("detail");
        let detail = detail.and_then(|it| it.parse().ok()).unwrap_or(1.0);
        let seen = libm::log10(arguments.size.size.long_side() / detail);
        let of_digit = steps / (last - first);
        return Some(ColorRanges {
            first: [first, last].map(|digits| digits * of_digit),
            length: (seen * of_digit).max(1.0),
        });
    }
    let most = arguments.steps.as_ref()?.as_slice().iter().max()?;
    Some(ColorRanges {
        first: [0.0; 2],
        length: f64::from(*most).max(1.0),
    })
}

/// Steps of the palette in the course of a film.
struct ColorRanges {
    /// Step of the first colour, at the start and at the end.
    first: [f64; 2],
    /// Number of steps to the last colour.
    length: f64,
}

impl ColorRanges {
    fn at(&self, moment: &Moment) -> String {
        let [from, to] = self.first;
        let first = from + (to - from) * moment.share();
        let [first, last] = [first, first + self.length].map(super::super::family::plain);
        format!("--color-range={first}..{last}")
    }
}

/// Returns the arguments of one frame.
fn at(arguments: &Arguments, moment: &Moment, course: Option<&Course>) -> Vec<String> {
    let mut own = Vec::new();
    let tracks = arguments.set.iter().flat_map(Assignment::tracks);
    own.extend(tracks.map(|track| format!("--set={}", track.at(moment))));
    // Each seed has an equal part of the film.
    own.push(format!("--seed={}", moment.part(arguments.seed.as_slice())));
    own.extend({ arguments.steps.iter() }.flat_map(|it| steps(arguments, it, moment)));
    let share = super::super::family::plain(moment.share());
    if let Some(to) = &arguments.to {
        own.extend([format!("--to={}", to.display()), format!("--share={share}")]);
    }
    if arguments.draw {
        own.push(format!("--drawn={share}"));
    }
    let mut turn = { arguments.turn.as_ref() }.map(|keys| keys.at(moment));
    if let Some(course) = course {
        let share = moment.share();
        own.push(format!("--zoom={}", course.factor(share)));
        if course.turn[1] != 0.0 {
            turn = Some(super::super::family::plain(course.turn[1] * share));
        }
    }
    own.extend(turn.map(|turn| format!("--turn={turn}")));
    if let Some([azimuth, elevation]) = &arguments.from {
        own.push(format!(
            "--from={},{}",
            azimuth.at(moment),
            elevation.at(moment)
        ));
    }
    own
}

/// Returns the options of the number of steps at a moment.
fn steps(arguments: &Arguments, several: &Several, moment: &Moment) -> Vec<String> {
    let mut all = several.as_slice().to_vec();
    // After the last one of a list, a film without end goes to the first, but not in cuts.
    if moment.closes && several.is_list() && !arguments.cuts {
        all.push(several.first());
    }
    let last = all.len() - 1;
    let keys: Vec<f64> = (0..all.len())
        .map(|at| f64::from(u32::try_from(at).unwrap_or(u32::MAX)))
        .collect();
    if arguments.cuts {
        // Each step takes an equal part of the film.
        let at = moment.share() * (keys[last] + 1.0);
        return vec![format!("--steps={}", all[index(at).min(last)])];
    }
    let at = moment.between(&keys, false);
    let before = index(at + 1e-9).min(last);
    let share = super::super::family::plain(at - keys[before]);
    let (from, to) = (all[before], all[(before + 1).min(last)]);
    let (from, share) = match to == from + 1 {
        true => (from, share),
        // Steps between others are passed through, backwards if they fall.
        false => {
            let at = f64::from(from) + share * (f64::from(to) - f64::from(from));
            let below = u32::try_from(index(at + 1e-9)).unwrap_or(from);
            (below, super::super::family::plain(at - f64::from(below)))
        }
    };
    if share <= 1e-9 {
        return vec![format!("--steps={from}")];
    }
    vec![
        format!("--steps={}", from + 1),
        format!("--between={share}"),
    ]
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small and not negative"
)]
fn index(value: f64) -> usize {
    value as usize
}
