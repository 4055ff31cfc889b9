//! Tables: independent readers find the same data in CSV and JSON.

use std::num::NonZero;

use kfrac::export::{self, TableFormat};
use kfrac::graph::Graph;
use kfrac::grow::Growth;

use super::library;

#[test]
fn both_tables_say_the_same() {
    let graph = Graph::compile(&library("pythagoras"), 4).unwrap();
    let table = |format| {
        let mut bytes = Vec::new();
        let one = NonZero::<usize>::MIN;
        export::write(&graph, &Growth::steps(4), format, one, &mut bytes).unwrap();
        bytes
    };
    let (comma, lines) = (table(TableFormat::Csv), table(TableFormat::JsonLines));
    let mut reader = csv::Reader::from_reader(comma.as_slice());
    let names = reader.headers().unwrap().clone();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    let text = String::from_utf8(lines).unwrap();
    let objects = text
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
    let objects: Vec<_> = objects.collect();
    assert!(rows.len() > 30);
    assert_eq!(rows.len(), objects.len());
    for (row, object) in rows.iter().zip(&objects) {
        for (name, value) in names.iter().zip(row) {
            let value: serde_json::Value = serde_json::from_str(value).unwrap();
            assert_eq!(object[name].as_f64(), value.as_f64(), "{name}");
            assert_eq!(object[name].as_bool(), value.as_bool(), "{name}");
        }
    }
}
