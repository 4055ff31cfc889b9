//! Import of FractaSketch's templates.

use std::fs;

use super::{assert_same, imported};

/// The dragon of paper folding, whose second side is walked backwards; screens have y downwards.
const DRAGON: &str = "100 300\n1 200 200\n4 300 300\n";

/// Sierpinski's curve: outer sides are reflected, the middle is reflected and walked backwards, and so is as it was.
const GASKET: &str = "\
0 0
2 100 -173.20508075688772
3 300 -173.20508075688772
2 400 0
";

#[test]
fn templates_are_the_sets_of_the_library() {
    let (folder, _) = imported("dragon.fsk", DRAGON, &[]);
    assert_same(folder.path(), "dragon.yaml", "dragon-by-direction", "0.01");
    let (folder, _) = imported("gasket.txt", GASKET, &["--from", "fsk"]);
    assert_same(
        folder.path(),
        "gasket.yaml",
        "sierpinski-arrowhead",
        "0.001",
    );
}

#[test]
fn lines_that_are_kept_belong_to_the_set() {
    // A tree: a trunk that is kept, two branches, and a way back that is not drawn.
    let tree = "0 0\n5 0 -100\n1 -50 -150\n6 0 -100\n1 50 -150\n6 100 0\n";
    let (folder, _) = imported("tree.fsk", tree, &[]);
    let system = "\
kind: ifs
maps:
  - {times: [-1/2, 1/2], translate: [0, 1]}
  - {times: [1/2, 1/2], translate: [0, 1]}
condensation:
  - {segment: [[0, 0], [0, 1]]}
";
    fs::write(folder.path().join("system.yaml"), system).unwrap();
    assert_same(folder.path(), "tree.yaml", "system.yaml", "0.01");
}
