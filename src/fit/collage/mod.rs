//! Collages: maps whose images of the shape cover the shape, as a start for the refinement on the attractor.

mod copies;
mod cover;
mod ground;
mod pairs;
mod stems;

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::parallel::{self, is_cancelled};
use crate::random::{GOLDEN, Pcg, mix};

use self::copies::Copy;
pub(super) use self::ground::Ground;
pub(super) use self::pairs::{Form, clamped};
use super::orbit::{Level, Orbit};
use super::refine::{Refined, refine};
use super::{Candidate, Disk, FitError, FitOptions, Method, Silhouette, methods};

/// Cells of the long side at which copies are searched.
const GROUND: usize = 96;
/// Points of the shape by which covers are judged.
const SAMPLE: usize = 768;
/// Random starts of every list of copies; more for few maps.
const STARTS: usize = 6;
/// Covers by one copy less that a flat map completes.
const STEMS: usize = 16;
/// Starts from random maps.
const RANDOM: usize = 16;

/// Forms of the maps of starts with rounds of least squares, from covers by copies and with a flat map.
const ROUNDS: [(Form, usize); 3] = [(Form::Similar, 0), (Form::Similar, 6), (Form::Affine, 10)];
const STEM_ROUNDS: [(Form, usize); 2] = [(Form::Affine, 0), (Form::Affine, 10)];

/// Multiple of the shortest description up to which that of a rough candidate makes it worth to be refined.
const ROUGH: f64 = 1.15;

/// Cells of the long side at which candidates are refined last.
pub(super) const FINE: usize = 160;

/// Shortens a list, best first, to `most` candidates, of which one has similarities if any has.
fn shorten(list: &mut Vec<Refined>, most: usize) {
    let first = list.iter().position(|it| it.form == Form::Similar);
    if let Some(first) = first.filter(|first| *first >= most) {
        list.swap(most - 1, first);
    }
    list.truncate(most);
}

/// A search for collages of a shape; what does not depend on the number of maps is done once.
pub(super) struct Collage<'s> {
    shape: &'s Silhouette,
    options: &'s FitOptions,
    ground: Ground,
    copies: Vec<Copy>,
    disks: Vec<Copy>,
    coarse: Level,
    fine: Level,
    evaluations: AtomicUsize,
}

impl<'s> Collage<'s> {
    pub(super) fn new(shape: &'s Silhouette, options: &'s FitOptions) -> Result<Self, FitError> {
        let ground = Ground::new(shape, GROUND, SAMPLE).ok_or(FitError::Empty)?;
        Ok(Self {
            copies: copies::copies(&ground, options.threads.get()),
            disks: copies::disks(&ground),
            ground,
            shape,
            options,
            coarse: Level::new(shape, 72),
            fine: Level::new(shape, FINE),
            evaluations: AtomicUsize::new(0),
        })
    }

    /// Returns the shape at the size at which copies are searched.
    pub(super) fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Returns the shape at the size at which candidates are refined last.
    pub(super) fn fine(&self) -> &Level {
        &self.fine
    }

    /// Returns the options.
    pub(super) fn options(&self) -> &FitOptions {
        self.options
    }

    /// Returns what cancels the search.
    pub(super) fn cancel(&self) -> Option<&AtomicBool> {
        self.options.cancel.as_deref()
    }

    /// Returns whether the search is to end with what it has.
    pub(super) fn is_stopped(&self) -> bool {
        is_cancelled(self.options.stop.as_deref())
    }

    /// Returns the number of evaluations so far.
    pub(super) fn evaluations(&self) -> usize {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Returns candidates, best first, whose number of maps is in the range of the options, by the least [description
    /// length](methods::description).
    pub(super) fn search(&self) -> Result<Vec<Refined>, FitError> {
        self.search_in(self.options.maps.clone(), Method::Collage, |count| {
            self.starts(count)
        })
    }

    /// Returns candidates, best first, from starts with each number of maps, until three numbers more are no better.
    pub(super) fn search_in(
        &self,
        counts: RangeInclusive<usize>,
        method: Method,
        starts: impl Fn(usize) -> Vec<Refined>,
    ) -> Result<Vec<Refined>, FitError> {
        let mut orbit = Orbit::new(&self.fine);
        let mut best: Option<(f64, Vec<Refined>)> = None;
        let mut worse = 0;
        for count in counts {
            if best.is_some() && self.is_stopped() {
                break;
            }
            let most = best.as_ref().map_or(f64::INFINITY, |best| ROUGH * best.0);
            let found = self.refined(count, starts(count), most)?;
            let Some(first) = found.first() else {
                continue;
            };
            if let Some(progress) = &self.options.progress {
                let iou = orbit.iou(&first.candidate, &self.fine);
                progress.note(method, &first.candidate, iou);
            }
            let length = methods::description(&first.candidate, &mut orbit, &self.fine);
            let is_whole = orbit.misfit(&first.candidate, &self.fine) == 0.0;
            worse += 1;
            if best.as_ref().is_none_or(|best| length < best.0) {
                best = Some((length, found));
                worse = 0;
            }
            if is_whole || worse == 3 {
                break;
            }
        }
        best.map(|(_, found)| found).ok_or(FitError::Cancelled)
    }

    /// Returns the best candidates with a number of maps, best first, refined from starts; roughly, if the description of the
    /// best is longer than `most` then.
    fn refined(
        &self,
        count: usize,
        mut starts: Vec<Refined>,
        most: f64,
    ) -> Result<Vec<Refined>, FitError> {
        let effort = self.options.effort;
        shorten(&mut starts, 12);
        let stage = |starts: Vec<Refined>, level: &Level, share: usize, step: f64, stage: u64| {
            let seed = mix(stage ^ (count as u64).wrapping_mul(GOLDEN));
            self.stage(starts, level, effort / share, step, seed)
        };
        let mut kept = stage(starts, &self.coarse, 60, 2.0, 1)?;
        shorten(&mut kept, 4);
        let mut kept = stage(kept, &self.coarse, 16, 1.0, 2)?;
        shorten(&mut kept, 2);
        let mut orbit = Orbit::new(&self.fine);
        let length = |it: &Refined| methods::description(&it.candidate, &mut orbit, &self.fine);
        if kept.first().map(length).is_some_and(|length| length > most) {
            return Ok(kept);
        }
        stage(kept, &self.fine, 10, 0.5, 3)
    }

    /// Counts candidates that were evaluated.
    pub(super) fn count(&self, evaluations: usize) {
        self.evaluations.fetch_add(evaluations, Ordering::Relaxed);
        if let Some(progress) = &self.options.progress {
            progress.count(evaluations);
        }
    }

    /// Refines candidates at a level, best first.
    fn stage(
        &self,
        starts: Vec<Refined>,
        level: &Level,
        evaluations: usize,
        step: f64,
        seed: u64,
    ) -> Result<Vec<Refined>, FitError> {
        let threads = self.options.threads.get();
        let cancel = self.options.cancel.as_deref();
        let step = step / level.scale();
        let budget = self.options.budget(evaluations);
        let refined = parallel::map(&starts, threads, |number, start| {
            if is_cancelled(cancel) {
                return Vec::new();
            }
            if self.is_stopped() {
                return vec![start.clone()];
            }
            let random = || Pcg::new(self.options.seed ^ seed, number as u64 * 2 + 1);
            let mut all = vec![refine(
                self.shape,
                level,
                &start.candidate,
                start.form,
                step,
                budget,
                random(),
            )];
            if start.form == Form::Similar && !self.options.similar {
                let affine = &start.candidate;
                all.push(refine(
                    self.shape,
                    level,
                    affine,
                    Form::Affine,
                    step,
                    budget,
                    random(),
                ));
            }
            self.count(all.iter().map(|it| it.evaluations).sum());
            all
        });
        if is_cancelled(cancel) {
            return Err(FitError::Cancelled);
        }
        let mut refined = refined.concat();
        // Fewer numbers are worth a little.
        let cost = |it: &Refined| it.loss + if it.form == Form::Affine { 0.004 } else { 0.0 };
        refined.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
        Ok(refined)
    }

    /// Returns candidates with a number of maps, best first.
    fn starts(&self, count: usize) -> Vec<Refined> {
        let covers = self.covers(count);
        let threads = self.options.threads.get();
        // Random maps leave no room for disks.
        let random = if self.options.disks == 0 {
            RANDOM as u64
        } else {
            0
        };
        let numbers: Vec<u64> = (0..random).collect();
        let random = parallel::map(&numbers, threads, |_, &number| self.random(count, number));
        let whole = covers
            .into_iter()
            .chain(random)
            .map(|candidate| (candidate, &ROUNDS[..]));
        let stems = self.stems(count).into_iter();
        let all: Vec<_> = whole
            .chain(stems.map(|it| (it, &STEM_ROUNDS[..])))
            .collect();
        let starts = parallel::map(&all, threads, |_, (candidate, rounds)| {
            let mut orbit = Orbit::new(&self.coarse);
            let free = self.uncovered(candidate);
            let mut best: Vec<Refined> = Vec::new();
            for &(form, rounds) in *rounds {
                if form == Form::Affine && self.options.similar {
                    continue;
                }
                let mut maps: Vec<DAffine2> = candidate
                    .maps
                    .iter()
                    .map(|map| self.ground.inward(map))
                    .collect();
                pairs::improve(&self.ground, &free, &mut maps, form, rounds);
                let maps = maps.iter().map(|map| self.ground.outward(map)).collect();
                let candidate = Candidate {
                    maps,
                    disks: candidate.disks.clone(),
                };
                let loss = orbit.loss(&candidate, &self.coarse);
                let start = Refined {
                    candidate,
                    form,
                    loss,
                    evaluations: 1,
                };
                let is_beaten = |other: &Refined| match other.form == form {
                    true => loss >= other.loss,
                    // Fewer numbers are worth a little.
                    false => loss > other.loss - 0.004,
                };
                if !best.iter().any(is_beaten) {
                    best.retain(|other| other.form != form);
                    best.push(start);
                }
            }
            best
        });
        let mut starts: Vec<Refined> = starts.into_iter().flatten().collect();
        self.count(3 * starts.len());
        starts.sort_by(|a, b| a.loss.total_cmp(&b.loss));
        let mut kept: Vec<Refined> = Vec::new();
        for start in starts {
            let known = |other: &Refined| (other.loss - start.loss).abs() < 1e-9;
            if !kept.iter().any(known) {
                kept.push(start);
            }
        }
        kept
    }

    /// Returns candidates of covers by one copy less, with a [flat map](stems::stem) for what they leave uncovered.
    fn stems(&self, count: usize) -> Vec<Candidate> {
        if count < 3 || self.options.similar {
            return Vec::new();
        }
        let mut covers = self.covers(count - 1);
        covers.truncate(STEMS);
        let completed = covers.into_iter().filter_map(|mut cover| {
            let maps: Vec<DAffine2> = { cover.maps.iter() }
                .map(|map| self.ground.inward(map))
                .collect();
            let stem = stems::stem(&self.ground, &maps)?;
            cover.maps.push(self.ground.outward(&stem));
            Some(cover)
        });
        completed.collect()
    }

    /// Returns the candidates of covers by similar copies, of one ratio and of several.
    fn covers(&self, count: usize) -> Vec<Candidate> {
        let ratios = copies::ratios().len();
        let disks: Vec<&Copy> = self.disks.iter().collect();
        let lists: Vec<Option<usize>> = (0..ratios).map(Some).chain([None; 4]).collect();
        let found = parallel::map(&lists, self.options.threads.get(), |number, ratio| {
            let of_ratio = |copy: &&Copy| ratio.is_none_or(|ratio| copy.ratio == ratio);
            let list: Vec<&Copy> = self.copies.iter().filter(of_ratio).collect();
            let mut slots: Vec<&[&Copy]> = vec![&list; count];
            slots.extend(vec![&disks[..]; self.options.disks]);
            let seed = self.options.seed ^ mix(number as u64 + 1) ^ count as u64;
            let mut random = Pcg::new(seed, 7);
            let covers = (0..STARTS + 48 / count).filter_map(|_| {
                let cover = cover::choose(&slots, self.ground.points().len(), &mut random)?;
                let (maps, round) = cover.copies.split_at(count);
                let maps = maps
                    .iter()
                    .map(|&copy| self.ground.outward(&list[copy].map));
                let maps = maps.collect();
                let round = round.iter().map(|&copy| self.disk(disks[copy]));
                Some((
                    cover.cost,
                    Candidate {
                        maps,
                        disks: round.collect(),
                    },
                ))
            });
            covers.collect::<Vec<_>>()
        });
        let mut found: Vec<(f64, Candidate)> = found.into_iter().flatten().collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-9);
        found.truncate(48);
        found.into_iter().map(|(_, candidate)| candidate).collect()
    }

    /// Returns the disk that a copy of the unit disk is, in pixels.
    fn disk(&self, copy: &Copy) -> Disk {
        Disk {
            centre: self.ground.back().transform_point2(copy.map.translation),
            radius: copy.map.matrix2.x_axis.x / self.ground.scale(),
        }
    }

    /// Returns the points of the ground that no disk of a candidate covers; all if there are hardly any.
    fn uncovered(&self, candidate: &Candidate) -> Vec<DVec2> {
        let all = self.ground.points();
        let is_free = |point: &&DVec2| {
            let point = self.ground.back().transform_point2(**point);
            candidate
                .disks
                .iter()
                .all(|disk| point.distance(disk.centre) > disk.radius)
        };
        let free: Vec<DVec2> = all.iter().filter(is_free).copied().collect();
        if free.len() * 20 < all.len() {
            all.to_vec()
        } else {
            free
        }
    }

    /// Returns a candidate of random maps.
    pub(super) fn random(&self, count: usize, number: u64) -> Candidate {
        let mut random = Pcg::new(self.options.seed ^ mix(number), count as u64 * 2 + 1);
        let points = self.ground.points();
        let maps = (0..count).map(|_| {
            let ratio = 0.3 + 0.5 * random.unit();
            let turned = ratio * DVec2::from_angle(std::f64::consts::TAU * random.unit());
            let flip = if random.unit() < 0.3 { -1.0 } else { 1.0 };
            let matrix = DMat2::from_cols(turned, flip * turned.perp());
            let image = points[cover::pick(&mut random, points.len())];
            let map =
                DAffine2::from_mat2_translation(matrix, image - matrix * self.ground.middle());
            self.ground.outward(&map)
        });
        Candidate::of_maps(maps.collect())
    }
}
