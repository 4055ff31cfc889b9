//! Systems as functions of parameters.

use crate::diagnostic::Diagnostics;
use crate::document::{Document, Setting};
use crate::geometry::DAffine2;
use crate::model::Model;
use crate::resolve::VaryingMaps;

/// Iterated function systems of the plane that depend on parameters, neither recurrent nor with condensation sets.
#[derive(Clone, Debug)]
pub struct Family {
    /// Parameters that vary.
    names: Vec<String>,
    /// Numbers of the maps that are left out, from 0.
    omitted: Vec<usize>,
    maps: Maps,
}

#[derive(Clone, Debug)]
enum Maps {
    Programs(VaryingMaps),
    /// Document that is resolved for each member, with the settings of all members.
    Resolved(Box<Document>, Vec<Setting>),
}

/// Error: a file has no family whose parameters can be mapped.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FamilyError {
    /// The file is of another kind.
    #[error(
        "maps of parameters are made of iterated function systems (`kfrac convert --to ifs` makes them of other files)"
    )]
    NotASystem,
    /// The system lies in space.
    #[error("maps of parameters are made of systems of the plane, not of space")]
    InSpace,
    /// The system has edges.
    #[error(
        "the system is recurrent: its attractor is not the union of its images under all maps, as the theorems require"
    )]
    Recurrent,
    /// The system has condensation sets.
    #[error(
        "the system has condensation sets: its attractor is not the union of its images, as the theorems require"
    )]
    Condensation,
    /// There is no parameter of this name.
    #[error("there is no parameter '{name}' ({hint})")]
    NoParameter {
        /// Name.
        name: String,
        /// Names of parameters.
        hint: String,
    },
    /// The file has mistakes.
    #[error("the file has mistakes")]
    Mistakes(Diagnostics),
}

impl Family {
    /// Creates the family of a document with settings of further parameters, over the parameters `names`. The parts of a
    /// complex parameter `s` are `s.re` and `s.im`.
    ///
    /// # Errors
    ///
    /// Returns an error if the document is no iterated function system of the plane, is recurrent, has condensation sets,
    /// has no such parameters, or cannot be resolved.
    pub fn of(
        document: &Document,
        settings: &[Setting],
        names: &[String],
    ) -> Result<Self, FamilyError> {
        let metadata = document.metadata();
        for name in names {
            if !metadata.params.iter().any(|it| it.name.value == *name) {
                return Err(FamilyError::NoParameter {
                    name: name.clone(),
                    hint: metadata.instead_of(name),
                });
            }
        }
        let (model, _) = document.resolve(settings).map_err(FamilyError::Mistakes)?;
        let system = match &model {
            Model::Ifs(system) => system,
            Model::IfsInSpace(_) => return Err(FamilyError::InSpace),
            _ => return Err(FamilyError::NotASystem),
        };
        if system.ifs().is_recurrent() {
            return Err(FamilyError::Recurrent);
        }
        if !system.ifs().condensation().is_empty() {
            return Err(FamilyError::Condensation);
        }
        let maps = match VaryingMaps::of(document, settings, names) {
            Some(programs) => Maps::Programs(programs),
            None => Maps::Resolved(Box::new(document.clone()), settings.to_vec()),
        };
        Ok(Self {
            names: names.to_vec(),
            omitted: Vec::new(),
            maps,
        })
    }

    /// Leaves out maps, by their numbers from 0.
    #[must_use]
    pub fn omitting(self, maps: &[usize]) -> Self {
        Self {
            omitted: maps.to_vec(),
            ..self
        }
    }

    /// Returns the names of the parameters that vary.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns memory for the maps of a member.
    #[must_use]
    pub fn member(&self) -> FamilyMember<'_> {
        FamilyMember {
            family: self,
            slots: Vec::new(),
            maps: Vec::new(),
        }
    }
}

/// Member of a family, for one list of values after another.
#[derive(Clone, Debug)]
pub struct FamilyMember<'a> {
    family: &'a Family,
    slots: Vec<f64>,
    maps: Vec<DAffine2>,
}

impl FamilyMember<'_> {
    /// Returns the maps for values of the parameters, in the order of [`Family::names`]; `None` where the file admits no
    /// system with these values.
    pub fn at(&mut self, values: &[f64]) -> Option<&[DAffine2]> {
        match &self.family.maps {
            Maps::Programs(programs) => {
                let are_right = programs.evaluate(values, &mut self.slots, &mut self.maps);
                are_right.then_some(())?;
            }
            Maps::Resolved(document, settings) => {
                let own = self.family.names.iter().zip(values);
                let own = own.map(|(name, value)| Setting::from((name.as_str(), *value)));
                let settings: Vec<Setting> = settings.iter().cloned().chain(own).collect();
                let Ok((Model::Ifs(system), _)) = document.resolve(&settings) else {
                    return None;
                };
                self.maps.clear();
                let maps = system.ifs().maps().iter().map(|map| map.affine);
                self.maps.extend(maps);
            }
        }
        let mut number = 0..;
        let omitted = &self.family.omitted;
        self.maps.retain(|_| {
            number
                .next()
                .is_some_and(|number| !omitted.contains(&number))
        });
        (!self.maps.is_empty()).then_some(&self.maps)
    }
}
