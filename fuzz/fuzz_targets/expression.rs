//! Fuzzing of expressions from arbitrary text: read, printed, read again, compiled and evaluated.
//!
//! Checks that nothing panics; that mistakes lie in the text; that a printed expression is read as equal; and
//! that constant folding changes no value.

#![no_main]

use kfrac::expression::{Expression, ExpressionError, Scope, Type};
use libfuzzer_sys::fuzz_target;

const NAMES: [&str; 5] = ["i", "age", "step", "length", "x"];
const VALUES: [f64; 5] = [3.0, 2.0, 0.0, 0.5, -45.0];

fuzz_target!(|text: &str| {
    let expression = match Expression::parse(text) {
        Ok(expression) => expression,
        Err(error) => return lies_in(text, &error),
    };
    let printed = expression.to_string();
    // Additional parentheses and digits may exceed the limit of the parser.
    match Expression::parse(&printed) {
        Ok(again) => {
            assert_eq!(again, expression, "{printed}");
            assert_eq!(again.to_string(), printed);
        }
        Err(error) => assert!(error.message.contains("too long"), "{printed}: {error}"),
    }
    for warning in expression.warnings() {
        lies_in(text, &warning);
    }
    let (mut constants, mut variables) = (Scope::new(), Scope::new());
    for (slot, (name, value)) in NAMES.into_iter().zip(VALUES).enumerate() {
        constants.constant(name, value);
        variables.variable(name, slot);
    }
    let result = expression.yields();
    for mistake in expression.mistakes(result, &variables) {
        lies_in(text, &mistake);
    }
    let compile = |scope| match result {
        Type::Number => expression.compile(scope),
        Type::Condition => expression.compile_condition(scope),
    };
    let Ok(program) = compile(&variables) else {
        return;
    };
    let value = program.eval(&VALUES);
    if let Ok(folded) = compile(&constants) {
        let folded = folded.eval(&VALUES);
        assert!(folded == value, "{printed} is {folded} or {value}");
    }
});

fn lies_in(text: &str, error: &ExpressionError) {
    assert!(text.get(error.range.clone()).is_some(), "{error:?}");
    assert!(!error.message.is_empty());
}
