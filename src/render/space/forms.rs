//! Forms of instances: an object under the linear part of a map.
//!
//! Instances of one form differ by a translation. A system has few forms where its maps have few linear parts:
//! they are found before the descent, with their instances from far to near, and a parallel picture shows small
//! ones as copies of one [stamp](super::stamp::Stamp). Where they are too many, objects of few forms come first.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::ops::Range;

use crate::fast_hash::FastSet;
use crate::geometry::{Bounds, DMat3, DVec3};

use super::camera::{Placement, Projection};
use super::gathered::{Gathered, gather};
use super::scene::{Child, ClassBy, End, Part};
use super::stamp::{COARSE_PHASES, PHASES, PIECE, REACH, Stamps};
use super::{buffer::MAX_CLASS, scene};

/// Limit of the number of forms that are known before the descent.
pub(super) const MAX_FORMS: usize = 1 << 12;

/// Limit of the number of instances in all forms that are known.
const MAX_STEPS: usize = 1 << 20;

/// Limit of the number of elements of a stamp.
const MAX_ELEMENTS: u64 = 1 << 12;

/// Limit of the number of samples of all small stamps, in one position each.
const MAX_SAMPLES: f64 = (1 << 16) as f64;

/// Limit of the number of samples of all large stamps, in all positions.
const MAX_LARGE_SAMPLES: f64 = (1 << 21) as f64;

/// Largest half side of a form that has stamps as exact as those of small forms, in samples.
const FINE_REACH: f64 = 48.0;

/// Largest half side of a form that has stamps, in samples.
const LARGE: f64 = 128.0;

/// Number of instances from which a form has large stamps.
const MANY: f64 = 256.0;

/// Limit of the number of elements of a large stamp.
const FEW: u64 = 64;

/// Number of samples of a large stamp beside one of its elements, up to which a copy takes less than these.
const MAX_SHARE: f64 = 4.0;

/// Fraction of a sample by which equal forms may differ.
const FINE: f64 = (1 << 24) as f64;

/// Relative tolerance of lengths: a cell of exactly a pixel is not replaced.
const ROUNDING: f64 = 1e-9;

/// An object under a linear map.
pub(super) struct Form {
    pub(super) object: usize,
    pub(super) level: u32,
    pub(super) linear: DMat3,
    /// Upper bound of the stretch.
    pub(super) length: f64,
    /// Middle of the box around the subtree, from the origin of the object.
    pub(super) middle: DVec3,
    /// Half sides of the box.
    pub(super) half: DVec3,
    /// Middle of the box of the hull, from the origin of the object.
    pub(super) centre: DVec3,
    /// Largest side across the view of the box of the hull, by which the size of an instance is judged.
    across: f64,
    /// Places of its instances in the table, if they are known.
    steps: Option<Range<usize>>,
    /// Number of elements of which it consists; 0 if it is not known to the last, or has too many.
    elements: u64,
    /// Number of samples of all its elements together.
    area: f64,
    /// Half of the longest side of its largest element, across the view.
    reach: f64,
    /// Its pictures in positions relative to a sample, if it has any.
    pub(super) stamps: Option<Stamps>,
    /// Forms that stand for what is in it, where they are far fewer and lie close together.
    pub(super) gathered: Box<[Gathered]>,
}

impl Form {
    /// Creates the form of an instance in a form.
    pub(super) fn inner(&self, parts: &[Part], child: &Child) -> Self {
        let linear = self.linear * child.map.matrix3;
        let placed = (child.object, self.level + 1);
        Self::new(parts, placed, linear, self.length * child.length)
    }

    /// Creates the form of an object at a level under a linear map.
    pub(super) fn new(
        parts: &[Part],
        (object, level): (usize, u32),
        linear: DMat3,
        length: f64,
    ) -> Self {
        let (middle, half) = parts[object].hull.image(&linear);
        Self {
            object,
            level,
            linear,
            length,
            middle,
            half,
            centre: middle,
            across: 2.0 * half.x.max(half.y),
            steps: None,
            elements: 0,
            area: 0.0,
            reach: 0.0,
            stamps: None,
            gathered: Box::default(),
        }
    }

    /// Returns the vector from the middle of the form to that of an instance in it, whose form is given.
    pub(super) fn offset(&self, child: &Child, inner: &Self) -> DVec3 {
        self.linear * child.map.translation + inner.middle - self.middle
    }

    /// Returns whether the form is too small to be replaced. `scale` is the number of samples a unit.
    #[inline]
    pub(super) fn is_small(&self, end: &End, scale: f64) -> bool {
        self.across.min(self.length * end.unit) * scale <= end.detail * (1.0 + ROUNDING)
    }
}

/// An instance in a form.
pub(super) struct Step {
    /// From the middle of the form to that of the instance.
    pub(super) offset: DVec3,
    pub(super) form: usize,
    /// Class of all that is in the instance, where it begins one.
    pub(super) class: Option<u16>,
}

/// The forms that are known before the descent.
pub(super) struct Forms {
    pub(super) known: Vec<Form>,
    steps: Vec<Step>,
    /// The instances of the initiator, from far to near: offsets are positions.
    pub(super) start: Vec<Step>,
}

/// Forms by level, kind of object, and linear part.
type Names = HashMap<(u32, usize, [i64; 9]), usize>;

struct Finder<'a> {
    parts: &'a [Part],
    class_by: ClassBy,
    /// Multiples of the unit in which linear parts are compared.
    fine: f64,
    names: Names,
    /// Number of forms of each kind.
    counts: Vec<usize>,
    /// Forms to be expanded: those of kinds that have the fewest first, and of these, the first.
    next: BinaryHeap<Reverse<(usize, usize)>>,
    forms: Forms,
}

impl Forms {
    /// Finds forms, from the initiator on. They have stamps where the classes of samples are known before the descent.
    pub(super) fn find(
        parts: &[Part],
        start: &[Child],
        end: &End,
        class_by: ClassBy,
        placement: &Placement,
        pad: f64,
        has_stamps: bool,
    ) -> Self {
        let [far, near] = placement.range;
        // The number of samples a unit at the near and at the far end.
        let [scale, least] = match placement.projection {
            Projection::Parallel => [1.0; 2],
            Projection::Central { focus, .. } if near < 0.0 => [focus / -near, focus / -far],
            Projection::Central { focus, .. } => [focus / (near - far); 2],
        };
        let reach = parts.iter().map(|part| part.hull.reach());
        let mut finder = Finder {
            parts,
            class_by,
            fine: FINE * scale * reach.fold(0.0, f64::max),
            names: Names::new(),
            counts: vec![0; 2 * parts.len()],
            next: BinaryHeap::new(),
            forms: Self {
                known: Vec::new(),
                steps: Vec::new(),
                start: Vec::new(),
            },
        };
        for child in start {
            let linear = child.map.matrix3;
            let form = Form::new(parts, (child.object, 0), linear, child.length);
            let offset = child.map.translation + form.middle;
            let form = finder.number(form);
            finder.forms.start.push(Step {
                offset,
                form,
                class: None,
            });
        }
        finder.forms.start.reverse();
        sort(&mut finder.forms.start, &finder.forms.known);
        while finder.forms.known.len() < MAX_FORMS
            && let Some(Reverse((_, number))) = finder.next.pop()
        {
            let form = &finder.forms.known[number];
            if !scene::ends(parts, form, end) && !form.is_small(end, scale) {
                finder.expand(number);
            }
        }
        let mut forms = finder.forms;
        let is_parallel = matches!(placement.projection, Projection::Parallel);
        if is_parallel {
            forms.tighten();
        }
        gather(&mut forms, parts, end, least);
        if is_parallel && has_stamps {
            forms.count(parts, end);
            forms.admit_stamps(pad);
            forms.admit_large_stamps(pad, end);
        }
        forms
    }

    /// Returns the instances in a form, from far to near, if they are known.
    #[inline]
    pub(super) fn steps(&self, form: &Form) -> Option<&[Step]> {
        form.steps.clone().map(|steps| &self.steps[steps])
    }

    /// Returns the numbers of the forms, the inner ones first.
    pub(super) fn inner_first(&self) -> Vec<usize> {
        let mut numbers: Vec<usize> = (0..self.known.len()).rev().collect();
        numbers.sort_by_key(|number| Reverse(self.known[*number].level));
        numbers
    }

    /// Replaces the boxes of forms by those around the boxes of their instances, the inner ones first: boxes of turned hulls are
    /// larger than what they contain. Parallel pictures never draw the hull of a form whose instances are known.
    fn tighten(&mut self) {
        let mut moved = vec![DVec3::ZERO; self.known.len()];
        for number in self.inner_first() {
            let Some(range) = self.known[number].steps.clone().filter(|it| !it.is_empty()) else {
                continue;
            };
            let steps = &mut self.steps[range];
            let mut bounds = Bounds::EMPTY;
            for step in &mut *steps {
                step.offset += moved[step.form];
                let half = self.known[step.form].half;
                bounds.add(step.offset - half);
                bounds.add(step.offset + half);
            }
            let form = &mut self.known[number];
            // The hull limits the box, too.
            let (min, max) = (bounds.min().max(-form.half), bounds.max().min(form.half));
            let middle = (min + max) / 2.0;
            moved[number] = middle;
            form.middle += middle;
            form.half = ((max - min) / 2.0).max(DVec3::ZERO);
            steps.iter_mut().for_each(|step| step.offset -= middle);
            sort(steps, &self.known);
        }
        for step in &mut self.start {
            step.offset += moved[step.form];
        }
        sort(&mut self.start, &self.known);
    }

    /// Counts the elements of all forms, and adds up their areas, the inner ones first.
    fn count(&mut self, parts: &[Part], end: &End) {
        for number in self.inner_first() {
            let form = &self.known[number];
            let (elements, area, reach) = if let Some(gathered) = form.gathered(end, 1.0) {
                let halves = gathered
                    .iter()
                    .map(|own| self.known[own.form].half + own.reach());
                let (area, reach) = of_elements(halves.map(|half| (area(half), across(half))));
                (Some(gathered.len() as u64), area, reach)
            } else if let Some(steps) = self.steps(form) {
                let inner = || steps.iter().map(|step| &self.known[step.form]);
                let elements = inner().try_fold(0, |sum: u64, inner| {
                    let sum = sum.checked_add(inner.elements)?;
                    (inner.elements > 0 && sum <= MAX_ELEMENTS).then_some(sum)
                });
                let (area, reach) = of_elements(inner().map(|inner| (inner.area, inner.reach)));
                (elements, area, reach)
            } else {
                let is_last = scene::ends(parts, form, end) || form.is_small(end, 1.0);
                (is_last.then_some(1), area(form.half), across(form.half))
            };
            let form = &mut self.known[number];
            (form.elements, form.area, form.reach) = (elements.unwrap_or(0), area, reach);
        }
    }

    /// Admits stamps of small forms, as large as there is memory for.
    fn admit_stamps(&mut self, pad: f64) {
        let mut reach = REACH;
        loop {
            let fits = |form: &Form| form.elements > 0 && across(form.half) + pad <= reach;
            let samples = self.known.iter().filter(|form| fits(form));
            if samples.map(|form| samples_of(form, pad)).sum::<f64>() <= MAX_SAMPLES {
                for form in self.known.iter_mut().filter(|form| fits(form)) {
                    form.stamps = Some(Stamps::new(PHASES, false));
                }
                return;
            }
            reach /= 2.0;
        }
    }

    /// Admits stamps of larger forms that have many instances, where a copy takes less than its few elements, which are too large for
    /// small stamps.
    fn admit_large_stamps(&mut self, pad: f64, end: &End) {
        let mut instances = vec![0.0; self.known.len()];
        for step in &self.start {
            instances[step.form] += 1.0;
        }
        let mut samples = 0.0;
        for number in self.inner_first().into_iter().rev() {
            let form = &self.known[number];
            let is_gathered = form.gathered(end, 1.0).is_some();
            let is_coarse = is_gathered || across(form.half) > FINE_REACH;
            let phases = if is_coarse { COARSE_PHASES } else { PHASES };
            let own = samples_of(form, pad) * (phases * phases) as f64;
            let is_apt = instances[number] >= MANY
                && (1..=FEW).contains(&form.elements)
                && form.reach > REACH
                && across(form.half) <= LARGE
                && area(form.half) <= MAX_SHARE * form.area
                && samples + own <= MAX_LARGE_SAMPLES;
            if is_apt && form.stamps.is_none() {
                samples += own;
                self.known[number].stamps = Some(Stamps::new(phases, true));
            } else if form.stamps.is_none() && !is_gathered {
                // Instances inside stamps are not visited.
                for step in form.steps.clone().into_iter().flatten() {
                    let inner = self.steps[step].form;
                    instances[inner] += instances[number];
                }
            }
        }
    }
}

/// Returns the sum of areas and the largest reach.
fn of_elements(elements: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    elements.fold((0.0, 0.0), |(sum, most), (area, reach)| {
        (sum + area, reach.max(most))
    })
}

/// Returns half of the longest side of a box across the view.
fn across(half: DVec3) -> f64 {
    half.x.max(half.y)
}

/// Returns the number of samples in the picture of a box.
fn area(half: DVec3) -> f64 {
    4.0 * (half.x + 0.5) * (half.y + 0.5)
}

/// Returns the number of samples of a stamp, in one position.
fn samples_of(form: &Form, pad: f64) -> f64 {
    let sides = 2.0 * (form.half + pad + 1.0);
    // Rows consist of pieces.
    (sides.x + PIECE as f64) * sides.y
}

impl Finder<'_> {
    /// Returns the number of a form, which is known from then on.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "casts from floats saturate"
    )]
    fn number(&mut self, form: Form) -> usize {
        let kind = match self.class_by {
            ClassBy::FirstMap | ClassBy::Tint => form.object,
            _ => self.parts[form.object].kind,
        };
        let numbers = form.linear.to_cols_array();
        let linear = numbers.map(|value| (value * self.fine).round() as i64);
        let known = &mut self.forms.known;
        let name = (form.level, kind, linear);
        *self.names.entry(name).or_insert_with(|| {
            self.next.push(Reverse((self.counts[kind], known.len())));
            self.counts[kind] += 1;
            known.push(form);
            known.len() - 1
        })
    }

    /// Finds the instances in a form.
    fn expand(&mut self, number: usize) {
        let parts = self.parts;
        let children = &parts[self.forms.known[number].object].children;
        if self.forms.steps.len() + children.len() > MAX_STEPS {
            return;
        }
        let mut steps: Vec<Step> = Vec::new();
        let mut places = FastSet::default();
        for child in children {
            let outer = &self.forms.known[number];
            let inner = outer.inner(parts, child);
            let offset = outer.offset(child, &inner);
            let class = match (self.class_by, outer.level) {
                (ClassBy::LastMap, 0) => Some(class(parts[child.object].origin)),
                _ => None,
            };
            let form = self.number(inner);
            let place = offset
                .to_array()
                .map(|part| ((part * FINE).round() + 0.0).to_bits());
            if places.insert((form, place)) {
                steps.push(Step {
                    offset,
                    form,
                    class,
                });
            }
        }
        steps.reverse();
        sort(&mut steps, &self.forms.known);
        let first = self.forms.steps.len();
        self.forms.steps.extend(steps);
        self.forms.known[number].steps = Some(first..self.forms.steps.len());
    }
}

/// Sorts instances: the nearest last. Equally near ones keep their order.
fn sort(steps: &mut [Step], forms: &[Form]) {
    let near = |step: &Step| step.offset.z + forms[step.form].half.z;
    steps.sort_by(|a, b| near(a).total_cmp(&near(b)));
}

/// Returns the class of a map.
pub(super) fn class(map: Option<usize>) -> u16 {
    map.map_or(0, |map| u16::try_from(map).unwrap_or(MAX_CLASS))
}
