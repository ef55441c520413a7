//! The numbers p + q√c, whose signs are found by squaring.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

use super::binary::Binary;

/// p + q√c. The root is kept as long as nothing has rounded c, and taken at once where something
/// has.
#[derive(Clone, Debug)]
pub(crate) struct Number {
    p: Binary,
    root: Option<Box<Root>>,
}

/// q√c. Numbers that meet in a sum or a product have the same c, or no root.
#[derive(Clone, Debug)]
struct Root {
    q: Binary,
    c: Arc<Binary>,
}

impl Root {
    fn sign(&self) -> Ordering {
        match self.c.sign() {
            Ordering::Equal => Ordering::Equal,
            _ => self.q.sign(),
        }
    }

    fn squared(&self) -> Binary {
        &(&self.q * &self.q) * &*self.c
    }

    fn times(&self, factor: &Binary) -> Root {
        Root {
            q: &self.q * factor,
            c: self.c.clone(),
        }
    }
}

/// The sign of a sum of two numbers, given theirs and how the squares compare.
fn sign_of_sum(a: Ordering, b: Ordering, squares: impl FnOnce() -> Ordering) -> Ordering {
    match (a, b) {
        (Ordering::Equal, other) | (other, Ordering::Equal) => other,
        (a, b) if a == b => a,
        (Ordering::Greater, _) => squares(),
        _ => squares().reverse(),
    }
}

impl Number {
    fn new(p: Binary, root: Option<Root>) -> Number {
        let root = root.map(Box::new);
        Number { p, root }
    }

    /// An f64, taken exactly.
    pub(crate) fn exact(value: f64) -> Number {
        Number::new(Binary::exact(value), None)
    }

    /// The sine and the cosine of an f64 in `bits` bits; those of 0 are exact.
    pub(crate) fn sin_cos(angle: f64, bits: usize) -> [Number; 2] {
        Binary::sin_cos(angle, bits).map(|value| Number::new(value, None))
    }

    /// For computing on in at most `bits` bits, without a root.
    pub(crate) fn limited(&self, bits: usize) -> Number {
        let p = self.p.limited(bits);
        let p = match &self.root {
            None => p,
            Some(root) => &p + &(&root.q * &root.c.limited(bits).root()),
        };
        Number::new(p, None)
    }

    /// A number that must not have a root.
    fn plain(&self) -> &Binary {
        assert!(self.root.is_none(), "{self:?} has a root");
        &self.p
    }

    /// The square root of a number that is not negative and has no root itself.
    pub(crate) fn root(&self) -> Number {
        let c = self.plain();
        if c.is_exact() {
            let (q, c) = (Binary::exact(1.0), Arc::new(c.clone()));
            Number::new(Binary::ZERO, Some(Root { q, c }))
        } else {
            Number::new(c.root(), None)
        }
    }

    /// max(0, self)^`power`.
    pub(crate) fn clipped_power(&self, power: u32) -> Number {
        Number::new(self.plain().clipped_power(power), None)
    }

    /// The nearest f32, ties to even.
    pub(crate) fn to_sample(&self) -> f32 {
        self.plain().to_sample()
    }

    pub(crate) fn sign(&self) -> Ordering {
        match &self.root {
            None => self.p.sign(),
            Some(root) => sign_of_sum(self.p.sign(), root.sign(), || {
                (&(&self.p * &self.p) - &root.squared()).sign()
            }),
        }
    }

    /// Whether self < other, also where their roots are different ones.
    pub(crate) fn less(&self, other: &Number) -> bool {
        let (Some(one), Some(two)) = (&self.root, &other.root) else {
            return (self - other).sign().is_lt();
        };
        // The sign of p + x − y, with the roots x and y.
        let p = &self.p - &other.p;
        let [x_squared, y_squared] = [one, two].map(|root| root.squared());
        let roots = sign_of_sum(one.sign(), two.sign().reverse(), || {
            (&x_squared - &y_squared).sign()
        });
        let sign = sign_of_sum(p.sign(), roots, || {
            // p² against (x − y)² = x² + y² − 2xy.
            let rest = &(&(&p * &p) - &x_squared) - &y_squared;
            let product = Root {
                q: &(&Binary::exact(2.0) * &one.q) * &two.q,
                c: Arc::new(&*one.c * &*two.c),
            };
            Number::new(rest, Some(product)).sign()
        });
        sign.is_lt()
    }
}

impl Add for &Number {
    type Output = Number;
    fn add(self, other: &Number) -> Number {
        let root = match (&self.root, &other.root) {
            (Some(one), Some(two)) => {
                assert_eq!(one.c, two.c, "two different roots");
                let (q, c) = (&one.q + &two.q, one.c.clone());
                Some(Box::new(Root { q, c }))
            }
            (one, two) => one.as_ref().or(two.as_ref()).cloned(),
        };
        let p = &self.p + &other.p;
        Number { p, root }
    }
}

impl Sub for &Number {
    type Output = Number;
    fn sub(self, other: &Number) -> Number {
        self + &-other
    }
}

impl Neg for &Number {
    type Output = Number;
    fn neg(self) -> Number {
        let root = |root: &Root| Root {
            q: -&root.q,
            c: root.c.clone(),
        };
        Number::new(-&self.p, self.root.as_deref().map(root))
    }
}

impl Mul for &Number {
    type Output = Number;
    fn mul(self, other: &Number) -> Number {
        let p = &self.p * &other.p;
        match (&self.root, &other.root) {
            (None, None) => Number { p, root: None },
            (Some(root), None) => Number::new(p, Some(root.times(&other.p))),
            (None, Some(root)) => Number::new(p, Some(root.times(&self.p))),
            (Some(one), Some(two)) => {
                assert_eq!(one.c, two.c, "two different roots");
                let root = Root {
                    q: &(&self.p * &two.q) + &(&one.q * &other.p),
                    c: one.c.clone(),
                };
                Number::new(&p + &(&(&one.q * &two.q) * &*one.c), Some(root))
            }
        }
    }
}

/// Of numbers without roots of which one is limited, the second not 0.
impl Div for &Number {
    type Output = Number;
    fn div(self, other: &Number) -> Number {
        Number::new(self.plain() / other.plain(), None)
    }
}

#[test]
fn signs_are_those_of_the_real_numbers() {
    let number = |p: f64, q: f64, c: f64| {
        let [p, q, c] = [p, q, c].map(Number::exact);
        &p + &(&q * &c.root())
    };
    // √2 lies between the convergents 1393/985 and 3363/2378.
    for (p, q, expected) in [
        (-1393.0, 985.0, Ordering::Greater),
        (-3363.0, 2378.0, Ordering::Less),
        (1393.0, -985.0, Ordering::Less),
        (3363.0, -2378.0, Ordering::Greater),
        (0.0, 0.0, Ordering::Equal),
        (-1.0, 0.0, Ordering::Less),
        (0.0, 2.0, Ordering::Greater),
    ] {
        assert_eq!(number(p, q, 2.0).sign(), expected);
    }
    assert_eq!(number(-6.0, 3.0, 4.0).sign(), Ordering::Equal);
    assert_eq!(number(0.0, -1.0, 0.0).sign(), Ordering::Equal);
    // (1 + √2)(1 − √2) = −1.
    let product = &number(1.0, 1.0, 2.0) * &number(1.0, -1.0, 2.0);
    assert_eq!((&product + &Number::exact(1.0)).sign(), Ordering::Equal);

    let order = |a: &Number, b: &Number| match (a.less(b), b.less(a)) {
        (true, _) => Ordering::Less,
        (_, true) => Ordering::Greater,
        _ => Ordering::Equal,
    };
    // √2, √3 and √5, with and against one another, as f64s have them.
    let radicands = [2.0f64, 3.0, 5.0, 4.0, 0.0];
    for (c, d) in radicands
        .into_iter()
        .flat_map(|c| radicands.map(|d| (c, d)))
    {
        for p in (-5..=5).map(f64::from) {
            for (q, r) in [
                (1.0, 1.0),
                (1.0, -1.0),
                (-1.0, 1.0),
                (-1.0, -1.0),
                (2.0, -1.0),
            ] {
                let about = p + q * c.sqrt() - r * d.sqrt();
                let expected = if about.abs() < 1e-9 { 0.0 } else { about };
                let expected = expected.total_cmp(&0.0);
                let got = order(&number(p, q, c), &number(0.0, r, d));
                assert_eq!(got, expected, "{p} + {q}√{c} against {r}√{d}");
            }
        }
    }
    // √2 + √3 against 3 + 146264…/10^15, which agrees with it to 15 digits, on both sides.
    for (p, expected) in [
        (3_146_264_369_941_972.0, Ordering::Greater),
        (3_146_264_369_941_973.0, Ordering::Less),
    ] {
        let got = order(&number(0.0, 1e15, 2.0), &number(p, -1e15, 3.0));
        assert_eq!(got, expected);
    }
}
