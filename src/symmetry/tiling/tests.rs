//! Wallpaper and frieze groups, recognised by their isometries.

use super::*;
use crate::random::Pcg;
use crate::saturating::whole;
use crate::style::Named;

const NEAR: f64 = 1e-9;

/// Kinds of the isometries of a group, found from their maps alone.
struct Found {
    /// Order and centre of every rotation.
    centres: Vec<(f64, DVec2)>,
    /// Direction and a point of the axis of every reflection.
    mirrors: Vec<(DVec2, DVec2)>,
    /// Direction and a point of the axis of every glide reflection.
    glides: Vec<(DVec2, DVec2)>,
}

impl Found {
    fn of(isometries: &[DAffine2]) -> Self {
        let mut found = Self {
            centres: Vec::new(),
            mirrors: Vec::new(),
            glides: Vec::new(),
        };
        for map in isometries {
            let (linear, shift) = (map.matrix2, map.translation);
            if linear.determinant() > 0.0 {
                let turn = libm::atan2(linear.x_axis.y, linear.x_axis.x)
                    .to_degrees()
                    .abs();
                if turn > 1.0 {
                    let centre = (DMat2::IDENTITY - linear).inverse() * shift;
                    let order = (360.0 / turn).round();
                    // Of the powers of a rotation, that by the smallest angle counts.
                    if (order * turn - 360.0).abs() < 1e-6 {
                        found.centres.push((order, centre));
                    }
                }
                continue;
            }
            // The linear part keeps the direction of the axis.
            let double = linear.x_axis + DVec2::X;
            let along = match double.length() > NEAR {
                true => double.normalize(),
                false => DVec2::Y,
            };
            let glide = along.dot(shift);
            let at = (shift - along * glide) / 2.0;
            match glide.abs() < NEAR {
                true => found.mirrors.push((along, at)),
                false => found.glides.push((along, at)),
            }
        }
        found
    }

    fn is_on_mirror(&self, point: DVec2) -> bool {
        let is_on = |(along, at): &(DVec2, DVec2)| along.perp_dot(point - *at).abs() < NEAR;
        self.mirrors.iter().any(is_on)
    }

    /// Returns whether a glide reflection has an axis that is no mirror line.
    fn glides_alone(&self) -> bool {
        let is_mirror = |(along, at): &(DVec2, DVec2)| {
            let same = |(other, point): &(DVec2, DVec2)| {
                along.perp_dot(*other).abs() < NEAR && along.perp_dot(*at - *point).abs() < NEAR
            };
            self.mirrors.iter().any(same)
        };
        !self.glides.iter().all(is_mirror)
    }

    fn order(&self) -> f64 {
        self.centres
            .iter()
            .map(|(order, _)| *order)
            .fold(1.0, f64::max)
    }

    /// Returns the wallpaper group by the flow chart of D. Schattschneider (The plane symmetry groups: their recognition and
    /// notation, American Mathematical Monthly 85, 1978).
    fn wallpaper(&self) -> &'static str {
        let has_mirrors = !self.mirrors.is_empty();
        let all_on_mirrors = |least: f64| {
            let centres = self.centres.iter().filter(|(order, _)| *order >= least);
            { centres }.all(|(_, centre)| self.is_on_mirror(*centre))
        };
        let first = self.mirrors.first().map_or(DVec2::X, |(along, _)| *along);
        let in_two = self
            .mirrors
            .iter()
            .any(|(along, _)| first.perp_dot(*along).abs() > NEAR);
        match (whole(self.order()), has_mirrors) {
            (1, true) if self.glides_alone() => "cm",
            (1, true) => "pm",
            (1, false) if self.glides_alone() => "pg",
            (1, false) => "p1",
            (2, true) if !in_two => "pmg",
            (2, true) if all_on_mirrors(2.0) => "pmm",
            (2, true) => "cmm",
            (2, false) if self.glides_alone() => "pgg",
            (2, false) => "p2",
            (3, true) if all_on_mirrors(3.0) => "p3m1",
            (3, true) => "p31m",
            (3, false) => "p3",
            (4, true) if all_on_mirrors(4.0) => "p4m",
            (4, true) => "p4g",
            (4, false) => "p4",
            (_, true) => "p6m",
            (_, false) => "p6",
        }
    }

    fn frieze(&self) -> &'static str {
        let has = |direction: DVec2| {
            self.mirrors
                .iter()
                .any(|(along, _)| along.perp_dot(direction).abs() < NEAR)
        };
        match (has(DVec2::Y), has(DVec2::X), self.order() > 1.0) {
            (true, true, _) => "frieze-p2mm",
            (true, false, true) => "frieze-p2mg",
            (true, false, false) => "frieze-p1m1",
            (false, true, _) => "frieze-p11m",
            (false, false, true) => "frieze-p2",
            (false, false, false) if self.glides_alone() => "frieze-p11g",
            (false, false, false) => "frieze-p1",
        }
    }
}

fn motif() -> Bounds {
    Bounds::new(DVec2::new(-0.3, 0.2), DVec2::new(0.7, 0.9))
}

fn tilings() -> impl Iterator<Item = (&'static str, Tiling)> {
    TilingGroup::NAMES
        .iter()
        .map(|&(name, group)| (name, Tiling::new(group, &motif(), 1.0)))
}

fn wide(tiling: &Tiling) -> Vec<DAffine2> {
    let size = tiling.vectors().map(DVec2::length);
    let size = DVec2::splat(2.5 * size[0].max(size[1]));
    let centre = motif().centre();
    tiling
        .isometries(&Bounds::new(centre - size, centre + size))
        .unwrap()
}

/// The isometries alone show which group it is.
#[test]
fn groups_are_recognised() {
    for (name, tiling) in tilings() {
        let found = Found::of(&wide(&tiling));
        let recognised = match tiling.is_frieze {
            true => found.frieze(),
            false => found.wallpaper(),
        };
        assert_eq!(recognised, name);
    }
}

/// Products of general positions are general positions, up to translations by the lattice.
#[test]
fn groups_are_closed() {
    let orders = [
        1, 2, 2, 2, 4, 4, 4, 4, 8, 4, 8, 8, 3, 6, 6, 6, 12, 1, 2, 2, 2, 4, 2, 4,
    ];
    for ((name, tiling), order) in tilings().zip(orders) {
        let all: Vec<_> = { tiling.positions.iter() }
            .map(|position| tiling.isometry(position, DVec2::ZERO))
            .collect();
        assert_eq!(all.len(), order, "{name}");
        let back = tiling.vectors.inverse();
        for a in &all {
            for b in &all {
                let product = *a * *b;
                let is_in = |c: &&DAffine2| {
                    let steps = back * (product.translation - c.translation);
                    let is_whole = (steps - steps.round()).abs().max_element() < NEAR;
                    let stays = !tiling.is_frieze || steps.y.abs() < NEAR;
                    product.matrix2.abs_diff_eq(c.matrix2, NEAR) && is_whole && stays
                };
                assert_eq!(all.iter().filter(is_in).count(), 1, "{name}");
            }
        }
    }
}

/// Images of the domain cover the plane once, and the motif's box lies inside of it.
#[test]
fn domains_tile_the_plane() {
    for ((name, tiling), (_, group)) in tilings().zip(TilingGroup::NAMES) {
        let far = 50.0;
        let corners: Vec<DVec2> = { group.definition().domain.iter() }
            .map(|&[x, y]| {
                let y = if tiling.is_frieze { far * y } else { y };
                tiling.origin + tiling.vectors * DVec2::new(x, y)
            })
            .collect();
        let is_inside = |point: DVec2, slack: f64| {
            let next = corners.iter().cycle().skip(1);
            let mut sides = corners.iter().zip(next);
            sides.all(|(from, to)| (*to - *from).normalize().perp_dot(point - *from) > -slack)
        };
        for corner in [motif().min(), motif().max()] {
            assert!(is_inside(corner, NEAR), "{name}");
        }
        let all = wide(&tiling);
        let mut random = Pcg::new(3, 1);
        for _ in 0..500 {
            let mut coordinate = || 2.0 * random.unit() - 1.0;
            let point = motif().centre() + DVec2::new(coordinate(), coordinate());
            let count = all
                .iter()
                .filter(|map| is_inside(map.inverse().transform_point2(point), 0.0));
            assert_eq!(count.count(), 1, "{name}: {point}");
        }
    }
}

/// Boxes of copies do not overlap, and in rectangular cells they leave no gap but that of rounding.
#[test]
fn boxes_touch() {
    for (name, tiling) in tilings() {
        let all = wide(&tiling);
        let area: f64 = motif().size().x * motif().size().y;
        let cell = tiling.vectors.determinant();
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let share = area * tiling.positions.len() as f64 / cell;
        if tiling.is_frieze {
            continue;
        }
        assert!(share <= 1.0 + NEAR, "{name}");
        let is_rectangular = tiling.vectors.x_axis.y == 0.0 && !tiling.is_hexagonal;
        let is_square = tiling.vectors.x_axis.x == tiling.vectors.y_axis.y;
        assert!(
            !is_rectangular || is_square || share > 0.99,
            "{name}: {share}"
        );
        assert!(share > 0.25, "{name}: {share}");
        assert!(all.len() > 4 * tiling.positions.len(), "{name}");
    }
}

/// One period has a whole number of pixels along both axes.
#[test]
fn periods_are_whole_numbers_of_pixels() {
    for (name, tiling) in tilings() {
        let ([width, height], [_, _, w, h]) = (tiling.size().map(f64::from), tiling.window(1));
        let off = width / w * h - height;
        assert!(off.abs() < 0.002, "{name}: {off}");
        assert!(
            (500.0..=1025.0).contains(&width.max(height)),
            "{name}: {width} x {height}"
        );
    }
}

#[test]
fn copies_are_limited() {
    for (name, tiling) in tilings() {
        let window = Bounds::new(DVec2::splat(-1e9), DVec2::splat(1e9));
        assert_eq!(tiling.isometries(&window), Err(TooManyCopies), "{name}");
        assert!(
            tiling
                .isometries(&Bounds::new(DVec2::splat(1e6), DVec2::splat(1e6 + 9.0)))
                .is_ok()
        );
    }
    // A point has copies, too.
    let point = Bounds::new(DVec2::ONE, DVec2::ONE);
    for (name, group) in TilingGroup::NAMES {
        let tiling = Tiling::new(*group, &point, 1.0);
        let [x, y, width, height] = tiling.window(2);
        let window = Bounds::new(DVec2::new(x, y), DVec2::new(x + width, y + height));
        assert!(!tiling.isometries(&window).unwrap().is_empty(), "{name}");
    }
}
