//! Instances in equal positions, which are drawn once.

use crate::geometry::DVec3;

use super::scene::{Child, Part};

/// Number of instances of a level that are remembered.
const SLOTS: usize = 1 << 11;

/// Number of levels that share their slots with others from that on.
const LEVELS: usize = 16;

/// Fraction of a sample by which equal positions may differ.
const FINE: f64 = 1024.0;

/// Limit of the number of products of maps that are compared.
const MAX_PRODUCTS: usize = 1 << 16;

/// Scale at which products of maps are compared.
const LARGE: f64 = 1e9;

/// Instance that is remembered, in 24 bytes.
#[derive(Clone, Copy, Default)]
struct Slot {
    /// Position in fractions of a sample.
    at: [i32; 3],
    form: u32,
    /// Number of the tile; 0 if there is no instance.
    tile: u32,
    class: u16,
}

/// Instances that a tile has met, as many as fit: a table in which the last one of a slot stays.
pub(super) struct Copies {
    slots: Vec<Slot>,
    tile: u32,
}

impl Copies {
    /// Creates a table.
    pub(super) fn new() -> Self {
        Self {
            slots: vec![Slot::default(); SLOTS * LEVELS],
            tile: 0,
        }
    }

    /// Begins a tile, of which no instance is known.
    pub(super) fn begin(&mut self) {
        self.tile += 1;
    }

    /// Notes an instance of a form; returns whether an equal one, of the same class or of one before it, is known.
    ///
    /// Instances that are too far away for a table, or of too many forms, are not known.
    pub(super) fn knows(&mut self, at: DVec3, form: usize, level: u32, class: u16) -> bool {
        let at = rounded(at.to_array(), FINE).map(i32::try_from);
        let ([Ok(x), Ok(y), Ok(z)], Ok(form)) = (at, u32::try_from(form)) else {
            return false;
        };
        let at = [x, y, z];
        let mut hash = u64::from(form);
        for part in at {
            let part = u64::from(part.cast_unsigned());
            hash = (hash.rotate_left(5) ^ part).wrapping_mul(0x517c_c1b7_2722_0a95);
        }
        let place = usize::try_from(hash >> 32).unwrap_or_default() % SLOTS;
        let slot = &mut self.slots[level as usize % LEVELS * SLOTS + place];
        let is_equal = (slot.at, slot.form, slot.tile) == (at, form, self.tile);
        if is_equal && slot.class <= class {
            return true;
        }
        *slot = Slot {
            at,
            form,
            tile: self.tile,
            class,
        };
        false
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn rounded<const N: usize>(numbers: [f64; N], scale: f64) -> [i64; N] {
    numbers.map(|number| {
        let number = number * scale + 0.5;
        let whole = number as i64;
        whole - i64::from(number < 0.0)
    })
}

/// Returns whether instances meet in equal positions within two steps.
pub(super) fn overlap(parts: &[Part]) -> bool {
    parts.iter().any(|part| {
        let inner = part
            .children
            .iter()
            .map(|child| parts[child.object].children.len());
        if inner.sum::<usize>() > MAX_PRODUCTS {
            return true;
        }
        let products = part.children.iter().flat_map(|outer| {
            let inner = parts[outer.object].children.iter();
            inner.map(|inner: &Child| (parts[inner.object].kind, outer.map * inner.map))
        });
        let mut keys: Vec<(usize, [i64; 12])> = products
            .map(|(kind, map)| (kind, rounded(map.to_cols_array(), LARGE)))
            .collect();
        keys.sort_unstable();
        keys.windows(2).any(|pair| pair[0] == pair[1])
    })
}
