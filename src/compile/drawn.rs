//! Objects of structures whose instances are drawn at random: one of several unions, or maps with random variables.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::draws::{Path, Variable, nodes, pick_by_weight};
use crate::expression::Interval;
use crate::geometry::{Frame, Point as _};
use crate::graph::{
    Alternative, Buffers, Chain, CompileError, DrawVisitor, Graph, Instance, Replacement, Source,
    Successor,
};
use crate::ifs::{AffineMap, PointOf};
use crate::instancing::{Instancing, Master, ObjectInstance, cells_of_each, draw_into};
use crate::rule::{ElementContext, Extent, Part};

/// Union that may be drawn.
#[derive(Debug)]
struct DrawnUnion<M: AffineMap> {
    /// Name of the object that it belongs to.
    name: String,
    weight: f64,
    /// Its instances; those whose maps are drawn have the maps of representative draws.
    chain: Chain<M::Frame>,
    drawn: Vec<DrawnInstance<M>>,
    /// The variables on which any of the maps depends.
    needed: Vec<bool>,
    level: f64,
}

/// Instance whose map is drawn.
#[derive(Debug)]
struct DrawnInstance<M: AffineMap> {
    /// Its number in the union.
    number: usize,
    instance: ObjectInstance<M>,
    /// Map that the object which is instanced applies to itself.
    inner: M,
}

/// Unions of all objects that are drawn at random, with the variables of their maps.
#[derive(Debug)]
struct DrawnUnions<M: AffineMap> {
    unions: Vec<DrawnUnion<M>>,
    variables: Arc<[Variable]>,
    /// Number of cells into which the ranges of draws are divided for an instance.
    cells: usize,
}

impl<F: Frame> Graph<F> {
    /// Has the instances drawn of every object that is replaced at random, which so far consists of all of its
    /// alternatives, under representative maps. `canonical` are the canonical objects of the graph's objects.
    pub(super) fn draw_unions<M: AffineMap<Frame = F>>(
        &mut self,
        structure: &Instancing<M>,
        canonical: &[Option<usize>],
    ) {
        let mut unions = Vec::new();
        let mut made: BTreeMap<usize, Option<Replacement<F>>> = BTreeMap::new();
        for (object, canonical) in self.objects.iter_mut().zip(canonical) {
            let Some((canonical, all)) = canonical.zip(object.successor()) else {
                continue;
            };
            let replacement = made.entry(canonical).or_insert_with(|| {
                let first = unions.len();
                unions.extend(drawn_unions(structure, canonical, &all.body.instances)?);
                let alternative = |(generator, union): (usize, &DrawnUnion<M>)| Alternative {
                    generator,
                    objects: { union.chain.instances.iter() }
                        .map(|it| it.object)
                        .collect(),
                };
                let alternatives = unions.iter().enumerate().skip(first).map(alternative);
                Some(Replacement::Evaluated(alternatives.collect()))
            });
            if let Some(replacement) = replacement {
                object.replacement = replacement.clone();
            }
        }
        if !unions.is_empty() {
            self.draws = true;
            let variables = Arc::clone(&structure.variables);
            let drawn = unions.iter().map(|union| union.drawn.len()).sum();
            self.source = Some(Arc::new(DrawnUnions {
                unions,
                variables,
                cells: cells_of_each(drawn),
            }));
        }
    }
}

/// Returns the unions of which one is drawn for an object, or its only union, if maps are drawn; `None` if nothing is
/// drawn. `placed` are the instances of all unions in the graph.
fn drawn_unions<M: AffineMap>(
    structure: &Instancing<M>,
    object: usize,
    placed: &[Instance<M::Frame>],
) -> Option<Vec<DrawnUnion<M>>> {
    let object = &structure.objects()[object];
    let union = |weight, range: std::ops::Range<usize>| {
        let mut instances = placed[range.clone()].to_vec();
        let mut drawn = Vec::new();
        let mut needed = vec![false; structure.variables.len()];
        let written = &object.instances[range];
        for (number, (instance, written)) in instances.iter_mut().zip(written).enumerate() {
            instance.position = u32::try_from(number).unwrap_or(u32::MAX);
            let own = written.needed(&structure.variables);
            if own.contains(&true) {
                drawn.push(DrawnInstance {
                    number,
                    instance: written.clone(),
                    inner: match written.master {
                        Master::Object(number) => structure.objects()[number].map,
                        Master::Shape(_) => M::IDENTITY,
                    },
                });
            }
            needed
                .iter_mut()
                .zip(own)
                .for_each(|(all, own)| *all |= own);
        }
        DrawnUnion {
            name: object.name.clone(),
            weight,
            chain: Chain::loose(instances),
            drawn,
            needed,
            level: object.level(),
        }
    };
    if object.alternatives.is_empty() {
        let only = union(1.0, 0..placed.len());
        return (!only.drawn.is_empty()).then(|| vec![only]);
    }
    let alternatives = object.alternatives.iter();
    Some(
        alternatives
            .map(|it| union(it.weight, it.instances.clone()))
            .collect(),
    )
}

impl<M: AffineMap> DrawnInstance<M> {
    /// Places the instance by the values of all slots; returns `false` if its map is not finite.
    fn place(&self, slots: &[f64], instance: &mut Instance<M::Frame>) -> bool {
        let map = M::product(&self.instance.transforms, slots) * self.inner;
        instance.frame = M::Frame::from(map);
        instance.length = instance.frame.stretch();
        map.is_finite()
    }
}

impl<M: AffineMap> Source<M::Frame> for DrawnUnions<M> {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        context: &ElementContext,
        Buffers { slots, .. }: &mut Buffers<M::Frame>,
        successor: &mut Successor<M::Frame>,
    ) -> Result<(), CompileError> {
        let union = |alternative: &Alternative| &self.unions[alternative.generator];
        let drawn = match alternatives {
            [only] => only,
            _ => {
                let weights = alternatives.iter().map(|it| union(it).weight);
                &alternatives[pick_by_weight(path, weights)]
            }
        };
        successor.clear();
        // Objects have other numbers while a step grows.
        let (union, objects) = (union(drawn), &drawn.objects);
        let instances = union.chain.instances.iter().zip(objects);
        let instances = instances.map(|(instance, &object)| Instance {
            object,
            ..instance.clone()
        });
        successor.body.instances.extend(instances);
        if union.drawn.is_empty() {
            return Ok(());
        }
        draw_into(slots, (&self.variables, &union.needed), union.level, path);
        for drawn in &union.drawn {
            if !drawn.place(slots, &mut successor.body.instances[drawn.number]) {
                return Err(CompileError::DrawnNotFinite {
                    object: union.name.clone(),
                    step: context.step,
                });
            }
        }
        Ok(())
    }

    fn parts(&self, _: usize) -> &[Part] {
        &[]
    }

    fn extents(
        &self,
        union: usize,
        power: f64,
        _: &[Interval; 4],
        middle: PointOf<M>,
    ) -> Vec<Extent> {
        let union = &self.unions[union];
        let instances = union.chain.instances.iter();
        let extents = instances.map(|instance| Extent {
            away: (instance.frame.apply(middle) - middle).length(),
            length: instance.length,
        });
        let mut extents: Vec<_> = extents.collect();
        for DrawnInstance {
            number,
            instance,
            inner,
        } in &union.drawn
        {
            let drawn = (&*self.variables, union.level, self.cells);
            extents[*number] = instance.extent_of_draws(inner, drawn, power, middle);
        }
        extents
    }

    fn visit_draws(
        &self,
        union: usize,
        is_wanted: &dyn Fn(usize) -> bool,
        visit: &mut DrawVisitor<'_, M::Frame>,
    ) -> Result<(), String> {
        let union = &self.unions[union];
        let mut drawn = union.drawn.iter().peekable();
        for (number, instance) in union.chain.instances.iter().enumerate() {
            let drawn = drawn.next_if(|drawn| drawn.number == number);
            if !is_wanted(number) {
                continue;
            }
            let Some(drawn) = drawn else {
                visit(number, instance, union.weight)?;
                continue;
            };
            let needed = drawn.instance.needed(&self.variables);
            let Some(nodes) = nodes(&self.variables, &needed, &[union.level]) else {
                return Err("too many numbers are drawn to integrate over".into());
            };
            let mut instance = instance.clone();
            for (slots, share) in nodes {
                if !drawn.place(&slots, &mut instance) {
                    return Err("draws of a transform are not finite".into());
                }
                visit(number, &instance, union.weight * share)?;
            }
        }
        Ok(())
    }

    fn weight(&self, union: usize) -> f64 {
        self.unions[union].weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source as Text;
    use crate::document::Document;
    use crate::geometry::DVec2;
    use crate::model::Model;

    #[test]
    fn what_is_drawn_keeps_within_its_extents() {
        let text = "kind: instancing
random: {a: 'uniform(-40, 200)', b: 'normal(0.5, 0.1)', c: 'choice(0.2, -0.7)', d: 'uniform(a/9, a)'}
objects:
  A(n):
    at_random:
      - [{object: A(n), rotate: a, scale: [b, c], translate: [1, b]}, {object: A(n), matrix: [[c, b], [0, n/9]], rotate: d}]
      - [{segment: [[0, 0], [1, 0]], translate: [b, c], scale: c}, {object: A(n), scale: 1/2, translate: [0, 3]}]
    scale: 0.9
scene: [A(3)]
";
        let document = Document::read(&Text::new("test", text), &Catalogue::embedded()).unwrap();
        let (model, _) = document.resolve(&[]).unwrap();
        let Model::Instancing(structure) = model else {
            unreachable!("it is a structure");
        };
        let graph = Graph::of_structure(&*structure);
        let Replacement::Evaluated(alternatives) = &graph.objects()[0].replacement else {
            unreachable!("its instances are drawn");
        };
        let context = ElementContext {
            index: 1.0,
            age: 0.0,
            step: 0.0,
            length: 1.0,
        };
        let middle = DVec2::new(0.3, -0.7);
        let (mut buffers, mut successor) = (Buffers::default(), Successor::default());
        for alternative in alternatives.iter() {
            let one = std::slice::from_ref(alternative);
            let extents = |power| {
                let source = graph.source();
                source.extents(alternative.generator, power, &[Interval::ALL; 4], middle)
            };
            let (most, squares) = (extents(f64::INFINITY), extents(2.0));
            let mut sums = vec![[0.0; 2]; most.len()];
            const COUNT: u32 = 4000;
            for number in 0..COUNT {
                let path = Path::of_seed(7).child(number);
                let source = graph.source();
                source
                    .evaluate(one, path, &context, &mut buffers, &mut successor)
                    .unwrap();
                let drawn = successor.body.instances.iter().zip(&most).zip(&mut sums);
                for ((instance, most), sums) in drawn {
                    let away = (instance.frame.apply(middle) - middle).length();
                    let limits = [most.away, most.length].map(|it| it * (1.0 + 1e-12));
                    assert!(
                        away <= limits[0] && instance.length <= limits[1],
                        "{most:?}"
                    );
                    sums[0] += away * away;
                    sums[1] += instance.length * instance.length;
                }
            }
            // Means over draws are below the bounds of their expectations, but for what chance adds, and not far below.
            for (sums, bound) in sums.iter().zip(&squares) {
                let means = sums.map(|sum| (sum / f64::from(COUNT)).sqrt());
                for (mean, bound) in means.into_iter().zip([bound.away, bound.length]) {
                    assert!(mean < 1.02 * bound && bound < 1.6 * mean, "{mean} {bound}");
                }
            }
        }
    }
}
