//! Every bound holds: random expressions in each number against the same expression in arbitrary
//! precision.

use std::cmp::Ordering;

use super::{Bounded, DoubleDouble, Doubt, Expression, Real};
use crate::random::Random;

/// A number as a scene has them: short, long, tiny, large, of either sign, or one that nearly
/// cancels another.
fn number(random: &mut Random) -> f64 {
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let long = 1.0 + random.fraction();
    sign * match random.below(6) {
        0 => random.below(16) as f64,
        1 => random.below(1000) as f64 / 64.0,
        2 => 1.0 + f64::EPSILON * random.below(4) as f64,
        3 => long * 1e-30,
        4 => long * 1e6,
        _ => long,
    }
}

/// How to compute a number from those before it.
#[derive(Clone, Copy, Debug)]
enum Step {
    Exact(f64),
    Sine(f64),
    Cosine(f64),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    /// The sum of three products, some of them with numbers that are known exactly.
    SumOfProducts(usize, usize),
    Divide(usize, usize),
    /// The root of a number that is known exactly.
    RootOf(f64),
    /// The root of a sum of two squares.
    Root(usize, usize),
    /// (1 − x²)ⁿ.
    Power(usize, u32),
}

fn steps(random: &mut Random, angles: &[f64]) -> Vec<Step> {
    let mut steps = Vec::new();
    for count in 0..14 {
        let a = random.below(count.max(1));
        let b = random.below(count.max(1));
        steps.push(match random.below(11) {
            _ if count < 4 => Step::Exact(number(random)),
            0 => Step::Sine(angles[random.below(angles.len())]),
            1 if count % 2 == 0 => Step::Cosine(angles[random.below(angles.len())]),
            1 => Step::RootOf(number(random).abs()),
            2 | 3 => Step::Add(a, b),
            4 | 5 => Step::Subtract(a, b),
            6 | 7 => Step::Multiply(a, b),
            8 => Step::Root(a, b),
            9 => Step::SumOfProducts(a, b),
            _ if count % 2 == 0 => Step::Divide(a, b),
            _ => Step::Power(a, [1, 2, 7, 1000][random.below(4)]),
        });
    }
    steps
}

fn compute<R: Real>(steps: &[Step]) -> Vec<R> {
    let mut values: Vec<R> = Vec::new();
    for &step in steps {
        values.push(match step {
            Step::Exact(x) => R::exact(x),
            Step::Sine(x) => R::sin_cos(x).0,
            Step::Cosine(x) => R::sin_cos(x).1,
            Step::Add(a, b) => values[a] + values[b],
            Step::Subtract(a, b) => values[a] - values[b],
            Step::Multiply(a, b) => values[a] * values[b],
            Step::SumOfProducts(a, b) => {
                let (a, b) = (values[a], values[b]);
                R::sum_of_products([a, b, values[0]], [b, values[1], a])
            }
            Step::Divide(a, b) => {
                // Not 0, and not well known.
                let cube = values[b].squared() + R::exact(0.125);
                values[a] / (cube * cube * cube)
            }
            Step::RootOf(x) => R::exact(x).sqrt(),
            Step::Root(a, b) => (values[a].squared() + values[b].squared()).sqrt(),
            Step::Power(a, exponent) => values[a].squared().one_minus_to_the(exponent),
        });
    }
    values
}

/// The truth lies within `error` of `middle`.
fn encloses(middle: Expression, error: f64, truth: Expression) -> bool {
    let off = truth - middle;
    let within =
        |off: Expression| (Expression::exact(error) - off).evaluated_sign() != Ordering::Less;
    !error.is_finite() || (within(off) && within(-off))
}

/// What a number says must be so, whose true sign and sample those are; where it is silent, that is
/// counted.
fn check<R: Real<Doubt = Doubt>>(
    number: R,
    (sign, sample): (Ordering, f32),
    what: &dyn Fn() -> String,
) -> u32 {
    let mut silent = 0;
    match number.sign() {
        Ok(said) => assert_eq!(said, sign, "{}", what()),
        Err(Doubt) => silent += 1,
    }
    match number.to_sample() {
        Ok(said) => assert_eq!(said.to_bits(), sample.to_bits(), "{}", what()),
        Err(Doubt) => silent += 1,
    }
    silent
}

#[test]
fn what_is_not_in_doubt_is_right() {
    let mut random = Random::new();
    let mut angles = Vec::new();
    let (mut asked, mut bounded_silent, mut double_silent) = (0, 0, 0);
    for turn in 0..1500 {
        // Sines and cosines would take nine tenths of the time if each came once. Of some angles
        // they are remembered; how right they are is tested where they are computed.
        if turn % 500 == 0 {
            angles = (0..8).map(|_| number(&mut random)).collect();
        }
        let steps = steps(&mut random, &angles);
        Expression::session(|| {
            let truth = compute::<Expression>(&steps);
            let (bounded, double) = (compute::<Bounded>(&steps), compute::<DoubleDouble>(&steps));
            for place in 4..steps.len() {
                let (truth, bounded, double) = (truth[place], bounded[place], double[place]);
                let what = || format!("step {place} of {steps:?}: {bounded:?} {double:?}");
                let middle = Expression::exact(bounded.value);
                assert!(encloses(middle, bounded.error, truth), "{}", what());
                let middle = Expression::exact(double.high) + Expression::exact(double.low);
                assert!(encloses(middle, double.error, truth), "{}", what());
                // Not by what is held against it here.
                let truth = (truth.evaluated_sign(), truth.evaluated_sample());
                bounded_silent += check(bounded, truth, &what);
                double_silent += check(double, truth, &what);
                asked += 2;
            }
        });
    }
    // Numbers that are always in doubt would pass, too.
    assert!(bounded_silent * 4 < asked, "{bounded_silent} of {asked}");
    assert!(double_silent * 20 < asked, "{double_silent} of {asked}");
}

#[test]
fn exact_cancellation_is_seen_by_double_doubles() {
    let x = DoubleDouble::exact(0.1);
    let y = DoubleDouble::exact(0.3);
    // (x + y)(x + y) needs more than 106 bits; x·x is exact, and so is the difference of equal
    // things.
    assert_eq!((x * x - x * x).sign(), Ok(Ordering::Equal));
    assert_eq!((x - x).sign(), Ok(Ordering::Equal));
    assert_eq!((x * y - y * x).sign(), Ok(Ordering::Equal));
    assert_eq!(
        (DoubleDouble::exact(0.0) * (x / y)).sign(),
        Ok(Ordering::Equal)
    );
}

#[test]
fn an_expression_knows_what_no_number_of_digits_shows() {
    Expression::session(|| {
        let (sin, cos) = Expression::sin_cos(0.7);
        let one = sin * sin + cos * cos;
        assert_eq!((one - Expression::exact(1.0)).sign(), Ok(Ordering::Equal));
        // A root of what is exactly 0, but not known to be.
        assert_eq!(
            (one - Expression::exact(1.0)).sqrt().sign(),
            Ok(Ordering::Equal)
        );
        assert_eq!(
            (one - Expression::exact(1f64.next_down()))
                .sqrt()
                .to_sample(),
            Ok(1.053_671_2e-8)
        );
        // 1 + 2⁻²⁴ is halfway between two floats, and the tie goes to the even one; a hair above it
        // does not.
        let half = Expression::exact(1.0 + f64::from(f32::EPSILON) / 2.0);
        assert_eq!((one * half).to_sample(), Ok(1.0));
        let hair = Expression::exact(1e-300);
        assert_eq!((one * half + hair).to_sample(), Ok(1.0 + f32::EPSILON));
    });
}
