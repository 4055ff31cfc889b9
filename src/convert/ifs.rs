//! Conversion to an iterated function system.
//!
//! A system with a digraph has a set A_j = f_j(C) ∪ ⋃ f_j(A_i) for every map, and is drawn as the union of
//! these sets. Objects whose instances all have the same map are sets of this form already. Of all other
//! objects, every instance becomes a map: f_e(K_c) for an instance e of object c, which may follow the maps
//! of the instances in c. For the union of these sets to be the scene, the coordinates of every object have
//! to be those of the scene at the place where the object first occurs: with Q_b the composed map of the path
//! to object b, the map is Q_b f_e Q_c⁻¹. Every instance of the scene has a copy of the objects that it leads
//! to, and edges stay inside a copy. Shapes that do not follow every map, as condensation sets do, become
//! maps too: those of a line, a triangle or a point to its parts.

use std::collections::VecDeque;

use crate::build::written::{Entries, sequence};
use crate::digraph::components;
use crate::document::node::Value;
use crate::geometry::Linear;

use super::convertible::Convertible;
use super::number::value;
use super::structure::{PlacedObject, Structure};
use super::{Keeps, Refusal};

/// Limit of the number of maps.
const MAX_MAPS: usize = 1_000;

/// An iterated function system with a digraph.
struct RecurrentSystem<M> {
    maps: Vec<M>,
    /// Edges: a map, and a map that may follow it.
    edges: Vec<[usize; 2]>,
    /// The condensation sets.
    sets: Vec<PlacedObject<M>>,
    /// Map of the initial set.
    initial: M,
}

impl<M: Convertible> RecurrentSystem<M> {
    /// Creates a system without maps.
    fn new(initial: M) -> Self {
        Self {
            maps: Vec::new(),
            edges: Vec::new(),
            sets: Vec::new(),
            initial,
        }
    }
}

pub(super) fn write<M: Convertible>(
    structure: &Structure<M>,
    keeps: Keeps,
) -> Result<Entries, Refusal> {
    if keeps == Keeps::Approximants {
        check_steps(structure)?;
    }
    let system = match direct(structure) {
        Some(system) => system,
        None => match placed(structure) {
            Err(Refusal::ShapesInPart | Refusal::NoMaps) if keeps == Keeps::Limit => {
                placed(&M::with_copies(structure)?)?
            }
            system => system?,
        },
    };
    let maps = sequence(system.maps.iter().map(|map| map.written().value()));
    let sets: Result<Vec<_>, _> = system
        .sets
        .iter()
        .map(|placed| M::set(&structure.shapes[placed.shape], &placed.map))
        .collect();
    let sets = sets?.into_iter().map(Entries::value);
    let set = |shape: usize| {
        let initial = M::set(&structure.shapes[shape], &system.initial);
        initial.map(Entries::value)
    };
    let initial = match structure.initial() {
        // The elements that are replaced would not be drawn beside condensation sets.
        None if !system.sets.is_empty() => { structure.drawn_before() }
            .find_map(|shape| set(shape).ok())
            .map(Ok),
        shape => shape.flatten().map(set),
    };
    let initial = keeps.initial(initial)?;
    let count = system.maps.len();
    let edges = (system.edges.len() < count * count).then(|| edges(&system.edges, count));
    Ok(Entries::default()
        .set("maps", maps)
        .set_some("edges", edges)
        .set_some(
            "condensation",
            (!system.sets.is_empty()).then(|| sequence(sets)),
        )
        .set_some("initial", initial))
}

/// Returns an error if the approximants of a system differ from those of the structure.
fn check_steps<M: Convertible>(structure: &Structure<M>) -> Result<(), Refusal> {
    let refuse = |what| Err(Refusal::Steps(what));
    if structure.objects.len() != 1 || structure.scene.len() != 1 {
        return refuse("a system draws one initial set at first, in one place");
    }
    match structure.initial() {
        Some(Some(_)) => Ok(()),
        Some(None) => refuse("what is replaced is not drawn, and an initial set is"),
        None => refuse("what is replaced does not all look the same, as an initial set does"),
    }
}

/// Writes, for every map, the maps that may follow it.
fn edges(edges: &[[usize; 2]], count: usize) -> Value {
    let number = |map: usize| value(f64::from(u32::try_from(map + 1).unwrap_or(u32::MAX)));
    let entries = (0..count).fold(Entries::default(), |entries, from| {
        let mut following: Vec<usize> = edges
            .iter()
            .filter(|edge| edge[0] == from)
            .map(|edge| edge[1])
            .collect();
        following.sort_unstable();
        entries.add(
            (from + 1).to_string(),
            sequence(following.into_iter().map(number)),
        )
    });
    entries.value()
}

/// Returns the system with one map for each object, if all instances in every object have the same map.
fn direct<M: Convertible>(structure: &Structure<M>) -> Option<RecurrentSystem<M>> {
    let is_here = |placed: &PlacedObject<M>| placed.map == M::IDENTITY;
    let (objects, sets): (Vec<_>, Vec<_>) = structure
        .scene
        .iter()
        .cloned()
        .partition(|placed| placed.object.is_some());
    let mut all: Vec<usize> = objects.iter().filter_map(|placed| placed.object).collect();
    all.sort_unstable();
    let each_once = all.iter().copied().eq(0..structure.objects.len());
    if all.is_empty() || !each_once || !objects.iter().all(is_here) {
        return None;
    }
    let mut system = RecurrentSystem {
        sets,
        ..RecurrentSystem::new(M::IDENTITY)
    };
    for (number, object) in structure.objects.iter().enumerate() {
        let map = object.iter().find(|placed| placed.object.is_some())?.map;
        let mut befores: Vec<usize> = Vec::new();
        let mut kept: Vec<&PlacedObject<M>> = Vec::new();
        for placed in object {
            match placed.object {
                Some(before) => {
                    if !placed.map.is_same(&map) || befores.contains(&before) {
                        return None;
                    }
                    befores.push(before);
                }
                None => kept.push(placed),
            }
        }
        let moved = |set: &PlacedObject<M>| PlacedObject {
            map: map * set.map,
            ..set.clone()
        };
        let moved: Vec<_> = system.sets.iter().map(moved).collect();
        if !is_union(&kept.into_iter().cloned().collect::<Vec<_>>(), &moved) {
            return None;
        }
        system.maps.push(map);
        let edges = befores.into_iter().map(|before| [before, number]);
        system.edges.extend(edges);
    }
    let left = |map: usize| system.edges.iter().any(|edge| edge[0] == map);
    (0..system.maps.len()).all(left).then_some(system)
}

/// Returns whether two lists of shapes have the same union.
fn is_union<M: Convertible>(a: &[PlacedObject<M>], b: &[PlacedObject<M>]) -> bool {
    let within = |a: &[PlacedObject<M>], b: &[PlacedObject<M>]| {
        a.iter().all(|one| {
            let mut all = b.iter();
            all.any(|other| other.shape == one.shape && one.map.is_same(&other.map))
        })
    };
    within(a, b) && within(b, a)
}

/// An object in the coordinates of the scene.
struct Vertex<M> {
    /// Index of the scene's instance that it descends from.
    copy: usize,
    object: usize,
    /// Composed map of the path to the object.
    frame: M,
    /// Instances in the object, each with the index of its vertex if it is replaced.
    instances: Vec<(PlacedObject<M>, Option<usize>)>,
}

/// Returns the system with one map for each instance.
fn placed<M: Convertible>(structure: &Structure<M>) -> Result<RecurrentSystem<M>, Refusal> {
    let expanded = expanded(structure)?;
    let (roots, loose): (Vec<_>, Vec<_>) = expanded
        .scene
        .into_iter()
        .partition(|placed| placed.object.is_some());
    let mut distinct: Vec<PlacedObject<M>> = Vec::new();
    for root in roots {
        let same =
            |known: &PlacedObject<M>| known.object == root.object && known.map.is_same(&root.map);
        if !distinct.iter().any(same) {
            distinct.push(root);
        }
    }
    if distinct.is_empty() {
        return Err(Refusal::NoMaps);
    }
    let vertices = vertices(structure, &distinct, &expanded.objects)?;
    let mut system = RecurrentSystem::new(distinct[0].map);
    // The vertex that contains each map's instance, and the vertex that it is an image of.
    let mut ends = Vec::new();
    let mut sets: Option<Vec<PlacedObject<M>>> = None;
    for (number, vertex) in vertices.iter().enumerate() {
        let mut own = Vec::new();
        for (placed, inside) in &vertex.instances {
            let map = vertex.frame * placed.map;
            match *inside {
                Some(inside) => {
                    let is_plain =
                        vertex.frame == M::IDENTITY && vertices[inside].frame == M::IDENTITY;
                    system.maps.push(if is_plain {
                        placed.map
                    } else {
                        (map * vertices[inside].frame.inverse()).settled()
                    });
                    ends.push((number, inside));
                }
                None => own.push(PlacedObject {
                    map,
                    ..placed.clone()
                }),
            }
        }
        match &sets {
            None => sets = Some(own),
            Some(known) if is_union(known, &own) => {}
            Some(_) => return Err(Refusal::ShapesInPart),
        }
    }
    system.sets = sets.unwrap_or_default();
    // Shapes of the scene outside all objects would follow every map.
    let with_loose: Vec<_> = system.sets.iter().chain(&loose).cloned().collect();
    if !is_union(&with_loose, &system.sets) {
        return Err(Refusal::ShapesInPart);
    }
    for (to, &(_, inside)) in ends.iter().enumerate() {
        let before = (0..ends.len()).filter(|&from| ends[from].0 == inside);
        system.edges.extend(before.map(|from| [from, to]));
    }
    Ok(system)
}

/// Returns the objects that every instance of the scene leads to, with invertible maps of the paths to them.
fn vertices<M: Convertible>(
    structure: &Structure<M>,
    roots: &[PlacedObject<M>],
    objects: &[Vec<PlacedObject<M>>],
) -> Result<Vec<Vertex<M>>, Refusal> {
    let mut vertices: Vec<Vertex<M>> = Vec::new();
    let mut maps = 0;
    for (copy, root) in roots.iter().enumerate() {
        let first = vertices.len();
        let is_flat = |map: &M| map.linear().determinant() == 0.0;
        if is_flat(&root.map) {
            return Err(Refusal::Flat("an instance of the scene".into()));
        }
        let mut open = VecDeque::new();
        open.extend(root.object.map(|object| (object, root.map)));
        // A map that flattens the plane is used only if no other path leads to an object.
        let mut flat = None;
        while let Some((object, frame)) = open.pop_front() {
            let known = |vertex: &Vertex<M>| vertex.object == object;
            if vertices[first..].iter().any(known) {
                continue;
            }
            for (number, placed) in objects[object].iter().enumerate() {
                maps += usize::from(placed.object.is_some());
                let way = frame * placed.map;
                if let Some(inside) = placed.object {
                    if is_flat(&way) {
                        flat = flat.or(Some((object, number, inside)));
                    } else {
                        open.push_back((inside, way));
                    }
                }
            }
            if maps > MAX_MAPS {
                return Err(Refusal::TooManyMaps(MAX_MAPS));
            }
            vertices.push(Vertex {
                copy,
                object,
                frame,
                instances: Vec::new(),
            });
        }
        for number in first..vertices.len() {
            let mut instances = Vec::new();
            for placed in &objects[vertices[number].object] {
                let inside = placed.object.map(|object| {
                    let mut all = vertices[first..].iter();
                    let inside = all.position(|vertex| vertex.object == object);
                    inside.map(|inside| first + inside)
                });
                if let (Some(None), Some((object, number, _))) = (inside, flat) {
                    return Err(Refusal::Flat(structure.called(Some(object), number)));
                }
                instances.push((placed.clone(), inside.flatten()));
            }
            vertices[number].instances = instances;
        }
    }
    debug_assert!(vertices.is_sorted_by_key(|vertex| vertex.copy));
    Ok(vertices)
}

struct Expanded<M> {
    scene: Vec<PlacedObject<M>>,
    objects: Vec<Vec<PlacedObject<M>>>,
}

/// Returns scene and objects with only those objects that lead back to themselves; others are replaced by
/// their content.
fn expanded<M: Convertible>(structure: &Structure<M>) -> Result<Expanded<M>, Refusal> {
    let inside =
        |object: &Vec<PlacedObject<M>>| object.iter().filter_map(|placed| placed.object).collect();
    let targets: Vec<Vec<usize>> = structure.objects.iter().map(inside).collect();
    let components = components(&targets);
    let leads_back = |object: usize| {
        let mut targets = targets[object].iter();
        targets.any(|&target| components[target] == components[object])
    };
    let expand = |all: &[PlacedObject<M>]| -> Result<Vec<PlacedObject<M>>, Refusal> {
        let mut open: Vec<PlacedObject<M>> = all.iter().rev().cloned().collect();
        let mut made = Vec::new();
        while let Some(placed) = open.pop() {
            match placed.object {
                Some(object) if !leads_back(object) => {
                    let inside = structure.objects[object].iter().rev();
                    open.extend(inside.map(|inside| PlacedObject {
                        map: placed.map * inside.map,
                        ..inside.clone()
                    }));
                }
                _ => made.push(placed),
            }
            if made.len() + open.len() > MAX_MAPS {
                return Err(Refusal::TooManyMaps(MAX_MAPS));
            }
        }
        Ok(made)
    };
    let objects = structure.objects.iter().map(|object| expand(object));
    Ok(Expanded {
        scene: expand(&structure.scene)?,
        objects: objects.collect::<Result<_, _>>()?,
    })
}
