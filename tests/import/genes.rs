//! Import of genes of curves.

use std::fs;

use tempfile::TempDir;

use super::{assert_same, imported, kfrac, said};

/// Curves on both lattices, with every transform of a segment.
const GENES: &str = "\
Dragon:    G 0 1 0 0  1 0 1 0
Levy:      G 0 1 0 0  1 0 0 0
Terdragon: E 1 0 0 0  -1 -1 0 0  1 0 0 0
Koch:      E 1 0 0 0  1 1 0 0  0 -1 0 0  1 0 0 0
Gosper:    E 1 0 0 0  0 -1 1 0  -1 0 1 0  -1 -1 0 0  1 0 0 0  1 0 0 0  1 1 1 0
Sweep:     G 0 1 0 1  1 0 0 1
Arrowhead: E 1 1 0 1  1 0 0 0  0 -1 0 1
Gasket:    E 1 1 1 0  1 0 1 1  0 -1 1 0
";

#[test]
fn curves_are_those_of_the_library() {
    let (folder, _) = imported("curves.genes", GENES, &["-o", "out"]);
    for (file, known, tolerance) in [
        ("dragon", "dragon-by-direction", "0.01"),
        ("levy", "levy", "0.01"),
        ("terdragon", "terdragon", "0.01"),
        ("koch", "koch", "0.001"),
        ("gosper", "gosper", "0.01"),
        ("arrowhead", "sierpinski-arrowhead", "0.001"),
        // The arrowhead is symmetric: a half turn is a reflection, and the middle is that of a reflection.
        ("gasket", "sierpinski-arrowhead", "0.001"),
    ] {
        assert_same(folder.path(), &format!("out/{file}.yaml"), known, tolerance);
    }
    // A right triangle is four of half its size.
    let triangle = "\
kind: ifs
maps:
  - {scale: 1/2}
  - {scale: 1/2, translate: [1/2, 0]}
  - {scale: 1/2, translate: [1/4, 1/4]}
  - {scale: 1/2, rotate: 180, translate: [3/4, 1/4]}
";
    fs::write(folder.path().join("triangle.yaml"), triangle).unwrap();
    assert_same(folder.path(), "out/sweep.yaml", "triangle.yaml", "0.01");
}

#[test]
fn presets_come_from_standard_input() {
    let folder = TempDir::new().unwrap();
    let import = |text: &str| {
        let mut command = kfrac(folder.path());
        command.args(["import", "-", "--from", "genes", "--force"]);
        command.write_stdin(text).output().unwrap()
    };
    let output = import("[{\"name\": \"Koch\", \"gene\": \"E 1 0 0 0 1 1 0 0 0 -1 0 0 1 0 0 0\"}]");
    assert!(output.status.success(), "{:?}", said(&output));
    let yaml = fs::read_to_string(folder.path().join("koch.yaml")).unwrap();
    assert!(yaml.contains("source: Koch, a gene"), "{yaml}");
    let output = import("[{\"gene\": ]");
    let (_, errors) = said(&output);
    assert!(
        !output.status.success() && errors.contains("<stdin>:1:2"),
        "{errors}"
    );
}
