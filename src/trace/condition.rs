//! Conditions: where to stop, what to mark, what to look for.
//!
//! ```text
//! energy drift > 1e-6           of any body
//! angular_velocity.cone > 50    a vector by its length
//! torque.cone.y < 0             one component
//! attitude error >= 0.5 deg     in its own unit, or an angle in degrees
//! not finite                    any number of any body
//! ```
//!
//! `QUANTITY[.BODY][.COMPONENT] RELATION NUMBER [UNIT]`, or `not finite[.BODY]`. A quantity is called as in
//! `torquescope streams`, with spaces or underscores, or by the stream that it leads; `*` is any body. Without a component
//! vectors, attitudes, matrices and each push compare by the root of their squares' sum, and `energy_drift` by its size
//! (its component `signed` has the sign). A number that is not known makes no condition true.

use super::instant::{Sample, Subject};
use super::names::nearest;
use super::quantity::{Quantity, Shape};
use super::streams::STREAMS;
use std::fmt;

/// A quantity that there is.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// With underscores.
    pub name: String,
    pub unit: &'static str,
    pub shape: Shape,
}

/// What there is to ask about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vocabulary {
    pub terms: Vec<Term>,
    pub bodies: Vec<String>,
}

/// Before the name of a source whose own torque it is.
pub const TORQUE_BY: &str = "torque_by_";

impl Vocabulary {
    /// Everything that a sample of these bodies tells.
    pub fn of(subjects: &[Subject]) -> Self {
        let mut terms: Vec<Term> = all().map(Term::of).collect();
        for source in subjects.iter().flat_map(|subject| &subject.sources) {
            let term = Term::of_source(source);
            if !terms.contains(&term) {
                terms.push(term);
            }
        }
        let names = subjects.iter().map(|subject| subject.name.clone());
        Self {
            terms,
            bodies: names.collect(),
        }
    }

    fn term(&self, name: &str) -> Option<&Term> {
        let named = |name: &str| self.terms.iter().find(|term| term.name == name);
        named(name).or_else(|| named(led_by(name)?))
    }
}

impl Term {
    pub fn of(quantity: &Quantity) -> Self {
        Self {
            name: quantity.name.to_owned(),
            unit: quantity.unit,
            shape: quantity.shape,
        }
    }

    /// The torque of one source.
    pub fn of_source(source: &str) -> Self {
        Self {
            name: format!("{TORQUE_BY}{source}"),
            unit: "N·m",
            shape: Shape::Vector,
        }
    }

    fn components(&self) -> &'static [&'static str] {
        match self.name == ENERGY_DRIFT {
            true => &[SIGNED],
            false => self.shape.components(),
        }
    }
}

const ENERGY_DRIFT: &str = "energy_drift";
const SIGNED: &str = "signed";

fn all() -> impl Iterator<Item = &'static Quantity> {
    STREAMS
        .iter()
        .flat_map(|stream| stream.quantities.iter().copied())
}

/// The first quantity of a stream.
fn led_by(stream: &str) -> Option<&'static str> {
    let stream = STREAMS.iter().find(|known| known.name == stream)?;
    stream.quantities.first().map(|quantity| quantity.name)
}

/// A quantity of one body or any, or a part of it: `torque`, `torque.cone`, `torque.cone.y`.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    pub term: Term,
    /// None: any.
    pub body: Option<String>,
    pub part: Part,
}

/// Which number of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The root of the sum of the squares.
    Size,
    /// The only one there is, as it is.
    Value,
    /// One of several.
    Component(usize),
}

/// Something that holds at an instant or does not.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    text: String,
    about: About,
}

#[derive(Clone, Debug, PartialEq)]
enum About {
    Compared(Chosen, Relation, f64),
    NotFinite(Option<String>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Relation {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    Unequal,
}

/// Longer ones first, so that `<=` is not read as `<`.
const RELATIONS: [(&str, Relation); 10] = [
    ("<=", Relation::LessOrEqual),
    (">=", Relation::GreaterOrEqual),
    ("==", Relation::Equal),
    ("!=", Relation::Unequal),
    ("≤", Relation::LessOrEqual),
    ("≥", Relation::GreaterOrEqual),
    ("≠", Relation::Unequal),
    ("<", Relation::Less),
    (">", Relation::Greater),
    ("=", Relation::Equal),
];

/// Why a text is no condition.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("column {column}: {why}")]
pub struct ConditionError {
    /// In characters, from 1.
    pub column: usize,
    pub why: String,
}

/// What made a condition true.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    pub quantity: String,
    pub value: f64,
}

/// No condition is longer.
const LONGEST: usize = 1_000;

impl Condition {
    pub fn parse(text: &str, vocabulary: &Vocabulary) -> Result<Self, ConditionError> {
        let reader = Reader { text, vocabulary };
        let condition = |about| Self {
            text: text.split_whitespace().collect::<Vec<_>>().join(" "),
            about,
        };
        if text.len() > LONGEST {
            let why = format!("a condition has at most {LONGEST} bytes");
            return Err(reader.wrong(text, why));
        }
        if let Some(about) = reader.not_finite()? {
            return Ok(condition(about));
        }
        let found = RELATIONS
            .iter()
            .filter_map(|(sign, relation)| Some((text.find(sign)?, sign, relation)));
        // The first in the text; of two at one place the longer, which is the earlier of the table.
        let Some((at, sign, relation)) = found.min_by_key(|(at, ..)| *at) else {
            let why = "a condition compares a quantity with a number, as in `energy drift > 1e-6`, or is `not finite`";
            return Err(reader.wrong(text, why));
        };
        let chosen = reader.chosen(&text[..at])?;
        let bound = reader.number(&text[at + sign.len()..], chosen.term.unit)?;
        Ok(condition(About::Compared(chosen, *relation, bound)))
    }

    /// The quantity that it asks for, where it is one; `not finite` asks for all.
    pub fn chosen(&self) -> Option<&Chosen> {
        match &self.about {
            About::Compared(chosen, ..) => Some(chosen),
            About::NotFinite(_) => None,
        }
    }

    pub fn concerns(&self, body: &str) -> bool {
        let own = match &self.about {
            About::Compared(chosen, ..) => &chosen.body,
            About::NotFinite(body) => body,
        };
        own.as_ref().is_none_or(|own| own == body)
    }

    /// What among the values of one body's quantity makes it true.
    pub fn met_by(&self, values: &[f64]) -> Option<f64> {
        match &self.about {
            About::Compared(chosen, relation, bound) => {
                let mut readings = chosen.readings(values);
                readings.find(|&x| relation.holds(x, *bound))
            }
            About::NotFinite(_) => values.iter().copied().find(|x| !x.is_finite()),
        }
    }

    /// What in a sample makes it true; `scratch` is room for numbers.
    pub fn met_in(
        &self,
        subject: &Subject,
        sample: &Sample,
        scratch: &mut Vec<f64>,
    ) -> Option<Met> {
        if !self.concerns(&subject.name) {
            return None;
        }
        let asked = |name: &str| {
            let chosen = self.chosen();
            chosen.is_none_or(|chosen| chosen.term.name == name)
        };
        let mut met = |name: &str, write: &dyn Fn(&mut Vec<f64>)| {
            scratch.clear();
            write(scratch);
            let quantity = name.to_owned();
            self.met_by(scratch).map(|value| Met { quantity, value })
        };
        let quantities = all().filter(|quantity| asked(quantity.name));
        let mut own = quantities.filter_map(|quantity| {
            met(quantity.name, &|out| (quantity.write)(subject, sample, out))
        });
        if let Some(found) = own.next() {
            return Some(found);
        }
        drop(own);
        let mut sources = subject.sources.iter().zip(&sample.sources);
        sources.find_map(|(source, torque)| {
            let name = format!("{TORQUE_BY}{source}");
            asked(&name).then(|| met(&name, &|out| out.extend(torque.iter())))?
        })
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Relation {
    fn holds(self, x: f64, bound: f64) -> bool {
        match self {
            Self::Less => x < bound,
            Self::LessOrEqual => x <= bound,
            Self::Greater => x > bound,
            Self::GreaterOrEqual => x >= bound,
            Self::Equal => x == bound,
            // What is no number is unequal to all, and known to be nothing.
            Self::Unequal => x != bound && !x.is_nan(),
        }
    }
}

impl Chosen {
    pub fn parse(text: &str, vocabulary: &Vocabulary) -> Result<Self, ConditionError> {
        Reader { text, vocabulary }.chosen(text)
    }

    /// The numbers that are compared: one, or one for each push that acts.
    pub fn readings<'v>(&self, values: &'v [f64]) -> impl Iterator<Item = f64> + use<'v> {
        let width = self.term.shape.components().len().max(1);
        let part = self.part;
        values.chunks_exact(width).map(move |values| match part {
            Part::Size => values.iter().map(|x| x * x).sum::<f64>().sqrt(),
            Part::Value => values[0],
            Part::Component(k) => values[k],
        })
    }
}

/// As it is written in a formula: `|torque|`, `torque.y`.
impl fmt::Display for Chosen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.term.name;
        match self.part {
            Part::Size => write!(f, "|{name}|"),
            Part::Value => f.write_str(name),
            Part::Component(k) => write!(f, "{name}.{}", self.term.shape.components()[k]),
        }
    }
}

/// A text that is read; all its pieces are slices of it, which tell where they stand.
struct Reader<'t> {
    text: &'t str,
    vocabulary: &'t Vocabulary,
}

impl Reader<'_> {
    /// An error about a piece of the text.
    fn wrong(&self, piece: &str, why: impl Into<String>) -> ConditionError {
        let start = piece.as_ptr() as usize - self.text.as_ptr() as usize;
        let before = self.text.get(..start).unwrap_or_default();
        ConditionError {
            column: before.chars().count() + 1,
            why: why.into(),
        }
    }

    fn not_finite(&self) -> Result<Option<About>, ConditionError> {
        let text = self.text.trim();
        let (head, body) = match text.split_once('.') {
            Some((head, body)) => (head, Some(body.trim())),
            None => (text, None),
        };
        let mut words = head.split([' ', '\t', '_']).filter(|word| !word.is_empty());
        let is_so =
            (words.next(), words.next(), words.next()) == (Some("not"), Some("finite"), None);
        if !is_so {
            return Ok(None);
        }
        match body {
            None | Some("*") => Ok(Some(About::NotFinite(None))),
            Some(body) if self.is_body(body) => Ok(Some(About::NotFinite(Some(body.to_owned())))),
            Some(body) => Err(self.wrong(body, self.no_body(body))),
        }
    }

    fn is_body(&self, name: &str) -> bool {
        self.vocabulary.bodies.iter().any(|body| body == name)
    }

    fn no_body(&self, name: &str) -> String {
        let bodies = self.vocabulary.bodies.iter();
        let bodies: Vec<&str> = bodies.map(String::as_str).collect();
        format!("no body is called `{name}`; {}", nearest(name, &bodies))
    }

    fn chosen(&self, text: &str) -> Result<Chosen, ConditionError> {
        let text = text.trim();
        let (name, rest) = match text.split_once('.') {
            Some((name, rest)) => (name.trim(), Some(rest.trim())),
            None => (text, None),
        };
        let term = self.term(name)?.clone();
        let plain = match term.components().is_empty() {
            true => Part::Value,
            false => Part::Size,
        };
        let chosen = |body: Option<&str>, part| Chosen {
            term: term.clone(),
            body: body.filter(|body| *body != "*").map(str::to_owned),
            part,
        };
        let Some(rest) = rest else {
            return Ok(chosen(None, plain));
        };
        // A body may be called as a component is: then it is meant.
        if rest == "*" || self.is_body(rest) {
            return Ok(chosen(Some(rest), plain));
        }
        if let Some(part) = part(&term, rest) {
            return Ok(chosen(None, part));
        }
        // Entities of other recordings have dots in their names.
        let Some((body, component)) = rest.rsplit_once('.') else {
            return Err(self.wrong(rest, self.no_body(rest)));
        };
        let (body, component) = (body.trim(), component.trim());
        if body != "*" && !self.is_body(body) {
            return Err(self.wrong(body, self.no_body(body)));
        }
        match part(&term, component) {
            Some(part) => Ok(chosen(Some(body), part)),
            None => Err(self.wrong(component, no_component(&term, component))),
        }
    }

    fn term(&self, name: &str) -> Result<&Term, ConditionError> {
        if name.is_empty() {
            let why =
                "name a quantity, such as `angular_velocity` (`torquescope streams` lists them)";
            return Err(self.wrong(name, why));
        }
        let joined: Vec<&str> = name.split_whitespace().collect();
        let joined = joined.join("_");
        if let Some(term) = self.vocabulary.term(&joined) {
            return Ok(term);
        }
        let mut streams = STREAMS.iter();
        let stream = streams.find(|stream| stream.quantities.iter().any(|q| q.name == joined));
        if let Some(stream) = stream {
            let why = format!(
                "`{joined}` is not recorded here; the stream `{}` has it (`[record] streams` in the scene)",
                stream.name
            );
            return Err(self.wrong(name, why));
        }
        let known = self.vocabulary.terms.iter();
        let known: Vec<&str> = known.map(|term| term.name.as_str()).collect();
        let why = format!(
            "no quantity is called `{joined}`; {}",
            nearest(&joined, &known)
        );
        Err(self.wrong(name, why))
    }

    /// A finite number, with or without the quantity's unit.
    fn number(&self, text: &str, unit: &str) -> Result<f64, ConditionError> {
        let text = text.trim();
        let (number, said) = match text.split_once(char::is_whitespace) {
            Some((number, said)) => (number, said.trim()),
            None => (text, ""),
        };
        let value: f64 = number
            .parse()
            .ok()
            .filter(|x: &f64| x.is_finite())
            .ok_or_else(|| {
                let why = format!("`{number}` is no finite number; write one such as 50 or 1e-6");
                self.wrong(number, why)
            })?;
        let degrees = matches!(
            (unit, said),
            ("rad", "deg" | "°") | ("rad/s", "deg/s" | "°/s")
        );
        match said {
            _ if degrees => Ok(value.to_radians()),
            "" => Ok(value),
            said if said == unit => Ok(value),
            said => {
                let what = match unit {
                    "1" | "" => "it has none".to_owned(),
                    unit => format!("it is in {unit}"),
                };
                Err(self.wrong(said, format!("`{said}` is not the quantity's unit: {what}")))
            }
        }
    }
}

fn part(term: &Term, name: &str) -> Option<Part> {
    let k = term.components().iter().position(|known| *known == name)?;
    match name == SIGNED {
        true => Some(Part::Value),
        false => Some(Part::Component(k)),
    }
}

fn no_component(term: &Term, name: &str) -> String {
    let known = term.components();
    match known.is_empty() {
        true => format!(
            "`{}` is one number and has no component `{name}`",
            term.name
        ),
        false => format!(
            "`{}` has no component `{name}`, but {}",
            term.name,
            known.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vocabulary() -> Vocabulary {
        let mut vocabulary = Vocabulary::of(&[]);
        vocabulary.terms.push(Term::of_source("wind"));
        vocabulary.bodies = ["cone", "x", "/world/a.b"].map(str::to_owned).to_vec();
        vocabulary
    }

    fn parse(text: &str) -> Result<Condition, ConditionError> {
        Condition::parse(text, &vocabulary())
    }

    fn met(text: &str, values: &[f64]) -> Option<f64> {
        let condition = parse(text).unwrap_or_else(|why| panic!("{text}: {why}"));
        condition.met_by(values)
    }

    #[test]
    fn what_is_compared() {
        // 3, 4, 12 and 13.
        let v = [3.0, 4.0, -12.0];
        assert_eq!(met("angular_velocity.cone > 12.9", &v), Some(13.0));
        assert_eq!(met("angular velocity > 13", &v), None);
        assert_eq!(met("omega >= 13", &v), Some(13.0));
        assert_eq!(met("torque.cone.z < 0", &v), Some(-12.0));
        assert_eq!(met("torque.cone.y < 0", &v), None);
        assert_eq!(met("torque.*.y ≥ 4", &v), Some(4.0));
        assert_eq!(met("torque.y = 4", &v), Some(4.0));
        // A body is called x.
        assert_eq!(met("torque.x = 13 N·m", &v), Some(13.0));
        assert_eq!(met("torque by wind.cone == 13", &v), Some(13.0));
        assert_eq!(met("position./world/a.b.x < 4 m", &v), Some(3.0));
        assert_eq!(met("position./world/a.b > 12", &v), Some(13.0));
        assert_eq!(met("energy drift > 1e-6", &[-2e-6]), Some(2e-6));
        assert_eq!(met("energy drift.signed > 1e-6", &[-2e-6]), None);
        assert_eq!(met("energy drift.cone.signed < 0", &[-2e-6]), Some(-2e-6));
        assert_eq!(met("kinetic_energy < 0", &[-2e-6]), Some(-2e-6));
        assert_eq!(met("attitude error > 90 deg", &[1.571]), Some(1.571));
        assert_eq!(met("attitude error > 91 deg", &[1.571]), None);
        // Pushes are looked at one by one.
        assert_eq!(met("force > 6", &[3.0, 4.0, 0.0, 0.0, 0.0, 7.0]), Some(7.0));
        assert_eq!(met("force > 8", &[3.0, 4.0, 0.0, 0.0, 0.0, 7.0]), None);
    }

    #[test]
    fn what_is_not_known_or_no_number_makes_nothing_true() {
        for relation in ["<", "<=", ">", ">=", "==", "!="] {
            let text = format!("energy_drift {relation} 0.5");
            assert_eq!(met(&text, &[]), None, "{text}");
            assert_eq!(met(&text, &[f64::NAN]), None, "{text}");
        }
        assert!(met("not finite", &[1.0, f64::NAN]).is_some_and(f64::is_nan));
        assert_eq!(
            met("not  finite.cone", &[1.0, -f64::INFINITY]),
            Some(-f64::INFINITY)
        );
        assert_eq!(met("not finite", &[1.0, 2.0]), None);
        assert!(parse("not finite.cone").unwrap().concerns("cone"));
        assert!(!parse("not finite.cone").unwrap().concerns("x"));
        assert!(parse("energy drift > 1").unwrap().concerns("x"));
    }

    #[test]
    fn mistakes_are_told_with_their_column_and_what_was_meant() {
        for (text, column, part) in [
            ("", 1, "compares a quantity with a number"),
            ("energy drift", 1, "compares a quantity with a number"),
            ("> 1", 1, "name a quantity"),
            ("angular_velocty > 1", 1, "did you mean `angular_velocity`?"),
            ("torque.cnoe > 1", 8, "did you mean `cone`?"),
            ("torque . cone.w > 1", 15, "but x, y, z"),
            ("kinetic energy.cone.x > 1", 21, "has no component `x`"),
            ("torque.cone > fast", 15, "`fast` is no finite number"),
            ("torque.cone > 1e999", 15, "no finite number"),
            ("torque.cone >", 14, "no finite number"),
            ("τ.cone > 1 N", 1, "no quantity is called `τ`"),
            ("torque.cone > 1 N", 17, "it is in N·m"),
            ("energy_drift > 1 J", 18, "it has none"),
            ("not finite.cnoe", 12, "did you mean `cone`?"),
        ] {
            let why = parse(text).expect_err(text);
            assert_eq!(why.column, column, "{text}: {why}");
            assert!(why.why.contains(part), "{text}: {why}");
        }
        let only = Vocabulary {
            terms: Vec::new(),
            bodies: Vec::new(),
        };
        let why = Condition::parse("torque > 1", &only).unwrap_err();
        assert!(why.why.contains("stream `torque`"), "{why}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        /// Whatever is written is read or refused at a column of it.
        #[test]
        fn no_text_panics(text in "\\PC{0,40}|[a-z_.*<>=!≤ 0-9-]{0,60}|(torque|energy drift|not finite|omega|q|force)[ .]{0,2}(cone|x|/world/a.b|\\*)?[ .]{0,2}[xyzw]?[ ]?(<|>|<=|≠|!=|=)?[ ]?-?[0-9]{0,3}(e-?[0-9]{1,4})? ?(N·m|deg)?") {
            match parse(&text) {
                Ok(condition) => {
                    for values in [&[][..], &[1.0], &[1.0, f64::NAN, -3.0], &[0.0; 9]] {
                        let _ = condition.met_by(values);
                    }
                    // What it says of itself is the same condition.
                    prop_assert_eq!(parse(&condition.to_string()), Ok(condition));
                }
                Err(why) => {
                    prop_assert!(why.column >= 1 && why.column <= text.chars().count() + 1);
                    prop_assert!(!why.why.is_empty());
                }
            }
        }

        #[test]
        fn a_size_is_the_length(v in prop::array::uniform3(-1e3_f64..1e3), bound in 0.0..2e3_f64) {
            let length = nalgebra::Vector3::from(v).norm();
            let condition = parse(&format!("torque > {bound:?}")).unwrap();
            // Both are sums of three squares, whose order may differ in rounding.
            if (length - bound).abs() > 1e-12 * length {
                prop_assert_eq!(condition.met_by(&v).is_some(), length > bound);
            }
        }
    }
}
