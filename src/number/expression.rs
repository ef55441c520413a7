//! Numbers that are never in doubt: an expression, evaluated to as many digits as its sign or its
//! rounding needs.
//!
//! A number is a place in a thread's list of operations. Nothing is computed until a sign or a
//! sample is asked for; then the operations below it are evaluated in intervals whose ends are
//! rounded outward, with ever more bits. With the last of [`BITS`] the convention of the picture
//! ends it: a sign still open counts as 0, and a sample whose enclosure still holds a midpoint
//! between two f32s counts as that midpoint.

use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::HashMap;
use std::convert::Infallible;
use std::mem;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

use dashu_float::FBig;
use dashu_float::round::Round;
use dashu_float::round::mode::{Down, HalfEven, Up};

use super::{DoubleDouble, Doubt, Real, Ring, products_summed, round_sum};

/// The bits that an evaluation is tried with, one after the other. The first are more than a
/// double-double has, which has been tried before; with the last it ends.
const BITS: [usize; 7] = [192, 384, 768, 1536, 3072, 6144, 8192];

/// A number on this thread's list, valid until its session ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expression {
    place: usize,
    /// A double-double of the same value, which answers first: most parts of a formula in doubt
    /// are not in doubt themselves.
    near: DoubleDouble,
}

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
type Enclosure = Option<Arc<Interval>>;

/// A list of operations, and what is known of them.
#[derive(Default)]
pub(crate) struct Session {
    operations: Vec<Operation>,
    /// What each was evaluated to with each of [`BITS`], if it was: most never are.
    evaluated: Vec<Option<Box<[Option<Enclosure>; BITS.len()]>>>,
    /// Sines and cosines by the bits of their angle and the number among [`BITS`]. They outlive
    /// the operations: they are dear.
    turns: HashMap<(u64, usize), [Enclosure; 2]>,
}

thread_local! {
    /// The one that this thread's operations are added to.
    static SESSION: RefCell<Session> = RefCell::default();
}

impl Expression {
    /// Prepares this thread for expressions. The first one asks for a little memory for what the
    /// thread drops at its end, and the C library ends the process where that is refused.
    pub(crate) fn begin_thread() {
        SESSION.with(|_| ());
    }

    /// Runs `compute`, whose expressions must not leave it, and forgets them.
    pub(crate) fn session<T>(compute: impl FnOnce() -> T) -> T {
        let result = compute();
        SESSION.with_borrow_mut(|session| session.forget(0));
        result
    }

    fn new(operation: Operation, near: DoubleDouble) -> Expression {
        SESSION.with_borrow_mut(|session| {
            session.operations.push(operation);
            session.evaluated.push(None);
            let place = session.operations.len() - 1;
            Expression { place, near }
        })
    }

    /// Its sign, by evaluation alone.
    pub(super) fn evaluated_sign(self) -> Ordering {
        let sign = self.ask(|interval| {
            let signs = (
                interval.low.cmp(&FBig::ZERO),
                interval.high.cmp(&FBig::ZERO),
            );
            (signs.0 == signs.1).then_some(signs.0)
        });
        sign.unwrap_or(Ordering::Equal)
    }

    /// Rounded to the nearest f32, ties to even, by evaluation alone; a zero is +0.
    pub(super) fn evaluated_sample(self) -> f32 {
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
        0.0 + sample.unwrap_or_else(|enclosure| match enclosure {
            // The midpoint between two neighbours is an f64, and casting it breaks the tie to even.
            Some(interval) => {
                let (low, high) = ends(&interval);
                ((f64::from(low) + f64::from(high)) / 2.0) as f32
            }
            None => 0.0,
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
            let mut enclosure = None;
            for precision in 0..BITS.len() {
                enclosure = session.evaluate(self.place, precision);
                if let Some(answer) = enclosure.as_deref().and_then(&answer) {
                    return Ok(answer);
                }
            }
            Err(enclosure)
        })
    }
}

impl Session {
    /// A session of its own, and what `compute` returns: its expressions are valid in
    /// [`Session::go_on`] only, on any thread.
    pub(crate) fn begin<T>(compute: impl FnOnce() -> T) -> (Session, T) {
        let mut session = Session::default();
        let result = session.hold(compute);
        (session, result)
    }

    /// Runs `compute`, whose own expressions must not leave it, and forgets them. What was found
    /// out about those that there were before is remembered.
    pub(crate) fn go_on<T>(&mut self, compute: impl FnOnce() -> T) -> T {
        let kept = self.operations.len();
        let result = self.hold(compute);
        self.forget(kept);
        result
    }

    /// Runs `compute` with this as the thread's session.
    fn hold<T>(&mut self, compute: impl FnOnce() -> T) -> T {
        SESSION.with_borrow_mut(|session| mem::swap(session, self));
        let result = compute();
        SESSION.with_borrow_mut(|session| mem::swap(session, self));
        result
    }

    /// Forgets all operations but the first `kept`.
    fn forget(&mut self, kept: usize) {
        self.operations.truncate(kept);
        self.evaluated.truncate(kept);
    }

    /// What is at `place`, with the bits that have this number.
    fn evaluate(&mut self, place: usize, precision: usize) -> Enclosure {
        if let Some(evaluated) = &self.evaluated[place]
            && let Some(known) = &evaluated[precision]
        {
            return known.clone();
        }
        let bits = BITS[precision];
        let enclosure = match self.operations[place] {
            Operation::Exact(value) => Some(Arc::new(Interval::exact(value, bits))),
            Operation::Sine(alpha) => self.turn(alpha, precision)[0].clone(),
            Operation::Cosine(alpha) => self.turn(alpha, precision)[1].clone(),
            Operation::Sum(a, b) => self.both(a, b, precision, |a, b| Some(a.plus(b))),
            Operation::Product(a, b) => self.both(a, b, precision, |a, b| Some(a.times(b))),
            Operation::Quotient(a, b) => self.both(a, b, precision, Interval::over),
            Operation::Negation(a) => self.one(a, precision, Interval::negated),
            Operation::Root(a) => self.one(a, precision, Interval::root),
            Operation::OneMinusToThe(a, exponent) => self.one(a, precision, |a| {
                Interval::exact(1.0, bits)
                    .plus(&a.negated())
                    .clipped_power(exponent)
            }),
        };
        self.evaluated[place].get_or_insert_default()[precision] = Some(enclosure.clone());
        enclosure
    }

    fn one(
        &mut self,
        a: usize,
        precision: usize,
        operation: impl Fn(&Interval) -> Interval,
    ) -> Enclosure {
        self.evaluate(a, precision).map(|a| Arc::new(operation(&a)))
    }

    fn both(
        &mut self,
        a: usize,
        b: usize,
        precision: usize,
        operation: impl Fn(&Interval, &Interval) -> Option<Interval>,
    ) -> Enclosure {
        let (a, b) = (self.evaluate(a, precision)?, self.evaluate(b, precision)?);
        operation(&a, &b).map(Arc::new)
    }

    fn turn(&mut self, alpha: f64, precision: usize) -> [Enclosure; 2] {
        // An animation brings new angles for ever.
        if self.turns.len() > 64 {
            self.turns.clear();
        }
        let turn = self
            .turns
            .entry((alpha.to_bits(), precision))
            .or_insert_with(|| {
                let exact = |value: f64| Interval::exact(value, BITS[precision]);
                let turn = match alpha {
                    0.0 => [0.0, 1.0].map(exact),
                    _ => {
                        let (sin, cos) = exact(alpha).low.sin_cos();
                        [sin, cos].map(Interval::rounded_down)
                    }
                };
                turn.map(|part| Some(Arc::new(part)))
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

    /// What was rounded down to `low`, which is not 0: one rounding is half the work of two. At
    /// most an ulp away, it may be less tight by an ulp.
    fn rounded_down(low: FBig<Down>) -> Interval {
        // No digit of the sum is beyond those of `low`, so it is not rounded.
        let high = &low + low.ulp();
        Interval {
            high: high.with_rounding(),
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

    /// The extremes of a product lie at ends of both factors, and the factors' signs say at which.
    fn times(&self, other: &Interval) -> Interval {
        if self.is_at_most_zero() {
            return self.negated().times(other).negated();
        }
        if self.is_at_least_zero() {
            let (a, b) = (self, other);
            return Interval {
                low: if b.low >= FBig::<Down>::ZERO {
                    &a.low * &b.low
                } else {
                    up_as_down(&a.high) * &b.low
                },
                high: if b.high >= FBig::<Up>::ZERO {
                    &a.high * &b.high
                } else {
                    down_as_up(&a.low) * &b.high
                },
            };
        }
        if other.is_at_least_zero() || other.is_at_most_zero() {
            return other.times(self);
        }
        let (a, b) = (self, other);
        let lows = [&a.low * up_as_down(&b.high), up_as_down(&a.high) * &b.low];
        let highs = [down_as_up(&a.low) * down_as_up(&b.low), &a.high * &b.high];
        let ([low, other_low], [high, other_high]) = (lows, highs);
        Interval {
            low: low.min(other_low),
            high: high.max(other_high),
        }
    }

    /// `None` where the divisor may be 0.
    fn over(&self, other: &Interval) -> Option<Interval> {
        if other.high < FBig::<Up>::ZERO {
            return self.negated().over(&other.negated());
        }
        if other.low <= FBig::<Down>::ZERO {
            return None;
        }
        let (a, b) = (self, other);
        Some(Interval {
            low: if a.low >= FBig::<Down>::ZERO {
                &a.low / up_as_down(&b.high)
            } else {
                &a.low / &b.low
            },
            high: if a.high >= FBig::<Up>::ZERO {
                &a.high / down_as_up(&b.low)
            } else {
                &a.high / &b.high
            },
        })
    }

    fn is_at_least_zero(&self) -> bool {
        self.low >= FBig::<Down>::ZERO
    }

    fn is_at_most_zero(&self) -> bool {
        self.high <= FBig::<Up>::ZERO && !self.is_at_least_zero()
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

/// The nearest f32, ties to even.
fn round(x: FBig<HalfEven>) -> f32 {
    // Not by FBig::to_f32, which does not round to the nearest among subnormal f32s. The f64s here
    // are normal, or too small to count.
    let high = x.to_f64().value();
    let rest = FBig::try_from(high).map_or(Ordering::Equal, |high| x.cmp(&high));
    round_sum(high, f64::from(rest as i8))
}

impl Add for Expression {
    type Output = Expression;
    fn add(self, other: Expression) -> Expression {
        let sum = Operation::Sum(self.place, other.place);
        Expression::new(sum, self.near + other.near)
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
        Expression::new(Operation::Negation(self.place), -self.near)
    }
}

impl Mul for Expression {
    type Output = Expression;
    fn mul(self, other: Expression) -> Expression {
        let product = Operation::Product(self.place, other.place);
        Expression::new(product, self.near * other.near)
    }
}

impl Div for Expression {
    type Output = Expression;
    fn div(self, other: Expression) -> Expression {
        let quotient = Operation::Quotient(self.place, other.place);
        Expression::new(quotient, self.near / other.near)
    }
}

impl Ring for Expression {
    #[inline]
    fn sum_of_products<const N: usize>(a: [Expression; N], b: [Expression; N]) -> Expression {
        products_summed(a, b)
    }
}

impl Real for Expression {
    type Doubt = Infallible;

    fn exact(value: f64) -> Expression {
        Expression::new(Operation::Exact(value), DoubleDouble::exact(value))
    }

    fn sin_cos(alpha: f64) -> (Expression, Expression) {
        let (sin, cos) = DoubleDouble::sin_cos(alpha);
        (
            Expression::new(Operation::Sine(alpha), sin),
            Expression::new(Operation::Cosine(alpha), cos),
        )
    }

    fn sqrt(self) -> Expression {
        Expression::new(Operation::Root(self.place), self.near.sqrt())
    }

    fn one_minus_to_the(self, exponent: u32) -> Expression {
        let power = Operation::OneMinusToThe(self.place, exponent);
        Expression::new(power, self.near.one_minus_to_the(exponent))
    }

    fn sign(self) -> Result<Ordering, Infallible> {
        Ok(self
            .near
            .sign()
            .unwrap_or_else(|Doubt| self.evaluated_sign()))
    }

    fn to_sample(self) -> Result<f32, Infallible> {
        let sample = self.near.to_sample();
        Ok(sample.unwrap_or_else(|Doubt| self.evaluated_sample()))
    }

    fn to_f64(self) -> f64 {
        self.ask(|interval| Some(interval.low.to_f64().value()))
            .unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_cosines_are_enclosed() {
        let mut session = Session::default();
        // Of either sign, near 0 and near 1, and as large as angles are.
        for alpha in [
            0.3,
            -2.0,
            3.0,
            1e-300,
            std::f64::consts::FRAC_PI_2,
            1e22,
            1.7e308,
        ] {
            for precision in 0..3 {
                let wide = session.turn(alpha, precision);
                let narrow = session.turn(alpha, precision + 1);
                for (wide, narrow) in wide.iter().flatten().zip(narrow.iter().flatten()) {
                    let width = up_as_down(&wide.high) - &wide.low;
                    assert!(width > FBig::<Down>::ZERO && width <= wide.low.ulp());
                    assert!(
                        wide.low <= narrow.low && narrow.high <= wide.high,
                        "{alpha}"
                    );
                }
            }
        }
        for alpha in [0.0, -0.0] {
            let turn = session.turn(alpha, 0);
            for (part, value) in turn.iter().flatten().zip([0.0, 1.0]) {
                let exact = Interval::exact(value, BITS[0]);
                assert!(part.low == exact.low && part.high == exact.high);
            }
        }
    }
}
