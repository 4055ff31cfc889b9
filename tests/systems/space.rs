//! Sets of systems in space: counts, extents and colours by maps.

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::{Document, Setting};
use kfrac::geometry::{DVec3, Frame3, Outline as _, Round, Solid};
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use std::sync::Arc;

fn compiled(source: &Arc<Source>, settings: &[Setting]) -> Graph<Frame3> {
    let document = Document::read(source, &Catalogue::embedded()).unwrap();
    let (model, doubts) = document.resolve(settings).unwrap();
    assert!(doubts.is_empty(), "{doubts}");
    model.compile_in_space(false).unwrap()
}

fn graph(text: &str) -> Graph<Frame3> {
    compiled(
        &Source::new("test.yaml", format!("kind: ifs\nspace: 3\n{text}")),
        &[],
    )
}

fn structure(text: &str) -> Graph<Frame3> {
    compiled(
        &Source::new("test.yaml", format!("kind: instancing\nspace: 3\n{text}")),
        &[],
    )
}

const FLAKE: &str = "
maps:
  - {scale: 1/2, translate: [3/2, 0, 0]}
  - {scale: 1/2, translate: [-3/2, 0, 0]}
  - {scale: 1/2, translate: [0, 3/2, 0]}
  - {scale: 1/2, translate: [0, -3/2, 0]}
  - {scale: 1/2, translate: [0, 0, 3/2]}
  - {scale: 1/2, translate: [0, 0, -3/2]}
condensation: [{sphere: {}}]
";

#[test]
fn condensation_sets_are_drawn_at_every_level() {
    let flake = graph(FLAKE);
    let mut forecast = flake.forecast().unwrap();
    let levels = [(1u32, 1.0), (7, 2.0), (43, 2.5), (259, 2.75)];
    for (step, (visible, reach)) in (0..).zip(levels) {
        let level = forecast.level();
        // The whole, which is not drawn, counts.
        let fertile = level.fertile.to_string().parse::<u32>().unwrap();
        let all = level.elements.to_string().parse::<u32>().unwrap();
        assert_eq!(all - fertile, visible);
        let bounds = flake.bounds(step).unwrap();
        assert!((bounds.max() - DVec3::splat(reach)).length() < 1e-12);
        forecast.advance();
    }
    let limit = flake.limit_bounds().unwrap();
    assert!((limit.max() - DVec3::splat(3.0)).length() < 1e-12);
    assert!((limit.min() + DVec3::splat(3.0)).length() < 1e-12);
}

/// The digraph is that of Hart's pound sign: no map twice in a row.
#[test]
fn recurrent_systems_have_sets_too() {
    let signs = [-1, 1];
    let mut text = "maps:\n".to_owned();
    for [x, y, z] in signs
        .map(|x| signs.map(|y| signs.map(|z| [x, y, z])))
        .concat()
        .concat()
    {
        text.push_str(&format!(
            "  - {{scale: 1/2, translate: [{x}/2, {y}/2, {z}/2]}}\n"
        ));
    }
    text.push_str("edges:\n");
    for from in 1..=8 {
        let others: Vec<_> = (1..=8)
            .filter(|to| *to != from)
            .map(|to| to.to_string())
            .collect();
        text.push_str(&format!("  {from}: [{}]\n", others.join(", ")));
    }
    let bare = graph(&text);
    let mut forecast = bare.forecast().unwrap();
    for cells in ["1", "8", "56", "392", "2744"] {
        assert_eq!(forecast.level().elements.to_string(), cells);
        forecast.advance();
    }
    let with_sets = graph(&format!("{text}condensation: [{{solid: octahedron}}]\n"));
    assert!(with_sets.limit_bounds().unwrap().max().x > 0.999);
}

/// A sheared ball reaches as far as the lengths of the rows of its map.
#[test]
fn extents_of_sheared_sets_are_exact() {
    let sheared = graph(
        "
maps: [{matrix: [[1/2, 1/4, 0], [0, 1/3, 1/5], [0, 0, 0]], translate: [1, 0, 0]}]
initial: {sphere: {}}
",
    );
    let bounds = sheared.bounds(1).unwrap();
    let half = DVec3::new(0.3125f64.sqrt(), (1.0f64 / 9.0 + 0.04).sqrt(), 0.0);
    assert!(
        (bounds.max() - (DVec3::X + half)).length() < 1e-14,
        "{bounds:?}"
    );
    assert!(
        (bounds.min() - (DVec3::X - half)).length() < 1e-14,
        "{bounds:?}"
    );
}

/// Hart 1992, figure 5: 8 · 7ⁿ cells after n steps.
#[test]
fn the_pound_sign_has_its_cells() {
    let source = Catalogue::embedded().rule("pound-sign-in-space").unwrap();
    let sign = compiled(&source, &[]);
    let mut forecast = sign.forecast().unwrap();
    for cells in ["8", "56", "392", "2744", "19208"] {
        assert_eq!(forecast.level().elements.to_string(), cells);
        forecast.advance();
    }
    let limit = sign.limit_bounds().unwrap();
    assert!((limit.max() - DVec3::ONE).length() < 1e-12);
    assert!(sign.tints());
}

/// Hart 1992, equation (8): with n levels, 2 · 3ⁿ − 1 segments, of which 3ⁿ carry leaves.
#[test]
fn the_tree_has_its_segments() {
    let source = Catalogue::embedded().rule("hart-tree").unwrap();
    for (levels, segments, tips) in [(1u32, 5, 3), (2, 17, 9), (4, 161, 81)] {
        let tree = compiled(&source, &[("levels", f64::from(levels)).into()]);
        let elements = Elements::of(&tree, &Growth::steps(3 * levels + 1));
        let (mut cylinders, mut leaves, mut least, mut top) = (0, 0, f64::INFINITY, 0.0f64);
        for element in elements {
            let (_, element) = element.unwrap();
            let object = &tree.objects()[element.object];
            assert!(object.is_kept());
            match tree.base_elements()[object.base_element].primitive() {
                Some(Round::Cylinder) => {
                    cylinders += 1;
                    let linear = element.frame.map().matrix3;
                    // A trunk is thinned without being skewed.
                    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
                    assert!(x.dot(y).abs().max(y.dot(z).abs()) < 1e-12);
                    assert!((x.length() - z.length()).abs() < 1e-12);
                    least = least.min(x.length() / 0.06);
                    top = top.max(y.length());
                }
                _ => leaves += 1,
            }
        }
        assert_eq!((cylinders, leaves), (segments, 3 * tips));
        let thin = (0.902f64 * 0.64).powi(i32::try_from(levels).unwrap());
        assert!((least - thin).abs() < 1e-12 && top == 1.0);
    }
}

/// Names of primitives, and transforms in their order, against maps written out.
#[test]
fn structures_are_made_of_canonical_primitives() {
    let made = structure(
        "
objects:
  cone: [{object: sphere, scale: [2, 1, 1], rotate: {z: 90}, translate: [0, 0, 3]}]
scene:
  - cone
  - {object: cylinder, translate: [0, 0, 1], rotate: [{x: 90}, {axis: [0, 0, 2], angle: 90}]}
  - {object: plane, matrix: [[1, 0, 0], [0, 1, 0], [0, 0, 4]]}
",
    );
    let drawn: Vec<_> = Elements::of(&made, &Growth::steps(1))
        .map(|element| {
            let (_, element) = element.unwrap();
            let object = &made.objects()[element.object];
            let solid = &made.base_elements()[object.base_element];
            (solid.primitive(), solid.bounds(element.frame.map()))
        })
        .collect();
    let expected = [
        (Some(Round::Ball), [-1.0, -2.0, 2.0], [1.0, 2.0, 4.0]),
        // (x, y, z + 1) goes to (x, -z - 1, y), and that to (z + 1, x, y).
        (Some(Round::Cylinder), [0.0, -1.0, 0.0], [2.0, 1.0, 1.0]),
        (None, [-1.0, 0.0, -4.0], [1.0, 0.0, 4.0]),
    ];
    assert_eq!(drawn.len(), expected.len());
    for ((primitive, bounds), (known, min, max)) in drawn.iter().zip(expected) {
        assert_eq!(*primitive, known);
        assert!(
            (bounds.min() - DVec3::from(min)).length() < 1e-12,
            "{bounds:?}"
        );
        assert!(
            (bounds.max() - DVec3::from(max)).length() < 1e-12,
            "{bounds:?}"
        );
    }
}

/// Without shapes, an object is the box of its limit; recursion has the limit of the system.
#[test]
fn recursive_structures_have_the_limits_of_systems() {
    let text = "
objects:
  all:
    - {object: all, scale: 1/2, rotate: {y: 40}, translate: [1, 0, 0]}
    - {object: all, scale: [0.5, 0.6, 0.3], rotate: [{x: 10}, {z: 70}], translate: [0, 1, 0]}
scene: [all]
";
    let maps = "
maps:
  - {scale: 1/2, rotate: {y: 40}, translate: [1, 0, 0]}
  - {scale: [0.5, 0.6, 0.3], rotate: [{x: 10}, {z: 70}], translate: [0, 1, 0]}
";
    let [made, system] = [structure(text), graph(maps)];
    let [a, b] = [&made, &system].map(|graph| graph.limit_bounds().unwrap());
    assert!((a.min() - b.min()).length() < 1e-9 && (a.max() - b.max()).length() < 1e-9);
    let boxes = [&made, &system].map(|graph| graph.bounds(4).unwrap());
    assert!((boxes[0].max() - boxes[1].max()).length() < 1e-9);
}

/// A mesh lies beside the file, and polygons that are not convex become triangles.
#[test]
fn meshes_are_read_from_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.yaml");
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 3\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    std::fs::write(folder.path().join("tent.obj"), obj).unwrap();
    let text = "kind: ifs\nspace: 3\nmaps: [{scale: 1/2}]\ncondensation: [{mesh: tent.obj}]\n";
    std::fs::write(&path, text).unwrap();
    let source = Catalogue::embedded().rule(&path).unwrap();
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    assert!(
        document
            .paths()
            .contains(folder.path().join("tent.obj").as_path())
    );
    let inlined = Source::new("elsewhere.yaml", document.to_yaml());
    for source in [source, inlined] {
        let tent = compiled(&source, &[]);
        let faces = tent.objects().iter().filter(|object| object.is_kept());
        // The faces inside the map, and outside.
        assert_eq!(faces.count(), 10);
        let limit = tent.limit_bounds().unwrap();
        assert!((limit.max() - DVec3::new(1.0, 1.0, 3.0)).length() < 1e-12);
    }
    let arrow =
        "objects: {a: [{polygon: [[0, 0, 1], [4, 0, 1], [1, 1, 1], [0, 4, 1]]}]}\nscene: [a]\n";
    assert_eq!(
        structure(arrow)
            .forecast()
            .unwrap()
            .level()
            .elements
            .to_string(),
        "1"
    );
    let drawn = Elements::of(&structure(arrow), &Growth::steps(1)).count();
    assert_eq!(drawn, 2);
}

/// Fractals as sets have the solids of their elements: of space as they are, of the plane as lines and polygons.
#[test]
fn fractals_are_sets_in_space() {
    let sets = |set: &str| {
        let graph = graph(&format!("maps: [{{scale: 1/2}}]\ninitial: {set}\n"));
        let growth = Growth::steps(0);
        let elements = Elements::of(&graph, &growth).map(|element| element.unwrap().1);
        let solids = elements.map(|element| {
            let solid = &graph.base_elements()[graph.objects()[element.object].base_element];
            solid.image(element.frame.map())
        });
        solids.collect::<Vec<_>>()
    };
    let cubes =
        sets("{fractal: menger-cubes, steps: 1, map: {scale: [2, 1, 1], shift: [1, 0, 0]}}");
    assert_eq!(cubes.len(), 20);
    let area: f64 = cubes.iter().map(|solid| solid.signed_area()).sum();
    // Boxes of 2/3 by 1/3 by 1/3.
    assert!((area - 20.0 * 10.0 / 9.0).abs() < 1e-9, "{area}");
    let reach = |solids: &[Solid]| {
        let corners = solids.iter().flat_map(|solid| solid.corners().to_vec());
        corners.fold(DVec3::MIN, DVec3::max) - DVec3::X
    };
    assert!((reach(&cubes).x - 2.0).abs() < 1e-12);
    let curve = sets("{fractal: koch, steps: 2, map: {scale: 1, rotate: {x: 90}}}");
    assert_eq!(curve.len(), 16);
    let top = reach(&curve);
    assert!(
        (top - DVec3::new(0.0, 0.0, 3f64.sqrt() / 6.0)).length() < 1e-12,
        "{top}"
    );
    let tiles =
        sets("{fractal: {initiator: segment, base_element: triangle, generator: koch}, steps: 1}");
    assert_eq!(tiles.len(), 4);
}
