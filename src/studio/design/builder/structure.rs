//! Scenes of instancing structures: objects, the instances in each, and shapes of lines.

use crate::document::node::{Node, Value};
use crate::edit::PathStep;

use super::super::instances;
use super::super::scene::{MOST, Scene};
use super::{Builder, below};

impl Builder<'_> {
    /// Shows an instancing structure.
    pub(in crate::studio::design) fn structure(mut self) -> Scene {
        self.names = self.names.with_drawn(self.root.get("random"), 0.5);
        self.scene.names = self.names.clone();
        let mut unions = Vec::new();
        if let Some(scene) = self.root.get("scene") {
            unions.push((vec!["scene".into()], "Scene".to_owned(), scene));
        }
        let objects = self.root.get("objects");
        if let Some(Value::Mapping(entries)) = objects.map(|it| &it.value) {
            for (key, node) in entries {
                let at = vec!["objects".into(), PathStep::Key(key.name.clone())];
                unions.push((at, key.name.clone(), node));
            }
        }
        if let Some(objects) = objects {
            self.placed(objects, &unions);
        }
        for (at, title, node) in &unions {
            self.union(at, title, node);
        }
        self.scene
    }

    /// Shows the transforms of whole objects, if there are any.
    fn placed(&mut self, objects: &Node, unions: &[(Vec<PathStep>, String, &Node)]) {
        let all = unions.iter().filter_map(|(at, name, node)| {
            let is_union = matches!(node.value, Value::Mapping(_));
            let handle = instances::handle(name.clone(), node, at.clone(), &self.names);
            handle.filter(|it| is_union && !it.form.is_empty())
        });
        let handles: Vec<_> = all.collect();
        if !handles.is_empty() {
            self.parallelograms(&["objects".into()], "Objects", objects, handles);
        }
    }

    /// Shows the instances of a union, or of each of its alternatives.
    fn union(&mut self, at: &[PathStep], title: &str, node: &Node) {
        if let Some(list) = node.get("union") {
            return self.instances(&below(at, &["union".into()]), title, list);
        }
        if let Some(Value::Sequence(all)) = node.get("at_random").map(|it| &it.value) {
            for (number, alternative) in all.iter().enumerate() {
                let at = below(at, &["at_random".into(), number.into()]);
                self.union(
                    &at,
                    &format!("{title}, alternative {}", number + 1),
                    alternative,
                );
            }
            return;
        }
        self.instances(at, title, node);
    }

    fn instances(&mut self, at: &[PathStep], title: &str, list: &Node) {
        let Value::Sequence(items) = &list.value else {
            return;
        };
        let shown = self.scene.panels.iter();
        let shown: usize = shown.map(|it| it.maps.len() + it.points.len()).sum();
        if items.is_empty() || shown + items.len() > MOST {
            return;
        }
        let mut shapes = Vec::new();
        for (number, item) in items.iter().enumerate() {
            let at = below(at, &[number.into()]);
            shapes.push(self.shape(&at, &format!("{title}, {}", number + 1), item));
        }
        let mut handles = instances::handles(list, at, &self.names);
        // Shapes without transforms are moved by their points.
        handles.retain(|it| match it.at.last() {
            Some(PathStep::Item(number)) => !shapes[*number] || !it.form.is_empty(),
            _ => true,
        });
        if !handles.is_empty() {
            self.parallelograms(at, title, list, handles);
        }
    }
}
