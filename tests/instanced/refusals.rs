//! Pictures that nested instances cannot show are refused, with the reason.

use kfrac::render::{NotInstanced, Options, RenderError};
use kfrac::style::{Cap, ColorBy, Colour, Width};

use super::{common, compiled, options, write};

/// Returns the reason why a picture is refused.
fn refusal(text: &str, change: impl FnOnce(&mut Options)) -> NotInstanced {
    let (heading, graph) = compiled(&common::document_of(text), 3);
    let mut options = options(&heading);
    change(&mut options);
    match write(&graph, 3, &options) {
        Err(RenderError::NotInstanced(refusal)) => refusal,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_refusal_has_its_reason() {
    let koch = "initiator: segment\ngenerator: [[0, 0], [0.4, 0], [0.5, 0.3], [0.6, 0], [1, 0]]\n";
    let random = "initiator: segment\ngenerators:\n  a:\n    random: {x: \"uniform(0.3, 0.6)\"}\n    \
                  elements: [[0, 0], [x, 0.2], [1, 0]]\n";
    assert_eq!(refusal(random, |_| {}), NotInstanced::Draws);
    let counted = "initiator: segment\ngenerator: [[0, 0], [0.5, 0.3 / i], [1, 0]]\n";
    assert_eq!(refusal(counted, |_| {}), NotInstanced::CountsIndex);
    let resets = "initiator: segment\ngenerators:\n  a:\n    parts:\n      \
                  - {elements: [[0, 0], [0.5, 0.2], [1, 0]]}\n      \
                  - {seeds: true, placed: initiator, elements: [[0, 0], [0, 0.2]]}\n";
    assert_eq!(refusal(resets, |_| {}), NotInstanced::Resets);
    let by = |by: ColorBy| move |options: &mut Options| options.style.color_by = by;
    assert_eq!(
        refusal(koch, by(ColorBy::Index)),
        NotInstanced::Colours { by: "index" }
    );
    let ring = koch.replace("segment", "square");
    let filled = |options: &mut Options| options.style.fill = Some(Colour::BLACK);
    assert_eq!(refusal(&ring, filled), NotInstanced::Areas);
    assert_eq!(
        refusal(koch, |options| options.style.cap = Cap::Butt),
        NotInstanced::Corners
    );
    let close = |options: &mut Options| options.view.window = Some([0.5, 0.1, 1e-6, 1e-6]);
    assert_eq!(refusal(koch, close), NotInstanced::TooClose);
    let sheared = "kind: ifs\nmaps:\n  - {matrix: [[0.5, 0], [0, 0.3]]}\n  \
                   - {matrix: [[0.4, 0.1], [0, 0.3]], shift: [0.5, 0]}\n\
                   initial: {segment: [[0, 0], [1, 0]]}\n";
    let relative = |options: &mut Options| options.style.width = Width::Relative(0.1);
    assert_eq!(refusal(sheared, relative), NotInstanced::Flattened);
}

/// Symbols are counted before they are written.
#[test]
fn there_are_only_so_many_symbols() {
    let (heading, graph) = compiled(&common::document("koch"), 0);
    let options = options(&heading);
    let refused = write(&graph, 900_000, &options);
    assert!(matches!(
        refused,
        Err(RenderError::NotInstanced(NotInstanced::TooManySymbols))
    ));
}
