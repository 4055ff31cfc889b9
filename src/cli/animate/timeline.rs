//! Time of a film: the moment of every frame, and values between key frames.

use super::super::{Failure, number};
use crate::style::Named;

/// Course of time between two key frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ease {
    /// At an even speed.
    Linear,
    /// From rest.
    In,
    /// To rest.
    Out,
    /// From rest to rest: 3t² − 2t³.
    InOut,
    /// From rest to rest, as a pendulum.
    Sine,
}

impl Named for Ease {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("linear", Self::Linear),
        ("in", Self::In),
        ("out", Self::Out),
        ("in-out", Self::InOut),
        ("sine", Self::Sine),
    ];
}

impl Ease {
    /// Returns the share of the way that is covered after a share of the time.
    fn at(self, time: f64) -> f64 {
        match self {
            Self::Linear => time,
            Self::In => time * time,
            Self::Out => time * (2.0 - time),
            Self::InOut => time * time * (3.0 - 2.0 * time),
            Self::Sine => (1.0 - libm::cos(std::f64::consts::PI * time)) / 2.0,
        }
    }
}

/// Division of a film into frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Timeline {
    /// Number of frames in which values change.
    pub(super) frames: u32,
    /// Whether the first frame follows the last one.
    pub(super) is_loop: bool,
    /// Whether the second half goes back.
    pub(super) bounces: bool,
    /// Number of frames for which those at both ends of the way are kept, each.
    pub(super) hold: u32,
    pub(super) ease: Ease,
    pub(super) is_smooth: bool,
}

impl Timeline {
    /// Returns the number of frames of the film.
    pub(super) fn count(&self) -> u32 {
        self.frames + 2 * self.hold
    }

    /// Returns an error if a film has too many frames.
    pub(super) fn check(&self) -> Result<(), Failure> {
        const MOST: u32 = 100_000;
        match self.count() <= MOST {
            true => Ok(()),
            false => Err(Failure::Usage(format!("a film has up to {MOST} frames"))),
        }
    }

    /// Returns the moment of a frame.
    pub(super) fn moment(&self, frame: u32) -> Moment {
        let Self {
            frames,
            is_loop,
            bounces,
            hold,
            ease,
            is_smooth,
        } = *self;
        // The end of the way, from which a film may go back.
        let end = if bounces { frames / 2 } else { frames - 1 };
        let begun = frame.saturating_sub(hold);
        let number = begun
            .min(end.max(begun.saturating_sub(hold)))
            .min(frames - 1);
        let share = |way: u32, whole: u32| f64::from(way) / f64::from(whole.max(1));
        Moment {
            // A film that returns to its start does not show it twice.
            time: match bounces {
                true if number > end => share(frames - number, frames - end),
                _ if is_loop => share(number, frames),
                _ => share(number, end),
            },
            way: match bounces {
                true if number > end => [frames - number, frames - end],
                true => [number, end],
                false => [number, frames - 1],
            },
            closes: is_loop && !bounces,
            ease,
            is_smooth,
        }
    }
}

/// Moment of a film.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct Moment {
    /// Share of the time, from 0 to 1.
    time: f64,
    /// Number of the frame on the way, without those that are kept, and of all frames of the way.
    way: [u32; 2],
    /// Whether lists of key frames return to the first one.
    pub(super) closes: bool,
    ease: Ease,
    is_smooth: bool,
}

impl Moment {
    /// Returns the one of some values of which each has an equal part of the way.
    pub(super) fn part<'v, T>(&self, values: &'v [T]) -> &'v T {
        let [number, last] = self.way.map(|it| it as usize);
        &values[(number * values.len() / (last + 1)).min(values.len() - 1)]
    }

    /// Returns the share of the whole way.
    pub(in crate::cli) fn share(&self) -> f64 {
        self.ease.at(self.time)
    }

    /// Returns the value between key frames. After the last one of a list, a film without end returns to the first.
    pub(in crate::cli) fn between(&self, keys: &[f64], is_list: bool) -> f64 {
        let count = keys.len();
        let returns = self.closes && is_list;
        let ways = if returns { count } else { count - 1 };
        if ways == 0 {
            return keys[0];
        }
        let key = |at: i64| {
            let count = i64::try_from(count).unwrap_or(i64::MAX);
            let at = match returns {
                true => at.rem_euclid(count),
                false => at.clamp(0, count - 1),
            };
            keys[usize::try_from(at).unwrap_or_default()]
        };
        #[expect(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            reason = "films have few key frames"
        )]
        let (at, way) = {
            // Each way is eased by itself, so that key frames are places of rest, unless the curve is smooth.
            let at = match self.is_smooth {
                true => self.share() * ways as f64,
                false => self.time * ways as f64,
            };
            let way = at.floor().min(ways as f64 - 1.0);
            (at - way, way as i64)
        };
        if self.is_smooth && count > 2 {
            return catmull_rom([-1, 0, 1, 2].map(|it| key(way + it)), at);
        }
        let share = if self.is_smooth { at } else { self.ease.at(at) };
        key(way) + (key(way + 1) - key(way)) * share
    }
}

/// Returns the value between the second and the third of four values (Catmull and Rom 1974).
fn catmull_rom([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let linear = c - a;
    let square = 2.0 * a - 5.0 * b + 4.0 * c - d;
    let cubic = 3.0 * (b - c) + d - a;
    b + t * (linear + t * (square + t * cubic)) / 2.0
}

/// Key frames of a number: `10..80`, or a list such as `10,80,30`, or one number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Keys {
    values: Vec<f64>,
    is_list: bool,
}

impl Keys {
    /// Parses key frames.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let by = if text.contains("..") { ".." } else { "," };
        let parts = text.split(by).map(|it| number::degrees(it.trim()));
        let values: Result<Vec<f64>, _> = parts.collect();
        match values {
            Ok(values) if !text.contains("..") || values.len() == 2 => Ok(Self {
                values,
                is_list: !text.contains(".."),
            }),
            _ => Err("expected a number, two as in 0..360, or a list as in 0,90,30".into()),
        }
    }

    /// Returns the value at a moment.
    pub(super) fn at(&self, moment: &Moment) -> f64 {
        super::super::family::plain(moment.between(&self.values, self.is_list))
    }

    /// Returns whether the value changes.
    pub(super) fn changes(&self) -> bool {
        self.values.len() > 1
    }
}

/// Parses directions in space: azimuth and elevation, of which each may be a range.
pub(super) fn direction(text: &str) -> Result<[Keys; 2], String> {
    let wrong = || "write azimuth and elevation in degrees, as 0..360,25".to_owned();
    let (azimuth, elevation) = text.split_once(',').ok_or_else(wrong)?;
    let keys = |text: &str| {
        Keys::parse(text)
            .ok()
            .filter(|keys| !keys.is_list || keys.values.len() == 1)
    };
    match [keys(azimuth), keys(elevation)] {
        [Some(azimuth), Some(elevation)] => Ok([azimuth, elevation]),
        _ => Err(wrong()),
    }
}

/// Parses a number of frames a second: the number of frames in a number of seconds.
pub(super) fn rate(text: &str) -> Result<crate::film::Rate, String> {
    let wrong = "a number of frames a second lies from 0.01 to 240";
    let rate = text
        .parse::<f64>()
        .ok()
        .filter(|rate| (0.01..=240.0).contains(rate));
    let rate = rate.ok_or(wrong)?;
    let seconds = [1_u32, 10, 100]
        .into_iter()
        .find(|it| (rate * f64::from(*it)).fract() == 0.0);
    let seconds = seconds.unwrap_or(100);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 24,000"
    )]
    let frames = (rate * f64::from(seconds)).round() as u32;
    Ok(crate::film::Rate { frames, seconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: Timeline = Timeline {
        frames: 5,
        is_loop: false,
        bounces: false,
        hold: 0,
        ease: Ease::Linear,
        is_smooth: false,
    };

    fn values(timeline: Timeline, keys: &str) -> Vec<f64> {
        let keys = Keys::parse(keys).unwrap();
        let frames = 0..timeline.count();
        frames
            .map(|frame| keys.at(&timeline.moment(frame)))
            .collect()
    }

    #[test]
    fn values_follow_their_key_frames() {
        assert_eq!(values(LINE, "0..8"), [0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(values(LINE, "0,8,4"), [0.0, 4.0, 8.0, 6.0, 4.0]);
        let held = Timeline { hold: 2, ..LINE };
        assert_eq!(
            values(held, "0..8"),
            [0.0, 0.0, 0.0, 2.0, 4.0, 6.0, 8.0, 8.0, 8.0]
        );
        // Films without end do not show the first frame twice.
        let endless = Timeline {
            is_loop: true,
            ..LINE
        };
        assert_eq!(values(endless, "0..10"), [0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(values(endless, "0,10"), [0.0, 4.0, 8.0, 8.0, 4.0]);
        let bouncing = Timeline {
            bounces: true,
            frames: 4,
            ..LINE
        };
        assert_eq!(values(bouncing, "0..8"), [0.0, 4.0, 8.0, 4.0]);
        let odd = Timeline {
            frames: 5,
            hold: 1,
            ..bouncing
        };
        assert_eq!(values(odd, "0..6"), [0.0, 0.0, 3.0, 6.0, 6.0, 4.0, 2.0]);
        let one = Timeline { frames: 1, ..LINE };
        assert_eq!(values(one, "3..8"), [3.0]);
    }

    #[test]
    fn courses_begin_and_end_in_place() {
        for (name, ease) in Ease::NAMES {
            let eased = Timeline {
                ease: *ease,
                frames: 11,
                ..LINE
            };
            let all = values(eased, "0..1");
            assert_eq!([all[0], all[10]], [0.0, 1.0], "{name}");
            assert!(all.is_sorted(), "{name}");
            let smooth = Timeline {
                is_smooth: true,
                ..eased
            };
            let all = values(smooth, "0,1,0,1,0,1");
            assert_eq!([all[0], all[10]], [0.0, 1.0], "{name}");
        }
        let smooth = Timeline {
            is_smooth: true,
            frames: 7,
            ..LINE
        };
        assert_eq!(
            values(smooth, "0,1,2,3"),
            [0.0, 0.4375, 1.0, 1.5, 2.0, 2.5625, 3.0]
        );
    }

    #[test]
    fn rates_are_fractions() {
        let rate = |text| rate(text).map(|rate| [rate.frames, rate.seconds]);
        assert_eq!(rate("30"), Ok([30, 1]));
        assert_eq!(rate("12.5"), Ok([125, 10]));
        assert_eq!(rate("23.976"), Ok([2398, 100]));
        assert!(rate("0").is_err() && rate("x").is_err() && rate("NaN").is_err());
        assert!(direction("0..360,25").is_ok() && direction("30").is_err());
        assert!(Keys::parse("1..2..3").is_err() && Keys::parse("").is_err());
    }
}
