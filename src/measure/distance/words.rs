//! Words of limit sets: products of the maps of instances along paths of the instancing graph.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::extent::{Bounded, Products};
use crate::geometry::{Affine, Linear, Point};
use crate::graph::{Graph, Instance, Replacement};
use crate::saturating::real;

/// Objects that the initiator reaches and that are replaced and drawn in the limit, one of each behaviour.
pub(super) struct Objects<'g, F: Bounded> {
    graph: &'g Graph<F>,
    /// Whether each object of the graph is drawn in the limit.
    alive: Vec<bool>,
    /// Numbers of the objects in the graph.
    numbers: Vec<usize>,
    /// Index in `numbers` of each behaviour.
    of: Vec<Option<usize>>,
}

impl<'g, F: Bounded> Objects<'g, F> {
    pub(super) fn new(graph: &'g Graph<F>) -> Self {
        let mut objects = Self {
            graph,
            alive: graph.alive(true),
            numbers: Vec::new(),
            of: vec![None; graph.behaviours().count()],
        };
        let start = graph.initiator(0).instances.iter();
        let mut open: Vec<usize> = start.map(|instance| instance.object).collect();
        while let Some(number) = open.pop() {
            let object = &graph.objects()[number];
            let is_replaced = object.successor().is_some();
            if !objects.alive[number] || !is_replaced || objects.of[object.behaviour].is_some() {
                continue;
            }
            objects.of[object.behaviour] = Some(objects.numbers.len());
            objects.numbers.push(number);
            open.extend(graph.children(number).map(|(_, it)| it.object));
        }
        objects
    }

    /// Returns the numbers of the objects in the graph.
    pub(super) fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    /// Returns the index of the object with the behaviour of one of the graph, if that is replaced.
    pub(super) fn index(&self, number: usize) -> Option<usize> {
        let object = &self.graph.objects()[number];
        self.of[object.behaviour].filter(|_| object.successor().is_some())
    }

    /// Returns whether an object of the graph is kept, and drawn in the limit.
    pub(super) fn is_kept(&self, number: usize) -> bool {
        let replacement = &self.graph.objects()[number].replacement;
        self.alive[number] && matches!(replacement, Replacement::Kept)
    }

    /// Returns the instances in the production of an object.
    fn instances(&self, index: usize) -> impl Iterator<Item = &'g Instance<F>> {
        let children = self.graph.children(self.numbers[index]);
        children.map(|(_, instance)| instance)
    }

    /// Returns the indices of the replaced objects in the production of an object, and their maps.
    pub(super) fn replaced(&self, index: usize) -> impl Iterator<Item = (usize, F::Map)> {
        self.instances(index)
            .filter_map(|it| Some((self.index(it.object)?, *it.frame.map())))
    }

    /// Returns the numbers of the kept objects in the production of an object, and their maps.
    fn kept(&self, index: usize) -> impl Iterator<Item = (usize, F::Map)> {
        let kept = self.instances(index).filter(|it| self.is_kept(it.object));
        kept.map(|it| (it.object, *it.frame.map()))
    }
}

/// A map from the unit frame of an object into that of an object whose subtree contains it.
#[derive(Clone, Copy)]
pub(super) struct Word<M> {
    pub(super) map: M,
    /// Object that the map leads from: an index, or the number of a kept object.
    pub(super) inner: usize,
    /// Index of the object that the map leads to.
    pub(super) outer: usize,
}

/// Words by whose images the limit sets are made up of limit sets and kept outlines.
pub(super) struct Words<M> {
    /// Words that lead from replaced objects.
    pub(super) replaced: Vec<Word<M>>,
    /// Words that lead from kept objects.
    pub(super) kept: Vec<Word<M>>,
    /// Upper bound of the sum, over all n, of the largest stretch of products of n words, by the weights of [`Products`].
    pub(super) sum: f64,
}

impl<M: Affine> Words<M> {
    /// Finds the words with which the fewest images of cells have to be found.
    ///
    /// Words are the maps of instances at first. The word that stretches most is replaced by its continuations, again and
    /// again: the less all words stretch, the less do the errors of images add up, the larger are the cells, and the more
    /// words there are.
    pub(super) fn new<F: Bounded<Map = M>>(objects: &Objects<'_, F>, products: &Products) -> Self {
        let (times, sum) = Self::fewest_images(objects, products);
        let mut search = Search::new(objects, &products.weights);
        (0..times).for_each(|_| search.lengthen());
        let numbers = { search.open.iter() }.map(|(_, Reverse(number))| *number);
        let mut numbers: Vec<usize> = numbers.collect();
        numbers.sort_unstable();
        Self {
            replaced: { numbers.iter() }.map(|it| search.words[*it]).collect(),
            kept: search.kept,
            sum,
        }
    }

    /// Returns how many times a word is replaced until the fewest images have to be found, and the sum of stretches then.
    fn fewest_images<F: Bounded<Map = M>>(
        objects: &Objects<'_, F>,
        products: &Products,
    ) -> (usize, f64) {
        /// Maximum number of words, and of times that one is replaced.
        const MOST: usize = 4096;
        let mut search = Search::new(objects, &products.weights);
        let own = search.kept.len();
        // There are as many cells as the power of the sum with the dimension, and each has an image by every word.
        let images = |search: &Search<'_, F>, sum: f64| {
            let words = search.open.len() + search.kept.len() - own;
            (0..M::Point::DIMENSION).fold(real(words), |all, _| all * sum)
        };
        let mut best = (images(&search, products.sum), 0, products.sum);
        for times in 1..=MOST {
            // The search ends where even without errors that add up there would be more images.
            if images(&search, 1.0) >= best.0 || search.open.len() + search.kept.len() > MOST + own
            {
                break;
            }
            search.lengthen();
            let sum = 1.0 / (1.0 - search.longest());
            let images = images(&search, sum);
            if sum > 0.0 && images < best.0 {
                best = (images, times, sum);
            }
        }
        (best.1, best.2)
    }
}

/// Words that are replaced by longer ones.
struct Search<'a, F: Bounded> {
    objects: &'a Objects<'a, F>,
    weights: &'a [f64],
    /// Words that lead from replaced objects, including those that were replaced by longer ones.
    words: Vec<Word<F::Map>>,
    /// Stretch and index of each word that is not replaced. Stretches are not negative, and ordered as their bits.
    open: BinaryHeap<(u64, Reverse<usize>)>,
    kept: Vec<Word<F::Map>>,
}

impl<'a, F: Bounded> Search<'a, F> {
    /// Creates the words that are maps of instances.
    fn new(objects: &'a Objects<'a, F>, weights: &'a [f64]) -> Self {
        let mut search = Self {
            objects,
            weights,
            words: Vec::new(),
            open: BinaryHeap::new(),
            kept: Vec::new(),
        };
        for index in 0..objects.numbers().len() {
            search.continue_from(Word {
                map: F::Map::IDENTITY,
                inner: index,
                outer: index,
            });
        }
        search
    }

    /// Adds the products of a word with the maps of all instances in the production of its inner object.
    fn continue_from(&mut self, word: Word<F::Map>) {
        let objects = self.objects;
        let product = |(inner, map)| Word {
            map: word.map * map,
            inner,
            outer: word.outer,
        };
        self.kept.extend(objects.kept(word.inner).map(product));
        for word in objects.replaced(word.inner).map(product) {
            let weight = |index: usize| self.weights[objects.numbers()[index]];
            let stretch = word.map.linear().stretch() * weight(word.inner) / weight(word.outer);
            self.open
                .push((stretch.to_bits(), Reverse(self.words.len())));
            self.words.push(word);
        }
    }

    /// Replaces the word that stretches most by its continuations.
    fn lengthen(&mut self) {
        if let Some((_, Reverse(longest))) = self.open.pop() {
            self.continue_from(self.words[longest]);
        }
    }

    /// Returns the largest stretch of a word.
    fn longest(&self) -> f64 {
        self.open
            .peek()
            .map_or(0.0, |(bits, _)| f64::from_bits(*bits))
    }
}
