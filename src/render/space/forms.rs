//! Forms of instances: an object under the linear part of a map.
//!
//! Instances of one form differ by a translation. A system has few forms where its maps have few linear parts:
//! they are found before the descent, with their instances from far to near, and a parallel picture shows small
//! ones as copies of one [stamp](super::stamp::Stamp).

use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

use crate::geometry::{Bounds, DMat3, DVec3};

use super::camera::{Placement, Projection};
use super::scene::{Child, ClassBy, End, Part};
use super::stamp::{PHASES, PIECE, REACH, Stamp};
use super::{buffer::MAX_CLASS, scene};

/// Limit of the number of forms that are known before the descent.
pub(super) const MAX_FORMS: usize = 1 << 12;

/// Limit of the number of elements of a stamp.
const MAX_ELEMENTS: u64 = 1 << 12;

/// Limit of the number of samples of all stamps, in one position each.
const MAX_SAMPLES: f64 = (1 << 16) as f64;

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
    /// Its pictures in all positions relative to a sample, if it is small enough to have them.
    pub(super) stamps: Option<Box<[OnceLock<Stamp>]>>,
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
            stamps: None,
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

/// The forms that are known before the descent, those of outer instances first.
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
        let scale = match placement.projection {
            Projection::Parallel => 1.0,
            Projection::Central { focus, .. } if near < 0.0 => focus / -near,
            Projection::Central { focus, .. } => focus / (near - far),
        };
        let reach = parts.iter().map(|part| part.hull.reach());
        let mut finder = Finder {
            parts,
            class_by,
            fine: FINE * scale * reach.fold(0.0, f64::max),
            names: Names::new(),
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
        let mut next = 0;
        while next < finder.forms.known.len() && finder.forms.known.len() < MAX_FORMS {
            let form = &finder.forms.known[next];
            if !scene::ends(parts, form, end) && !form.is_small(end, scale) {
                finder.expand(next);
            }
            next += 1;
        }
        let mut forms = finder.forms;
        if let Projection::Parallel = placement.projection {
            forms.tighten();
            forms.count(parts, end);
            if has_stamps {
                forms.admit_stamps(pad);
            }
        }
        forms
    }

    /// Returns the instances in a form, from far to near, if they are known.
    #[inline]
    pub(super) fn steps(&self, form: &Form) -> Option<&[Step]> {
        form.steps.clone().map(|steps| &self.steps[steps])
    }

    /// Replaces the boxes of forms by those around the boxes of their instances, the inner ones first: boxes of turned hulls are
    /// larger than what they contain. Parallel pictures never draw the hull of a form whose instances are known.
    fn tighten(&mut self) {
        let mut moved = vec![DVec3::ZERO; self.known.len()];
        for number in (0..self.known.len()).rev() {
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

    /// Counts the elements of all forms, the inner ones first.
    fn count(&mut self, parts: &[Part], end: &End) {
        for number in (0..self.known.len()).rev() {
            let form = &self.known[number];
            let elements = match self.steps(form) {
                Some(steps) => steps.iter().try_fold(0, |sum: u64, step| {
                    let inner = self.known[step.form].elements;
                    let sum = sum.checked_add(inner)?;
                    (inner > 0 && sum <= MAX_ELEMENTS).then_some(sum)
                }),
                None if scene::ends(parts, form, end) || form.is_small(end, 1.0) => {
                    // Stamps consist of planes.
                    let drawn = parts[form.object].drawn(form.level, end);
                    let is_round = drawn.is_some_and(|solid| solid.primitive().is_some());
                    (!is_round).then_some(1)
                }
                None => None,
            };
            self.known[number].elements = elements.unwrap_or(0);
        }
    }

    /// Admits stamps of forms as large as there is memory for.
    fn admit_stamps(&mut self, pad: f64) {
        let mut reach = REACH;
        loop {
            let fits =
                |form: &Form| form.elements > 0 && form.half.x.max(form.half.y) + pad <= reach;
            let samples = self.known.iter().filter(|form| fits(form)).map(|form| {
                let sides = 2.0 * (form.half + pad + 1.0);
                // Rows consist of pieces.
                (sides.x + PIECE as f64) * sides.y
            });
            if samples.sum::<f64>() <= MAX_SAMPLES {
                for form in self.known.iter_mut().filter(|form| fits(form)) {
                    let stamps = (0..PHASES * PHASES).map(|_| OnceLock::new());
                    form.stamps = Some(stamps.collect());
                }
                return;
            }
            reach /= 2.0;
        }
    }
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
            known.push(form);
            known.len() - 1
        })
    }

    /// Finds the instances in a form.
    fn expand(&mut self, number: usize) {
        let parts = self.parts;
        let mut steps: Vec<Step> = Vec::new();
        for child in &parts[self.forms.known[number].object].children {
            let outer = &self.forms.known[number];
            let inner = outer.inner(parts, child);
            let offset = outer.offset(child, &inner);
            let class = match (self.class_by, outer.level) {
                (ClassBy::LastMap, 0) => Some(class(parts[child.object].origin)),
                _ => None,
            };
            let form = self.number(inner);
            let is_known =
                |step: &Step| step.form == form && step.offset.abs_diff_eq(offset, 1.0 / FINE);
            if !steps.iter().any(is_known) {
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
