//! Maps of a system as functions of some of its parameters.

use crate::document::{
    Document, KindDocument, MapsDocument, Setting, VerticesDocument, WrittenNumber,
};
use crate::expression::{AffineOf, Program};
use crate::geometry::{DAffine2, DVec2};

use super::Resolver;
use super::ifs::OfIfs;
use super::parameters::order;

/// Maps of a system whose numbers are programs of varying parameters.
#[derive(Clone, Debug)]
pub(crate) struct VaryingMaps {
    /// Parameters that depend on the varying ones; their values follow these in the slots of programs.
    derived: Vec<Program>,
    limits: Vec<Limits>,
    maps: Vec<AffineOf<Program>>,
}

/// Limits of a parameter.
#[derive(Clone, Debug)]
struct Limits {
    value: Program,
    min: Option<Program>,
    max: Option<Program>,
}

impl VaryingMaps {
    /// Compiles the maps of a document as functions of parameters; `None` for maps that are found by a computation, as
    /// those of fractal interpolation, and where anything has a mistake.
    pub(crate) fn of(
        document: &Document,
        settings: &[Setting],
        varying: &[String],
    ) -> Option<Self> {
        let KindDocument::Ifs(document) = document.kind() else {
            return None;
        };
        if !document.random.is_empty() {
            return None;
        }
        let mut resolver = Resolver::<OfIfs> {
            varies: true,
            ..Resolver::default()
        };
        let mut found = Self {
            derived: Vec::new(),
            limits: Vec::new(),
            maps: Vec::new(),
        };
        let params = &document.metadata.params;
        let (order, cyclic) = order(params);
        for written in order.iter().map(|index| &params[*index]) {
            let name = &written.name.value;
            let value = found.value(&mut resolver, name, &written.value, settings, varying);
            let mut limit = |number: &Option<WrittenNumber>| {
                let number = number.as_ref()?;
                Some(resolver.constant_program(number))
            };
            let (min, max) = (limit(&written.min), limit(&written.max));
            found.limits.push(Limits { value, min, max });
        }
        let maps = match document.maps.as_ref()? {
            MapsDocument::Listed(maps) => {
                let maps = maps.iter().map(|map| resolver.affine::<DAffine2, 2>(map));
                maps.collect::<Option<Vec<_>>>()?
            }
            MapsDocument::Vertices {
                points: VerticesDocument::Scattered(_),
                ..
            } => return None,
            MapsDocument::Vertices { points, shrink } => {
                let (_, maps) = resolver.toward::<DAffine2, 2>(points, shrink)?;
                maps
            }
            MapsDocument::Interpolated(_) | MapsDocument::AtRandom(_) => return None,
        };
        found.maps = maps;
        let is_right = cyclic.is_empty() && !resolver.diagnostics.has_errors();
        is_right.then_some(found)
    }

    /// Compiles the value of a parameter, and adds its name to the scope of expressions.
    fn value(
        &mut self,
        resolver: &mut Resolver<OfIfs>,
        name: &str,
        written: &WrittenNumber,
        settings: &[Setting],
        varying: &[String],
    ) -> Program {
        let slot = match varying.iter().position(|it| it == name) {
            Some(slot) => slot,
            None => {
                let set = settings.iter().rfind(|setting| setting.name == *name);
                let value = match set {
                    Some(setting) => Program::constant(setting.value),
                    None => resolver.constant_program(written),
                };
                if let Some(constant) = value.as_constant() {
                    resolver.constants.constant(name, constant);
                    return value;
                }
                self.derived.push(value);
                varying.len() + self.derived.len() - 1
            }
        };
        resolver.constants.variable(name, slot);
        Program::slot(slot)
    }

    /// Evaluates the maps for values of the varying parameters, into `maps`; `slots` is memory. Returns whether all
    /// values are within the limits of their parameters, and all maps are finite.
    pub(crate) fn evaluate(
        &self,
        values: &[f64],
        slots: &mut Vec<f64>,
        maps: &mut Vec<DAffine2>,
    ) -> bool {
        slots.clear();
        slots.extend_from_slice(values);
        for program in &self.derived {
            slots.push(program.eval(slots));
        }
        if !self.limits.iter().all(|limits| limits.hold(slots)) {
            return false;
        }
        maps.clear();
        maps.extend(self.maps.iter().map(|map| {
            let point = |[x, y]: &[Program; 2]| DVec2::new(x.eval(slots), y.eval(slots));
            let [right, up] = map.axes.each_ref().map(point);
            DAffine2::from_cols(right, up, point(&map.origin))
        }));
        maps.iter().all(|map| map.is_finite())
    }
}

impl Limits {
    fn hold(&self, slots: &[f64]) -> bool {
        let value = self.value.eval(slots);
        let limit = |program: &Option<Program>, none: f64| {
            program.as_ref().map_or(none, |program| program.eval(slots))
        };
        let low = limit(&self.min, f64::NEG_INFINITY);
        let high = limit(&self.max, f64::INFINITY);
        value.is_finite() && low <= value && value <= high
    }
}
