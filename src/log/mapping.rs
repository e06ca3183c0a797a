//! What a user says of a log's columns: `QUANTITY=COLUMNS[:OPTION]…`.
//!
//! ```text
//! omega=wx,wy,wz:deg/s         three columns, in degrees a second
//! attitude=a,b,c,d:wxyz        four, the scalar first
//! attitude=orientation:xyzw    orientation[0] to orientation[3]
//! omega=:body                  the columns that are recognised, along the body's axes
//! force=none                   not read
//! time=#1:ms                   the first column
//! ```

use super::spellings::{Frame, Quantity};
use super::units::Unit;
use std::fmt;
use std::str::FromStr;

/// What is said of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    pub quantity: Quantity,
    pub columns: Source,
    pub unit: Option<&'static Unit>,
    pub frame: Option<Frame>,
    /// Of an attitude: where x, y, z, w stand among its columns.
    pub order: Option<[usize; 4]>,
    /// The attitude is logged from world to body.
    pub conjugated: bool,
}

/// Which columns are meant.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Those that are recognised.
    Recognised,
    /// None: the quantity is not read.
    Nothing,
    /// As the header has them, `#N` by number; one alone of a quantity with several components is their
    /// common beginning.
    Named(Vec<String>),
}

/// Why a text is no mapping.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{text}: {why}; {remedy}")]
pub struct MappingError {
    pub text: String,
    pub why: String,
    pub remedy: String,
}

impl FromStr for Mapping {
    type Err = MappingError;

    fn from_str(text: &str) -> Result<Self, MappingError> {
        let wrong = |why: String, remedy: String| MappingError {
            text: text.replace(char::is_control, " "),
            why,
            remedy,
        };
        let (name, rest) = text.split_once('=').ok_or_else(|| {
            wrong(
                "is no mapping".to_owned(),
                "write QUANTITY=COLUMNS, such as omega=wx,wy,wz:deg/s".to_owned(),
            )
        })?;
        let quantity = Quantity::called(name).ok_or_else(|| {
            let known: Vec<&str> = Quantity::ALL.iter().map(|q| q.name()).collect();
            wrong(
                format!("`{}` is no quantity of a log", name.trim()),
                crate::trace::nearest(name.trim(), &known),
            )
        })?;
        let mut mapping = Self {
            quantity,
            columns: Source::Recognised,
            unit: None,
            frame: None,
            order: None,
            conjugated: false,
        };
        // From the end, so that a column's name may hold a colon.
        let mut columns = rest;
        while let Some((before, option)) = columns.rsplit_once(':') {
            match mapping.take(option) {
                Ok(()) => columns = before,
                Err(Some(why)) => {
                    return Err(wrong(why, "keep one".to_owned()));
                }
                Err(None) if before.is_empty() => {
                    return Err(wrong(
                        format!("`{option}` is no option of {}", quantity.name()),
                        mapping.options(),
                    ));
                }
                Err(None) => break,
            }
        }
        let columns = columns.trim();
        mapping.columns = match columns {
            "" => Source::Recognised,
            "none" => Source::Nothing,
            _ => Source::Named(columns.split(',').map(|c| c.trim().to_owned()).collect()),
        };
        let width = quantity.width();
        if let Source::Named(names) = &mapping.columns {
            if names.iter().any(String::is_empty) {
                let why = "has an empty name among its columns".to_owned();
                return Err(wrong(why, format!("name {width}, with commas between")));
            }
            let two_clocks = quantity == Quantity::Time && names.len() == 2;
            if names.len() != width && names.len() != 1 && !two_clocks {
                return Err(wrong(
                    format!(
                        "{} has {width} columns, not {}",
                        quantity.name(),
                        names.len()
                    ),
                    format!("name {width}, or what their names begin with"),
                ));
            }
        }
        if mapping.columns == Source::Recognised
            && mapping.unit.is_none()
            && mapping.frame.is_none()
            && mapping.order.is_none()
            && !mapping.conjugated
        {
            return Err(wrong(
                "says nothing".to_owned(),
                format!("name columns after the =, none, or {}", mapping.options()),
            ));
        }
        Ok(mapping)
    }
}

impl Mapping {
    /// Takes an option in; `Err(None)` is none, `Err(Some)` says why it cannot be.
    fn take(&mut self, option: &str) -> Result<(), Option<String>> {
        let option = option.trim();
        let twice = |what: &str| Err(Some(format!("says its {what} twice")));
        if let Some(unit) = self.quantity.unit(option) {
            return match self.unit.replace(unit) {
                None => Ok(()),
                Some(_) => twice("unit"),
            };
        }
        let is_vector = self.quantity.width() == 3 && self.quantity != Quantity::Position;
        let frame = match option {
            "world" if is_vector => Some(Frame::World),
            "body" if is_vector => Some(Frame::Body),
            _ => None,
        };
        if let Some(frame) = frame {
            return match self.frame.replace(frame) {
                None => Ok(()),
                Some(_) => twice("axes"),
            };
        }
        if self.quantity != Quantity::Attitude {
            return Err(None);
        }
        if option == "conjugated" {
            self.conjugated = true;
            return Ok(());
        }
        let order = order(option).ok_or(None)?;
        match self.order.replace(order) {
            None => Ok(()),
            Some(_) => twice("order"),
        }
    }

    /// What may follow a colon.
    fn options(&self) -> String {
        let mut options: Vec<&str> = self.quantity.units().map(|unit| unit.name).collect();
        match self.quantity {
            Quantity::Attitude => options.extend(["xyzw", "wxyz", "conjugated"]),
            Quantity::Time | Quantity::Body | Quantity::Run | Quantity::Position => {}
            _ => options.extend(["world", "body"]),
        }
        match options.is_empty() {
            true => "it takes columns alone".to_owned(),
            false => format!("an option is one of {}", options.join(", ")),
        }
    }
}

/// Where x, y, z, w stand in a word such as `wxyz`.
fn order(word: &str) -> Option<[usize; 4]> {
    if word.len() != 4 {
        return None;
    }
    let mut order = [0; 4];
    for (slot, letter) in order.iter_mut().zip("xyzw".chars()) {
        *slot = word.find(letter)?;
    }
    Some(order)
}

impl fmt::Display for Mapping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}=", self.quantity.name())?;
        match &self.columns {
            Source::Recognised => {}
            Source::Nothing => write!(f, "none")?,
            Source::Named(names) => write!(f, "{}", names.join(","))?,
        }
        if let Some(order) = self.order {
            let mut word = [' '; 4];
            for (place, letter) in order.into_iter().zip("xyzw".chars()) {
                word[place] = letter;
            }
            write!(f, ":{}", word.iter().collect::<String>())?;
        }
        if let Some(unit) = self.unit {
            write!(f, ":{}", unit.name)?;
        }
        if let Some(frame) = self.frame {
            write!(f, ":{}", frame.name())?;
        }
        if self.conjugated {
            write!(f, ":conjugated")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mapping_is_what_it_was_written_as() {
        for text in [
            "omega=wx,wy,wz:deg/s",
            "attitude=a,b,c,d:wxyz",
            "attitude=orientation:xyzw:conjugated",
            "omega=:body",
            "force=none",
            "time=#1:ms",
            "omega=/imu:0/x,/imu:0/y,/imu:0/z",
        ] {
            let mapping: Mapping = text.parse().unwrap_or_else(|why| panic!("{why}"));
            assert_eq!(mapping.to_string(), text);
        }
        let mapping: Mapping = "q=w,x,y,z:wxyz".parse().unwrap();
        assert_eq!(mapping.order, Some([1, 2, 3, 0]));
    }

    #[test]
    fn what_is_none_is_refused_with_a_remedy() {
        for (text, said) in [
            (
                "omega",
                "omega: is no mapping; write QUANTITY=COLUMNS, such as omega=wx,wy,wz:deg/s",
            ),
            (
                "omga=a,b,c",
                "omga=a,b,c: `omga` is no quantity of a log; did you mean `omega`?",
            ),
            (
                "omega=a,b",
                "omega=a,b: omega has 3 columns, not 2; name 3, or what their names begin with",
            ),
            (
                "omega=a,,b",
                "omega=a,,b: has an empty name among its columns; name 3, with commas between",
            ),
            (
                "omega=:mm",
                "omega=:mm: `mm` is no option of omega; an option is one of rad/s, deg/s, rev/s, rpm, world, body",
            ),
            (
                "body=",
                "body=: says nothing; name columns after the =, none, or it takes columns alone",
            ),
            (
                "time=t:ms:us",
                "time=t:ms:us: says its unit twice; keep one",
            ),
        ] {
            let why = text.parse::<Mapping>().unwrap_err();
            assert_eq!(why.to_string(), said);
        }
    }
}
