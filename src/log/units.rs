//! Units that logs come in, as factors to SI: `SI = number · times / over`.
//!
//! A whole power of ten is divided by, not multiplied with its inverse: `1234 ms` is then the double nearest to 1.234.

use super::spellings::Quantity;
use std::f64::consts::PI;

/// A unit of one kind of quantity.
#[derive(Debug, PartialEq)]
pub struct Unit {
    /// As it is written where it is told.
    pub name: &'static str,
    /// As headers and mappings write it, besides; case, blanks and signs do not count.
    spellings: &'static [&'static str],
    kind: Kind,
    times: f64,
    over: f64,
}

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Time,
    Length,
    Speed,
    AngularSpeed,
    Torque,
    Force,
}

const fn unit(
    name: &'static str,
    spellings: &'static [&'static str],
    kind: Kind,
    times: f64,
    over: f64,
) -> Unit {
    Unit {
        name,
        spellings,
        kind,
        times,
        over,
    }
}

/// Every unit that is read, the one of SI first of its kind.
pub static UNITS: &[Unit] = &[
    unit(
        "s",
        &["sec", "secs", "second", "seconds"],
        Kind::Time,
        1.0,
        1.0,
    ),
    unit(
        "ms",
        &["msec", "msecs", "millisecond", "milliseconds"],
        Kind::Time,
        1.0,
        1e3,
    ),
    unit(
        "us",
        &["µs", "usec", "usecs", "microsecond", "microseconds"],
        Kind::Time,
        1.0,
        1e6,
    ),
    unit(
        "ns",
        &[
            "nsec",
            "nsecs",
            "nanosec",
            "nanosecs",
            "nanosecond",
            "nanoseconds",
        ],
        Kind::Time,
        1.0,
        1e9,
    ),
    unit(
        "m",
        &["metre", "metres", "meter", "meters"],
        Kind::Length,
        1.0,
        1.0,
    ),
    unit(
        "cm",
        &["centimetre", "centimetres", "centimeter", "centimeters"],
        Kind::Length,
        1.0,
        1e2,
    ),
    unit(
        "mm",
        &["millimetre", "millimetres", "millimeter", "millimeters"],
        Kind::Length,
        1.0,
        1e3,
    ),
    unit("km", &[], Kind::Length, 1e3, 1.0),
    unit(
        "m/s",
        &["mps", "m per s", "m per sec"],
        Kind::Speed,
        1.0,
        1.0,
    ),
    unit("cm/s", &[], Kind::Speed, 1.0, 1e2),
    unit("mm/s", &[], Kind::Speed, 1.0, 1e3),
    unit("km/h", &["kmh", "kph"], Kind::Speed, 1.0, 3.6),
    unit(
        "rad/s",
        &["rad", "rad per s", "rad per sec", "rad/sec"],
        Kind::AngularSpeed,
        1.0,
        1.0,
    ),
    unit(
        "deg/s",
        &[
            "deg",
            "dps",
            "deg per s",
            "deg per sec",
            "deg/sec",
            "degrees/s",
            "°/s",
        ],
        Kind::AngularSpeed,
        PI,
        180.0,
    ),
    unit("rev/s", &["turns/s"], Kind::AngularSpeed, 2.0 * PI, 1.0),
    unit("rpm", &["rev/min"], Kind::AngularSpeed, 2.0 * PI, 60.0),
    unit("N m", &["newton metre"], Kind::Torque, 1.0, 1.0),
    unit("mN m", &["N mm"], Kind::Torque, 1.0, 1e3),
    unit("N", &["newton", "newtons"], Kind::Force, 1.0, 1.0),
    unit("mN", &[], Kind::Force, 1.0, 1e3),
    unit("kN", &[], Kind::Force, 1e3, 1.0),
];

impl Unit {
    /// A number of this unit in SI.
    #[inline]
    pub fn to_si(&self, number: f64) -> f64 {
        number * self.times / self.over
    }

    /// How many of SI it is.
    pub fn size(&self) -> f64 {
        self.times / self.over
    }

    pub fn is_si(&self) -> bool {
        self.times == 1.0 && self.over == 1.0
    }

    /// Of a time: how many decimal digits it is finer than a second.
    pub fn digits(&self) -> u32 {
        [1.0, 1e3, 1e6, 1e9]
            .iter()
            .position(|over| *over == self.over)
            .map_or(0, |k| 3 * k as u32)
    }

    /// How it and others are written, for the docs.
    pub fn written(&self) -> Vec<&'static str> {
        std::iter::once(self.name)
            .chain(self.spellings.iter().copied())
            .collect()
    }

    fn is_called(&self, key: &str) -> bool {
        plain(self.name) == key || self.spellings.iter().any(|name| plain(name) == key)
    }
}

impl Quantity {
    fn kind(self) -> Option<Kind> {
        Some(match self {
            Self::Time => Kind::Time,
            Self::Position | Self::Point => Kind::Length,
            Self::Velocity => Kind::Speed,
            Self::Omega => Kind::AngularSpeed,
            Self::Torque => Kind::Torque,
            Self::Force => Kind::Force,
            Self::Attitude | Self::Body | Self::Run => return None,
        })
    }

    /// The units that it may come in, SI first.
    pub fn units(self) -> impl Iterator<Item = &'static Unit> {
        let kind = self.kind();
        UNITS.iter().filter(move |unit| Some(unit.kind) == kind)
    }

    /// Its unit of a name, in any spelling.
    pub fn unit(self, name: &str) -> Option<&'static Unit> {
        let key = plain(name);
        self.units().find(|unit| unit.is_called(&key))
    }

    pub fn si(self) -> Option<&'static Unit> {
        self.units().next()
    }
}

/// Small letters and digits alone: `deg/s` and `deg_s` are one.
pub(super) fn plain(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    let small = letters.flat_map(char::to_lowercase);
    // Micro sign and mu.
    small
        .map(|c| if c == 'µ' || c == 'μ' { 'u' } else { c })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_of_a_quantity_is_one() {
        for quantity in Quantity::ALL {
            for unit in quantity.units() {
                for name in unit.written() {
                    assert_eq!(quantity.unit(name), Some(unit), "{name}");
                }
            }
        }
    }

    #[test]
    fn numbers_of_units_are_the_nearest_in_si() {
        let of = |quantity: Quantity, unit: &str, x: f64| quantity.unit(unit).unwrap().to_si(x);
        assert_eq!(of(Quantity::Time, "µs", 1_234_567.0), 1.234_567);
        assert_eq!(of(Quantity::Position, "mm", 0.3), 0.000_3);
        assert_eq!(of(Quantity::Omega, "deg/s", 180.0), PI);
        // The product rounds once, an ulp of 2π.
        assert!((of(Quantity::Omega, "RPM", 60.0) - 2.0 * PI).abs() < 1e-15);
        assert_eq!(of(Quantity::Velocity, "km/h", 36.0), 10.0);
    }
}
