//! Files of meshes.

use std::path::Path;

use crate::diagnostic::{Diagnostic, Place};

use crate::document::node::{Key, Node, Value};

/// Limit of the number of faces.
const MAX_FACES: usize = 20_000;

/// Points, and faces as lists of their numbers, from 0.
#[derive(Default)]
struct Mesh {
    points: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
}

/// Reads a file of Wavefront (`.obj`), of stereolithography (`.stl`) or of polygons (`.ply`) as a mapping of points
/// and faces, all at one place.
pub(in crate::document) fn read(
    path: &Path,
    bytes: &[u8],
    place: &Place,
) -> Result<Node, Diagnostic> {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let mesh = match extension.to_lowercase().as_str() {
        "obj" => read_obj(bytes),
        "stl" => read_stl(bytes),
        "ply" => read_ply(bytes),
        _ => {
            let message = format!("'{}' is no mesh", path.display());
            return Err(Diagnostic::error(message).hint("a mesh is a file .obj, .stl or .ply"));
        }
    };
    let wrong = |message: String| {
        let message = format!("'{}' cannot be read as a mesh: {message}", path.display());
        Diagnostic::error(message)
    };
    let mesh = mesh.map_err(wrong)?;
    if mesh.faces.is_empty() {
        return Err(wrong("it has no faces".into()));
    }
    if mesh.faces.len() > MAX_FACES {
        let count = mesh.faces.len();
        let hint = "simplify the mesh in the program that made it";
        return Err(wrong(format!(
            "it has {count} faces, and at most {MAX_FACES} are drawn"
        ))
        .hint(hint));
    }
    if !mesh
        .points
        .iter()
        .flatten()
        .all(|number| number.is_finite())
    {
        return Err(wrong("a coordinate is not finite".into()));
    }
    Ok(mesh.into_node(place))
}

impl Mesh {
    fn into_node(self, place: &Place) -> Node {
        let node = |value| Node {
            place: place.clone(),
            value,
        };
        let points = self.points.iter().map(|point| {
            let numbers = point.map(|number| node(Value::Number(number)));
            node(Value::Sequence(numbers.into()))
        });
        let faces = self.faces.iter().map(|face| {
            #[expect(clippy::cast_precision_loss, reason = "numbers of points are small")]
            let numbers = face
                .iter()
                .map(|&number| node(Value::Number(number as f64)));
            node(Value::Sequence(numbers.collect()))
        });
        let key = |name: &str| Key {
            name: name.into(),
            place: place.clone(),
        };
        let points = node(Value::Sequence(points.collect()));
        let faces = node(Value::Sequence(faces.collect()));
        node(Value::Mapping(vec![
            (key("points"), points),
            (key("faces"), faces),
        ]))
    }
}

fn read_obj(mut bytes: &[u8]) -> Result<Mesh, String> {
    let options = tobj::LoadOptions {
        ignore_points: true,
        ignore_lines: true,
        ..tobj::LoadOptions::default()
    };
    // Materials lie in other files, and are not read.
    let materials = |_: &Path| Err(tobj::LoadError::GenericFailure);
    let (models, _) =
        tobj::load_obj_buf(&mut bytes, &options, materials).map_err(|error| error.to_string())?;
    let mut all = Mesh::default();
    for tobj::Model { mesh, .. } in models {
        let first = all.points.len();
        let (points, rest) = mesh.positions.as_chunks::<3>();
        if !rest.is_empty() {
            return Err("a point has no three coordinates".into());
        }
        all.points.extend(points);
        let mut corners = mesh.indices.iter().map(|&corner| first + corner as usize);
        let count = mesh.indices.len() / 3;
        let arities: Vec<usize> = match mesh.face_arities.is_empty() {
            true => vec![3; count],
            false => { mesh.face_arities.iter() }
                .map(|&arity| arity as usize)
                .collect(),
        };
        for arity in arities {
            all.faces.push(corners.by_ref().take(arity).collect());
        }
    }
    Ok(all)
}

fn read_stl(bytes: &[u8]) -> Result<Mesh, String> {
    /// Bytes before the triangles of a binary file, of which the last four are their number, and of a triangle.
    const HEAD: usize = 84;
    const TRIANGLE: usize = 50;
    let mut bytes = bytes.to_vec();
    let count = bytes.get(80..HEAD).and_then(|count| count.try_into().ok());
    let count = count.map_or(0, |count| u32::from_le_bytes(count) as usize);
    if bytes.len() == HEAD.saturating_add(count.saturating_mul(TRIANGLE)) {
        // A binary file whose comment begins like a file of text.
        bytes[0] = b' ';
    }
    let mesh =
        stl_io::read_stl(&mut std::io::Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let points = mesh.vertices.iter();
    Ok(Mesh {
        points: points
            .map(|point| [0, 1, 2].map(|axis| f64::from(point[axis])))
            .collect(),
        faces: mesh
            .faces
            .iter()
            .map(|face| face.vertices.to_vec())
            .collect(),
    })
}

fn read_ply(mut bytes: &[u8]) -> Result<Mesh, String> {
    use ply_rs_bw::parser::Parser;
    use ply_rs_bw::ply::{DefaultElement, Property};

    let read = Parser::<DefaultElement>::new().read_ply(&mut bytes);
    let read = read.map_err(|error| error.to_string())?;
    let number = |property: Option<&Property>| {
        Some(match property? {
            Property::Char(value) => f64::from(*value),
            Property::UChar(value) => f64::from(*value),
            Property::Short(value) => f64::from(*value),
            Property::UShort(value) => f64::from(*value),
            Property::Int(value) => f64::from(*value),
            Property::UInt(value) => f64::from(*value),
            Property::Float(value) => f64::from(*value),
            Property::Double(value) => *value,
            _ => return None,
        })
    };
    fn whole<N: Copy + TryInto<usize>>(list: &[N]) -> Option<Vec<usize>> {
        list.iter().map(|&number| number.try_into().ok()).collect()
    }
    let corners = |face: &DefaultElement| {
        let names = ["vertex_indices", "vertex_index"];
        match names.iter().find_map(|name| face.get(*name))? {
            Property::ListChar(list) => whole(list),
            Property::ListUChar(list) => whole(list),
            Property::ListShort(list) => whole(list),
            Property::ListUShort(list) => whole(list),
            Property::ListInt(list) => whole(list),
            Property::ListUInt(list) => whole(list),
            _ => None,
        }
    };
    let all = |name: &str| read.payload.get(name).map_or(&[][..], Vec::as_slice);
    let points = all("vertex").iter().map(|vertex| {
        let [x, y, z] = ["x", "y", "z"].map(|axis| number(vertex.get(axis)));
        Some([x?, y?, z?])
    });
    let faces = all("face").iter().map(corners);
    Ok(Mesh {
        points: points
            .collect::<Option<_>>()
            .ok_or("a vertex has no x, y and z")?,
        faces: faces
            .collect::<Option<_>>()
            .ok_or("a face has no list of vertices")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Source;

    const POINTS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.5]];
    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    /// Returns the corners of the faces of a file.
    fn faces(name: &str, bytes: &[u8]) -> Result<Vec<Vec<[f64; 3]>>, String> {
        let place = Place::new(&Source::new("test", ""), 0..0);
        let read =
            read(Path::new(name), bytes, &place).map_err(|error| error.message().to_owned())?;
        let numbers = |node: &Node| -> Vec<f64> {
            let Value::Sequence(nodes) = &node.value else {
                panic!("no list")
            };
            let number = |node: &Node| match node.value {
                Value::Number(number) => number,
                _ => panic!("no number"),
            };
            nodes.iter().map(number).collect()
        };
        let lists = |key: &str| -> Vec<Vec<f64>> {
            match &read.get(key).unwrap().value {
                Value::Sequence(nodes) => nodes.iter().map(numbers).collect(),
                _ => panic!("no list"),
            }
        };
        let points = lists("points");
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "numbers of points are small"
        )]
        let point = |number: f64| <[f64; 3]>::try_from(points[number as usize].as_slice()).unwrap();
        let face = |face: Vec<f64>| face.into_iter().map(point).collect();
        Ok(lists("faces").into_iter().map(face).collect())
    }

    fn expected() -> Vec<Vec<[f64; 3]>> {
        let face = |face: [usize; 3]| face.map(|corner| POINTS[corner].map(f64::from)).to_vec();
        FACES.map(face).to_vec()
    }

    fn obj() -> String {
        let points = POINTS.map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        let faces = FACES.map(|face| {
            let [a, b, c] = face.map(|corner| corner + 1);
            format!("f {a} {b}//1 {c}\n")
        });
        let faces = faces.concat().replace("//1", "");
        format!("mtllib none.mtl\no solid\n{}{faces}", points.concat())
    }

    #[test]
    fn files_of_all_kinds_have_the_same_faces() {
        assert_eq!(faces("a.obj", obj().as_bytes()), Ok(expected()));
        let mut text = "solid a\n".to_owned();
        let mut bytes = b"solid, says the comment".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(4u32.to_le_bytes());
        for face in FACES {
            text.push_str("facet normal 0 0 1\nouter loop\n");
            bytes.extend([0; 12]);
            for [x, y, z] in face.map(|corner| POINTS[corner]) {
                text.push_str(&format!("vertex {x} {y} {z}\n"));
                bytes.extend([x, y, z].map(f32::to_le_bytes).concat());
            }
            text.push_str("endloop\nendfacet\n");
            bytes.extend([0; 2]);
        }
        text.push_str("endsolid a\n");
        assert_eq!(faces("a.STL", text.as_bytes()), Ok(expected()));
        assert_eq!(faces("a.stl", &bytes), Ok(expected()));
        let head = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n\
                    property list uchar int vertex_indices\nend_header\n";
        let mut text = format!("ply\nformat ascii 1.0\n{head}");
        let mut bytes = format!("ply\nformat binary_little_endian 1.0\n{head}").into_bytes();
        for [x, y, z] in POINTS {
            text.push_str(&format!("{x} {y} {z}\n"));
            bytes.extend([x, y, z].map(f32::to_le_bytes).concat());
        }
        for [a, b, c] in FACES {
            text.push_str(&format!("3 {a} {b} {c}\n"));
            bytes.push(3);
            let corners = [a, b, c].map(|corner| i32::try_from(corner).unwrap());
            bytes.extend(corners.map(i32::to_le_bytes).concat());
        }
        assert_eq!(faces("a.ply", text.as_bytes()), Ok(expected()));
        assert_eq!(faces("a.ply", &bytes), Ok(expected()));
    }

    #[test]
    fn what_is_no_mesh_is_refused() {
        let head = b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n\
                     property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n\
                     end_header\n";
        let mut counted = vec![b' '; 80];
        counted.extend(u32::MAX.to_le_bytes());
        let files: [(&str, &[u8]); 9] = [
            ("a.txt", b"v 0 0 0"),
            ("a.obj", b""),
            ("a.obj", b"v 0 0\nf 1 1 1\n"),
            ("a.obj", b"v 0 0 0\nf 1 2 3\n"),
            ("a.stl", b""),
            ("a.stl", &counted),
            ("a.ply", b"ply\n"),
            ("a.ply", head),
            ("a.ply", b"\xff\xfe"),
        ];
        for (name, bytes) in files {
            assert!(faces(name, bytes).is_err(), "{name} {bytes:?}");
        }
        let mut many = obj();
        many.push_str(&"f 1 2 3\n".repeat(MAX_FACES));
        let error = faces("a.obj", many.as_bytes()).unwrap_err();
        assert!(error.contains("20004 faces"), "{error}");
    }
}
