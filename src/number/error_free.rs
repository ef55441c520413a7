//! Sums and products as f64s together with what their rounding leaves out, exactly.

/// a + b as a rounded sum and its error, exactly (Knuth).
#[inline]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// The same where |a| ≥ |b| or a = 0 (Dekker).
#[inline]
pub(super) fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// A number's upper 26 bits and the rest (Veltkamp). No operand comes near the 2⁹⁹⁶ where this
/// would overflow.
#[inline]
fn split(a: f64) -> (f64, f64) {
    let scaled = a * 134_217_729.0;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}

/// a · b as a rounded product and its error, exactly where nothing underflows (Dekker). A fused
/// multiply-add would do it in one step, and would be a slow call on every machine that has none.
#[inline]
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_upper, a_lower), (b_upper, b_lower)) = (split(a), split(b));
    let error = a_lower * b_lower
        - (((product - a_upper * b_upper) - a_lower * b_upper) - a_upper * b_lower);
    (product, error)
}
