//! Structures of derivations: an object for each state, or one with levels for those that differ by a count.

use std::collections::{BTreeMap, BTreeSet};

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::expression::is_reserved;
use crate::geometry::DVec3;
use crate::style::Colour;

use super::colour::{Colouring, FIRST, colour_text};
use super::derive::{Call, Callee, Derivation, TooLarge};
use super::loops::{Instanced, LEVEL, Loops, NAMES};
use super::program::{Loop, Primitive, Target};

/// A state with the number of generations that are left, where they end before the state does.
type Key = (usize, Option<u32>);

/// A state that is drawn.
struct Node {
    /// Number of the group, and level within it.
    group: usize,
    level: Option<u32>,
    content: Vec<(Call, Place)>,
}

/// Node or primitive that a call leads to.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Node(usize),
    Primitive(Primitive),
    /// Mesh along a passage.
    Mesh(usize),
}

/// States with the same name, which differ by their level.
struct Group {
    name: String,
    /// Numbers of the nodes by their levels.
    nodes: BTreeMap<Option<u32>, usize>,
}

/// Form of the contents of several levels.
struct General {
    /// Node from which the form is taken, and its level.
    of: usize,
    level: u32,
    /// For each call, whether the level of what is called follows that of the node.
    relative: Vec<bool>,
    /// Nodes whose contents have the form.
    covered: BTreeSet<usize>,
}

struct Writer<'d, 'a> {
    derivation: &'d mut Derivation<'a>,
    keys: Vec<Key>,
    numbers: BTreeMap<Key, usize>,
    nodes: Vec<Node>,
    groups: Vec<Group>,
    loops: Loops,
    /// Primitives that are drawn.
    primitives: BTreeSet<Primitive>,
    /// Passages whose meshes are drawn.
    meshes: BTreeSet<usize>,
}

/// Returns the keys of the structure of a derivation that has been built, and that ends after a number of generations unless
/// it is complete; `None` if nothing is drawn.
pub(super) fn structure(
    derivation: &mut Derivation,
    generations: Option<u32>,
) -> Result<Option<Entries>, TooLarge> {
    let mut writer = Writer {
        derivation,
        keys: Vec::new(),
        numbers: BTreeMap::new(),
        nodes: Vec::new(),
        groups: Vec::new(),
        loops: Loops::default(),
        primitives: BTreeSet::new(),
        meshes: BTreeSet::new(),
    };
    let mut open = 0;
    let scene = writer.content(0, generations)?;
    while open < writer.keys.len() {
        let (state, left) = writer.keys[open];
        let content = writer.content(state, left)?;
        writer.nodes.push(Node {
            group: 0,
            level: None,
            content,
        });
        open += 1;
    }
    if scene.is_empty() {
        return Ok(None);
    }
    writer.group();
    Ok(Some(writer.entries(&scene)))
}

impl Writer<'_, '_> {
    /// Returns the calls of a state that draw something in the generations that are left, the state's own included.
    fn content(&mut self, state: usize, left: Option<u32>) -> Result<Vec<(Call, Place)>, TooLarge> {
        let left = match left {
            Some(0) => return Ok(Vec::new()),
            Some(left) => Some(left - 1),
            None => None,
        };
        let mut content = Vec::new();
        for call in self.derivation.content(state)?.to_vec() {
            let place = match call.callee {
                Callee::Nothing => continue,
                Callee::Primitive(primitive) => Place::Primitive(primitive),
                Callee::Mesh(passage) => Place::Mesh(passage),
                Callee::State(callee) => {
                    let first = self.derivation.first(callee)?;
                    if first == u32::MAX || left.is_some_and(|left| first > left) {
                        continue;
                    }
                    Place::Node(self.node(callee, left)?)
                }
            };
            if left != Some(0) {
                content.push((call, place));
            }
        }
        Ok(content)
    }

    /// Returns the number of the node of a state.
    fn node(&mut self, mut state: usize, left: Option<u32>) -> Result<usize, TooLarge> {
        let height = self.derivation.height(state)?;
        let left = left.filter(|left| *left < height);
        if let Some(left) = left
            && self.derivation.states[state].serial.is_none()
        {
            // Counts that are not used up do not matter.
            let mut same = self.derivation.states[state].clone();
            same.left.retain(|_, count| *count < left);
            let depth = |it: usize| self.derivation.program.alternatives[it].depth;
            let removed = self.derivation.states[state].left.keys();
            let is_sound = removed
                .filter(|it| !same.left.contains_key(it))
                .all(|it| depth(*it).is_some_and(|depth| depth >= left));
            if is_sound {
                state = self.derivation.number(same)?;
            }
        }
        let key = (state, left);
        if let Some(number) = self.numbers.get(&key) {
            return Ok(*number);
        }
        let number = self.keys.len();
        self.keys.push(key);
        self.numbers.insert(key, number);
        Ok(number)
    }

    /// Divides the nodes into groups with levels.
    fn group(&mut self) {
        // The first name of a rule is its own, further ones are numbered.
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        let mut groups = BTreeMap::new();
        for (number, (state, left)) in self.keys.iter().enumerate() {
            let state = &self.derivation.states[*state];
            let alternative = &self.derivation.program.alternatives[state.alternative];
            let own = self.derivation.left(&state.left, state.alternative);
            let mut others = state.left.clone();
            let (kind, level) = match (state.serial, left) {
                (Some(_), _) => ((0, number), None),
                (None, Some(left)) => ((1, 0), Some(*left)),
                (None, None) => match (own, others.pop_first()) {
                    (Some(own), first) => {
                        others.extend(first);
                        others.remove(&state.alternative);
                        ((2, 0), Some(own))
                    }
                    (None, Some((counted, count))) => ((3, counted), Some(count)),
                    (None, None) => ((4, 0), None),
                },
            };
            let key = (state.alternative, state.colour, state.passage, others, kind);
            let group = *groups.entry(key).or_insert_with(|| {
                let rule = alternative
                    .rule
                    .map(|rule| &self.derivation.program.rules[rule]);
                let name = plain(rule.map_or("", |rule| &rule.name));
                let count = names.entry(name.clone()).or_insert(0);
                *count += 1;
                let name = match *count {
                    1 => name,
                    count => format!("{name}__{count}"),
                };
                self.groups.push(Group {
                    name,
                    nodes: BTreeMap::new(),
                });
                self.groups.len() - 1
            });
            self.groups[group].nodes.insert(level, number);
            (self.nodes[number].group, self.nodes[number].level) = (group, level);
        }
    }

    /// Returns the keys of the structure.
    fn entries(mut self, scene: &[(Call, Place)]) -> Entries {
        let scene = self.instances(usize::MAX, scene, None);
        let mut objects = Entries::default();
        for group in 0..self.groups.len() {
            let general = self.general(group);
            for (level, number) in self.groups[group].nodes.clone() {
                if general
                    .as_ref()
                    .is_some_and(|it| it.covered.contains(&number))
                {
                    continue;
                }
                let name = self.text(number, level);
                let instances = self.instances(number, &self.nodes[number].content.clone(), None);
                objects = objects.add(name, instances);
            }
            if let Some(general) = general {
                let content = self.nodes[general.of].content.clone();
                let instances = self.instances(general.of, &content, Some(&general));
                let name = format!("{}({LEVEL})", self.groups[group].name);
                objects = objects.add(name, instances);
            }
        }
        for (name, instances) in std::mem::take(&mut self.loops.objects) {
            objects = objects.add(name, instances);
        }
        for primitive in &self.primitives {
            objects = objects.add(primitive.name(), shape(*primitive));
        }
        for passage in &self.meshes {
            let sides = self.derivation.passages.get(*passage);
            let sides = sides.sides(self.derivation.program);
            objects = objects.add(mesh_name(*passage), polygons(&sides));
        }
        let half = || NumberText::from("1/2").0;
        let background = self.derivation.program.settings.background;
        let style = Entries::default()
            .set("stroke", colour_text(FIRST))
            .set("fill", colour_text(FIRST))
            .set_some("background", background.map(colour_text));
        // The cube is centred at the origin in objects, and has a corner there in the scene.
        let scene = Entries::default()
            .set("union", scene)
            .set("translate", sequence([half(), half(), half()]));
        let view = Entries::default()
            .set("shade", Value::Text("cosine".into()))
            .set("ambient", NumberText::from(0.3).0);
        Entries::default()
            .set("kind", Value::Text("instancing".into()))
            .set("space", Value::Number(3.0))
            .set("objects", objects.value())
            .set("scene", scene.value())
            .set("style", style.value())
            .set("view", view.value())
    }

    /// Returns the form that the contents of most levels of a group have.
    fn general(&self, group: usize) -> Option<General> {
        let mut levels = self.groups[group].nodes.iter().rev();
        let ((level, of), (below, other)) = (levels.next()?, levels.next()?);
        let (level, of, below, other) = ((*level)?, *of, (*below)?, *other);
        if level - below != 1 {
            return None;
        }
        let contents = [of, other].map(|it| &self.nodes[it].content);
        let relative = contents[0].iter().zip(contents[1]);
        let relative = relative.map(|((_, a), (_, b))| a != b).collect();
        let mut general = General {
            of,
            level,
            relative,
            covered: BTreeSet::new(),
        };
        let nodes = self.groups[group].nodes.iter();
        let covered = nodes.filter(|(_, number)| self.is_covered(&general, **number));
        general.covered = covered.map(|(_, number)| *number).collect();
        (general.covered.contains(&of) && general.covered.contains(&other)).then_some(general)
    }

    /// Returns whether the content of a node has a form.
    fn is_covered(&self, general: &General, number: usize) -> bool {
        let (of, node) = (&self.nodes[general.of], &self.nodes[number]);
        let Some(level) = node.level else {
            return false;
        };
        let lower = i64::from(general.level) - i64::from(level);
        let all = of.content.iter().zip(&node.content).zip(&general.relative);
        of.content.len() == node.content.len() && general.relative.len() == node.content.len() && {
            all
        }
        .all(|(((a, to), (b, place)), is_relative)| {
            let parts = |call: &Call| (call.action, call.times.clone(), call.colour);
            let is_same = match (to, place) {
                (Place::Node(to), Place::Node(place)) if *is_relative => {
                    let [to, place] = [to, place].map(|it| &self.nodes[*it]);
                    let levels = to.level.zip(place.level);
                    to.group == place.group
                        && levels.is_some_and(|(a, b)| i64::from(a) - i64::from(b) == lower)
                }
                _ => to == place,
            };
            is_same && parts(a) == parts(b)
        })
    }

    /// Returns the name of a node with its level.
    fn text(&self, number: usize, level: Option<u32>) -> String {
        let group = &self.groups[self.nodes[number].group];
        match level.filter(|_| group.nodes.len() > 1) {
            Some(level) => format!("{}({level})", group.name),
            None => group.name.clone(),
        }
    }

    /// Returns the instances of the content of a node, or of the scene.
    fn instances(
        &mut self,
        number: usize,
        content: &[(Call, Place)],
        general: Option<&General>,
    ) -> Value {
        let mut instances = Vec::new();
        for (at, (call, place)) in content.iter().enumerate() {
            let of = match *place {
                Place::Primitive(primitive) => {
                    self.primitives.insert(primitive);
                    Instanced {
                        object: primitive.name().to_owned(),
                        has_level: false,
                        colour: call.colour.map(Colour::of_rgba),
                    }
                }
                Place::Mesh(passage) => {
                    self.meshes.insert(passage);
                    Instanced {
                        object: mesh_name(passage),
                        has_level: false,
                        colour: call.colour.map(Colour::of_rgba),
                    }
                }
                Place::Node(callee) => {
                    let node = &self.nodes[callee];
                    let general = general.filter(|it| it.relative[at]);
                    let object = match general.zip(node.level) {
                        Some((general, level)) => {
                            let name = &self.groups[node.group].name;
                            match i64::from(level) - i64::from(general.level) {
                                0 => format!("{name}({LEVEL})"),
                                more if more > 0 => format!("{name}({LEVEL} + {more})"),
                                less => format!("{name}({LEVEL} - {})", -less),
                            }
                        }
                        None => self.text(callee, node.level),
                    };
                    Instanced {
                        object,
                        has_level: general.is_some(),
                        colour: None,
                    }
                }
            };
            let state = self.keys.get(number).map_or(0, |(state, _)| *state);
            let loops = self.loops_of(state, call);
            instances.extend(self.loops.instances(&of, &loops));
        }
        sequence(instances)
    }

    /// Returns the loops of a call, of which the last one is applied first.
    fn loops_of(&self, state: usize, call: &Call) -> Vec<Loop> {
        let alternative = self.derivation.states[state].alternative;
        let action = &self.derivation.program.alternatives[alternative].actions[call.action];
        let mut loops = action.loops.clone();
        for (it, times) in loops.iter_mut().zip(call.times.iter().flatten()) {
            it.motion = it.motion.power(*times);
            it.colouring = it.colouring.power(*times);
            it.count = 1;
        }
        // An absolute colour replaces those outside.
        let absolute = { loops.iter() }.rposition(|it| it.colouring.absolute.is_some());
        for it in &mut loops[..absolute.unwrap_or(0)] {
            it.colouring = Colouring::default();
        }
        loops
    }
}

/// Returns the name of an object for a rule: letters, digits and single lines below.
fn plain(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let name = words.join("_");
    let is_taken = NAMES.contains(&&name[..])
        || name == LEVEL
        || Target::from_name(&name).is_some()
        || is_reserved(&name);
    if is_taken || !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return format!("r_{name}");
    }
    name
}

/// Returns the name of the object for the mesh along a passage, which no rule has.
fn mesh_name(passage: usize) -> String {
    format!("mesh__{}", passage + 1)
}

/// Returns the instances of an object that consists of polygons.
fn polygons(corners: &[Vec<DVec3>]) -> Value {
    let number = |value: f64| NumberText::from(value).0;
    let polygon = |corners: &Vec<DVec3>| {
        let corners = corners.iter().map(|it| sequence(it.to_array().map(number)));
        Entries::default().set("polygon", sequence(corners)).value()
    };
    sequence(corners.iter().map(polygon))
}

/// Returns the instances of an object that is a primitive in the unit cube about the origin.
fn shape(primitive: Primitive) -> Value {
    let number = |value: f64| NumberText::from(value).0;
    let point = |at: [f64; 3]| sequence(at.map(number));
    let set = |name: &str, value: Value| sequence([Entries::default().set(name, value).value()]);
    let ends = |from: [f64; 3], to: [f64; 3]| {
        let ends = Entries::default().set("from", point(from));
        ends.set("to", point(to))
    };
    match primitive {
        Primitive::Box => set("box", ends([-0.5; 3], [0.5; 3]).value()),
        Primitive::Sphere => {
            let radius = Entries::default().set("radius", number(0.5));
            set("sphere", radius.value())
        }
        Primitive::Cylinder => {
            let ends = ends([-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
            set("cylinder", ends.set("radius", number(0.5)).value())
        }
        Primitive::Line => {
            let ends = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]].map(point);
            set("segment", sequence(ends))
        }
        Primitive::Dot => set("point", point([0.0; 3])),
        Primitive::Grid => {
            let edges = (0..3).flat_map(|axis: usize| {
                [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(|[a, b]| {
                    let end = |along: f64| {
                        let mut at = [along; 3];
                        (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (a, b);
                        point(at)
                    };
                    let ends = sequence([end(-0.5), end(0.5)]);
                    Entries::default().set("segment", ends).value()
                })
            });
            sequence(edges)
        }
    }
}
