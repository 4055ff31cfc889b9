//! Contribution mask: the elements of which a pass may paint descendants.

use std::ops::RangeInclusive;

use crate::graph::Object;
use crate::grow::{Element, Subtree};

use super::scene::{Pass, Scene};
use super::short_cuts::ShortCut;

/// Elements that a pass paints, as far as they are known before replacement. Elements without painted
/// descendants are left out.
pub(super) struct ContributionMask {
    /// Whether nothing needs to be known of elements that are not painted.
    pub(super) stands_alone: bool,
    /// Steps in which painted elements are born, if the colour depends on steps.
    pub(super) steps: Option<RangeInclusive<u32>>,
    /// By object, the part of its descendants that is painted; empty unless objects determine classes.
    objects: Vec<Contribution>,
}

/// Selection of painted elements.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Painted {
    All,
    /// Elements born in some steps, from the first to the last.
    Steps(u32, u32),
    /// Elements whose objects are of a class.
    Class(u64),
}

impl Painted {
    /// Returns the selection with steps counted from `born`.
    pub(super) fn since(self, born: u32) -> Self {
        match self {
            Self::Steps(first, last) => {
                let [first, last] = [first, last].map(|step| step.saturating_sub(born));
                Self::Steps(first, last)
            }
            painted => painted,
        }
    }

    /// Returns whether an element is selected.
    pub(super) fn has(self, scene: &Scene<'_>, element: &Element) -> bool {
        match self {
            Self::All => true,
            Self::Steps(first, last) => (first..=last).contains(&element.born),
            Self::Class(class) => {
                let object = &scene.graph.objects()[element.object];
                scene.classes.of_object(object) == Some(class)
            }
        }
    }
}

/// Part of an object's descendants that is painted.
#[derive(Clone, Copy, PartialEq)]
enum Contribution {
    Nothing,
    Some,
    Everything,
}

impl ContributionMask {
    pub(super) fn of(scene: &Scene<'_>, pass: Pass) -> Self {
        let stands_alone = !scene.graph.links();
        let class = match pass {
            Pass::Class(class) if stands_alone => Some(class),
            _ => None,
        };
        Self {
            stands_alone,
            steps: class.and_then(|class| scene.classes.steps(class)),
            objects: class.map_or(Vec::new(), |class| parts(scene, class)),
        }
    }

    /// Returns whether any descendant of an element may be painted.
    #[inline]
    pub(super) fn may_paint(&self, scene: &Scene<'_>, subtree: &Subtree) -> bool {
        if !scene.short_cuts.has(ShortCut::Contribution) {
            return true;
        }
        if self.objects.get(subtree.object) == Some(&Contribution::Nothing) {
            return false;
        }
        self.steps.as_ref().is_none_or(|steps| {
            let before = steps.start().saturating_sub(subtree.born + 1);
            let length = subtree.frame.stretch();
            subtree.born < *steps.end() && scene.culling.lasts(length, before)
        })
    }

    /// Returns the selection of elements that a pass paints, if it depends on births or objects only and no
    /// line leads to elements that are not painted.
    pub(super) fn painted(&self, scene: &Scene<'_>, pass: Pass) -> Option<Painted> {
        let Pass::Class(class) = pass else {
            return None;
        };
        match &self.steps {
            _ if !self.stands_alone => None,
            Some(steps) => Some(Painted::Steps(*steps.start(), *steps.end())),
            None if self.depends_on_objects() => Some(Painted::Class(class)),
            None => (scene.classes.count() == 1).then_some(Painted::All),
        }
    }

    /// Returns whether objects determine which elements are painted.
    #[inline]
    pub(super) fn depends_on_objects(&self) -> bool {
        !self.objects.is_empty()
    }

    /// Returns whether all descendants of an object are painted.
    #[inline]
    pub(super) fn paints_all_of(&self, object: usize) -> bool {
        self.objects.get(object) == Some(&Contribution::Everything)
    }
}

/// Returns, by object, the part of its descendants that is of a class; empty unless objects determine
/// classes.
fn parts(scene: &Scene<'_>, class: u64) -> Vec<Contribution> {
    let graph = scene.graph;
    let of = |object: &Object| scene.classes.of_object(object);
    let Some(classes) = graph.objects().iter().map(of).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    let is_drawn = |object: usize| graph.objects()[object].visible;
    let painted = graph.leading_to(|object| is_drawn(object) && classes[object] == class);
    let others = graph.leading_to(|object| !is_drawn(object) || classes[object] != class);
    let part = |(painted, others)| match (painted, others) {
        (false, _) => Contribution::Nothing,
        (true, true) => Contribution::Some,
        (true, false) => Contribution::Everything,
    };
    painted.into_iter().zip(others).map(part).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::convert::Infallible;

    use super::{Contribution, parts};
    use crate::catalogue::Catalogue;
    use crate::document::Document;
    use crate::graph::Graph;
    use crate::grow::{Element, Enter, Growth, Subtree, Visitor, walk};
    use crate::model::Model;
    use crate::render::Options;
    use crate::render::layout::Layout;
    use crate::render::scene::Scene;
    use crate::style::ColorBy;

    /// Visitor that records, by object, the classes of its drawn descendants.
    struct Lineage<'a> {
        scene: &'a Scene<'a>,
        /// Ancestors of the next element, with the steps of their birth.
        path: Vec<(u32, usize)>,
        drawn: Vec<BTreeSet<u64>>,
    }

    impl Lineage<'_> {
        fn come_to(&mut self, born: u32, object: usize) {
            self.path.retain(|(earlier, _)| *earlier < born);
            self.path.push((born, object));
        }
    }

    impl Visitor for Lineage<'_> {
        type Error = Infallible;

        fn enter(&mut self, subtree: &Subtree) -> Enter {
            self.come_to(subtree.born, subtree.object);
            Enter::Replace
        }

        fn element(&mut self, element: &Element) -> Result<(), Infallible> {
            self.come_to(element.born, element.object);
            let object = &self.scene.graph.objects()[element.object];
            if let Some(class) = self
                .scene
                .classes
                .of_object(object)
                .filter(|_| object.visible)
            {
                for (_, ancestor) in &self.path {
                    self.drawn[*ancestor].insert(class);
                }
            }
            Ok(())
        }
    }

    #[test]
    fn what_is_left_out_has_nothing_of_its_class() {
        let catalogue = Catalogue::embedded();
        // Any map may be the first one, and either star leads to both.
        for (name, color_by, leaves_out) in [
            ("twindragon-ifs", ColorBy::LastMap, true),
            ("square-filled", ColorBy::FirstMap, false),
            ("barnsley-fern", ColorBy::LastMap, true),
            ("snow-crystal", ColorBy::Generator, true),
            ("penrose-stars", ColorBy::Generator, false),
        ] {
            let source = catalogue.rule(name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let model = document.resolve(&[]).unwrap().0;
            let graph = match &model {
                Model::Ifs(system) => Graph::with_last_maps(system).unwrap(),
                model => model.compile(4).unwrap(),
            };
            let mut options = Options::of(model.metadata());
            options.style.color_by = color_by;
            let growth = Growth::steps(4);
            let layout = Layout::find(&graph, &growth, &options).unwrap();
            let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
            let mut lineage = Lineage {
                scene: &scene,
                path: Vec::new(),
                drawn: vec![BTreeSet::new(); graph.objects().len()],
            };
            walk(&graph, &growth, &mut lineage).unwrap();
            let mut nothing = 0;
            for class in scene.classes.all() {
                for (part, drawn) in parts(&scene, class).iter().zip(&lineage.drawn) {
                    match part {
                        Contribution::Nothing => assert!(!drawn.contains(&class), "{name}"),
                        Contribution::Everything => {
                            assert!(drawn.iter().all(|of| *of == class), "{name}");
                        }
                        Contribution::Some => {}
                    }
                    nothing += usize::from(*part == Contribution::Nothing && !drawn.is_empty());
                }
            }
            assert_eq!(nothing > 0, leaves_out, "{name}");
        }
    }
}
