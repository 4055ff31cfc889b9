//! An artificial rule that combines the features of the reference's rules: three generators by index, all
//! directions, infertile elements, and several seeds of an element.

use kfrac::grow::Growth;

use super::common::{compiled, document_of, grown, resolved};
use super::compare;
use super::data::Entry;

const RULE: &str = "
initiator: [[0, 0], {to: [1, 1], direction: 3}, {to: [2, 0], direction: 2}]
generators:
  bend:
    - [0, 0]
    - {to: [1/2, 1/4], direction: 4}
    - {to: [1, 0], direction: 3}
  sow:
    parts:
      - elements: [[0, 0], {to: [1/2, -1/4], fertile: false}, {to: [1, 0], direction: 2}]
      - {seeds: true, elements: [[0, 1], {to: [1/4, 1], direction: 3}, {to: [1/2, 3/2], fertile: false}]}
      - {seeds: true, elements: [[1/2, 2], {to: [3/4, 2], direction: 4}]}
  stop:
    - [0, 0]
    - {to: [3/4, 0], direction: 2}
    - {to: [1, 0], fertile: false, direction: 3}
select: {by_index: [bend, sow, stop]}
";

/// The rule as an entry of the reference.
const DATA: &str = r#"{
  "id": "invented", "rule": "", "set": {}, "connected": true, "closed": false, "by_index": true,
  "dimension": null, "base_element": {"closed": false, "points": [[0, 0], [1, 0]]},
  "initiator": [[0, 0, 1, 1, 3, 1, 0], [1, 1, 2, 0, 2, 1, 0]],
  "generators": [
    [[0, 0, 0.5, 0.25, 4, 1, 0], [0.5, 0.25, 1, 0, 3, 1, 0]],
    [[0, 0, 0.5, -0.25, 1, 0, 0], [0.5, -0.25, 1, 0, 2, 1, 0],
     [0, 1, 0.25, 1, 3, 1, 1], [0.25, 1, 0.5, 1.5, 1, 0, 1], [0.5, 2, 0.75, 2, 4, 1, 2]],
    [[0, 0, 0.75, 0, 2, 1, 0], [0.75, 0, 1, 0, 3, 0, 0]]
  ],
  "per_step": []
}"#;

#[test]
fn an_invented_rule_is_walked_as_by_the_naive_engine() {
    let entry: Entry = serde_json::from_str(DATA).unwrap();
    let graph = compiled(&resolved(&document_of(RULE), &[]), 6);
    for n in 0..=6 {
        compare(&entry, n, &grown(&graph, &Growth::steps(n)));
    }
}
