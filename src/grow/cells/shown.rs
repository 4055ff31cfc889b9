//! Points of layers, from which none are derived.

use super::field::{Field, NoRoom};
use crate::geometry::DVec2;
use crate::parallel::for_each;

/// Maximum number of points that are put into cells together.
const MANY: usize = 1 << 17;

/// Number of points that are worth several threads.
const WORTH_THREADS: usize = 1 << 14;

/// Data of a point that is put into its cell.
pub(super) trait Mark: Copy + Send + Sync {
    /// Puts a point into its cell.
    fn put(self, field: &mut Field, point: DVec2) -> Result<(), NoRoom>;
}

/// Without data, the first point of a cell is kept.
impl Mark for () {
    #[inline]
    fn put(self, field: &mut Field, point: DVec2) -> Result<(), NoRoom> {
        field.add(point).map(drop)
    }
}

/// The greatest label of a cell is kept.
impl Mark for u16 {
    #[inline]
    fn put(self, field: &mut Field, point: DVec2) -> Result<(), NoRoom> {
        field.label(point, self)
    }
}

/// Cells of layers, divided so that every thread has a part of the plane of its own.
///
/// The points of a cell are put in their order, regardless of the number of threads.
pub(super) struct LayerCells<M> {
    /// Fields by thread and by layer.
    parts: Vec<Vec<Field>>,
    /// Points of layers that are not in their cells yet.
    open: Vec<(usize, DVec2, M)>,
}

impl<M: Mark> LayerCells<M> {
    /// Creates layers without points; `scales` are their numbers of cells per unit of length.
    pub(super) fn new(scales: impl Iterator<Item = f64> + Clone, threads: usize) -> Self {
        let layers = || scales.clone().map(Field::new).collect();
        Self {
            parts: (0..threads.max(1)).map(|_| layers()).collect(),
            open: Vec::new(),
        }
    }

    /// Returns the number of cells of a layer per unit of length.
    pub(super) fn scale(&self, layer: usize) -> f64 {
        self.parts
            .first()
            .map_or(0.0, |layers| layers[layer].scale())
    }

    /// Adds a point of a layer.
    #[inline]
    pub(super) fn push(&mut self, layer: usize, point: DVec2, mark: M) -> Result<(), NoRoom> {
        if let [only] = &mut self.parts[..] {
            return mark.put(&mut only[layer], point);
        }
        self.open.push((layer, point, mark));
        if self.open.len() >= MANY {
            self.put_open()?;
        }
        Ok(())
    }

    /// Puts all points into their cells.
    fn put_open(&mut self) -> Result<(), NoRoom> {
        let Self { parts, open } = self;
        let count = parts.len();
        let put_part = |number: usize, layers: &mut Vec<Field>| {
            open.iter().try_for_each(|&(layer, point, mark)| {
                let field = &mut layers[layer];
                if field.share_of(point, count) == number {
                    mark.put(field, point)?;
                }
                Ok(())
            })
        };
        let threads = if open.len() < WORTH_THREADS { 1 } else { count };
        let mut outcomes = vec![Ok(()); count];
        let parts = parts.iter_mut().enumerate().zip(&mut outcomes);
        for_each(parts, threads, |((number, layers), outcome)| {
            *outcome = put_part(number, layers);
        });
        self.open.clear();
        outcomes.into_iter().collect()
    }

    /// Returns the cells of every layer.
    pub(super) fn into_fields(mut self) -> Result<Vec<Field>, NoRoom> {
        self.put_open()?;
        let mut parts = self.parts.into_iter();
        let mut fields = parts.next().unwrap_or_default();
        for part in parts {
            for (field, other) in fields.iter_mut().zip(part) {
                field.take_over(other)?;
            }
        }
        Ok(fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first point and the greatest label of a cell are kept, regardless of the number of threads.
    #[test]
    fn threads_do_not_show_in_layers() {
        let points = || {
            (0..300_000_u32).map(|number| {
                let turn = f64::from(number) * 2.399_963;
                DVec2::from_angle(turn) * f64::from(number % 977)
            })
        };
        let shown = |threads: usize| {
            let scales = [0.3, 0.7].into_iter();
            let mut places = LayerCells::new(scales.clone(), threads);
            let mut labels = LayerCells::new(scales, threads);
            for (point, number) in points().zip(0_u32..) {
                let label = u16::try_from(number % 5_000).unwrap();
                places.push(number as usize % 2, point, ()).unwrap();
                labels.push(number as usize % 2, point, label).unwrap();
            }
            let fields = [places.into_fields(), labels.into_fields()];
            fields
                .into_iter()
                .flat_map(Result::unwrap)
                .collect::<Vec<_>>()
        };
        let expected = shown(1);
        for threads in [2, 3, 8] {
            for (field, expected) in shown(threads).iter().zip(&expected) {
                assert_eq!(field.bounds(), expected.bounds());
                for point in points() {
                    assert_eq!(field.label_of(point), expected.label_of(point), "{point}");
                }
            }
        }
    }
}
