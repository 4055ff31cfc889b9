//! Import of AIFS.

use std::fs;

use super::{assert_same, imported};

/// Curves over the Gaussian and Eisenstein integers, with g = 1 + i and 2 + ω, and a system in space.
const SETS: &str = "\
@G
$a=h
$dim=2
s=$companion([1,0])
g=s+1
A=(f0|f1)*A

@:G
$n=Levy
f0=s*g^-1
f1=g^-1*[0,1]

@:G
$n=Dragon
f0=s*g^-1
f1=[1,0]*s^2*g^-1*s^-1*s

@
$n=Koch
$dim=2
$subspace=[s,0]
s=$companion([1,-1])
g=s+1
A=g^-2*(s|s^2*[1,-1]|[-1,2]|s*[2,0])*A

@
$n=Snowflake
$dim=2
$subspace=[s,0]
$root=S
s=$companion([1,-1])
A=3^-1*($i|[1,0]*s|[1,1]*s^-1|[2,0])*A
S=s*A|[0,1]*s^-1*A|[1,0]*s^3*A

@
$n=Terdragon
$dim=2
$subspace=[w,0]
w=$companion([1,1])
T=(w^2+2)^-1*($i|[1,0]*w^2|[0,-1])*T

@
$n=Sponge
$dim=3
H=$i|[0,0,1]|[0,0,2]
E=[0,0,0]|[2,0,0]|[0,2,0]|[2,2,0]
M=3^-1*(E*H|[1,0,0]|[0,1,0]|[2,1,0]|[1,2,0]|[0,1,2]|[1,0,2]|[1,2,2]|[2,1,2])*M
";

#[test]
fn sets_are_those_of_the_library() {
    let (folder, said) = imported("sets.aifs", SETS, &["-o", "out"]);
    assert_eq!(said, "sets.aifs: 6 written to out\n");
    for (file, known, tolerance) in [
        ("levy", "levy", "0.01"),
        ("dragon", "dragon-ifs", "0.01"),
        ("koch", "koch", "0.001"),
        ("snowflake", "koch-snowflake", "0.001"),
        ("terdragon", "terdragon-lsystem", "0.01"),
        ("sponge", "menger", "0.05"),
    ] {
        assert_same(folder.path(), &format!("out/{file}.yaml"), known, tolerance);
    }
}

/// The triangles of R. M. Robinson over the tenth roots of unity, in four dimensions: an acute one with the vertices 0, 1
/// and ζ, and an obtuse one with 0, 1 and ζ/φ.
const TRIANGLES: &str = "\
@
$n=Acute
$dim=4
$subspace=[s,0]
s=$companion([1,-1,1,-1])
phi=s-s^4
A=B|[1,0,0,0]*(s-1)*A
B=phi^-1*A|[1,0,0,0]*(s*phi^-1-1)*B
";

#[test]
fn sets_that_refer_to_each_other_are_those_of_geometry() {
    let (folder, _) = imported("triangles.aifs", TRIANGLES, &[]);
    let quarters = "\
kind: ifs
maps:
  - {scale: 1/2}
  - {scale: 1/2, translate: [1/2, 0]}
  - {scale: 1/2, translate: [cos(36)/2, sin(36)/2]}
  - {scale: 1/2, rotate: 180, translate: [(1 + cos(36))/2, sin(36)/2]}
";
    fs::write(folder.path().join("triangle.yaml"), quarters).unwrap();
    assert_same(folder.path(), "acute.yaml", "triangle.yaml", "0.01");
}
