//! Whole powers.

/// `x^n` by squares, in an order of its own: std's `powi` may round otherwise on another platform or in another build.
pub fn power(x: f64, n: i32) -> f64 {
    let (mut product, mut square, mut left) = (1.0, x, n.unsigned_abs());
    loop {
        if left % 2 == 1 {
            product *= square;
        }
        left /= 2;
        if left == 0 {
            break;
        }
        square *= square;
    }
    if n < 0 { 1.0 / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_powers_of_small_numbers_are_exact() {
        for n in 0..=19 {
            let exact = (0..n).fold(1_u64, |product, _| product * 7);
            assert_eq!(power(7.0, n), exact as f64);
        }
        assert_eq!(
            (power(2.0, -10), power(-3.0, 3), power(0.0, 0)),
            (1.0 / 1024.0, -27.0, 1.0)
        );
        assert_eq!(power(2.0, i32::MIN), 0.0);
    }
}
