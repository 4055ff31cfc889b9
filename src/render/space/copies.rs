//! Instances in equal positions, which are drawn once.

use crate::geometry::{DAffine3, DVec3};

use super::scene::{Child, Part};

/// Number of instances that are remembered.
const SLOTS: usize = 1 << 14;

/// Fraction of a sample by which equal positions may differ.
const FINE: f64 = 1024.0;

/// Limit of the number of products of maps that are compared.
const MAX_PRODUCTS: usize = 1 << 16;

/// Scale at which products of maps are compared.
const LARGE: f64 = 1e6;

/// Numbers of a map, in fractions of a sample.
type Key = [i64; 12];

#[derive(Clone, Copy)]
struct Slot {
    key: Key,
    kind: usize,
    level: u32,
    class: u16,
    tile: u64,
}

/// Instances that a tile has met, as many as fit: a table in which the last one of a slot stays.
pub(super) struct Copies {
    slots: Vec<Option<Slot>>,
    tile: u64,
}

impl Copies {
    /// Creates a table.
    pub(super) fn new() -> Self {
        Self {
            slots: vec![None; SLOTS],
            tile: 0,
        }
    }

    /// Forgets all instances.
    pub(super) fn clear(&mut self) {
        self.tile += 1;
    }

    /// Notes an instance; returns whether an equal one, of the same class or of one before it, is known.
    pub(super) fn knows(&mut self, map: &DAffine3, kind: usize, level: u32, class: u16) -> bool {
        let key = key(map);
        let mut hash = kind as u64 ^ u64::from(level).rotate_left(32);
        for part in key {
            hash = (hash.rotate_left(5) ^ part.cast_unsigned()).wrapping_mul(0x517c_c1b7_2722_0a95);
        }
        let place = usize::try_from(hash >> 50).unwrap_or_default() % SLOTS;
        let slot = &mut self.slots[place];
        if let Some(known) = slot
            && known.tile == self.tile
            && known.key == key
            && (known.kind, known.level) == (kind, level)
            && known.class <= class
        {
            return true;
        }
        *slot = Some(Slot {
            key,
            kind,
            level,
            class,
            tile: self.tile,
        });
        false
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn key(map: &DAffine3) -> Key {
    map.to_cols_array()
        .map(|value| (value * FINE).round() as i64)
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
        let mut keys: Vec<(usize, Key)> = products
            .map(|(kind, map)| {
                (
                    kind,
                    key(&(DAffine3::from_scale(DVec3::splat(LARGE)) * map)),
                )
            })
            .collect();
        keys.sort_unstable();
        keys.windows(2).any(|pair| pair[0] == pair[1])
    })
}
