//! The fields of one row, whatever it was written in.

use csv::ByteRecord;
use serde_json::Value;
use std::borrow::Cow;

/// A field as a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    /// Empty.
    Nothing,
    Is(f64),
    NotFinite,
    /// No number.
    Wrong,
}

impl Number {
    fn of(x: f64) -> Self {
        match x.is_finite() {
            true => Self::Is(x),
            false => Self::NotFinite,
        }
    }

    #[inline]
    fn read(text: &[u8]) -> Self {
        let parsed = |text: &[u8]| std::str::from_utf8(text).ok()?.parse::<f64>().ok();
        if let Some(x) = parsed(text) {
            return Self::of(x);
        }
        let text = text.trim_ascii();
        let nothing: [&[u8]; 6] = [b"", b"null", b"NA", b"N/A", b"None", b"-"];
        match parsed(text) {
            Some(x) => Self::of(x),
            None if nothing.contains(&text) => Self::Nothing,
            None => Self::Wrong,
        }
    }
}

/// Fields by the number of their column, from 0.
pub(super) trait Cells {
    fn number(&self, column: usize) -> Number;
    /// As written; empty where there is nothing.
    fn text(&self, column: usize) -> Cow<'_, [u8]>;
}

impl Cells for ByteRecord {
    #[inline]
    fn number(&self, column: usize) -> Number {
        self.get(column).map_or(Number::Nothing, Number::read)
    }

    #[inline]
    fn text(&self, column: usize) -> Cow<'_, [u8]> {
        Cow::Borrowed(self.get(column).unwrap_or_default().trim_ascii())
    }
}

impl Cells for Vec<Value> {
    fn number(&self, column: usize) -> Number {
        match self.get(column) {
            None | Some(Value::Null) => Number::Nothing,
            Some(Value::Number(number)) => number.as_f64().map_or(Number::Wrong, Number::of),
            Some(Value::String(text)) => Number::read(text.as_bytes()),
            Some(_) => Number::Wrong,
        }
    }

    fn text(&self, column: usize) -> Cow<'_, [u8]> {
        match self.get(column) {
            None | Some(Value::Null) => Cow::Borrowed(b""),
            Some(Value::String(text)) => Cow::Borrowed(text.trim().as_bytes()),
            Some(other) => Cow::Owned(other.to_string().into_bytes()),
        }
    }
}

/// A number with a point and no exponent, in units of 10⁻¹² of what it would be in after `digits` decimal digits more:
/// `1700000000.25` with 0 is 1700000000250000000000, `1700000000250` with 3 (ms) is the same.
pub(super) fn fixed(text: &[u8], digits: u32) -> Option<i128> {
    const PICO: u32 = 12;
    let text = text.trim_ascii();
    let (negative, text) = match text.split_first()? {
        (b'-', rest) => (true, rest),
        (b'+', rest) => (false, rest),
        _ => (false, text),
    };
    let (mut value, mut after) = (0_i128, None);
    if text.is_empty() || text.len() > 36 {
        return None;
    }
    for &byte in text {
        match byte {
            b'0'..=b'9' if after == Some(PICO - digits) => {}
            b'0'..=b'9' => {
                value = value
                    .checked_mul(10)?
                    .checked_add(i128::from(byte - b'0'))?;
                after = after.map(|n| n + 1);
            }
            b'.' if after.is_none() => after = Some(0),
            _ => return None,
        }
    }
    let missing = PICO - digits - after.unwrap_or(0);
    let value = value.checked_mul(10_i128.pow(missing))?;
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_numbers_keep_every_digit() {
        for (text, digits, wanted) in [
            ("1700000000.25", 0, Some(1_700_000_000_250_000_000_000)),
            ("1700000000250", 3, Some(1_700_000_000_250_000_000_000)),
            (
                "1700000000123456789",
                9,
                Some(1_700_000_000_123_456_789_000),
            ),
            ("-0.5", 0, Some(-500_000_000_000)),
            (" 12. ", 0, Some(12_000_000_000_000)),
            ("0.1234567890123456", 0, Some(123_456_789_012)),
            ("0.0019", 9, Some(1)),
            ("1e5", 0, None),
            ("1.2.3", 0, None),
            ("", 0, None),
            ("-", 0, None),
        ] {
            assert_eq!(fixed(text.as_bytes(), digits), wanted, "{text}");
        }
    }

    #[test]
    fn fields_are_numbers_nothing_or_wrong() {
        for (text, wanted) in [
            ("1.5", Number::Is(1.5)),
            (" -2e-3 ", Number::Is(-2e-3)),
            ("", Number::Nothing),
            (" ", Number::Nothing),
            ("null", Number::Nothing),
            ("nan", Number::NotFinite),
            ("-inf", Number::NotFinite),
            ("1e999", Number::NotFinite),
            ("0,5", Number::Wrong),
            ("abc", Number::Wrong),
        ] {
            assert_eq!(Number::read(text.as_bytes()), wanted, "{text}");
        }
    }
}
