//! Tests of laws on random expressions and numbers: printing, folding, remainders, trigonometry.

use crate::expression::functions::FUNCTIONS;
use crate::expression::operator::{One, Two, modulo};
use crate::expression::{Expression, Node, degrees};

/// Generator of test data: Marsaglia's xorshift (2003).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from((self.0 >> 20) % bound).unwrap()
    }

    fn number(&mut self) -> f64 {
        let mantissa = f64::from(u32::try_from(self.below(1 << 32)).unwrap());
        match self.below(4) {
            0 => (mantissa % 10.0).floor(),
            1 => mantissa / 1e4,
            2 => mantissa * 1e20,
            _ => mantissa * 1e-20,
        }
    }

    fn tree(&mut self, levels: u32) -> Expression {
        const INFIX: [Two; 14] = [
            Two::Or,
            Two::And,
            Two::Less,
            Two::LessEqual,
            Two::Greater,
            Two::GreaterEqual,
            Two::Equal,
            Two::NotEqual,
            Two::Add,
            Two::Subtract,
            Two::Multiply,
            Two::Divide,
            Two::Modulo,
            Two::Power,
        ];
        let kind = if levels == 0 {
            self.below(3)
        } else {
            self.below(12)
        };
        let node = match kind {
            0 => Node::Number(self.number()),
            1 => Node::Truth(self.below(2) == 0),
            2 => Node::Name(["x", "_a1", "pi", "e", "notx", "e3"][self.below(6)].to_owned()),
            3 => Node::Prefix(One::Not, Box::new(self.tree(levels - 1))),
            4 => Node::Prefix(One::Negate, Box::new(self.tree(levels - 1))),
            5 => {
                let function = &FUNCTIONS[self.below(FUNCTIONS.len() as u64)];
                let count = (1..=3).find(|&count| function.accepts(count)).unwrap();
                let arguments = (0..count).map(|_| self.tree(levels - 1)).collect();
                Node::Call(function, arguments)
            }
            _ => {
                let operands = [self.tree(levels - 1), self.tree(levels - 1)];
                Node::Infix(INFIX[self.below(14)], Box::new(operands))
            }
        };
        Expression { node, range: 0..0 }
    }
}

#[test]
fn printing_and_parsing_again_is_the_identity() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for round in 0..20_000 {
        let tree = random.tree(round % 6);
        let text = tree.to_string();
        if text.len() <= 4096 {
            let again =
                Expression::parse(&text).unwrap_or_else(|error| panic!("{text}: {error:?}"));
            assert_eq!(again, tree, "{text}");
            assert_eq!(again.to_string(), text);
            assert_eq!(again.range(), 0..text.len());
        }
    }
}

#[test]
fn any_text_is_read_or_refused_within_its_bounds() {
    const PIECES: [&str; 30] = [
        "1", ".5", "1e", "1.", "x", "pi", "sin(", "max(", "if(", "(", ")", ",", " ", "+", "-", "*",
        "/", "%", "^", "<", "==", "=", "!", "not ", "and", "é", "×", "uniform(", "√", "\u{a0}",
    ];
    let mut random = Random(42);
    for _ in 0..50_000 {
        let text: String = (0..random.below(12))
            .map(|_| PIECES[random.below(30)])
            .collect();
        let result = Expression::parse(&text).and_then(|expression| {
            drop(expression.warnings());
            expression.compile(&super::scope())
        });
        if let Err(error) = result {
            assert!(text.get(error.range.clone()).is_some(), "{text}: {error:?}");
        }
    }
}

#[test]
fn folding_changes_no_value() {
    let slots = super::SLOTS;
    let mut random = Random(7);
    for _ in 0..20_000 {
        let tree = random.tree(3);
        let (mut constants, mut variables) = (super::Scope::new(), super::Scope::new());
        for (slot, name) in ["x", "_a1", "notx"].into_iter().enumerate() {
            constants.constant(name, slots[slot]);
            variables.variable(name, slot);
        }
        let compiled = (tree.compile(&constants), tree.compile(&variables));
        if let (Ok(folded), Ok(program)) = compiled {
            let (folded, value) = (folded.as_constant().unwrap(), program.eval(&slots));
            assert!(folded == value, "{tree}: {folded} {value}");
        }
    }
}

#[test]
fn the_remainder_is_exact() {
    let mut random = Random(3);
    let bits = |random: &mut Random| {
        let size = i64::try_from(random.below(1 << 40)).unwrap() >> random.below(40);
        let sign = if random.below(2) == 0 { 1 } else { -1 };
        (size << random.below(14)) * sign
    };
    for _ in 0..200_000 {
        let (x, c) = (bits(&mut random), bits(&mut random));
        if c != 0 {
            // `rem_euclid` is not negative; it is shifted to the sign of the divisor.
            let remainder = x.rem_euclid(c);
            let remainder = if c < 0 && remainder != 0 {
                remainder + c
            } else {
                remainder
            };
            let [x, c, remainder] = [x, c, remainder].map(|whole| whole as f64);
            let found = modulo(x, c);
            assert_eq!(found.to_bits(), remainder.to_bits(), "{x} % {c}");
            // Scaling by powers of two is exact, but the numbers are no longer integers.
            let scaled = modulo(x * 2.0_f64.powi(-60), c * 2.0_f64.powi(-60));
            assert_eq!(scaled, remainder * 2.0_f64.powi(-60), "{x} % {c}");
        }
    }
}

#[test]
fn trigonometry_is_exact_where_the_value_is() {
    use degrees::{acos, asin, atan, atan2, cos, sin, tan};
    let zero = 0.0_f64.to_bits();
    for turn in [-720.0, -360.0, 0.0, 360.0, 3.6e15] {
        for (angle, sine) in [
            (0.0, 0.0),
            (30.0, 0.5),
            (90.0, 1.0),
            (150.0, 0.5),
            (180.0, 0.0),
        ] {
            assert_eq!(sin(turn + angle), sine);
            assert_eq!(sin(turn - angle), -sine);
            assert_eq!(cos(turn + 90.0 - angle), sine);
        }
        assert_eq!(
            [sin(turn + 180.0), cos(turn + 90.0), tan(turn + 180.0)].map(f64::to_bits),
            [zero; 3]
        );
        assert_eq!(tan(turn + 45.0), 1.0);
        assert_eq!(tan(turn + 135.0), -1.0);
        assert!(tan(turn + 90.0).is_infinite() && tan(turn - 90.0).is_infinite());
        assert_eq!(sin(turn + 60.0), 3.0_f64.sqrt() / 2.0);
        assert_eq!(tan(turn + 60.0), 3.0_f64.sqrt());
    }
    assert_eq!(sin(45.0), cos(45.0));
    for quarters in -1440_i16..=1440 {
        let angle = f64::from(quarters) / 4.0;
        assert_eq!(sin(angle), cos(90.0 - angle), "{angle}");
        assert_eq!(sin(-angle), -sin(angle));
        assert_eq!(cos(-angle), cos(angle));
        assert_eq!(sin(angle + 180.0), -sin(angle));
        assert!((sin(angle) - angle.to_radians().sin()).abs() < 2e-15);
        assert!((cos(angle) - angle.to_radians().cos()).abs() < 2e-15);
    }
    for whole in -90_i8..=90 {
        let angle = f64::from(whole);
        assert_eq!(asin(sin(angle)), angle);
        assert_eq!(acos(cos(angle + 90.0)), angle + 90.0);
        assert_eq!(atan(tan(angle)), angle);
    }
    for (y, x, angle) in [
        (0.0, 0.0, 0.0),
        (0.0, -1.0, 180.0),
        (1.0, 0.0, 90.0),
        (-1.0, 0.0, -90.0),
        (-1.0, -1.0, -135.0),
        (3.0_f64.sqrt(), -1.0, 120.0),
    ] {
        assert_eq!(atan2(y, x), angle, "{y} {x}");
    }
    assert!(
        [
            sin(f64::NAN),
            cos(f64::INFINITY),
            asin(2.0),
            atan2(f64::NAN, 0.0)
        ]
        .iter()
        .all(|x| x.is_nan())
    );
}
