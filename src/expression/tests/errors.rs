//! Tests of the errors of parsing and compiling, with ranges and help texts.

use super::{Expression, ExpressionError, compile, scope};

/// Asserts that `text` without its guillemets fails with this message and hint at the range of the
/// first `«…»`.
#[track_caller]
fn fails(marked: &str, message: &str, hint: &str) {
    let (before, rest) = marked.split_once('«').unwrap();
    let (inside, after) = rest.split_once('»').unwrap();
    let text = format!("{before}{inside}{after}");
    let error = compile(&text).expect_err(&text);
    let expected = ExpressionError {
        range: before.len()..before.len() + inside.len(),
        message: message.to_owned(),
        hint: (!hint.is_empty()).then(|| hint.to_owned()),
    };
    assert_eq!(error, expected, "{text}");
    assert_eq!(error.to_string(), message);
}

#[test]
fn names() {
    fails(
        "1 + «angel»/2",
        "unknown name 'angel'",
        "did you mean 'angle'?",
    );
    fails("«Age»", "unknown name 'Age'", "did you mean 'age'?");
    fails("«True»", "unknown name 'True'", "did you mean 'true'?");
    let all = "what can be used here: age, angle, index, number, zero, pi, phi, e";
    fails("2*«width»", "unknown name 'width'", all);
    fails("«x»", "unknown name 'x'", all);
    fails("«sqr»(2)", "unknown function 'sqr'", "did you mean 'sqrt'?");
    fails(
        "«pi»(2)",
        "'pi' is a number, not a function",
        "write pi * (...)",
    );
    fails(
        "«sqrt» 2",
        "'sqrt' is a function: its arguments are missing",
        "write sqrt(x)",
    );
    fails(
        "1 + «atan2»",
        "'atan2' is a function: its arguments are missing",
        "write atan2(y, x)",
    );
    let error = compile("width(2)").unwrap_err();
    assert!(
        error
            .hint
            .unwrap()
            .starts_with("to multiply, write width * (...); the functions are ")
    );
    let error = Expression::parse("x")
        .unwrap()
        .compile(&super::Scope::new());
    assert_eq!(
        error.unwrap_err().hint.unwrap(),
        "what can be used here: pi, phi, e"
    );
}

#[test]
fn arguments() {
    fails("1 + «sin()»", "sin takes 1 argument, not 0", "write sin(x)");
    fails(
        "«sin(0,5)»",
        "sin takes 1 argument, not 2",
        "write 0.5: decimals follow a point",
    );
    fails(
        "«hypot(1)»",
        "hypot takes 2 arguments, not 1",
        "write hypot(x, y)",
    );
    fails(
        "«max()»",
        "max takes at least 1 argument, not 0",
        "write max(a, b, ...)",
    );
    fails(
        "«if(true, 1)»",
        "if takes 3 arguments, not 2",
        "write if(condition, then, otherwise)",
    );
    fails(
        "«uniform(1)»",
        "uniform takes 2 arguments, not 1",
        "write uniform(a, b)",
    );
}

#[test]
fn types() {
    let (condition, number) = (
        "a condition is needed here, this is a number",
        "a number is needed here, this is a condition",
    );
    let (compare, make) = (
        "compare it with something: x > 0",
        "if(condition, 1, 0) makes a number of it",
    );
    fails("«age» and true", condition, compare);
    fails("not «(age + 1)»", condition, compare);
    fails("if(«age», 1, 2)", condition, compare);
    fails("if(true, odd(age), «2»)", condition, compare);
    fails("if(true, 2, «odd(age)»)", number, make);
    fails("1 + «odd(age)»", number, make);
    fails("«(1 < 2)» == true", number, make);
    fails("-«true»", number, make);
    fails("sqrt(«not true»)", number, make);
    let age = Expression::parse("age").unwrap();
    assert_eq!(
        age.compile_condition(&scope()).unwrap_err().message,
        condition
    );
    let odd = Expression::parse("odd(age)").unwrap();
    assert_eq!(odd.compile(&scope()).unwrap_err().message, number);
}

#[test]
fn constant_parts() {
    fails("1/«0»", "division by zero", "");
    fails(
        "age % «(angle - 60)»",
        "division by zero",
        "angle - 60 is 0 here",
    );
    fails(
        "if(age == 0, 1, 2/«zero»)",
        "division by zero",
        "zero is 0 here",
    );
    fails(
        "1 + «sqrt(-1)»",
        "sqrt(-1) is not a real number",
        "sqrt takes no numbers below 0",
    );
    fails(
        "«asin(2)»",
        "asin(2) is not a real number",
        "asin takes numbers from -1 to 1",
    );
    fails(
        "«log(-1)»",
        "log(-1) is not a real number",
        "log takes no numbers below 0",
    );
    fails("age + «ln(0)»", "the value of this is not finite", "");
    fails("«tan(90)»*0", "the value of this is not finite", "");
    fails("«exp(1000)»", "the value of this is not finite", "");
    fails("«1e308 * 10» - 1", "the value of this is not finite", "");
    fails(
        "«(-8)^(1/4)»",
        "(-8)^(0.25) is not a real number",
        "a number below zero has only whole powers; cbrt(x) is its cube root",
    );
}

#[test]
fn distributions() {
    fails(
        "1 + «uniform(0, 1)»",
        "'uniform' cannot be used in a formula",
        "a distribution belongs under `random:`, where it gets a name",
    );
}

#[test]
fn brackets() {
    let flow = "in YAML's flow style a comma ends the value: quote it, or write it on a line of \
                its own";
    for text in [
        "uniform«(»-20",
        "uniform«(»-20,",
        "max«(»",
        "sqrt(1 + max«(»2 *",
    ] {
        fails(text, "this bracket is not closed", flow);
    }
    fails("sqrt(«(»2 + 1", "this bracket is not closed", flow);
    fails("2*«(»1 + ", "this bracket is not closed", "close it with )");
    fails("20«)»", "no bracket is open here", flow);
    fails(
        "(«)»",
        "a value is missing before ')'",
        "write a number, a name or a formula",
    );
}

#[test]
fn operators() {
    let missing = "an operator is missing here";
    fails("«2x»", missing, "write 2 * x");
    fails("«2(»1 + 1)", missing, "write 2 * (...)");
    fails("«2 pi»", missing, "write 2 * pi");
    fails("(1«) (»2)", missing, "write (...) * (...)");
    fails("1 + «2 sqrt»(2)", missing, "write 2 * sqrt(...)");
    fails("«2e»", missing, "write 2 * e");
    fails("«true odd»(age)", missing, "write and or or between them");
    fails(
        "(age > 1«) AND» true",
        missing,
        "write and, in small letters",
    );
    fails("age > «1 AND» true", missing, "write and, in small letters");
    fails("«index mod» 2", missing, "write % for the remainder");
    fails(
        "1 < age «<» 3",
        "comparisons do not chain",
        "write 1 < age and age < ...",
    );
    fails("2 «**» 3", "'**' is not an operator", "write ^ for powers");
    fails(
        "age «=» 3",
        "'=' does not belong in an expression",
        "write == to compare",
    );
    fails(
        "true «&» false",
        "'&' does not belong in an expression",
        "write and",
    );
    fails(
        "1 «+»",
        "a value is missing at the end",
        "write a number, a name or a formula after '+'",
    );
    fails(
        "50«%»",
        "a value is missing at the end",
        "% is the remainder of a division; for 50 percent write 0.5",
    );
    fails(
        "«+»5",
        "a value is missing before '+'",
        "leave the plus sign out",
    );
    fails(
        "2 * «/» 3",
        "a value is missing before '/'",
        "write a number, a name or a formula after '*'",
    );
    fails(
        "1 + «not» true",
        "'not' binds less tightly than this",
        "write (not ...)",
    );
}

#[test]
fn characters() {
    fails("2 «×» 3", "'×' does not belong in an expression", "write *");
    fails(
        "«√»3",
        "'√' does not belong in an expression",
        "write sqrt(x)",
    );
    fails("2«π»", "'π' does not belong in an expression", "write pi");
    fails(
        "«ä»",
        "'ä' does not belong in an expression",
        "names are written with A to Z, a to z, 0 to 9 and _",
    );
    fails(
        "sin(30«°»)",
        "'°' does not belong in an expression",
        "leave it out: angles are in degrees",
    );
    fails(
        "1«\u{a0}»+ 2",
        "'\\u{a0}' does not belong in an expression",
        "write an ordinary space",
    );
    fails(
        "0«,»5",
        "a comma does not belong here",
        "write 0.5: decimals follow a point",
    );
    fails(
        "1 + (12«,»5)",
        "a comma does not belong here",
        "write 12.5: decimals follow a point",
    );
    fails(
        "1«,» 2",
        "a comma does not belong here",
        "a comma stands only between the arguments of a function",
    );
    fails("«1.» + 2", "digits are missing after the point", "write 1");
    fails("«1.2.3»", "a number has one decimal point", "");
    fails("«1_000»", "a number has no separators", "write 1000");
    fails(
        "«1e999»",
        "this number is too large",
        "the largest is about 1.8e308",
    );
    fails(
        "«»",
        "an expression is missing",
        "write a number or a formula, such as sqrt(3)/6",
    );
    fails(
        "« »",
        "an expression is missing",
        "write a number or a formula, such as sqrt(3)/6",
    );
}

#[test]
fn limits() {
    let error = Expression::parse(&"(".repeat(100_000)).unwrap_err();
    assert_eq!(
        (error.range, error.message.as_str()),
        (0..100_000, "this is too long: 100000 bytes")
    );
    for (open, close) in [
        ("(", ")"),
        ("-", ""),
        ("not ", ""),
        ("sin(", ")"),
        ("1^", ""),
    ] {
        let nested = |levels| open.repeat(levels) + "1" + &close.repeat(levels);
        assert!(Expression::parse(&nested(64)).is_ok(), "{open}");
        let error = Expression::parse(&nested(65)).unwrap_err();
        assert_eq!(error.message, "this is nested too deeply", "{open}");
        assert!(Expression::parse(&open.repeat(4096 / open.len())).is_err());
    }
    let chain = |operators| "age".to_owned() + &"+1".repeat(operators);
    assert!(compile(&chain(256)).is_ok());
    assert_eq!(
        compile(&chain(257)).unwrap_err().message,
        "there are too many operators"
    );
    let deep = |levels| "age*(age+".repeat(levels) + "1" + &")".repeat(levels);
    assert!(compile(&deep(31)).is_ok());
    let error = compile(&deep(32)).unwrap_err();
    assert_eq!(error.message, "this needs more than 64 intermediate values");
}

#[test]
fn the_deepest_expression_needs_little_stack() {
    // The parser needs most stack for parentheses that follow all the operators.
    let text = "1 or 1 and 1 < 1 + 1*(".repeat(51) + &"(".repeat(13) + "1" + &")".repeat(64);
    let thread = std::thread::Builder::new().stack_size(1 << 20);
    let parsed = thread.spawn(move || {
        let chain = Expression::parse(&("-age".to_owned() + &"-age".repeat(254))).unwrap();
        assert_eq!(
            Expression::parse(&chain.to_string()).unwrap(),
            chain.clone()
        );
        assert!(chain.compile(&scope()).is_ok());
        let deep = Expression::parse(&text).unwrap();
        assert_eq!(Expression::parse(&deep.to_string()).unwrap(), deep);
        drop(deep.compile(&scope()));
    });
    parsed.unwrap().join().unwrap();
}

#[test]
fn warnings() {
    let warn = |text| {
        let warnings = Expression::parse(text).unwrap().warnings();
        warnings
            .into_iter()
            .map(|w| (w.range, w.message, w.hint))
            .collect::<Vec<_>>()
    };
    let message = "trigonometry takes degrees here";
    let warning = |range, hint: &str| (range, message.to_owned(), Some(hint.to_owned()));
    assert_eq!(
        warn("1 + cos(pi/3)"),
        [warning(4..13, "write cos(60), not cos(pi/3)")]
    );
    assert_eq!(
        warn("sin(x*pi)"),
        [warning(0..9, "write sin(60), not sin(pi/3)")]
    );
    assert_eq!(warn("pi*cos(60) + atan(pi)"), []);
}
