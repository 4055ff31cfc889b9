//! Cells with the last step in which an element that covers them is born.
//!
//! Elements of a later step cover those of earlier ones. Two kinds of points are followed, from inner to
//! outer maps, with the linear part of the composition of all maps that were applied:
//!
//! - Points of elements that are replaced without end. Only their last steps are visible, by which they have
//!   been contracted to the shortest length. The cells in which one point represents others may therefore be
//!   larger by the factor by which they are still to be contracted, so that nearly all work is that of the
//!   last halving.
//! - Points of outlines, step by step, unless they lie within elements that are replaced without end: images
//!   of these would cover all images of such a point.

use std::collections::VecDeque;

use super::field::{Field, NoRoom};
use super::net::Edge;
use super::shown::LayerCells;
use super::waves::Waves;
use super::{CellSearch, FoundCells, LimitCells, Stopped};
use super::{finished, looked_for, outlined};
use crate::geometry::{DAffine2, DMat2, DVec2, stretch};

/// Multiple of the shortest length below which elements are hardly replaced again.
const SHORT: f64 = 2.0;

/// Sides of cells, in cells of the picture, for which the last steps of elements replaced without end are
/// found.
const GRAINS: [f64; 3] = [4.0, 2.0, 1.0];

/// Expected number of images of points above which the next finer grain is not tried.
const WORTH: u64 = 12_000_000;

/// Numbers of points along a side of a cell by which outlines are followed, in the order in which they are
/// tried.
const FINENESS: [f64; 3] = [1.0, 2.0, 4.0];

/// Maximum number of points whose images are computed together: small, so that most images that coincide with
/// others are recognised.
const BLOCK: usize = 1 << 12;

/// Number of images that are worth another thread.
const WORTH_A_THREAD: usize = 1 << 13;

/// Factor by which the number of cells grows when their sides are halved.
const TIMES: u64 = 4;

/// Maximum number of sizes of cells, each of which is half of the one before.
const MAX_SIZES: usize = 40;

/// Point with the linear part of the maps that were applied to it.
#[derive(Clone, Copy)]
struct MappedPoint {
    at: DVec2,
    linear: DMat2,
}

impl MappedPoint {
    #[inline]
    fn mapped(&self, map: &DAffine2) -> Self {
        Self {
            at: map.transform_point2(self.at),
            linear: map.matrix2 * self.linear,
        }
    }
}

/// Search for the last steps.
struct Steps<'a> {
    set: &'a LimitCells<'a>,
    search: &'a CellSearch<'a>,
    /// Minimum length of elements that are replaced.
    shortest: f64,
    /// Cells of elements that are replaced without end, by set and then by layer.
    cores: Vec<Field>,
    /// Last steps of cells, by set and then by layer; the cells of sets are larger.
    last: Vec<Field>,
    waves: Waves<MappedPoint>,
    /// Points of the coming waves: by the number of maps from the last wave, minus 1, by set, and by the size
    /// of the cells that the points represent.
    met: VecDeque<Vec<Vec<Field>>>,
    /// Step to which one map leads from the last wave.
    step: u16,
    /// Number of images that may still be computed.
    left: u64,
}

/// Image of a point.
struct Image<'a> {
    edge: &'a Edge,
    drawn: MappedPoint,
    step: u16,
    /// Index of the size of the cell that the point represents.
    size: usize,
    /// Whether hardly any descendant of the point is born in a later step.
    is_last: bool,
}

impl LimitCells<'_> {
    /// Finds the cells of every layer, with the last steps in which elements that cover them are born.
    /// Elements are replaced down to the length `shortest`.
    ///
    /// # Errors
    ///
    /// Returns an error if that takes more work or more steps than are allowed, or if it is cancelled.
    pub(crate) fn find_steps(
        &self,
        search: &CellSearch<'_>,
        shortest: f64,
    ) -> Result<FoundCells, Stopped> {
        let mut cores = self.find_all(search, false)?;
        self.refine(search, &mut cores)?;
        cores.fields = finished(cores.fields);
        let mut steps = Steps {
            set: self,
            search,
            shortest,
            last: Vec::new(),
            waves: Waves::of(&self.net),
            met: VecDeque::new(),
            step: 0,
            left: search.max_images.saturating_sub(cores.images),
            cores: cores.fields,
        };
        let mut inner = 0;
        for grain in GRAINS {
            let before = steps.left;
            inner = steps.follow_points(grain)?;
            if (before - steps.left) * TIMES > WORTH {
                break;
            }
        }
        let first_layer = steps.first_layer();
        let labelled = steps.last.iter_mut().zip(&steps.cores);
        for (last, core) in labelled.skip(first_layer) {
            last.spread_to(core)?;
        }
        let mut outer = 0;
        for fineness in FINENESS {
            let before = steps.left;
            outer = steps.follow_outlines(fineness)?;
            if (before - steps.left) * TIMES > WORTH / 2 {
                break;
            }
        }
        Ok(FoundCells {
            fields: finished(steps.last.split_off(first_layer)),
            images: search.max_images - steps.left,
            steps: inner.max(outer).into(),
        })
    }
}

impl Steps<'_> {
    fn first_layer(&self) -> usize {
        self.set.net.nodes.len() - self.set.layers
    }

    /// Takes images from the remaining ones. Returns an error if there are too few, or if the search was
    /// cancelled.
    fn take(&mut self, images: usize) -> Result<(), Stopped> {
        self.search.check()?;
        self.left = { self.left.checked_sub(images as u64) }.ok_or(Stopped::TooMany)?;
        Ok(())
    }

    /// Returns the length of an element in the picture, as a multiple of the shortest length.
    #[inline]
    fn ratio(&self, whole: usize, drawn: &MappedPoint) -> f64 {
        stretch(&drawn.linear) * self.set.net.nodes[whole].stretch / self.shortest
    }

    /// Prepares fields for the points of the coming waves; `met` creates those of a set.
    fn begin(&mut self, met: impl Fn(usize) -> Vec<Field>) {
        let net = &self.set.net;
        let first_layer = self.first_layer();
        self.step = 0;
        self.waves = Waves::of(net);
        let waves = 0..net.max_maps();
        self.met = waves
            .map(|_| (0..first_layer).map(&met).collect())
            .collect();
    }

    /// Returns whether the cell of an image already holds a point of its wave.
    #[inline]
    fn has_met(&self, image: &Image<'_>) -> bool {
        let sizes = &self.met[image.edge.maps - 1][image.edge.whole];
        sizes[image.size.min(sizes.len() - 1)].holds(image.drawn.at)
    }

    /// Continues from an image, unless its cell already holds a point of its wave. Returns whether it does
    /// continue.
    #[inline]
    fn follow(&mut self, image: &Image<'_>) -> Result<bool, NoRoom> {
        let Edge { whole, maps, .. } = *image.edge;
        let sizes = &mut self.met[maps - 1][whole];
        let last = sizes.len() - 1;
        let is_new = sizes[image.size.min(last)].add(image.drawn.at)?;
        if is_new {
            self.waves.push(maps, whole, image.drawn);
        }
        Ok(is_new)
    }

    /// Computes the images of the points of the next wave, and calls `add` with those that are kept.
    fn go_on(
        &mut self,
        is_kept: impl Fn(&Self, &Image<'_>) -> bool + Sync,
        mut add: impl FnMut(&mut Self, Image<'_>) -> Result<(), Stopped>,
    ) -> Result<(), Stopped> {
        let set = self.set;
        let first_layer = self.first_layer();
        self.step = self.step.checked_add(1).ok_or(Stopped::TooMany)?;
        self.met.rotate_left(1);
        self.met
            .back_mut()
            .into_iter()
            .flatten()
            .flatten()
            .for_each(Field::clear);
        let wave = self.waves.next();
        for ((number, node), points) in set.net.nodes.iter().enumerate().zip(&wave) {
            for block in points.chunks(BLOCK) {
                let images = block.len() * node.images.len();
                self.take(images)?;
                let threads = self.search.threads.get().min(images / WORTH_A_THREAD);
                let this = &*self;
                let found = looked_for(block, threads, |drawn, found: &mut Vec<Image<'_>>| {
                    let from = found.len();
                    let mut is_last = this.ratio(number, drawn) < SHORT;
                    let mut goes_on = false;
                    for edge in &node.images {
                        let drawn = drawn.mapped(&edge.map);
                        let ratio = this.ratio(edge.whole, &drawn);
                        if ratio >= 1.0 {
                            goes_on |= edge.whole < first_layer;
                            found.push(Image {
                                edge,
                                drawn,
                                step: this.step.saturating_add(edge.later()),
                                size: size_of(ratio),
                                is_last: false,
                            });
                        }
                    }
                    is_last |= !goes_on;
                    found[from..]
                        .iter_mut()
                        .for_each(|image| image.is_last = is_last);
                    let mut kept = from;
                    for at in from..found.len() {
                        if is_kept(this, &found[at]) {
                            found.swap(kept, at);
                            kept += 1;
                        }
                    }
                    found.truncate(kept);
                });
                for image in found {
                    add(self, image)?;
                }
            }
        }
        Ok(())
    }

    /// Finds the last steps of elements that are replaced without end, in cells of `grain` picture cells
    /// along a side. Returns the number of steps.
    fn follow_points(&mut self, grain: f64) -> Result<u16, Stopped> {
        let first_layer = self.first_layer();
        let cores = self.cores.iter().enumerate();
        // In each cell of this size only one point is followed, and labels the whole cell.
        let grain = |set: usize| if set < first_layer { grain } else { 1.0 };
        let scales: Vec<f64> = cores.map(|(set, core)| core.scale() / grain(set)).collect();
        let (sets, layers) = scales.split_at(first_layer);
        self.last = sets.iter().map(|&scale| Field::new(scale)).collect();
        let mut shown = LayerCells::new(layers.iter().copied(), self.search.threads.get());
        self.begin(|set| {
            let sizes = std::iter::successors(Some(scales[set]), |scale| Some(scale / 2.0));
            sizes.take(MAX_SIZES).map(Field::new).collect()
        });
        let linear = DMat2::IDENTITY;
        for (number, node) in self.set.net.nodes[..first_layer].iter().enumerate() {
            if let Some(at) = node.point.filter(|_| node.stretch >= self.shortest) {
                self.waves.push(0, number, MappedPoint { at, linear });
            }
        }
        while !self.waves.are_over() {
            let is_kept = |this: &Self, image: &Image<'_>| {
                if image.edge.whole < first_layer {
                    !this.has_met(image)
                } else {
                    image.is_last
                }
            };
            self.go_on(is_kept, |this, image| {
                let (whole, at) = (image.edge.whole, image.drawn.at);
                if whole >= first_layer {
                    shown.push(whole - first_layer, at, image.step)?;
                } else if this.follow(&image)? && image.is_last {
                    this.last[whole].label(at, image.step)?;
                }
                Ok(())
            })?;
        }
        self.last.extend(shown.into_fields()?);
        Ok(self.step)
    }

    /// Finds the last steps of outlines, by `fineness` points along a side of a cell. Returns the number of
    /// steps.
    fn follow_outlines(&mut self, fineness: f64) -> Result<u16, Stopped> {
        let set = self.set;
        let first_layer = self.first_layer();
        let linear = DMat2::IDENTITY;
        let scales: Vec<f64> = { self.cores.iter() }
            .map(|core| core.scale() * fineness)
            .collect();
        self.begin(|set| vec![Field::new(scales[set])]);
        let mut met: Vec<Field> = scales.iter().map(|&scale| Field::new(scale)).collect();
        for (number, node) in set.net.nodes.iter().enumerate() {
            let points = if node.stretch > 0.0 {
                outlined(set.graph, node, scales[number], self.left)?
            } else {
                Vec::new()
            };
            self.take(points.len())?;
            for at in points {
                if number >= first_layer {
                    self.last[number].label(at, 0)?;
                } else if !self.is_covered(number, &MappedPoint { at, linear }, 0)
                    && met[number].add(at)?
                {
                    self.waves.push(0, number, MappedPoint { at, linear });
                }
            }
        }
        while !self.waves.are_over() {
            let is_kept = |this: &Self, image: &Image<'_>| {
                let whole = image.edge.whole;
                if whole < first_layer {
                    !this.has_met(image) && !this.is_covered(whole, &image.drawn, image.step)
                } else {
                    let known = this.last[whole].label_of(image.drawn.at);
                    known.is_none_or(|known| known < image.step)
                }
            };
            self.go_on(is_kept, |this, image| {
                let whole = image.edge.whole;
                if whole >= first_layer {
                    this.last[whole].label(image.drawn.at, image.step)?;
                } else {
                    this.follow(&image)?;
                }
                Ok(())
            })?;
        }
        Ok(self.step)
    }

    /// Returns whether elements that are replaced without end cover a point of a step, and thereby all its
    /// images: when they are as short, they are born in at least as many steps, or nearly.
    fn is_covered(&self, whole: usize, drawn: &MappedPoint, step: u16) -> bool {
        const NEARLY: f64 = 1.25;
        const SPARE: f64 = 2.0;
        if !self.cores[whole].holds(drawn.at) {
            return false;
        }
        let node = &self.set.net.nodes[whole];
        let all = libm::log(node.stretch / self.shortest).max(0.0);
        let gone = -libm::log(stretch(&drawn.linear));
        let steps = self.last[whole].label_of(drawn.at).unwrap_or(0);
        (f64::from(step) - SPARE) * all <= NEARLY * f64::from(steps) * gone
    }
}

/// Returns the index of a size of cells; the smallest is for points that cannot be contracted any further.
fn size_of(ratio: f64) -> usize {
    let mut size = 0;
    let mut longest = SHORT;
    while ratio >= longest && size + 1 < MAX_SIZES {
        (size, longest) = (size + 1, longest * 2.0);
    }
    size
}

impl From<NoRoom> for Stopped {
    fn from(_: NoRoom) -> Self {
        Self::TooMany
    }
}
