//! Formulas of complex numbers as points and factors.

use crate::common;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::grow::Growth;
use kfrac::model::Model;
use proptest::prelude::*;

/// Returns the maps of a system; `None` if one of its formulas is too long when it is written out.
fn maps(text: &str) -> Option<Vec<DAffine2>> {
    let source = Source::new("test.yaml", text);
    let document = Document::read(&source, &Catalogue::embedded());
    let resolved = document.and_then(|document| document.resolve(&[]));
    let model = match resolved {
        Ok((model, _)) => model,
        Err(errors) => {
            let errors = errors.render(false);
            let is_long = errors.contains("too long") || errors.contains("intermediate values");
            assert!(is_long, "{errors}");
            return None;
        }
    };
    let Model::Ifs(system) = model else {
        panic!("{text}");
    };
    Some(system.ifs().maps().iter().map(|map| map.affine).collect())
}

/// Returns the value of a formula, with a complex parameter s and a real one p.
fn value(formula: &str, s: DVec2, p: f64) -> Option<DVec2> {
    let text = format!(
        "kind: ifs\nparams: {{s: [{}, {}], p: {p}}}\nmaps:\n  - {{scale: 1/2, translate: {formula}}}\n  - {{scale: p/100, translate: s}}\n",
        s.x, s.y
    );
    Some(maps(&text)?[0].translation)
}

/// A formula of complex numbers, with its value computed in polar or Cartesian form.
#[derive(Clone, Debug)]
enum Formula {
    Unit,
    Real(i32),
    S,
    P,
    Negative(Box<Formula>),
    Join(char, Box<[Formula; 2]>),
    Power(Box<Formula>, i32),
}

impl Formula {
    fn text(&self) -> String {
        match self {
            Self::Unit => "i".into(),
            Self::Real(number) => number.to_string(),
            Self::S => "s".into(),
            Self::P => "p".into(),
            Self::Negative(of) => format!("-({})", of.text()),
            Self::Join(sign, both) => format!("({}) {sign} ({})", both[0].text(), both[1].text()),
            Self::Power(of, exponent) => format!("({})^{exponent}", of.text()),
        }
    }

    fn value(&self, s: DVec2, p: f64) -> DVec2 {
        match self {
            Self::Unit => DVec2::Y,
            Self::Real(number) => DVec2::new(f64::from(*number), 0.0),
            Self::S => s,
            Self::P => DVec2::new(p, 0.0),
            Self::Negative(of) => -of.value(s, p),
            Self::Join(sign, both) => {
                let [a, b] = [&both[0], &both[1]].map(|it| it.value(s, p));
                match sign {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a.rotate(b),
                    _ => a.rotate(DVec2::new(b.x, -b.y)) / b.length_squared(),
                }
            }
            Self::Power(of, exponent) => {
                let base = of.value(s, p);
                let angle = f64::from(*exponent) * base.y.atan2(base.x);
                DVec2::from_angle(angle) * base.length().powi(*exponent)
            }
        }
    }
}

fn formulas() -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        Just(Formula::Unit),
        (1..5).prop_map(Formula::Real),
        Just(Formula::S),
        Just(Formula::P),
    ];
    leaf.prop_recursive(4, 12, 2, |inner| {
        prop_oneof![
            inner.clone().prop_map(|it| Formula::Negative(Box::new(it))),
            (
                prop::sample::select(vec!['+', '-', '*', '/']),
                inner.clone(),
                inner.clone()
            )
                .prop_map(|(sign, a, b)| Formula::Join(sign, Box::new([a, b]))),
            (inner, -2..4).prop_map(|(it, exponent)| Formula::Power(Box::new(it), exponent)),
        ]
    })
}

proptest! {
    #![proptest_config(common::cases(200))]

    #[test]
    fn formulas_have_their_values(formula in formulas(), x in -2.0..2.0f64, y in 0.1..2.0f64, p in 0.5..3.0f64) {
        let s = DVec2::new(x, y);
        let expected = formula.value(s, p);
        // Near a division by 0, digits are lost or the value is none.
        let near = formula.value(s * (1.0 + 1e-9), p * (1.0 - 1e-9));
        let is_steady = expected.is_finite() && (near - expected).length() < 1e-6 * (1.0 + expected.length());
        let is_complex = formula.text().contains(['i', 's', 'p']) && formula.text() != "p";
        if is_steady && is_complex && expected.length() < 1e9 && divisors(&formula, s, p) > 1e-3 {
            let found = value(&formula.text(), s, p);
            prop_assume!(found.is_some());
            let found = found.unwrap();
            prop_assert!(
                (found - expected).length() <= 1e-9 * (1.0 + expected.length()),
                "{}: {found}, not {expected}", formula.text()
            );
        }
    }
}

/// Returns the least absolute value of what is divided by.
fn divisors(formula: &Formula, s: DVec2, p: f64) -> f64 {
    match formula {
        Formula::Negative(of) => divisors(of, s, p),
        Formula::Join(sign, both) => {
            let own = match sign {
                '/' => both[1].value(s, p).length(),
                _ => f64::INFINITY,
            };
            both.iter().map(|it| divisors(it, s, p)).fold(own, f64::min)
        }
        Formula::Power(of, exponent) => {
            let own = match exponent {
                ..0 => of.value(s, p).length(),
                _ => f64::INFINITY,
            };
            own.min(divisors(of, s, p))
        }
        _ => f64::INFINITY,
    }
}

#[test]
fn values_are_exact_where_they_are_representable() {
    let s = DVec2::new(0.5, 0.25);
    for (formula, x, y) in [
        ("1/(-2 + i)", -0.4, -0.2),
        ("i^2 + 0*i", -1.0, 0.0),
        ("(1 + i)^8", 16.0, 0.0),
        ("(1 + i)/p", 1.0 / 3.0, 1.0 / 3.0),
        ("1/i", 0.0, -1.0),
        ("s*2", 1.0, 0.5),
        ("i*sqrt(2)", 0.0, 2.0_f64.sqrt()),
        ("cos(60) + i*sin(30)", 0.5, 0.5),
    ] {
        assert_eq!(value(formula, s, 3.0), Some(DVec2::new(x, y)), "{formula}");
    }
}

#[test]
fn digits_in_a_complex_base_are_one_line() {
    let found = maps("kind: ifs\nparams: {b: -3 + i}\nmaps:\n  - {for: {digit: 0..9}, times: 1/b, translate: digit/b}\n").unwrap();
    assert_eq!(found.len(), 10);
    for (digit, map) in (0..).map(f64::from).zip(&found) {
        let image = map.transform_point2(DVec2::new(-3.0, 1.0));
        // 1/b times b, and the digit over b = -3 + i.
        let expected = DVec2::new(1.0 - 0.3 * digit, -0.1 * digit);
        assert!(image.distance(expected) < 1e-15, "{digit}: {image}");
    }
}

#[test]
fn real_numbers_are_complex() {
    let short = maps(
        "kind: ifs\nmaps:\n  - {times: 0.5, translate: 1}\n  - {scale: 1/4, fixed: -2}\n  - {times: 1/4, shift: 3}\n",
    );
    let listed = "kind: ifs\nmaps:\n  - {times: [0.5, 0], translate: [1, 0]}\n  - {scale: 1/4, fixed: [-2, 0]}\n  \
                  - {times: [1/4, 0], shift: [3, 0]}\n";
    assert_eq!(short.unwrap(), maps(listed).unwrap());
}

#[test]
fn points_of_rules_are_complex_numbers() {
    let rule = common::resolved(
        &common::document_of(
            "initiator: [[0, 0], 1 + i]\ngenerator: [[0, 0], {to: (1 + i)/2}, [1, 0]]\n",
        ),
        &[],
    );
    let listed = "initiator: [[0, 0], [1, 1]]\ngenerator: [[0, 0], {to: [1/2, 1/2]}, [1, 0]]\n";
    let expected = common::resolved(&common::document_of(listed), &[]);
    let [own, expected] = [rule, expected].map(|rule| {
        let grown = common::grown(&common::compiled(&rule, 5), &Growth::steps(5));
        grown
            .iter()
            .map(|fractal| format!("{:?}", fractal.elements))
            .collect::<Vec<_>>()
    });
    assert_eq!(own, expected);
}
