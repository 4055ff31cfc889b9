//! Tests of the values of expressions and of compiled programs.

use super::{
    Arithmetic as _, Dependence, Expression, ExpressionError, Folding, Program, Scope, Symbols,
    Type, is_reserved,
};

mod errors;
mod laws;

/// Returns a scope with the constants `angle` = 60 and `zero` = 0, and with `age`, `index` and `number`
/// in slots 0, 1 and 2.
fn scope() -> Scope {
    let mut scope = Scope::new();
    scope.constant("angle", 60.0);
    scope.constant("zero", 0.0);
    scope.variable("age", 0);
    scope.variable("index", 1);
    scope.variable("number", 2);
    scope
}

const SLOTS: [f64; 3] = [3.0, 7.0, 0.25];

fn compile(text: &str) -> Result<Program, ExpressionError> {
    let expression = Expression::parse(text)?;
    match expression.yields() {
        Type::Number => expression.compile(&scope()),
        Type::Condition => expression.compile_condition(&scope()),
    }
}

fn eval(text: &str) -> f64 {
    compile(text)
        .unwrap_or_else(|error| panic!("{text}: {error:?}"))
        .eval(&SLOTS)
}

#[test]
fn folding_gives_the_values_of_symbols() {
    let constants = [0.1, 3.0, -0.0, 0.5].map(Program::constant);
    let slot = compile("age * 2").unwrap();
    for a in constants.iter().chain([&slot]) {
        assert_eq!(Folding.turn(a), Symbols.turn(a));
        for b in constants.iter().chain([&slot]) {
            assert_eq!(Folding.add(a, b), Symbols.add(a, b));
            assert_eq!(Folding.multiply(a, b), Symbols.multiply(a, b));
        }
    }
}

#[test]
fn values() {
    let phi = f64::midpoint(1.0, 5.0_f64.sqrt());
    let table = [
        ("1", 1.0),
        (".5", 0.5),
        ("1e-3", 0.001),
        ("2.5E+2", 250.0),
        ("1/2", 0.5),
        ("sqrt(3)/6", 3.0_f64.sqrt() / 6.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("2^-1*3", 1.5),
        ("-2*3 - -4", -2.0),
        ("--3", 3.0),
        ("10 - 4 - 3", 3.0),
        ("16 / 4 / 2", 2.0),
        ("7 % 4", 3.0),
        ("-7 % 4", 1.0),
        ("(-7) % -4", -3.0),
        ("7 % -4", -1.0),
        ("2 * 7 % 4", 2.0),
        ("5.5 % 2", 1.5),
        ("phi", phi),
        ("pi", std::f64::consts::PI),
        ("e", std::f64::consts::E),
        ("phi^2 - phi", phi * phi - phi),
        ("4^0.5", 2.0),
        ("27^(1/3)", 3.0),
        ("0.1^3", 0.1 * (0.1 * 0.1)),
        ("cbrt(-27)", -3.0),
        ("abs(-2)", 2.0),
        ("sign(-2) + sign(0) + 10*sign(5)", 9.0),
        ("floor(-1.5)", -2.0),
        ("ceil(-1.5)", -1.0),
        ("round(2.5)", 3.0),
        ("round(-2.5)", -3.0),
        ("min(3)", 3.0),
        ("min(3, 1, 2)", 1.0),
        ("max(age, 1, index, 2)", 7.0),
        ("hypot(3, 4)", 5.0),
        ("exp(0) + ln(1) + log(1)", 1.0),
        ("log2(8) + log10(1000)", 6.0),
        ("sin(30)", 0.5),
        ("cos(angle)", 0.5),
        ("tan(45)", 1.0),
        ("asin(0.5)", 30.0),
        ("acos(-0.5)", 120.0),
        ("atan(1)", 45.0),
        ("atan2(1, -1)", 135.0),
        ("if(age == 3, 10, 20)", 10.0),
        ("if(age != 3, 10, 20 + index)", 27.0),
        ("1 + if(odd(age), if(even(age), 1, 2), 3)", 3.0),
        ("age + index*number", 4.75),
        ("if(zero == 0, 1, 1/zero)", 1.0),
    ];
    for (text, value) in table {
        assert_eq!(
            eval(text).to_bits(),
            value.to_bits(),
            "{text}: {}",
            eval(text)
        );
    }
}

#[test]
fn conditions() {
    let table = [
        ("true", true),
        ("false or true and false", false),
        ("not true or true", true),
        ("not age == 4", true),
        ("!(age < 3) && index >= 7 || false", true),
        ("age < 3", false),
        ("age <= 3", true),
        ("age > 3", false),
        ("number != 0.25", false),
        ("odd(age) and not even(age)", true),
        ("odd(-3)", true),
        ("odd(number) or even(number)", false),
        ("even(0)", true),
        ("age % 2 == 1", true),
        ("1 + 1 == 2", true),
        ("zero != 0 and 1/zero > 2", false),
        ("zero == 0 or 1/zero > 2", true),
        ("if(age > 2, odd(index), false)", true),
    ];
    for (text, holds) in table {
        let program = compile(text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
        assert_eq!(program.holds(&SLOTS), holds, "{text}");
        assert_eq!(program.eval(&SLOTS), f64::from(u8::from(holds)), "{text}");
    }
}

#[test]
fn constants_fold() {
    for text in [
        "angle/2 + 1",
        "if(angle > 1, 31, age)",
        "max(31, min(angle, 3))",
    ] {
        assert_eq!(compile(text).unwrap().as_constant(), Some(31.0), "{text}");
    }
    assert_eq!(compile("1 + 2").unwrap(), Program::constant(3.0));
    assert_eq!(compile("age + 1").unwrap().as_constant(), None);
    assert_eq!(
        compile("age * (1 + 2)").unwrap(),
        compile("age * 3").unwrap()
    );
}

#[test]
fn values_that_depend_on_slots_may_not_be_finite() {
    assert_eq!(eval("1 / (age - 3)"), f64::INFINITY);
    assert!(eval("sqrt(-age)").is_nan());
    assert!(eval("max(1, sqrt(-age), 2)").is_nan());
    assert!(eval("age % (age - 3)").is_nan());
    assert!(compile("age").unwrap().eval(&[]).is_nan());
}

#[test]
fn dependences() {
    let table = [
        ("1", Dependence::None),
        ("age", Dependence::None),
        ("index", Dependence::Free),
        ("index % 4 == 1", Dependence::Modulo(4)),
        ("odd(index)", Dependence::Modulo(2)),
        ("even(index) or index % 3 == age", Dependence::Modulo(6)),
        ("index % 4 + index % 6", Dependence::Modulo(12)),
        ("index % angle", Dependence::Modulo(60)),
        ("index % (1 + 2) == 1", Dependence::Modulo(3)),
        ("index % 2.5", Dependence::Free),
        ("index % -2", Dependence::Free),
        ("index % age", Dependence::Free),
        ("(index + 1) % 2", Dependence::Free),
        ("index % 2 + index", Dependence::Free),
        ("index + index % 2", Dependence::Free),
        ("index % 65537 + index % 65536", Dependence::Free),
        (
            "index % 4294967295 + index % 5",
            Dependence::Modulo(u32::MAX),
        ),
        ("index % 1e300", Dependence::Free),
        ("if(angle == 60, 1, index)", Dependence::None),
    ];
    for (text, dependence) in table {
        assert_eq!(compile(text).unwrap().dependence(1), dependence, "{text}");
    }
}

#[test]
fn names_and_calls() {
    let expression = Expression::parse("angle*sin(pi + angle) + if(true, x, 1)").unwrap();
    let names = [
        ("angle", 0..5),
        ("pi", 10..12),
        ("angle", 15..20),
        ("x", 33..34),
    ];
    assert_eq!(expression.names(), names);
    assert_eq!(expression.as_call(), None);

    let draw = Expression::parse("(uniform(-20, 2*x))").unwrap();
    let (name, arguments) = draw.as_call().unwrap();
    assert_eq!(name, "uniform");
    assert_eq!(
        arguments,
        [
            Expression::number(-20.0),
            Expression::parse("2 * x").unwrap()
        ]
    );
    assert_eq!([draw.range(), arguments[1].range()], [0..19, 14..17]);
    assert_eq!(
        Expression::parse("choice(1, 2, 3)")
            .unwrap()
            .as_call()
            .unwrap()
            .1
            .len(),
        3
    );
    assert_eq!(Expression::parse("-uniform(1, 2)").unwrap().as_call(), None);
    assert_eq!(Expression::parse("max(1, 2)").unwrap().as_call(), None);

    for name in ["pi", "e", "sqrt", "if", "and", "true", "uniform", "choice"] {
        assert!(is_reserved(name), "{name}");
    }
    assert!(!is_reserved("angle") && !is_reserved("x") && !is_reserved(""));
    assert!(scope().contains("angle") && !scope().contains("pi"));
}

#[test]
fn reserved_names_keep_their_meaning() {
    let mut scope = Scope::new();
    scope.constant("pi", 3.0);
    let program = Expression::parse("pi").unwrap().compile(&scope).unwrap();
    assert_eq!(program, Program::constant(std::f64::consts::PI));
}

#[test]
fn prints_with_the_parentheses_that_are_needed() {
    let table = [
        ("1+2*3", "1 + 2*3"),
        ("((1+2))*(3)", "(1 + 2)*3"),
        ("1-(2-3)", "1 - (2 - 3)"),
        ("(1-2)-3", "1 - 2 - 3"),
        ("(2^3)^2", "(2^3)^2"),
        ("2^(3^2)", "2^3^2"),
        ("(-2)^2", "(-2)^2"),
        ("-(2^2)", "-2^2"),
        ("2^(-1)", "2^-1"),
        ("-(a*b)", "-(a*b)"),
        ("- -a", "--a"),
        ("a%2==0&&!(b<1||c>2)", "a % 2 == 0 and not (b < 1 or c > 2)"),
        ("(not a) == b", "(not a) == b"),
        ("max( 1,a )/.50", "max(1, a)/0.5"),
        ("1e300 + 1e-7", "1e300 + 1e-7"),
    ];
    for (text, printed) in table {
        assert_eq!(Expression::parse(text).unwrap().to_string(), printed);
    }
}

#[test]
fn a_number_is_what_its_text_is() {
    for value in [
        0.0,
        -0.0,
        1.5,
        -2.0,
        1e300,
        -1e-300,
        f64::MAX,
        f64::MIN_POSITIVE,
    ] {
        let number = Expression::number(value);
        assert_eq!(Expression::parse(&number.to_string()).unwrap(), number);
        let program = number.compile(&Scope::new()).unwrap();
        assert_eq!(program.eval(&[]).to_bits(), value.to_bits());
    }
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(Expression::number(value).compile(&Scope::new()).is_err());
    }
}
