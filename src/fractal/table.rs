//! Elements of a fractal as columns in memory.

use crate::diagnostic::Diagnostic;
use crate::export::{Columns, Listed};
use crate::graph::Graph;
use crate::grow::WalkError;

use super::{Error, Fractal};

impl Fractal {
    /// Returns the elements of the approximant as columns of numbers, of the plane or of space, infertile and invisible ones
    /// included. Coordinates are in the file's units.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::export::Column;
    ///
    /// let table = kfrac::Fractal::named("koch")?.steps(2).columns()?;
    /// assert_eq!(table.rows(), 16);
    /// let Some(Column::Reals(x)) = table.get("x1") else { panic!("there is a column x1") };
    /// assert!((x[3] - 1.0 / 3.0).abs() < 1e-15);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If the model cannot be compiled, it has more elements than allowed, or one of them is not finite.
    pub fn columns(&self) -> Result<Columns, Error> {
        self.check_cancelled()?;
        match self.model.is_in_space() {
            true => {
                let graph = self.graph_in_space("it has a table, too")?;
                self.columns_of(graph, self.steps_in_space(graph))
            }
            false => self.columns_of(self.graph()?, self.steps_grown()?),
        }
    }

    fn columns_of<F: Listed>(&self, graph: &Graph<F>, steps: u32) -> Result<Columns, Error> {
        let columns = Columns::of(graph, &self.growth(steps), self.threads);
        columns.map_err(|error| match error {
            WalkError::Visitor(error) => Diagnostic::error(error.to_string()).into(),
            error => error
                .map_visitor(|_| unreachable!("it is no visitor's"))
                .into(),
        })
    }
}
