//! Data sets that the command writes: parts, order, resumption, checks.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

use kfrac::dataset::Dataset;
use parquet::data_type::Int64Type;
use parquet::file::reader::{FileReader as _, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::RowAccessor as _;
use parquet::schema::parser::parse_message_type;
use serde_json::Value;

use crate::common::{files, said};

const SPEC: &str = "\
kind: dataset
categories: {systems: [{random: {maps: [2, 4]}, count: 3}, {rule: koch}]}
instances: {count: 5, weights: jitter(0.1), flips: true}
picture: {size: 24, points: 2k}
";

/// Runs the command in a folder that holds the data set.
fn run(folder: &Path, arguments: &[&str]) -> String {
    fs::write(folder.join("set.yaml"), SPEC).unwrap();
    let (status, said) = said(folder, &[&["dataset", "set.yaml"], arguments].concat());
    assert_eq!(status, Some(0), "{said}");
    said
}

fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = files(folder);
    found.retain(|name, _| Path::new(name).extension().is_some_and(|it| it == "png"));
    found
}

#[test]
fn parts_in_any_order_make_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let said = run(folder.path(), &["-o", "whole", "--threads", "3"]);
    assert!(said.contains("20 pictures of 4 categories"), "{said}");
    for part in ["3/3", "1/3", "2/3"] {
        run(
            folder.path(),
            &["-o", "parts", "--shard", part, "--threads", "1"],
        );
    }
    let whole = pictures(&folder.path().join("whole"));
    assert_eq!(whole.len(), 20);
    assert!(whole == pictures(&folder.path().join("parts")));
    let set = Dataset::parse(SPEC).unwrap();
    let fourth = &whole["00003-koch/000002.png"];
    assert!(*fourth == set.example(17).unwrap().picture.into_png());

    let labels = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let parts = [1, 2, 3].map(|part| labels(&format!("parts/labels-{part}-of-3.jsonl")));
    assert_eq!(parts.concat(), labels("whole/labels.jsonl"));
    let manifest: Value = serde_json::from_str(&labels("whole/manifest.json")).unwrap();
    assert_eq!(manifest["pictures"], 20);
    assert_eq!(manifest["spec"], SPEC);
    assert_eq!(manifest["categories"][3]["closed_form"], "log(4)/log(3)");
    assert_eq!(
        manifest["categories"][0]["maps"][0]
            .as_array()
            .unwrap()
            .len(),
        7
    );
}

#[test]
fn archives_are_those_of_the_whole_in_any_part() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["-o", "whole/%04d.tar", "--archive", "6"]);
    for part in ["2/2", "1/2"] {
        run(
            folder.path(),
            &["-o", "parts/%04d.tar", "--archive", "6", "--shard", part],
        );
    }
    let [whole, parts] = ["whole", "parts"].map(|name| {
        let mut found = files(&folder.path().join(name));
        found.retain(|name, _| name.ends_with(".tar"));
        found
    });
    assert_eq!(
        whole.keys().collect::<Vec<_>>(),
        ["0000.tar", "0001.tar", "0002.tar", "0003.tar"]
    );
    assert!(whole == parts);
    let set = Dataset::parse(SPEC).unwrap();
    let mut archive = tar::Archive::new(whole["0001.tar"].as_slice());
    let mut names = Vec::new();
    for entry in archive.entries().unwrap() {
        let mut entry = entry.unwrap();
        let name = entry.path().unwrap().display().to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        match name.as_str() {
            "00001_000002.png" => assert!(bytes == set.example(7).unwrap().picture.into_png()),
            "00001_000002.cls" => assert_eq!(bytes, b"1"),
            "00001_000002.json" => {
                let label: Value = serde_json::from_slice(&bytes).unwrap();
                assert_eq!(
                    (&label["category"], &label["instance"]),
                    (&1.into(), &2.into())
                );
            }
            _ => {}
        }
        names.push(name);
    }
    assert_eq!(names.len(), 18);
    assert_eq!(
        names[..3],
        ["00001_000001.png", "00001_000001.cls", "00001_000001.json"]
    );
    run(
        folder.path(),
        &["-o", "whole/%04d.tar", "--archive", "6", "--check"],
    );
}

#[test]
fn tables_have_the_pictures_and_labels_of_the_archives() {
    let folder = tempfile::tempdir().unwrap();
    run(
        folder.path(),
        &["-o", "whole/%04d.parquet", "--archive", "6"],
    );
    for part in ["2/2", "1/2"] {
        let parts = ["-o", "parts/%04d.parquet", "--archive", "6"];
        run(folder.path(), &[&parts[..], &["--shard", part]].concat());
    }
    run(folder.path(), &["-o", "tar/%d.tar"]);
    let file = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let set = Dataset::parse(SPEC).unwrap();
    let mut labels = Vec::new();
    for archive in 0..4 {
        let name = format!("{archive:04}.parquet");
        assert!(file(&format!("whole/{name}")) == file(&format!("parts/{name}")));
        let table = File::open(folder.path().join("whole").join(name)).unwrap();
        let table = SerializedFileReader::new(table).unwrap();
        for row in table.get_row_iter(None).unwrap() {
            let row = row.unwrap();
            let example = set.example(labels.len() as u64).unwrap();
            let name = set.category(example.category).unwrap().name();
            let image = row.get_group(0).unwrap();
            assert!(image.get_bytes(0).unwrap().data() == example.picture.into_png());
            let path = format!("{name}/{:06}.png", example.instance);
            assert_eq!(image.get_string(1).unwrap(), &path);
            assert_eq!(row.get_long(1).unwrap(), i64::from(example.category));
            assert_eq!(row.get_string(2).unwrap(), name);
            labels.push(row.get_string(3).unwrap().clone());
        }
    }
    let archive = file("tar/0.tar");
    let mut archive = tar::Archive::new(archive.as_slice());
    let mut expected = Vec::new();
    for entry in archive.entries().unwrap() {
        let mut entry = entry.unwrap();
        if entry.path().unwrap().extension().unwrap() == "json" {
            let mut text = String::new();
            entry.read_to_string(&mut text).unwrap();
            expected.push(text);
        }
    }
    assert_eq!(labels, expected);

    // Tables that exist are counted by their pictures, and compared as a whole.
    let manifest = file("whole/manifest.json");
    fs::remove_file(folder.path().join("whole/0002.parquet")).unwrap();
    let again = ["-o", "whole/%04d.parquet", "--archive", "6"];
    run(folder.path(), &again);
    assert!(file("whole/manifest.json") == manifest);
    run(folder.path(), &[&again[..], &["--check"]].concat());
    let other = file("whole/0000.parquet");
    fs::write(folder.path().join("whole/0003.parquet"), other).unwrap();
    let check = ["dataset", "set.yaml", "--check"];
    let (status, message) = said(folder.path(), &[&check[..], &again].concat());
    assert_eq!(status, Some(1));
    assert!(
        message.contains("0003.parquet is missing, or differs"),
        "{message}"
    );
    let schema = parse_message_type("message numbers { required int64 number; }").unwrap();
    let mut foreign =
        SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::default()).unwrap();
    let mut group = foreign.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    let numbers = column.typed::<Int64Type>();
    numbers.write_batch(&[1, 2], None, None).unwrap();
    column.close().unwrap();
    group.close().unwrap();
    let foreign = foreign.into_inner().unwrap();
    for other in [foreign.as_slice(), b"no table"] {
        fs::write(folder.path().join("whole/0003.parquet"), other).unwrap();
        let (status, message) = said(folder.path(), &[&check[..2], &again].concat());
        assert_eq!(status, Some(1));
        assert!(message.contains("0003.parquet"), "{message}");
    }
}

#[test]
fn what_is_there_is_kept_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["-o", "out"]);
    let out = folder.path().join("out");
    let before = files(&out);
    fs::remove_file(out.join("00001/000003.png")).unwrap();
    fs::remove_file(out.join("manifest.json")).unwrap();
    run(folder.path(), &["-o", "out"]);
    assert!(files(&out) == before);
    assert!(run(folder.path(), &["-o", "out", "--check"]).contains("as they would be drawn"));

    fs::write(out.join("00002/000001.png"), "no picture").unwrap();
    fs::remove_file(out.join("00000/000004.png")).unwrap();
    let arguments = ["dataset", "set.yaml", "-o", "out", "--check"];
    let (status, said) = said(folder.path(), &arguments);
    assert_eq!(status, Some(1));
    assert!(said.contains("000004.png is missing, or differs"), "{said}");
    assert!(said.contains("000001.png is missing, or differs"), "{said}");
}

#[test]
fn another_data_set_is_not_mixed_in() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["-o", "out"]);
    fs::write(folder.path().join("set.yaml"), SPEC.replace("24", "25")).unwrap();
    let wrong: [(&[&str], i32, &str); 6] = [
        (&["-o", "out"], 1, "holds another data set"),
        (&["-o", "nothing", "--check"], 1, "holds no data set"),
        (&["-o", "out/archive.tar"], 2, "%06d.tar"),
        (&["-o", "out/table.parquet"], 2, "%06d.parquet"),
        (&["-o", "new", "--shard", "4/3"], 2, "K from 1 to N"),
        (&["-o", "new", "--archive", "0"], 2, "from 1 to"),
    ];
    for (arguments, expected, message) in wrong {
        let (status, said) = said(
            folder.path(),
            &[&["dataset", "set.yaml"], arguments].concat(),
        );
        assert_eq!(status, Some(expected), "{said}");
        assert!(said.contains(message), "{said}");
    }
    fs::write(
        folder.path().join("set.yaml"),
        "kind: dataset\ncategories: {systems: {rule: kock}}\n",
    )
    .unwrap();
    let (status, said) = said(folder.path(), &["dataset", "set.yaml", "-o", "new"]);
    assert_eq!(status, Some(1));
    assert!(
        said.contains("set.yaml:2:30") && said.contains("did you mean 'koch'?"),
        "{said}"
    );
    assert!(!folder.path().join("new").exists());
}
