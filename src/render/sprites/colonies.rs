//! Sprites of colonies: seeded fractals, alone or with all their descendant fractals.

use std::convert::Infallible;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::grow::{
    Colony, ColonyKind, ColonyKinds, Element, Enter, FractalInfo, Subtree, Taken, Visitor,
};
use crate::render::png::SpriteSheet;
use crate::render::scene::Scene;
use crate::render::surface::PlacedSprite;

use super::{FEWEST_IN_RUN, Key, LARGEST, LINEAR, Of, Painted, Reach, Sprites, outline, whole};

/// Steps per pixel, along each axis, of the grid on which colonies are put; half as many with strokes.
const PLACES: f64 = 64.0;

/// Minimum number of uses of a sprite of a whole colony, relative to that of other sprites.
const USES_OF_WHOLE: u64 = 5;
/// Number of elements of descendant fractals for which a whole colony needs one more use, if that is more:
/// these cost less as sprites of their own.
const SEEDED_A_USE: u64 = 12;

/// Maximum number of elements of a sprite of a whole colony.
const MOST_ELEMENTS: u64 = 1 << 10;

/// Colonies that are stamped in a pass.
pub(super) struct Colonies<'a> {
    kinds: &'a ColonyKinds,
    /// Means by kind.
    means: Vec<Means>,
    painted: Painted,
    phases: f64,
}

/// Decision about the colonies of a kind.
struct Means {
    /// Part of each that is taken.
    taken: Taken,
    /// Part of it that is painted.
    shows: Shows,
    /// Centre of a disc that contains it without strokes, in the unit frame of the seeding element.
    middle: DVec2,
    /// Radius of that disc, as a multiple of the length of the seeding element.
    radius: f64,
}

/// Part of a colony that is painted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shows {
    Nothing,
    /// Elements of the first fractal.
    Own,
    /// Elements of any fractal.
    Any,
}

/// Way to draw a colony.
pub(in crate::render) enum Put {
    /// No element of it is painted.
    Nothing,
    Sprite(PlacedSprite),
    /// Element by element.
    Elements,
}

impl<'a> Colonies<'a> {
    /// Creates the colonies of a scene, if any are numerous enough for sprites.
    pub(super) fn of(
        scene: &'a Scene<'a>,
        reach: &Reach,
        painted: Painted,
        strokes: bool,
    ) -> Option<Self> {
        let kinds = scene.colonies.get_or_init(|| {
            let shortest = scene.culling.shortest().unwrap_or(0.0);
            ColonyKinds::of(scene.graph, scene.growth.steps, shortest)
        });
        let phases = if strokes { PLACES / 2.0 } else { PLACES };
        let places = whole(phases * phases).unsigned_abs();
        let means = |kind| Means::of(scene, reach, kind, (painted, places));
        let means: Vec<_> = kinds.all.iter().map(means).collect();
        let is_any = means.iter().any(|means| means.taken != Taken::Nothing);
        is_any.then_some(Self {
            kinds,
            means,
            painted,
            phases,
        })
    }

    fn means(&self, colony: &Colony<'_>) -> Option<(usize, &Means)> {
        let number = self.kinds.number(colony)?;
        Some((number, &self.means[number]))
    }
}

impl Means {
    const NOTHING: Self = Self {
        taken: Taken::Nothing,
        shows: Shows::Nothing,
        middle: DVec2::ZERO,
        radius: 0.0,
    };

    /// Decides about the colonies of a kind, for sprites at `places` positions in a pixel.
    fn of(
        scene: &Scene<'_>,
        reach: &Reach,
        kind: &ColonyKind,
        (painted, places): (Painted, u64),
    ) -> Self {
        let uses = kind.count / places.saturating_mul(kind.turns).max(1);
        let instances = kind.instances(scene.graph);
        if uses < scene.uses || instances.is_empty() {
            return Self::NOTHING;
        }
        let discs = instances.iter().map(|instance| {
            let middle = instance.frame.apply(scene.graph.middle());
            let radius = reach.radii[instance.object] * instance.frame.stretch();
            (middle, radius)
        });
        #[expect(clippy::cast_precision_loss, reason = "few instances")]
        let count = instances.len() as f64;
        let middle = discs.clone().map(|(middle, _)| middle).sum::<DVec2>() / count;
        let radii = discs.map(|(other, radius)| other.distance(middle) + radius);
        let radius = radii.fold(0.0, f64::max);
        let length = kind.frame.stretch();
        if 2.0 * reach.pixels(scene, radius, length) > LARGEST {
            return Self::NOTHING;
        }
        let means = |taken, shows| Self {
            taken,
            shows,
            middle,
            radius,
        };
        let mut census = Census::of(scene);
        let example = kind.example(scene.graph);
        let whole = example.walk(true, &mut census).ok();
        let later = painted.meets(&census.births[1]);
        if whole.is_none() {
            census = Census::of(scene);
            if example.walk(false, &mut census).is_err() {
                return Self::NOTHING;
            }
        }
        let own = painted.meets(&census.births[0]);
        let shows = if own { Shows::Own } else { Shows::Nothing };
        let [elements, seeded] = census.counts;
        let least = scene.uses * USES_OF_WHOLE.max(seeded / SEEDED_A_USE);
        let is_worth = uses >= least && elements + seeded >= FEWEST_IN_RUN;
        match whole {
            Some(_) if !own && !later => means(Taken::Unseen, shows),
            Some(walked) if !later && elements >= FEWEST_IN_RUN => {
                means(Taken::Whole(walked), shows)
            }
            Some(walked) if is_worth => means(Taken::Whole(walked), Shows::Any),
            _ if elements >= FEWEST_IN_RUN => means(Taken::Own { elements }, shows),
            _ => Self::NOTHING,
        }
    }
}

impl Painted {
    /// Returns whether elements born in some steps, from the first to the last, may be painted.
    fn meets(self, births: &[u32; 2]) -> bool {
        match self {
            Self::Steps(first, last) => first <= births[1] && last >= births[0],
            Self::All | Self::Class(_) => births[0] <= births[1],
        }
    }
}

impl Sprites<'_> {
    /// Returns the part of a colony that is put as a sprite.
    pub(in crate::render) fn takes(&self, colony: &Colony<'_>) -> Taken {
        let means = self.colonies.as_ref().and_then(|all| all.means(colony));
        means.map_or(Taken::Nothing, |(_, means)| means.taken)
    }

    /// Returns the way to draw the part of a colony that is taken.
    pub(in crate::render) fn of_colony(&self, scene: &Scene<'_>, colony: &Colony<'_>) -> Put {
        let Some(colonies) = &self.colonies else {
            return Put::Elements;
        };
        match colonies.means(colony) {
            Some((_, means)) if means.shows == Shows::Nothing => Put::Nothing,
            Some((number, means)) => {
                let placed = self.placed(scene, colony, colonies, (number, means));
                placed.map_or(Put::Elements, Put::Sprite)
            }
            None => Put::Elements,
        }
    }

    fn placed(
        &self,
        scene: &Scene<'_>,
        colony: &Colony<'_>,
        colonies: &Colonies<'_>,
        (number, means): (usize, &Means),
    ) -> Option<PlacedSprite> {
        let kind = &colonies.kinds.all[number];
        let map = scene.canvas.map(&kind.turned(colony.frame().map()));
        let key = Key {
            of: Of::Colony(number),
            linear: map.matrix2.to_cols_array().map(|part| whole(part * LINEAR)),
            painted: colonies.painted.since(colony.born()),
        };
        let length = kind.frame.stretch() * scene.canvas.scale();
        self.put(&key, map.translation, colonies.phases, |phase| {
            let linear = turned(&map.matrix2, &key.linear, length);
            let reach = { &self.reach }.pixels(scene, means.radius, length / scene.canvas.scale());
            let draw = |map: DAffine2, sheet: &mut SpriteSheet| {
                let mut points = Vec::new();
                let mut visitor = Members {
                    scene,
                    scale: scene.canvas.scale(),
                    painted: colonies.painted,
                    see: |element: &Element| outline(scene, element, &mut points, sheet),
                };
                // The walk cannot fail: its length has been limited before.
                let moved = colony.moved_to(map);
                let _ = moved.walk(means.shows == Shows::Any, &mut visitor);
            };
            self.drawn(linear, phase, (linear * means.middle, reach), draw)
        })
    }

    /// Passes the painted elements of the part of a colony that is taken to a function.
    pub(in crate::render) fn see(
        &self,
        scene: &Scene<'_>,
        colony: &Colony<'_>,
        see: impl FnMut(&Element),
    ) {
        let Some(colonies) = &self.colonies else {
            return;
        };
        let mut visitor = Members {
            scene,
            scale: 1.0,
            painted: colonies.painted,
            see,
        };
        let is_whole = !matches!(self.takes(colony), Taken::Own { .. });
        let _ = colony.walk(is_whole, &mut visitor);
    }
}

/// Computes the similarity with a given length whose first axis has the direction of a quantised map.
fn turned(map: &DMat2, steps: &[i64; 4], length: f64) -> DMat2 {
    #[expect(clippy::cast_precision_loss, reason = "steps in a small picture")]
    let along = DVec2::new(steps[0] as f64, steps[1] as f64);
    let along = if along == DVec2::ZERO {
        map.x_axis
    } else {
        along
    };
    let x_axis = along * (length / along.length());
    let across = if map.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat2::from_cols(x_axis, x_axis.perp() * across)
}

/// Visitor of the painted elements of a colony.
struct Members<'s, F> {
    scene: &'s Scene<'s>,
    /// Units of the walk per unit of the rule.
    scale: f64,
    painted: Painted,
    see: F,
}

impl<F: FnMut(&Element)> Visitor for Members<'_, F> {
    type Error = Infallible;

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        if self
            .scene
            .culling
            .is_short(subtree.frame.stretch() / self.scale)
        {
            return Enter::Keep;
        }
        match self.painted {
            Painted::Steps(_, last) if subtree.born >= last => Enter::Skip,
            _ => Enter::Replace,
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        let is_painted = match self.painted {
            Painted::All => true,
            Painted::Steps(first, last) => (first..=last).contains(&element.born),
            Painted::Class(class) => {
                let object = &self.scene.graph.objects()[element.object];
                self.scene.classes.of_object(object) == Some(class)
            }
        };
        if is_painted {
            (self.see)(element);
        }
        Ok(())
    }
}

/// Counts the elements of a colony and records their births, for its first fractal and for the others.
struct Census<'s> {
    scene: &'s Scene<'s>,
    is_seeded: bool,
    counts: [u64; 2],
    births: [[u32; 2]; 2],
}

impl<'s> Census<'s> {
    fn of(scene: &'s Scene<'s>) -> Self {
        Self {
            scene,
            is_seeded: false,
            counts: [0; 2],
            births: [[u32::MAX, 0]; 2],
        }
    }
}

/// Error that a colony has too many elements.
struct TooMany;

impl Visitor for Census<'_> {
    type Error = TooMany;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), TooMany> {
        self.is_seeded = fractal.number > 0;
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        if self.scene.culling.is_short(subtree.frame.stretch()) {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), TooMany> {
        let part = usize::from(self.is_seeded);
        self.counts[part] += 1;
        let [first, last] = self.births[part];
        self.births[part] = [first.min(element.born), last.max(element.born)];
        if self.counts.iter().sum::<u64>() > MOST_ELEMENTS {
            return Err(TooMany);
        }
        Ok(())
    }
}
