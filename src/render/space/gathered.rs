//! Instances that lie so close together that few stand for many, as the blades of a distant meadow do.
//!
//! A form may have any number of instances inside another. Where the middles of all that have one form lie within a detail, along each
//! axis, and the instances are more than the forms, each form is drawn once: in the middle of its instances, and grown by their
//! distance from it, so that it covers about what they do.

use crate::geometry::{Bounds, DVec3};
use crate::instancing::Appearance;

use super::forms::{Form, Forms};
use super::scene::{self, End, Part};

/// Limit of the number of forms that stand for what is in another.
const MAX_GATHERED: usize = 32;

/// All instances of a form inside another.
#[derive(Clone)]
pub(super) struct Gathered {
    pub(super) form: usize,
    /// Class of the instances, if one begins inside the outer form.
    pub(super) class: Option<u16>,
    /// Tints of the instances inside the outer form.
    pub(super) appearance: Appearance,
    /// Middles of the instances, from that of the outer form.
    places: Bounds<DVec3>,
}

impl Gathered {
    /// Returns the vector from the middle of the outer form to that of the solid that is drawn.
    pub(super) fn offset(&self) -> DVec3 {
        self.places.centre()
    }

    /// Returns the distance from the middle within which the instances lie, along each axis.
    pub(super) fn reach(&self) -> f64 {
        self.places.size().max_element() / 2.0
    }

    fn is_alike(&self, other: &Self) -> bool {
        (self.form, self.class) == (other.form, other.class) && self.appearance == other.appearance
    }
}

/// Content of a form, as far as it has been gathered.
struct Content {
    gathered: Vec<Gathered>,
    /// Number of instances.
    count: u64,
}

/// Gathers what is in the forms whose instances are known, the inner ones first. `scale` is the least number of samples a unit.
pub(super) fn gather(forms: &mut Forms, parts: &[Part], end: &End, scale: f64) {
    let reach = end.detail / 2.0 / scale;
    let mut contents: Vec<Option<Content>> = Vec::new();
    contents.resize_with(forms.known.len(), || None);
    for number in forms.inner_first() {
        contents[number] = content(forms, parts, end, (number, &contents), reach);
        let few = { contents[number].as_ref() }.filter(|it| it.count > it.gathered.len() as u64);
        let mut few = few.map(|it| it.gathered.clone()).unwrap_or_default();
        // From near to far.
        let near = |own: &Gathered| own.places.max().z + forms.known[own.form].half.z;
        few.sort_by(|a, b| near(b).total_cmp(&near(a)));
        forms.known[number].gathered = few.into_boxed_slice();
    }
}

/// Returns the content of a form; `None` if it is not known to the last, has too many forms, or lies farther than `reach` from its middles.
fn content(
    forms: &Forms,
    parts: &[Part],
    end: &End,
    (number, inner): (usize, &[Option<Content>]),
    reach: f64,
) -> Option<Content> {
    let form = &forms.known[number];
    let Some(steps) = forms.steps(form) else {
        let is_last = scene::ends(parts, form, end);
        return is_last.then(|| Content {
            gathered: vec![Gathered {
                form: number,
                class: None,
                appearance: Appearance::NONE,
                places: Bounds::new(DVec3::ZERO, DVec3::ZERO),
            }],
            count: 1,
        });
    };
    let mut content = Content {
        gathered: Vec::new(),
        count: 0,
    };
    for step in steps {
        let inner = inner[step.form].as_ref()?;
        let tint = parts[forms.known[step.form].object].appearance;
        content.count = content.count.saturating_add(inner.count);
        for own in &inner.gathered {
            let own = Gathered {
                class: step.class.or(own.class),
                appearance: tint.over(own.appearance),
                places: Bounds::new(
                    own.places.min() + step.offset,
                    own.places.max() + step.offset,
                ),
                ..*own
            };
            match content
                .gathered
                .iter_mut()
                .find(|known| known.is_alike(&own))
            {
                Some(known) => known.places.add_all(&own.places),
                None => content.gathered.push(own),
            }
        }
        let is_close = |own: &Gathered| own.reach() <= reach;
        if content.gathered.len() > MAX_GATHERED || !content.gathered.iter().all(is_close) {
            return None;
        }
    }
    Some(content)
}

impl Form {
    /// Returns what stands for all that is in the form, if all instances of a form lie within a detail. `scale` is the number of samples a unit.
    pub(super) fn gathered(&self, end: &End, scale: f64) -> Option<&[Gathered]> {
        let is_close = |own: &Gathered| 2.0 * own.reach() * scale <= end.detail;
        let gathered = &*self.gathered;
        (!gathered.is_empty() && gathered.iter().all(is_close)).then_some(gathered)
    }
}

#[cfg(test)]
mod tests {
    use super::super::buffer::SAMPLES;
    use super::super::tests::{FirstTile, Short, graph_of};
    use crate::style::Camera;

    /// A meadow of 512 × 512 blades, of which 64 are within a pixel.
    #[test]
    fn few_blades_stand_for_a_meadow() {
        let graph = graph_of(
            "kind: instancing
space: 3
objects:
  field(0): [{object: cone, scale: [0.01, 0.1, 0.01], rotate: {z: 20}}]
  field(n):
    - {object: field(n - 1), translate: [-2^(n - 11), 0, -2^(n - 11)]}
    - {object: field(n - 1), rotate: {y: 90}, translate: [2^(n - 11), 0, -2^(n - 11)]}
    - {object: field(n - 1), rotate: {y: 180}, translate: [-2^(n - 11), 0, 2^(n - 11)]}
    - {object: field(n - 1), scale: [-1, 1, 1], translate: [2^(n - 11), 0, 2^(n - 11)]}
scene: [field(9)]
",
        );
        let camera = Camera::default().from([20.0, 50.0]);
        let [exact, gathered] = [Short::Exact, Short::Cut]
            .map(|short| FirstTile::draw(&graph, Some(20), (&camera, 64, SAMPLES as f64), short));
        for (one, other) in [(&gathered, &exact), (&exact, &gathered)] {
            let (ink, share) = one.away_from(other, SAMPLES);
            assert!(ink > 20_000 && share < 0.01, "{share} of {ink}");
        }
        let [few, all] = [gathered.drawn, exact.drawn];
        assert!(few * 4 < all, "{few} of {all}");
    }
}
