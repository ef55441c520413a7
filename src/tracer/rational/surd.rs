//! The numbers p + q√c with rational p, q and c ≥ 0, whose signs are found by squaring.

use std::cmp::Ordering;
use std::ops::{Add, Sub};

use dashu_ratio::Relaxed;

pub(super) fn sign(x: &Relaxed) -> Ordering {
    x.cmp(&Relaxed::ZERO)
}

/// p + q√c. Numbers that meet in a sum or a product have the same c, or no root.
#[derive(Clone, Debug)]
pub(super) struct Surd {
    p: Relaxed,
    q: Relaxed,
    c: Relaxed,
}

impl From<Relaxed> for Surd {
    fn from(p: Relaxed) -> Surd {
        Surd::new(p, Relaxed::ZERO, Relaxed::ZERO)
    }
}

impl Surd {
    pub(super) fn new(p: Relaxed, q: Relaxed, c: Relaxed) -> Surd {
        assert!(sign(&c).is_ge(), "√{c} is not real");
        Surd { p, q, c }
    }

    /// The radicand of what is computed from both.
    fn radicand(&self, other: &Surd) -> Relaxed {
        let (one, two) = (!self.q.is_zero(), !other.q.is_zero());
        assert!(!(one && two) || self.c == other.c, "two different roots");
        if one { self.c.clone() } else { other.c.clone() }
    }

    pub(super) fn scaled(&self, factor: &Relaxed) -> Surd {
        Surd {
            p: &self.p * factor,
            q: &self.q * factor,
            c: self.c.clone(),
        }
    }

    pub(super) fn times(&self, other: &Surd) -> Surd {
        let c = self.radicand(other);
        Surd {
            p: &self.p * &other.p + &self.q * &other.q * &c,
            q: &self.p * &other.q + &self.q * &other.p,
            c,
        }
    }

    /// The sign of p + q√c.
    pub(super) fn sign(&self) -> Ordering {
        let root = sign(&(&self.q * &self.c));
        signs_of_sum(sign(&self.p), root, || {
            let (p, q) = (&self.p * &self.p, &self.q * &self.q * &self.c);
            p.cmp(&q)
        })
    }

    /// Less where self < other, also where their roots are different ones.
    pub(super) fn compare(&self, other: &Surd) -> Ordering {
        // The sign of p + x + y, with the roots x = q√c and y = −q'√c'.
        let p = &self.p - &other.p;
        let (x_squared, y_squared) = (&self.q * &self.q * &self.c, &other.q * &other.q * &other.c);
        let (x, y) = (
            sign(&(&self.q * &self.c)),
            sign(&(&other.q * &other.c)).reverse(),
        );
        let roots = signs_of_sum(x, y, || x_squared.cmp(&y_squared));
        signs_of_sum(sign(&p), roots, || {
            // p² against (x + y)² = x² + y² + 2xy.
            let rest = &p * &p - &x_squared - &y_squared;
            let product = &self.q * &other.q * Relaxed::from(2);
            Surd::new(rest, product, &self.c * &other.c).sign()
        })
    }
}

/// The sign of a sum of two numbers, given theirs and how the squares compare.
fn signs_of_sum(a: Ordering, b: Ordering, squares: impl FnOnce() -> Ordering) -> Ordering {
    match (a, b) {
        (Ordering::Equal, other) | (other, Ordering::Equal) => other,
        (a, b) if a == b => a,
        (Ordering::Greater, _) => squares(),
        _ => squares().reverse(),
    }
}

impl Add for &Surd {
    type Output = Surd;
    fn add(self, other: &Surd) -> Surd {
        Surd {
            p: &self.p + &other.p,
            q: &self.q + &other.q,
            c: self.radicand(other),
        }
    }
}

impl Sub for &Surd {
    type Output = Surd;
    fn sub(self, other: &Surd) -> Surd {
        Surd {
            p: &self.p - &other.p,
            q: &self.q - &other.q,
            c: self.radicand(other),
        }
    }
}

#[test]
fn signs_are_those_of_the_real_numbers() {
    let fraction = |a: i32, b: i32| Relaxed::from(a) / Relaxed::from(b);
    let surd =
        |p: i32, q: i32, c: i32| Surd::new(Relaxed::from(p), Relaxed::from(q), Relaxed::from(c));
    // √2 lies between the convergents 1393/985 and 3363/2378.
    for (p, q, expected) in [
        (fraction(-1393, 985), 1, Ordering::Greater),
        (fraction(-3363, 2378), 1, Ordering::Less),
        (fraction(1393, 985), -1, Ordering::Less),
        (fraction(3363, 2378), -1, Ordering::Greater),
    ] {
        assert_eq!(Surd::new(p, q.into(), 2.into()).sign(), expected);
    }
    assert_eq!(surd(-6, 3, 4).sign(), Ordering::Equal);
    assert_eq!(surd(0, -1, 0).sign(), Ordering::Equal);
    // (1 + √2)(1 − √2) = −1.
    let product = surd(1, 1, 2).times(&surd(1, -1, 2));
    assert_eq!((&product + &surd(1, 0, 0)).sign(), Ordering::Equal);

    // In tenths of millionths: √2, √3 and √5, with and against one another.
    let values = [
        (2, 14_142_136),
        (3, 17_320_508),
        (5, 22_360_680),
        (4, 20_000_000),
        (0, 0),
    ];
    for (c, root) in values {
        for (d, other_root) in values {
            for p in -5..=5 {
                for (q, r) in [(1, 1), (1, -1), (-1, 1), (-1, -1), (2, -1)] {
                    let about: i32 = 10_000_000 * p + q * root - r * other_root;
                    let expected = if about.abs() < 10 {
                        Ordering::Equal
                    } else {
                        about.cmp(&0)
                    };
                    let got = surd(p, q, c).compare(&surd(0, r, d));
                    assert_eq!(got, expected, "{p} + {q}√{c} against {r}√{d}");
                }
            }
        }
    }
    // √2 + √3 against 3 + 146264…/10^15, which agrees with it to 15 digits, on both sides.
    for (p, expected) in [
        (146_264_369_941_972_i64, Ordering::Greater),
        (146_264_369_941_973, Ordering::Less),
    ] {
        let p = Relaxed::from(3) + Relaxed::from(p) / Relaxed::from(1_000_000_000_000_000_i64);
        let got = surd(0, 1, 2).compare(&Surd::new(p, Relaxed::from(-1), Relaxed::from(3)));
        assert_eq!(got, expected);
    }
}
