//! Tests of the import of AIFS.

use crate::diagnostic::{Diagnostics, Severity, Source};
use crate::geometry::{DAffine2, DVec2};
use crate::import::{ImportOptions, Imported, SourceFormat};
use crate::model::Model;

fn read(text: &str) -> (Vec<Imported>, Diagnostics) {
    let source = Source::new("some/tile.aifs", text);
    crate::import::read(&source, SourceFormat::Aifs, &ImportOptions::default())
}

/// Returns the only entry of a text.
fn only(text: &str) -> Imported {
    let (mut imported, stray) = read(text);
    assert!(stray.is_empty(), "{stray}");
    assert_eq!(imported.len(), 1, "{imported:?}");
    imported.remove(0)
}

fn yaml(imported: &Imported) -> String {
    let document = imported.document.as_ref();
    document
        .unwrap_or_else(|| panic!("{}", imported.found))
        .to_yaml()
}

/// Returns the maps of a system.
fn maps(imported: &Imported) -> Vec<DAffine2> {
    let document = imported.document.as_ref();
    let document = document.unwrap_or_else(|| panic!("{}", imported.found));
    let Model::Ifs(system) = document.resolve(&[]).unwrap().0 else {
        panic!("it is a system of the plane");
    };
    system.ifs().maps().iter().map(|map| map.affine).collect()
}

/// Returns the factor and the translation of the maps z ↦ s z + t of a system.
fn complex(imported: &Imported) -> Vec<[DVec2; 2]> {
    let split = |map: DAffine2| {
        let DAffine2 {
            matrix2,
            translation,
        } = map;
        assert_eq!(matrix2.x_axis.x, matrix2.y_axis.y);
        assert_eq!(matrix2.x_axis.y, -matrix2.y_axis.x);
        [matrix2.x_axis, translation]
    };
    maps(imported).into_iter().map(split).collect()
}

/// Returns the line, the text and the message of each error.
fn errors(imported: &Imported) -> Vec<(usize, &str, &str)> {
    assert!(imported.document.is_none());
    let errors = imported
        .found
        .iter()
        .filter(|it| it.severity() == Severity::Error);
    let error = |error| {
        let error: &crate::diagnostic::Diagnostic = error;
        let place = error.place().unwrap();
        (
            place.line(),
            &place.source().text()[place.range()],
            error.message(),
        )
    };
    errors.map(error).collect()
}

#[test]
fn maps_are_products_of_translations_and_matrices() {
    let fern = only(
        "@\n$dim=2\n$n=Barnsley fern # four\nf1=[0,\t0 ]*[ 0,\t0,\t  0,\t0.16]\t\nf2=[0,1.60]*[ 0.85,\t0.04,\n  -0.04,\t0.85]\n\
         F=(f1|f2)*F",
    );
    assert_eq!(fern.name, "Barnsley fern # four");
    let expected = [
        [0., 0., 0., 0.16, 0., 0.],
        [0.85, -0.04, 0.04, 0.85, 0., 1.6],
    ];
    assert_eq!(
        maps(&fern),
        expected.map(|map| DAffine2::from_cols_array(&map))
    );
    let yaml = yaml(&fern);
    assert!(
        yaml.contains("source: \"Barnsley fern # four in tile.aifs, for IFStile\""),
        "{yaml}"
    );
}

#[test]
fn order_and_precedence_are_those_of_the_manual() {
    // 2 (z + [1, 0]) and 2 z + [1, 0], as a third of them.
    let set = only("@\n$dim=2\nA=(3^-1*[1,0]|[1,0]*3^-1|-1^2*2^-1^2*-(1-3/2)*$i|[8,0]/16)*A\n");
    let third = DVec2::new(1.0 / 3.0, 0.0);
    let expected = [
        [third, third],
        [third, DVec2::X],
        [DVec2::new(-0.25, 0.0), DVec2::ZERO],
        [DVec2::new(0.0625, 0.0), DVec2::new(8.0, 0.0)],
    ];
    assert_eq!(complex(&set), expected);
    let inverse = only("@\n$dim=2\nf=[1,0]*[0,2,-2,0]\nA=(f^-1|f^-2|(f|f)^0*f^-1)*A");
    assert_eq!(
        errors(&inverse),
        [(4, "(f|f)", "a union of maps where a map is expected")]
    );
    let inverse = only("@\n$dim=2\nf=[1,0]*[0,2,-2,0]\nA=(f^-1|f^-2)*A");
    // f is z ↦ -2i z + 1.
    let half = DVec2::new(0.0, 0.5);
    let squared = DVec2::new(-0.25, 0.0);
    assert_eq!(
        complex(&inverse),
        [[half, -half], [squared, DVec2::new(0.25, -0.5)]]
    );
}

#[test]
fn functions_and_lists_are_computed() {
    let text = "@\n$dim=2\nq=[[1, 2], [3, 4]]\na=q[1][0]+q[-1, 1]\nb=if(-1, 5, 0, 6, a%4+ceil(1.5))\n\
                c=abs(floor(-0.5))*cos($pi)+exp(log(2))+sin(0)+tan(0)+asin(0)+acos(1)+atan(0)\n\
                A=(b^-1*$companion([1,0])|[0,c]*4^-1*$exchange()|$diagonal([1/2,if(1)/4]))*A\n";
    let expected = [
        [0., 0.2, -0.2, 0., 0., 0.],
        [0., 0.25, 0.25, 0., 0., 1.],
        [0.5, 0., 0., 0.25, 0., 0.],
    ];
    let found = maps(&only(text));
    for (map, expected) in found.iter().zip(expected) {
        let expected = DAffine2::from_cols_array(&expected);
        assert!(
            map.abs_diff_eq(expected, 1e-12),
            "{map:?} is not {expected:?}"
        );
    }
    assert_eq!(found.len(), 3);
}

#[test]
fn blocks_inherit_what_they_do_not_replace() {
    let (imported, stray) = read(
        "@@version 3\n\n@G\n$a=h\n$n=2a\n$dim=2\ng=[1,-1,1,1]\ns=[0,-1,1,0]\n&R=$semigroup([s])\nh0=R\nh1=R\n\
         A=g^-1*(h0|h1)*A\n\n@:G\n$n=Heighway Dragon\nh0=s^2\nh1=s*[1,-1]\n\n@Levy:G\nh0=1\nh1=s^3*[0,1]*s\n\n@:G\nh1=1\n@IFStile\nx=1\n",
    );
    assert!(stray.is_empty(), "{stray}");
    let names: Vec<_> = imported.iter().map(|it| &it.name[..]).collect();
    assert_eq!(names, ["Heighway Dragon", "Levy", "tile"]);
    let [heighway, levy, random] = &imported[..] else {
        panic!("{imported:?}");
    };
    let half = |x: f64, y: f64| DVec2::new(x, y) / 2.0;
    // g is 1 + i: -1/(1 + i), and i/(1 + i) after [1, -1].
    let expected = [[half(-1., 1.), DVec2::ZERO], [half(1., 1.), DVec2::X]];
    assert_eq!(complex(heighway), expected);
    assert_eq!(complex(levy)[0], [half(1., -1.), DVec2::ZERO]);
    let message = "$semigroup is a template: it stands for a map that a search is to find";
    assert_eq!(errors(random), [(9, "$semigroup([s])", message)]);
}

#[test]
fn sets_that_refer_to_others_are_structures() {
    let text =
        "@\n$dim=2\n$root=B\nA=2^-1*([1,0]*A|B|E*A)\nB=3^-1*A|[1,0]*3^-1*B|C\nC=$e\nC2=C\nE=$e\n";
    let imported = only(text);
    let yaml = yaml(&imported);
    let start = yaml.find("objects").unwrap();
    let expected = "\
objects:
  B:
    - object: A
";
    assert!(
        yaml[start..].starts_with(expected) || yaml.contains("B:"),
        "{yaml}"
    );
    assert!(yaml.ends_with("scene: [B]\n"), "{yaml}");
    let Model::Instancing(_) = imported.document.unwrap().resolve(&[]).unwrap().0 else {
        panic!("it is a structure");
    };
}

#[test]
fn a_subspace_has_the_coordinates_of_its_eigenvector() {
    // Koch's curve over the Eisenstein integers: 1 is (1, 0), and s is (1/2, √3/2).
    let koch = only(
        "@\n$dim=2\n$subspace=[s,0]\ns=$companion([1,-1])\ng=s+1\nA=g^-2*(s|s^2*[1,-1]|[-1,2]|s*[2,0])*A\n",
    );
    let third = DVec2::new(1.0 / 3.0, 0.0);
    let turn = |degrees: f64| DVec2::from_angle(degrees.to_radians()).rotate(third);
    let height = f64::sqrt(3.0) / 6.0;
    let expected = [
        [third, DVec2::ZERO],
        [turn(60.0), third],
        [turn(-60.0), DVec2::new(0.5, height)],
        [third, DVec2::new(2.0 / 3.0, 0.0)],
    ];
    for (found, expected) in maps(&koch).iter().zip(expected) {
        let DAffine2 {
            matrix2,
            translation,
        } = found;
        assert!(matrix2.x_axis.distance(expected[0]) < 1e-14, "{found:?}");
        assert!(
            matrix2.y_axis.distance(expected[0].perp()) < 1e-14,
            "{found:?}"
        );
        assert!(translation.distance(expected[1]) < 1e-14, "{found:?}");
    }
    // The golden ratio in four dimensions: every map is a similarity of the plane with the ratio 1/φ.
    let text = "@\n$dim=4\n$subspace=s 0\ns=$companion([1,-1,1,-1])\nr=$exchange()\ng=s-s^4\n\
                A=g^-1*(s^4*[-1,0,-1,0]|s^2*r*[-1,0,0,0])*A\n";
    let [a, b] = maps(&only(text))[..] else {
        panic!("there are two maps");
    };
    let golden = f64::midpoint(f64::sqrt(5.0), -1.0);
    for (map, sign) in [(a, 1.0), (b, -1.0)] {
        let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis];
        assert!(
            (x.length() - golden).abs() < 1e-14 && x.dot(y).abs() < 1e-14,
            "{map:?}"
        );
        assert!((map.matrix2.determinant() - sign * golden * golden).abs() < 1e-14);
    }
    // A line lies in the plane, and three dimensions in space.
    let line = only("@\n$dim=1\nA=3^-1*([0]|[2])*A");
    let third = DVec2::new(1.0 / 3.0, 0.0);
    assert_eq!(complex(&line), [[third, DVec2::ZERO], [third, 2.0 * third]]);
    let space = only("@\n$dim=3\nA=2^-1*([0,0,0]|[1,0,0]|[0,1,0]|[0,0,1])*A");
    assert!(yaml(&space).contains("space: 3"));
}

#[test]
fn refusals_have_their_places() {
    let cases = [
        ("A=(f|1)*A", "f", "f is not defined"),
        (
            "A=([1,2,3]|1/2)*A",
            "[1,2,3]",
            "a list of 3 numbers is no map",
        ),
        ("A=1/2*A|1/3", "1/3", "a map stands where a set is expected"),
        ("A=1/2*A*A", "1/2*A*A", "a set is not a map"),
        ("A=1/2*A+1", "1/2*A", "a set where a map is expected"),
        ("A=[0,0,0,0]^-1*A", "[0,0,0,0]", "this map has no inverse"),
        ("A=(1/0)*A", "(1/0)", "this number is not finite"),
        (
            "A=1/2*(A|",
            "",
            "the definition ends where a number, a name, '(' or '[' is expected",
        ),
        ("A=1/2 A", "A", "'A' where an operator is expected"),
        ("A=1.2.3*A", "1.2.3", "'1.2.3' is not a number"),
        ("A=1/2*A\nA=A", "A", "A is defined twice in this block"),
        ("A=f(1)*A", "f(1)", "the function f is not read"),
        (
            "A=[$, 3]*A",
            "$",
            "lists that generate themselves are not read",
        ),
        ("A=2*A", "@", "map 1 does not contract"),
        ("$root=B\nA=1/2*A", "B", "there is no set 'B'"),
        ("A=$e*A", "A", "the set A is empty"),
        ("1/2", "1/2", "this is no definition"),
        (
            "s=1\n$subspace=[s,0]\nA=A",
            "[s,0]",
            "the eigenvalues of s are not distinct",
        ),
        (
            "s=[0,-1,1,0]\n$subspace=[s,1]\nA=A",
            "[s,1]",
            "'1' is none of the 1 eigenspaces of s, from 0 on",
        ),
        (
            "s=[2,0,0,1]\n$subspace=[s,0]\nA=[0,1,1,0]*A",
            "[0,1,1,0]",
            "this map has no image in $subspace",
        ),
        (
            "$dim=0\nA=1/2*A",
            "$dim",
            "$dim is defined twice in this block",
        ),
        ("H=1/2|1/3\nA=H^15*A", "H", "this has more than 20000 maps"),
    ];
    for (text, place, message) in cases {
        let text = format!("@\n$dim=2\n{text}\n");
        let imported = only(&text);
        let found = errors(&imported);
        let is_found = found
            .iter()
            .any(|found| found.1 == place && found.2.starts_with(message));
        assert!(is_found, "{text}: {found:?}");
    }
    for dimension in ["2*A", "[]*[]", "$exchange()", "$e"] {
        let imported = only(&format!("@\n$dim={dimension}\nA=1/2*A\n"));
        let message = "a map where the number of dimensions is expected";
        assert_eq!(errors(&imported)[0].2, message, "{dimension}");
    }
    let (imported, stray) = read(
        "x\nexport const a = 1;\n@@\n@@import b.aifs\n@P\n$dim=2\n@:Q\n@:P\nA=1/2*A|[1,0]*2^-1*A\n@\nA=A\n",
    );
    let stray: Vec<_> = stray
        .iter()
        .map(|it| (it.place().unwrap().line(), it.message()))
        .collect();
    let expected = [
        (1, "JavaScript is not run"),
        (4, "other files are not read"),
    ];
    assert_eq!(stray, expected);
    assert_eq!(errors(&imported[0]), [(7, "Q", "there is no block 'Q'")]);
    assert!(imported[1].document.is_some());
    assert_eq!(
        errors(&imported[2])[0].2,
        "the dimension of this block is not stated"
    );
}

#[test]
fn much_is_refused_soon() {
    let deep = format!("@\n$dim=2\nA={}1{}*A", "(".repeat(5000), ")".repeat(5000));
    assert!(
        errors(&only(&deep))[0]
            .2
            .contains("nests more than 64 levels")
    );
    let mut chain = String::from("@\n$dim=2\nA=x0*A\nx5000=1/2\n");
    (0..5000).for_each(|at| chain += &format!("x{at}=x{}\n", at + 1));
    assert!(
        errors(&only(&chain))[0]
            .2
            .contains("nests more than 200 levels")
    );
    let mut squares = String::from(
        "@\n$dim=12\n$subspace=[s,0]\ns=$companion([1,1,1,1,1,1,1,1,1,1,1,1])\nx0=s\n",
    );
    (0..60).for_each(|at| squares += &format!("x{}=x{at}*x{at}\n", at + 1));
    squares += "A=1/2*x60*A|1/2*A\n";
    let (imported, _) = read(&squares.repeat(50));
    assert!(
        imported.iter().all(|it| it.document.is_some()),
        "{}",
        imported[0].found
    );
    let generations: String = (0..100).map(|at| format!("@b{}:b{at}\n", at + 1)).collect();
    let (imported, _) = read(&format!("@b0\n$dim=2\n{generations}@:b99\nA=1/2*A\n"));
    assert!(
        errors(&imported[0])[0]
            .2
            .contains("inherits from more than 64 others")
    );
}
