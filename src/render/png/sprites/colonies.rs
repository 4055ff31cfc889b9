//! Sprites of colonies: seeded fractals, alone or with all their descendant fractals.

use std::convert::Infallible;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::grow::{
    Colony, ColonyKind, ColonyKinds, Element, Enter, FractalInfo, Subtree, Taken, Visitor,
    WalkError, Walked,
};
use crate::render::contribution::Painted;
use crate::render::png::coverage::SpriteSheet;
use crate::render::png::raster::PlacedSprite;
use crate::render::scene::Scene;

use super::{Key, LARGEST, LINEAR, MIN_IN_RUN, Of, Reach, Sprites, outline, whole};

/// Steps per pixel, along each axis, of the grid on which colonies are put; half as many with strokes.
const PLACES: f64 = 64.0;

/// Minimum number of uses of a sprite of a whole colony, relative to that of other sprites.
const USES_OF_WHOLE: u64 = 5;
/// Number of elements of descendant fractals for which a whole colony needs one more use, if that is more:
/// these cost less as sprites of their own.
const SEEDED_A_USE: u64 = 12;

/// Maximum number of elements of a sprite of a whole colony.
const MAX_ELEMENTS: u64 = 1 << 10;

/// Colonies that are drawn as sprites in a pass.
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
        let example = kind.example(scene.graph);
        let mut census = [Census::NOTHING; 2];
        let whole = count_members(scene, &example, true, &mut census).ok();
        let later = may_paint(painted, census[1].births);
        if whole.is_none() && count_members(scene, &example, false, &mut census).is_err() {
            return Self::NOTHING;
        }
        let own = may_paint(painted, census[0].births);
        let shows = if own { Shows::Own } else { Shows::Nothing };
        let [elements, seeded] = census.map(|part| part.elements);
        let least = scene.uses * USES_OF_WHOLE.max(seeded / SEEDED_A_USE);
        let is_worth = uses >= least && elements + seeded >= MIN_IN_RUN;
        match whole {
            Some(_) if !own && !later => means(Taken::Unseen, shows),
            Some(walked) if !later && elements >= MIN_IN_RUN => means(Taken::Whole(walked), shows),
            Some(walked) if is_worth => means(Taken::Whole(walked), Shows::Any),
            _ if elements >= MIN_IN_RUN => means(Taken::Own { elements }, shows),
            _ => Self::NOTHING,
        }
    }
}

/// Returns whether elements born in some steps, from the first to the last, may be painted.
fn may_paint(painted: Painted, births: [u32; 2]) -> bool {
    match painted {
        Painted::Steps(first, last) => first <= births[1] && last >= births[0],
        Painted::All | Painted::Class(_) => births[0] <= births[1],
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
            let reach = self
                .reach
                .pixels(scene, means.radius, length / scene.canvas.scale());
            let draw = |map: DAffine2, sheet: &mut SpriteSheet| {
                let mut points = Vec::new();
                let mut visitor = Members {
                    scale: scene.canvas.scale(),
                    ..Members::of(scene, colonies.painted, |element: &Element, _| {
                        outline(scene, element, &mut points, sheet);
                        Ok::<_, Infallible>(())
                    })
                };
                // The walk cannot fail: its length has been limited before.
                let _ = colony
                    .moved_to(map)
                    .walk(means.shows == Shows::Any, &mut visitor);
            };
            self.drawn(linear, phase, (linear * means.middle, reach), draw)
        })
    }

    /// Passes the painted elements of the part of a colony that is taken to a function.
    pub(in crate::render) fn see(
        &self,
        scene: &Scene<'_>,
        colony: &Colony<'_>,
        mut see: impl FnMut(&Element),
    ) {
        let Some(colonies) = &self.colonies else {
            return;
        };
        let mut visitor = Members::of(scene, colonies.painted, |element: &Element, _| {
            see(element);
            Ok::<_, Infallible>(())
        });
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

/// Number of a colony's elements, and the first and last step in which any of them is born.
#[derive(Clone, Copy)]
struct Census {
    elements: u64,
    births: [u32; 2],
}

impl Census {
    const NOTHING: Self = Self {
        elements: 0,
        births: [u32::MAX, 0],
    };
}

/// Error that a colony has too many elements.
struct TooMany;

/// Counts the elements of a colony, or of its first fractal: those of the first fractal, and those of the others.
fn count_members(
    scene: &Scene<'_>,
    colony: &Colony<'_>,
    is_whole: bool,
    census: &mut [Census; 2],
) -> Result<Walked, WalkError<TooMany>> {
    *census = [Census::NOTHING; 2];
    let mut visitor = Members::of(scene, Painted::All, |element: &Element, is_seeded| {
        let Census { elements, births } = &mut census[usize::from(is_seeded)];
        *elements += 1;
        *births = [births[0].min(element.born), births[1].max(element.born)];
        let all: u64 = census.iter().map(|part| part.elements).sum();
        if all > MAX_ELEMENTS {
            return Err(TooMany);
        }
        Ok(())
    });
    colony.walk(is_whole, &mut visitor)
}

/// Visitor of the painted elements of a colony.
struct Members<'s, F> {
    scene: &'s Scene<'s>,
    /// Units of the walk per unit of the rule.
    scale: f64,
    painted: Painted,
    /// Whether the current fractal is not the first.
    is_seeded: bool,
    /// Receives the elements, each with whether it is not of the first fractal.
    see: F,
}

impl<'s, F> Members<'s, F> {
    fn of(scene: &'s Scene<'s>, painted: Painted, see: F) -> Self {
        Self {
            scene,
            scale: 1.0,
            painted,
            is_seeded: false,
            see,
        }
    }
}

impl<E, F: FnMut(&Element, bool) -> Result<(), E>> Visitor for Members<'_, F> {
    type Error = E;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), E> {
        self.is_seeded = fractal.number > 0;
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let length = subtree.frame.stretch() / self.scale;
        match self.painted {
            _ if self.scene.culling.is_short(length) => Enter::Keep,
            Painted::Steps(_, last) if subtree.born >= last => Enter::Skip,
            _ => Enter::Replace,
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), E> {
        if self.painted.has(self.scene, element) {
            (self.see)(element, self.is_seeded)?;
        }
        Ok(())
    }
}
