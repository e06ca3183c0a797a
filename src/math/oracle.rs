//! Digits from mpmath for the tests of this room: tests/oracles/special.py made them.

use super::Dd;

const DIGITS: &str = include_str!("../../tests/oracles/special.csv");

/// The rows of one function: up to four arguments and the value, as an f64 and the rest.
pub fn rows(function: &str) -> Vec<([f64; 4], Dd)> {
    let parse = |line: &str| {
        let mut fields = line.split(',').skip(1).map(|f| f.parse().unwrap_or(0.0));
        let arguments = std::array::from_fn(|_| fields.next().unwrap());
        let (hi, lo) = (fields.next().unwrap(), fields.next().unwrap());
        (arguments, Dd { hi, lo })
    };
    let found: Vec<_> = DIGITS
        .lines()
        .filter(|line| line.split(',').next() == Some(function))
        .map(parse)
        .collect();
    assert!(found.len() > 5, "no digits for {function}");
    found
}

pub fn relative(got: Dd, want: Dd) -> f64 {
    ((got - want) / want).to_f64().abs()
}
