//! Elements of an approximant in memory, column by column.

use std::num::NonZero;
use std::sync::Arc;

use crate::geometry::{BEYOND, Point};
use crate::graph::Graph;
use crate::grow::{
    Division, Element, FractalInfo, Growth, Ranks, Run, Visitor, WalkError, walk_with,
};
use crate::parallel::with_team;

use super::listed::Listed;
use super::pattern::{Pattern, Patterns};

/// Values of a column, one for each element.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Column {
    /// Whole numbers.
    Wholes(Vec<i64>),
    /// Numbers from 0 to 255.
    Bytes(Vec<u8>),
    /// Real numbers.
    Reals(Vec<f64>),
    /// Truth values.
    Flags(Vec<bool>),
}

/// The elements of an approximant as a table in memory, in order of traversal.
///
/// Columns are those of [`write`](super::write) (`fractal`, `age`, `index`; the coordinates, in the model's units;
/// `fertile`, `direction`, `visible`; the entries of maps, if maps may be arbitrary affine ones) and `joined`: whether the
/// first point of traversal is the last one of the preceding element. Coordinates may differ by rounding from those that are
/// written to files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    rows: usize,
    columns: Vec<(&'static str, Column)>,
}

/// Error: an element has no place in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnError {
    /// A coordinate is not finite.
    #[error("{BEYOND}")]
    Beyond,
    /// A rank is beyond 2⁶³.
    #[error("the ranks of its elements are beyond whole numbers of 64 bits")]
    Rank,
}

impl Columns {
    /// Grows a graph, and returns the elements of the approximant. The result does not depend on the number of threads.
    ///
    /// # Errors
    ///
    /// Returns an error if growing ends early, or if an element has no finite coordinates.
    pub fn of<F: Listed>(
        graph: &Graph<F>,
        growth: &Growth<'_>,
        threads: NonZero<usize>,
    ) -> Result<Self, WalkError<ColumnError>> {
        let known = graph.check_size(growth.steps, growth.max_elements).ok();
        let known = known.flatten().and_then(|rows| usize::try_from(rows).ok());
        let patterns = Patterns::default();
        let mut all = Block::<F>::new(graph, known.unwrap_or(0), &patterns);
        with_team(threads, |team| {
            let division = Division {
                span: Some(MANY),
                ranks: Ranks::Unknown,
                blocks: None,
            };
            let fresh = || Block::new(graph, 0, &patterns);
            walk_with(team, graph, growth, division, fresh, |block, seam| {
                let before = i64::try_from(seam.before).map_err(|_| ColumnError::Rank)?;
                let goes_on = block.goes_on.min(block.index.len());
                for index in &mut block.index[..goes_on] {
                    *index = index.checked_add(before).ok_or(ColumnError::Rank)?;
                }
                if !seam.joined
                    && let Some(joined) = block.joined.first_mut()
                {
                    *joined = false;
                }
                all.take(block);
                Ok(())
            })
        })?;
        Ok(all.into_columns())
    }

    /// Returns the number of elements.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns a column by its name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Column> {
        let mut columns = self.columns.iter();
        let found = columns.find(|(known, _)| *known == name);
        found.map(|(_, column)| column)
    }

    /// Converts to the columns with their names, in order.
    #[must_use]
    pub fn into_columns(self) -> Vec<(&'static str, Column)> {
        self.columns
    }
}

/// Approximate number of elements that a thread collects before they are put in order.
const MANY: u64 = 1 << 14;

/// Elements of a part of a walk.
struct Block<'g, F: Listed> {
    graph: &'g Graph<F>,
    affine: bool,
    current: FractalInfo,
    /// Number of leading elements whose fractal began before.
    goes_on: usize,
    fractal: Vec<i64>,
    age: Vec<i64>,
    index: Vec<i64>,
    fertile: Vec<bool>,
    direction: Vec<u8>,
    visible: Vec<bool>,
    joined: Vec<bool>,
    /// Coordinates, and entries of maps.
    reals: Vec<Vec<f64>>,
    patterns: Patterns,
}

impl<'g, F: Listed> Block<'g, F> {
    fn new(graph: &'g Graph<F>, rows: usize, patterns: &Patterns) -> Self {
        let affine = graph.is_affine();
        let [coordinates, entries] = names::<F>();
        let reals = coordinates.len() + if affine { entries.len() } else { 0 };
        Self {
            graph,
            affine,
            current: FractalInfo::default(),
            goes_on: 0,
            fractal: Vec::with_capacity(rows),
            age: Vec::with_capacity(rows),
            index: Vec::with_capacity(rows),
            fertile: Vec::with_capacity(rows),
            direction: Vec::with_capacity(rows),
            visible: Vec::with_capacity(rows),
            joined: Vec::with_capacity(rows),
            reals: (0..reals).map(|_| Vec::with_capacity(rows)).collect(),
            patterns: Arc::clone(patterns),
        }
    }

    /// Appends the elements of a block, which is empty then.
    fn take(&mut self, other: &mut Self) {
        other.goes_on = 0;
        self.fractal.append(&mut other.fractal);
        self.age.append(&mut other.age);
        self.index.append(&mut other.index);
        self.fertile.append(&mut other.fertile);
        self.direction.append(&mut other.direction);
        self.visible.append(&mut other.visible);
        self.joined.append(&mut other.joined);
        for (all, own) in self.reals.iter_mut().zip(&mut other.reals) {
            all.append(own);
        }
    }

    fn into_columns(self) -> Columns {
        let [coordinates, entries] = names::<F>();
        let rows = self.index.len();
        let mut reals = self.reals.into_iter().map(Column::Reals);
        let mut columns = vec![
            ("fractal", Column::Wholes(self.fractal)),
            ("age", Column::Wholes(self.age)),
            ("index", Column::Wholes(self.index)),
        ];
        columns.extend(
            coordinates
                .iter()
                .copied()
                .zip(reals.by_ref().take(coordinates.len())),
        );
        columns.extend([
            ("fertile", Column::Flags(self.fertile)),
            ("direction", Column::Bytes(self.direction)),
            ("visible", Column::Flags(self.visible)),
            ("joined", Column::Flags(self.joined)),
        ]);
        columns.extend(entries.iter().copied().zip(reals));
        Columns { rows, columns }
    }
}

/// Returns the names of the coordinates, and those of the entries of maps.
fn names<F: Listed>() -> [&'static [&'static str]; 2] {
    let (others, entries) = F::COLUMNS.split_at(F::COLUMNS.len() - F::ENTRIES);
    // Three columns precede the coordinates, and three follow.
    [&others[3..others.len() - 3], entries]
}

impl<F: Listed> Visitor<F> for Block<'_, F> {
    type Error = ColumnError;

    fn go_on(&mut self, fractal: FractalInfo) {
        self.current = fractal;
        self.goes_on = usize::MAX;
    }

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), ColumnError> {
        self.current = fractal;
        self.goes_on = self.goes_on.min(self.index.len());
        Ok(())
    }

    fn element(&mut self, element: &Element<F>) -> Result<(), ColumnError> {
        let listed = element.frame.listed(self.graph.place(), self.affine);
        let (coordinates, entries) = listed.ok_or(ColumnError::Beyond)?;
        let rank = |_| ColumnError::Rank;
        self.fractal
            .push(i64::try_from(self.current.number).map_err(rank)?);
        self.age.push(self.current.age.into());
        self.index.push(i64::try_from(element.index).map_err(rank)?);
        self.fertile.push(element.fertile);
        self.direction.push(element.frame.direction().number());
        self.visible.push(element.visible);
        self.joined.push(element.joined);
        let values = coordinates.as_ref().iter().chain(entries.as_ref());
        for (reals, value) in self.reals.iter_mut().zip(values) {
            // Adding zero turns −0 into 0.
            reals.push(value + 0.0);
        }
        Ok(())
    }

    fn takes_runs(&self) -> bool {
        !self.affine && F::UNIT.plane_map().is_some()
    }

    fn run(&mut self, run: &Run<'_, F>) -> Result<(), ColumnError> {
        let Some(first) = run.first() else {
            return Ok(());
        };
        let frame = run.frame();
        let place = self.graph.place();
        let pattern = Pattern::find(&self.patterns, run);
        let map = frame.plane_map();
        let Some(map) = map.filter(|_| pattern.is_in_range(frame, place)) else {
            let mut elements = run.elements();
            return elements.try_for_each(|element| self.element(&element));
        };
        let rank = |_| ColumnError::Rank;
        let last = first.index + (pattern.joined.len() - 1) as u128;
        let [first_rank, last_rank] = [first.index, last].map(i64::try_from);
        let number = i64::try_from(self.current.number).map_err(rank)?;
        self.index
            .extend(first_rank.map_err(rank)?..=last_rank.map_err(rank)?);
        let rows = self.index.len();
        self.fractal.resize(rows, number);
        self.age.resize(rows, self.current.age.into());
        self.fertile.extend_from_slice(&pattern.fertile);
        self.direction.extend_from_slice(&pattern.direction);
        self.visible.extend_from_slice(&pattern.visible);
        self.joined.push(first.joined);
        self.joined.extend_from_slice(&pattern.joined[1..]);
        let (x, y) = (map.matrix2.x_axis, map.matrix2.y_axis);
        let start = map.translation;
        let ratio = place.ratio();
        let [shift_x, shift_y, _] = place.point(F::Point::ZERO).coordinates();
        let axes = [[x.x, y.x, start.x, shift_x], [x.y, y.y, start.y, shift_y]];
        for (points, reals) in pattern.coordinates.chunks(2).zip(self.reals.chunks_mut(2)) {
            for ([along, across, start, shift], reals) in axes.into_iter().zip(reals) {
                let points = points[0].iter().zip(&points[1]);
                // Adding zero turns −0 into 0.
                reals.extend(
                    points.map(|(x, y)| (along * x + across * y + start) * ratio + shift + 0.0),
                );
            }
        }
        Ok(())
    }
}
