//! Objects of structures that are one of several unions, drawn at random for every instance.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::draws::{Path, pick_by_weight};
use crate::expression::Interval;
use crate::geometry::{Frame, Point as _};
use crate::graph::{
    Alternative, Buffers, Chain, CompileError, Graph, Instance, Replacement, Source, Successor,
};
use crate::ifs::AffineMap;
use crate::instancing::Instancing;
use crate::rule::{ElementContext, Extent, Part};

/// Union that may be drawn.
#[derive(Debug)]
struct DrawnUnion<F: Frame> {
    weight: f64,
    chain: Chain<F>,
}

/// Unions of all objects that are drawn at random.
#[derive(Debug)]
struct DrawnUnions<F: Frame>(Vec<DrawnUnion<F>>);

impl<F: Frame> Graph<F> {
    /// Has one alternative drawn for every instance of an object that has several, and so far consists of all of them.
    /// `canonical` are the canonical objects of the graph's objects.
    pub(super) fn draw_alternatives<M: AffineMap<Frame = F>>(
        &mut self,
        structure: &Instancing<M>,
        canonical: &[Option<usize>],
    ) {
        let mut unions = Vec::new();
        let mut made: BTreeMap<usize, Replacement<F>> = BTreeMap::new();
        for (object, canonical) in self.objects.iter_mut().zip(canonical) {
            let Some((canonical, all)) = canonical.zip(object.successor()) else {
                continue;
            };
            let alternatives = &structure.objects()[canonical].alternatives;
            if alternatives.is_empty() {
                continue;
            }
            let replacement = made.entry(canonical).or_insert_with(|| {
                let drawn = alternatives.iter().map(|it| {
                    let mut instances = all.body.instances[it.instances.clone()].to_vec();
                    for (position, instance) in (0..).zip(&mut instances) {
                        instance.position = position;
                    }
                    let objects = instances.iter().map(|instance| instance.object).collect();
                    unions.push(DrawnUnion {
                        weight: it.weight,
                        chain: Chain::loose(instances),
                    });
                    Alternative {
                        generator: unions.len() - 1,
                        objects,
                    }
                });
                Replacement::Evaluated(drawn.collect())
            });
            object.replacement = replacement.clone();
        }
        if !unions.is_empty() {
            self.draws = true;
            self.source = Some(Arc::new(DrawnUnions(unions)));
        }
    }
}

impl<F: Frame> Source<F> for DrawnUnions<F> {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        _: &ElementContext,
        _: &mut Buffers<F>,
        successor: &mut Successor<F>,
    ) -> Result<(), CompileError> {
        let union = |alternative: &Alternative| &self.0[alternative.generator];
        let weights = alternatives.iter().map(|it| union(it).weight);
        let drawn = &alternatives[pick_by_weight(path, weights)];
        successor.clear();
        // Objects have other numbers while a step grows.
        let instances = union(drawn).chain.instances.iter().zip(&drawn.objects);
        let instances = instances.map(|(instance, &object)| Instance {
            object,
            ..instance.clone()
        });
        successor.body.instances.extend(instances);
        Ok(())
    }

    fn parts(&self, _: usize) -> &[Part] {
        &[]
    }

    fn extents(&self, union: usize, _: f64, _: &[Interval; 4], middle: F::Point) -> Vec<Extent> {
        let instances = self.0[union].chain.instances.iter();
        let extent = instances.map(|instance| Extent {
            away: (instance.frame.apply(middle) - middle).length(),
            length: instance.length,
        });
        extent.collect()
    }

    fn drawn(&self, union: usize) -> Option<(&Chain<F>, f64)> {
        let DrawnUnion { weight, chain } = &self.0[union];
        Some((chain, *weight))
    }
}
