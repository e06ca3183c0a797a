//! What a scene writes for an effect, and what has been read of it.

use nalgebra::{UnitQuaternion, Vector3};

/// What a scene writes.
#[derive(Clone, Copy, Debug)]
pub enum Argument {
    /// `true` or `false`.
    Switch,
    /// A number, in the unit named.
    Number(&'static str),
    /// Three numbers, in the unit named.
    Vector(&'static str),
    /// A number or three of them, in the unit named.
    Amount(&'static str),
    /// One of these words.
    Word(&'static [&'static str]),
    /// An attitude, body to world, as a body's `orientation` is written.
    Attitude,
    /// A point of a body: a named one, or three numbers in its axes from its shape's origin, m.
    Point,
    /// A table of arguments by their keys; any may be absent.
    Table(&'static [(&'static str, Argument)]),
}

/// An argument, read.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Switch(bool),
    Number(f64),
    Vector(Vector3<f64>),
    Word(&'static str),
    Attitude(UnitQuaternion<f64>),
    Point(BodyPoint),
    /// The keys that are there.
    Table(Vec<(&'static str, Value)>),
}

/// A point of a body, before it is known which body's.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyPoint {
    Named(String),
    /// From the shape's origin, body axes, m.
    At(Vector3<f64>),
}

impl Value {
    /// A table of numbers.
    pub fn numbers(entries: &[(&'static str, f64)]) -> Self {
        let number = |&(key, x): &(&'static str, f64)| (key, Self::Number(x));
        Self::Table(entries.iter().map(number).collect())
    }

    /// What a table holds under a key.
    pub fn get(&self, key: &str) -> Option<&Value> {
        match self {
            Self::Table(entries) => entries.iter().find(|(k, _)| *k == key).map(|(_, v)| v),
            _ => None,
        }
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        match self.get(key)? {
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// A number that is not negative; 0 where it is absent.
    pub fn not_negative(&self, key: &str) -> Result<f64, String> {
        match self.number(key) {
            None => Ok(0.0),
            Some(x) if x >= 0.0 => Ok(x),
            Some(x) => Err(format!("{key} = {x} is below 0")),
        }
    }

    pub fn vector(&self, key: &str) -> Option<Vector3<f64>> {
        match self.get(key)? {
            Self::Vector(v) => Some(*v),
            _ => None,
        }
    }

    pub fn word(&self, key: &str) -> Option<&'static str> {
        match self.get(key)? {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    pub fn switch(&self, key: &str) -> bool {
        matches!(self.get(key), Some(Self::Switch(true)))
    }
}
