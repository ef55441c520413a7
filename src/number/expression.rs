//! Numbers that are never in doubt: an expression, evaluated to as many digits as its sign or its rounding needs.
//!
//! A number is a place in a thread's list of operations. Nothing is computed until a sign or a sample is asked for; then the
//! operations below it are evaluated in intervals whose ends are rounded outward, with ever more bits. At [`MOST_BITS`] the
//! convention of the picture ends it: a sign still open counts as 0, and a sample whose enclosure still holds a midpoint
//! between two f32s counts as that midpoint.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::convert::Infallible;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::rc::Rc;

use dashu_float::FBig;
use dashu_float::round::Round;
use dashu_float::round::mode::{Down, HalfEven, Up};

use super::{DoubleDouble, Real, round_sum};

/// The bits that an evaluation begins with: more than a double-double has, which has been tried before.
const FEWEST_BITS: usize = 192;

/// The bits at which an evaluation ends.
const MOST_BITS: usize = 8192;

/// A number on this thread's list, valid until its session ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expression(usize);

/// What a number is made of, each operand by its place in the list.
#[derive(Clone, Copy)]
enum Operation {
    Exact(f64),
    Sine(f64),
    Cosine(f64),
    Sum(usize, usize),
    Negation(usize),
    Product(usize, usize),
    Quotient(usize, usize),
    Root(usize),
    OneMinusToThe(usize, u32),
}

/// The truth lies from `low` to `high`.
struct Interval {
    low: FBig<Down>,
    high: FBig<Up>,
}

/// `None` where nothing is known yet: after a division by an interval that holds 0.
type Enclosure = Option<Rc<Interval>>;

#[derive(Default)]
struct Session {
    operations: Vec<Operation>,
    /// What each was last evaluated to, and in how many bits.
    evaluated: Vec<(usize, Enclosure)>,
    /// Sines and cosines by the bits of their angle and of their precision, which outlive a session: they are dear.
    turns: HashMap<(u64, usize), [Enclosure; 2]>,
}

thread_local! {
    static SESSION: RefCell<Session> = RefCell::default();
}

impl Expression {
    /// Runs `compute`, whose expressions must not leave it, and forgets them.
    pub(crate) fn session<T>(compute: impl FnOnce() -> T) -> T {
        let result = compute();
        SESSION.with_borrow_mut(|session| {
            session.operations.clear();
            session.evaluated.clear();
        });
        result
    }

    fn new(operation: Operation) -> Expression {
        SESSION.with_borrow_mut(|session| {
            session.operations.push(operation);
            session.evaluated.push((0, None));
            Expression(session.operations.len() - 1)
        })
    }

    /// To about 100 bits.
    pub(crate) fn to_double_double(self) -> DoubleDouble {
        let parts = |interval: &Interval| {
            let high = interval.low.to_f64().value();
            let rest = |end: FBig<HalfEven>| {
                FBig::try_from(high).map_or(f64::INFINITY, |high| (end - high).to_f64().value())
            };
            let low = rest(interval.low.clone().with_rounding());
            let up_to = rest(interval.high.clone().with_rounding());
            DoubleDouble::around(high, low, up_to)
        };
        let known = self.ask(|interval| Some(parts(interval)).filter(DoubleDouble::is_known));
        known.unwrap_or_else(|_| DoubleDouble::unknown())
    }

    /// Asks `answer` about enclosures of more and more bits until it has one.
    fn ask<T>(self, answer: impl Fn(&Interval) -> Option<T>) -> Result<T, Enclosure> {
        SESSION.with_borrow_mut(|session| {
            let mut bits = FEWEST_BITS;
            loop {
                let enclosure = session.evaluate(self.0, bits);
                if let Some(answer) = enclosure.as_deref().and_then(&answer) {
                    return Ok(answer);
                }
                if bits >= MOST_BITS {
                    return Err(enclosure);
                }
                bits = (2 * bits).min(MOST_BITS);
            }
        })
    }
}

impl Session {
    fn evaluate(&mut self, place: usize, bits: usize) -> Enclosure {
        let (known_bits, known) = &self.evaluated[place];
        if *known_bits >= bits {
            return known.clone();
        }
        let enclosure = match self.operations[place] {
            Operation::Exact(value) => Some(Rc::new(Interval::exact(value, bits))),
            Operation::Sine(alpha) => self.turn(alpha, bits)[0].clone(),
            Operation::Cosine(alpha) => self.turn(alpha, bits)[1].clone(),
            Operation::Sum(a, b) => self.both(a, b, bits, |a, b| Some(a.plus(b))),
            Operation::Product(a, b) => self.both(a, b, bits, |a, b| Some(a.times(b))),
            Operation::Quotient(a, b) => self.both(a, b, bits, Interval::over),
            Operation::Negation(a) => self.one(a, bits, Interval::negated),
            Operation::Root(a) => self.one(a, bits, Interval::root),
            Operation::OneMinusToThe(a, exponent) => self.one(a, bits, |a| {
                Interval::exact(1.0, bits)
                    .plus(&a.negated())
                    .clipped_power(exponent)
            }),
        };
        self.evaluated[place] = (bits, enclosure.clone());
        enclosure
    }

    fn one(
        &mut self,
        a: usize,
        bits: usize,
        operation: impl Fn(&Interval) -> Interval,
    ) -> Enclosure {
        self.evaluate(a, bits).map(|a| Rc::new(operation(&a)))
    }

    fn both(
        &mut self,
        a: usize,
        b: usize,
        bits: usize,
        operation: impl Fn(&Interval, &Interval) -> Option<Interval>,
    ) -> Enclosure {
        let (a, b) = (self.evaluate(a, bits)?, self.evaluate(b, bits)?);
        operation(&a, &b).map(Rc::new)
    }

    fn turn(&mut self, alpha: f64, bits: usize) -> [Enclosure; 2] {
        // An animation brings new angles for ever.
        if self.turns.len() > 64 {
            self.turns.clear();
        }
        let turn = self
            .turns
            .entry((alpha.to_bits(), bits))
            .or_insert_with(|| {
                let angle = Interval::exact(alpha, bits);
                let ((sin_low, cos_low), (sin_high, cos_high)) =
                    (angle.low.sin_cos(), angle.high.sin_cos());
                let sine = Interval {
                    low: sin_low,
                    high: sin_high,
                };
                [
                    Some(Rc::new(sine)),
                    Some(Rc::new(Interval {
                        low: cos_low,
                        high: cos_high,
                    })),
                ]
            });
        turn.clone()
    }
}

impl Interval {
    /// The value of an f64: it has 53 bits, and intervals have more.
    fn exact(value: f64, bits: usize) -> Interval {
        let low = FBig::<Down>::try_from(value)
            .unwrap_or(FBig::ZERO)
            .with_precision(bits)
            .value();
        Interval {
            high: low.clone().with_rounding(),
            low,
        }
    }

    fn plus(&self, other: &Interval) -> Interval {
        Interval {
            low: &self.low + &other.low,
            high: &self.high + &other.high,
        }
    }

    fn negated(&self) -> Interval {
        Interval {
            low: -self.high.clone().with_rounding(),
            high: -self.low.clone().with_rounding(),
        }
    }

    fn times(&self, other: &Interval) -> Interval {
        // The extremes of a product lie at ends of both factors.
        let (a, b) = (
            [&self.low, &up_as_down(&self.high)],
            [&other.low, &up_as_down(&other.high)],
        );
        let lows = a.iter().flat_map(|a| b.iter().map(move |b| *a * *b));
        let (a, b) = (
            [&down_as_up(&self.low), &self.high],
            [&down_as_up(&other.low), &other.high],
        );
        let highs = a.iter().flat_map(|a| b.iter().map(move |b| *a * *b));
        Interval {
            low: least(lows),
            high: most(highs),
        }
    }

    /// `None` where the divisor may be 0.
    fn over(&self, other: &Interval) -> Option<Interval> {
        if other.low <= FBig::<Down>::ZERO && other.high >= FBig::<Up>::ZERO {
            return None;
        }
        let (a, b) = (
            [&self.low, &up_as_down(&self.high)],
            [&other.low, &up_as_down(&other.high)],
        );
        let lows = a.iter().flat_map(|a| b.iter().map(move |b| *a / *b));
        let (a, b) = (
            [&down_as_up(&self.low), &self.high],
            [&down_as_up(&other.low), &other.high],
        );
        let highs = a.iter().flat_map(|a| b.iter().map(move |b| *a / *b));
        Some(Interval {
            low: least(lows),
            high: most(highs),
        })
    }

    /// The root of a number that is not negative, whatever its enclosure says.
    fn root(&self) -> Interval {
        Interval {
            low: clipped(self.low.clone()).sqrt(),
            high: clipped(self.high.clone()).sqrt(),
        }
    }

    /// max(0, self) to the power `exponent`.
    fn clipped_power(self, exponent: u32) -> Interval {
        let mut square = Interval {
            low: clipped(self.low),
            high: clipped(self.high),
        };
        let mut power: Option<Interval> = None;
        let mut bits = exponent;
        loop {
            if bits & 1 == 1 {
                power = Some(match power {
                    Some(power) => power.times(&square),
                    None => Interval {
                        low: square.low.clone(),
                        high: square.high.clone(),
                    },
                });
            }
            bits >>= 1;
            if bits == 0 {
                // An exponent is at least 1.
                return power.unwrap_or(square);
            }
            square = square.times(&square);
        }
    }
}

/// max(0, x).
fn clipped<R: Round>(x: FBig<R>) -> FBig<R> {
    if x > FBig::<R>::ZERO { x } else { FBig::ZERO }
}

fn up_as_down(x: &FBig<Up>) -> FBig<Down> {
    x.clone().with_rounding()
}

fn down_as_up(x: &FBig<Down>) -> FBig<Up> {
    x.clone().with_rounding()
}

fn least(ends: impl Iterator<Item = FBig<Down>>) -> FBig<Down> {
    ends.reduce(|a, b| if b < a { b } else { a })
        .unwrap_or(FBig::ZERO)
}

fn most(ends: impl Iterator<Item = FBig<Up>>) -> FBig<Up> {
    ends.reduce(|a, b| if b > a { b } else { a })
        .unwrap_or(FBig::ZERO)
}

/// The nearest f32, ties to even.
fn round(x: FBig<HalfEven>) -> f32 {
    // Not by FBig::to_f32, which does not round to the nearest among subnormal f32s. The f64s here are normal, or too small to
    // count.
    let high = x.to_f64().value();
    let rest = FBig::try_from(high).map_or(Ordering::Equal, |high| x.cmp(&high));
    round_sum(high, f64::from(rest as i8))
}

impl Add for Expression {
    type Output = Expression;
    fn add(self, other: Expression) -> Expression {
        Expression::new(Operation::Sum(self.0, other.0))
    }
}

impl Sub for Expression {
    type Output = Expression;
    fn sub(self, other: Expression) -> Expression {
        self + -other
    }
}

impl Neg for Expression {
    type Output = Expression;
    fn neg(self) -> Expression {
        Expression::new(Operation::Negation(self.0))
    }
}

impl Mul for Expression {
    type Output = Expression;
    fn mul(self, other: Expression) -> Expression {
        Expression::new(Operation::Product(self.0, other.0))
    }
}

impl Div for Expression {
    type Output = Expression;
    fn div(self, other: Expression) -> Expression {
        Expression::new(Operation::Quotient(self.0, other.0))
    }
}

impl Real for Expression {
    type Doubt = Infallible;

    fn exact(value: f64) -> Expression {
        Expression::new(Operation::Exact(value))
    }

    fn sin_cos(alpha: f64) -> (Expression, Expression) {
        (
            Expression::new(Operation::Sine(alpha)),
            Expression::new(Operation::Cosine(alpha)),
        )
    }

    fn sqrt(self) -> Expression {
        Expression::new(Operation::Root(self.0))
    }

    fn one_minus_to_the(self, exponent: u32) -> Expression {
        Expression::new(Operation::OneMinusToThe(self.0, exponent))
    }

    fn sign(self) -> Result<Ordering, Infallible> {
        let sign = self.ask(|interval| {
            let signs = (
                interval.low.cmp(&FBig::ZERO),
                interval.high.cmp(&FBig::ZERO),
            );
            (signs.0 == signs.1).then_some(signs.0)
        });
        Ok(sign.unwrap_or(Ordering::Equal))
    }

    fn to_sample(self) -> Result<f32, Infallible> {
        let ends = |interval: &Interval| {
            (
                round(interval.low.clone().with_rounding()),
                round(interval.high.clone().with_rounding()),
            )
        };
        let sample = self.ask(|interval| {
            let (low, high) = ends(interval);
            (low == high).then_some(low)
        });
        Ok(0.0
            + sample.unwrap_or_else(|enclosure| match enclosure {
                // The midpoint between two neighbours is an f64, and casting it breaks the tie to even.
                Some(interval) => {
                    let (low, high) = ends(&interval);
                    ((f64::from(low) + f64::from(high)) / 2.0) as f32
                }
                None => 0.0,
            }))
    }

    fn to_f64(self) -> f64 {
        self.ask(|interval| Some(interval.low.to_f64().value()))
            .unwrap_or(f64::NAN)
    }
}
