//! Elements of an approximant in memory, column by column.

use std::num::NonZero;

use crate::geometry::BEYOND;
use crate::graph::Graph;
use crate::grow::{Division, Element, FractalInfo, Growth, Ranks, Visitor, WalkError, walk_with};
use crate::parallel::with_team;

use super::listed::Listed;

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
/// first point of traversal is the last one of the preceding element.
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
        let mut all = Block::<F>::new(graph, known.unwrap_or(0));
        with_team(threads, |team| {
            let division = Division {
                span: Some(MANY),
                ranks: Ranks::Unknown,
            };
            let fresh = || Block::new(graph, 0);
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
}

impl<'g, F: Listed> Block<'g, F> {
    fn new(graph: &'g Graph<F>, rows: usize) -> Self {
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
}
