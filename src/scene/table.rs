//! A TOML table read key by key: types checked, unknown keys named, every problem kept.
//!
//! Deserialising by derive would stop at the first problem; a scene reports all of them. Which keys a
//! table has stands in [`super::keys`].

use super::keys::{Key, Keys, Takes};
use super::problem::Problems;
pub(super) use crate::trace::nearest;
use nalgebra::Vector3;
use std::cell::RefCell;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

/// A table of a scene.
pub(crate) struct Table<'d> {
    entries: &'d DeTable<'d>,
    span: Range<usize>,
    /// As the messages name it, such as `[effects]`.
    name: String,
    known: Known,
}

/// Which keys a table may have.
enum Known {
    /// Those that are declared.
    Declared(&'static Keys),
    /// Those that are asked for: what a table of the program (solids, effects) says they take.
    Asked(RefCell<Vec<&'static str>>),
}

/// The value of a key.
#[derive(Clone)]
pub(crate) struct Node<'d> {
    pub key: &'static str,
    pub span: Range<usize>,
    value: &'d DeValue<'d>,
    takes: Option<&'static Takes>,
}

impl<'d> Table<'d> {
    /// A table whose keys are those that the reader asks for.
    pub fn new(entries: &'d DeTable<'d>, span: Range<usize>, name: impl Into<String>) -> Self {
        Self::with(entries, span, name.into(), Known::Asked(RefCell::default()))
    }

    /// The document.
    pub fn top(entries: &'d DeTable<'d>, keys: &'static Keys) -> Self {
        Self::with(entries, 0..0, keys.name.to_owned(), Known::Declared(keys))
    }

    fn with(entries: &'d DeTable<'d>, span: Range<usize>, name: String, known: Known) -> Self {
        Self {
            entries,
            span,
            name,
            known,
        }
    }

    pub fn span(&self) -> &Range<usize> {
        &self.span
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    /// The value of a key, which from now on is known; `None` where it is absent.
    pub fn get(&self, key: &'static str) -> Option<Node<'d>> {
        let declared = self.declared(key);
        let value: &'d Spanned<DeValue<'d>> = self.entries.get(key)?;
        Some(Node {
            key,
            span: value.span(),
            value: value.get_ref(),
            takes: declared.map(|key| &key.takes),
        })
    }

    /// What is declared of a key that is asked for.
    fn declared(&self, key: &'static str) -> Option<&'static Key> {
        match &self.known {
            Known::Declared(keys) => {
                debug_assert!(
                    keys.has(key),
                    "`{key}` of {} is not declared in scene/keys.rs",
                    keys.name
                );
                #[cfg(test)]
                super::keys_tests::asked(keys, key);
                keys.find(key)
            }
            Known::Asked(known) => {
                let mut known = known.borrow_mut();
                if !known.contains(&key) {
                    known.push(key);
                }
                None
            }
        }
    }

    /// Every entry under the name that the file gives it.
    pub fn named(&self, key: &'static str) -> impl Iterator<Item = (&'d str, Node<'d>)> {
        self.entries.iter().map(move |(name, value)| {
            let node = Node {
                key,
                span: value.span(),
                value: value.get_ref(),
                takes: None,
            };
            (name.get_ref().as_ref(), node)
        })
    }

    pub fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// The value of a key that must be there.
    pub fn require(
        &self,
        key: &'static str,
        what: &str,
        problems: &mut Problems,
    ) -> Option<Node<'d>> {
        let node = self.get(key);
        if node.is_none() {
            let message = format!("{} lacks `{key}`; add {what}", self.name);
            problems.add_as("missing-key", &self.span, message);
        }
        node
    }

    /// The table under a key.
    pub fn table(&self, key: &'static str, problems: &mut Problems) -> Option<Table<'d>> {
        self.get(key)?.table(format!("[{key}]"), problems)
    }

    /// The tables of an array of tables, such as `[[body]]`.
    pub fn tables(&self, key: &'static str, problems: &mut Problems) -> Vec<Table<'d>> {
        let Some(node) = self.get(key) else {
            return Vec::new();
        };
        let Some(items) = node.value.as_array() else {
            let message = format!("`{key}` takes a list of tables; write [[{key}]] above each");
            problems.add(&node.span, message);
            return Vec::new();
        };
        let mut tables = Vec::new();
        for item in items.iter() {
            tables.extend(node.item(item).table(format!("[[{key}]]"), problems));
        }
        tables
    }

    /// Names every key that is not known, with the nearest one that is; whether there is one. Call it
    /// last.
    pub fn check_keys(&self, problems: &mut Problems) -> bool {
        let mut unknown = false;
        let is_known = |name: &str| match &self.known {
            Known::Declared(keys) => keys.has(name),
            Known::Asked(known) => known.borrow().contains(&name),
        };
        for (key, _) in self.entries.iter() {
            let name = key.get_ref().as_ref();
            if is_known(name) {
                continue;
            }
            let known = match &self.known {
                _ if problems.is_full() => Vec::new(),
                Known::Declared(keys) => keys.names(),
                Known::Asked(known) => known.borrow().clone(),
            };
            let message = format!(
                "unknown key `{}` in {}; {}",
                shortened(name),
                self.name,
                nearest(name, &known)
            );
            problems.add_as("unknown-key", &key.span(), message);
            unknown = true;
        }
        unknown
    }
}

impl<'d> Node<'d> {
    /// `key = value` as the file has it.
    pub fn text(&self, problems: &Problems) -> String {
        format!("{} = {}", self.key, problems.text(&self.span))
    }

    /// A message about this value, which it opens: `key = value MESSAGE`.
    pub fn problem(&self, message: impl AsRef<str>, problems: &mut Problems) {
        let message = format!("{} {}", self.text(problems), message.as_ref());
        problems.add(&self.span, message);
    }

    fn wrong(&self, wanted: &str, problems: &mut Problems) {
        let wrong = with_article(self.value.type_str());
        let message = format!("{} is {wrong}, not {wanted}", self.text(problems));
        problems.add_as("wrong-type", &self.span, message);
    }

    pub fn is_text(&self) -> bool {
        self.value.is_str()
    }

    pub fn is_number(&self) -> bool {
        self.value.is_float() || self.value.is_integer()
    }

    pub fn is_table(&self) -> bool {
        self.value.is_table()
    }

    pub fn is_empty_table(&self) -> bool {
        self.value.as_table().is_some_and(|table| table.is_empty())
    }

    pub fn array_length(&self) -> Option<usize> {
        Some(self.value.as_array()?.len())
    }

    pub fn is_array_of_arrays(&self) -> bool {
        let array = self.value.as_array();
        array.is_some_and(|a| !a.is_empty() && a.iter().all(|x| x.get_ref().is_array()))
    }

    pub fn str(&self, problems: &mut Problems) -> Option<&'d str> {
        let text = self.value.as_str();
        if text.is_none() {
            self.wrong("a text in quotes", problems);
        }
        text
    }

    /// The text, if it is one; what else it is says somebody else.
    pub fn quiet_str(&self) -> Option<&'d str> {
        self.value.as_str()
    }

    pub fn boolean(&self, problems: &mut Problems) -> Option<bool> {
        let value = self.value.as_bool();
        if value.is_none() {
            self.wrong("true or false", problems);
        }
        value
    }

    /// A finite number in the unit named.
    pub fn number(&self, unit: &str, problems: &mut Problems) -> Option<f64> {
        let Some(number) = as_number(self.value) else {
            self.wrong(&format!("a number ({unit})"), problems);
            return None;
        };
        if !number.is_finite() {
            self.problem(format!("is not finite; write a number ({unit})"), problems);
            return None;
        }
        Some(number)
    }

    /// A finite number above zero.
    pub fn positive(&self, unit: &str, problems: &mut Problems) -> Option<f64> {
        let number = self.number(unit, problems)?;
        if number <= 0.0 {
            self.problem(format!("must be above zero ({unit})"), problems);
            return None;
        }
        Some(number)
    }

    /// `N` finite numbers.
    pub fn numbers<const N: usize>(&self, unit: &str, problems: &mut Problems) -> Option<[f64; N]> {
        let Some(array) = self.value.as_array().filter(|a| a.len() == N) else {
            match self.array_length() {
                Some(length) => self.problem(
                    format!("has {length} entries, not {N} numbers ({unit})"),
                    problems,
                ),
                None => self.wrong(&format!("a list of {N} numbers ({unit})"), problems),
            }
            return None;
        };
        let mut numbers = [0.0; N];
        for (slot, item) in numbers.iter_mut().zip(array.iter()) {
            *slot = self.item(item).number(unit, problems)?;
        }
        Some(numbers)
    }

    pub fn vector(&self, unit: &str, problems: &mut Problems) -> Option<Vector3<f64>> {
        self.numbers::<3>(unit, problems).map(Vector3::from)
    }

    /// A 3×3 matrix as three rows.
    pub fn matrix(&self, unit: &str, problems: &mut Problems) -> Option<nalgebra::Matrix3<f64>> {
        let Some(array) = self.value.as_array().filter(|a| a.len() == 3) else {
            self.wrong(&format!("three rows of three numbers ({unit})"), problems);
            return None;
        };
        let mut rows = Vec::with_capacity(3);
        for item in array.iter() {
            let row = self.item(item).numbers::<3>(unit, problems)?;
            rows.push(nalgebra::RowVector3::from(row));
        }
        Some(nalgebra::Matrix3::from_rows(&rows))
    }

    /// Texts in quotes, each with its place.
    pub fn texts(&self, problems: &mut Problems) -> Option<Vec<Node<'d>>> {
        let array = self.value.as_array();
        let texts = array.filter(|a| a.iter().all(|x| x.get_ref().is_str()));
        let Some(texts) = texts else {
            self.wrong("a list of texts in quotes", problems);
            return None;
        };
        Some(texts.iter().map(|item| self.item(item)).collect())
    }

    /// A whole number from `least` to `most`.
    pub fn whole(&self, least: u64, most: u64, problems: &mut Problems) -> Option<u64> {
        let number = self.number("a whole number", problems)?;
        // Up to 2⁵³ an f64 is the number that was written.
        let is_whole = number.fract() == 0.0 && self.value.is_integer();
        if !is_whole || number < least as f64 || number > most as f64 {
            self.problem(
                format!("is not a whole number from {least} to {most}"),
                problems,
            );
            return None;
        }
        Some(number as u64)
    }

    /// A list of tables, each called `name` and its number, from 1.
    pub fn tables(&self, name: &str, problems: &mut Problems) -> Option<Vec<Table<'d>>> {
        let Some(array) = self.value.as_array() else {
            self.wrong("a list of tables", problems);
            return None;
        };
        let mut tables = Vec::with_capacity(array.len());
        for (k, item) in (1..).zip(array.iter()) {
            if !item.get_ref().is_table() {
                let what = with_article(item.get_ref().type_str());
                problems.add_as(
                    "wrong-type",
                    &item.span(),
                    format!("{name} is {what}, not a table"),
                );
                return None;
            }
            tables.extend(self.item(item).table(format!("{name} ({k})"), problems));
        }
        Some(tables)
    }

    pub fn table(self, name: String, problems: &mut Problems) -> Option<Table<'d>> {
        let Some(entries) = self.value.as_table() else {
            self.wrong("a table", problems);
            return None;
        };
        Some(match self.takes.and_then(Takes::table) {
            Some(keys) => Table::with(entries, self.span, name, Known::Declared(keys)),
            None => Table::new(entries, self.span, name),
        })
    }

    /// An entry of the list that this is.
    fn item(&self, item: &'d Spanned<DeValue<'d>>) -> Node<'d> {
        Node {
            key: self.key,
            span: item.span(),
            value: item.get_ref(),
            takes: self.takes.and_then(Takes::entry),
        }
    }

    /// The only entry of a one-key table such as `{ body = […] }`, under this node's own key.
    pub fn only_entry(&self) -> Option<(&'d str, Node<'d>)> {
        let (name, _, value) = self.choice()?;
        let keys = self.takes.and_then(Takes::table);
        let declared = keys.and_then(|keys| keys.find(name));
        #[cfg(test)]
        if let (Some(keys), Some(key)) = (keys, declared) {
            super::keys_tests::asked(keys, key.name);
        }
        let node = Node {
            key: self.key,
            span: value.span(),
            value: value.get_ref(),
            takes: declared.map(|key| &key.takes),
        };
        Some((name, node))
    }

    /// The only key of a one-key table such as `{ cone = {…} }`, and what it holds.
    pub fn choice(&self) -> Option<(&'d str, Range<usize>, &'d Spanned<DeValue<'d>>)> {
        let table = self.value.as_table().filter(|t| t.len() == 1)?;
        let (key, value) = table.iter().next()?;
        Some((key.get_ref().as_ref(), key.span(), value))
    }
}

fn as_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            let whole = i128::from_str_radix(integer.as_str(), integer.radix());
            whole.map_or_else(|_| beyond(integer), |whole| Some(whole as f64))
        }
        _ => None,
    }
}

/// Of any length: what an i128 does not hold is a number all the same.
fn beyond(integer: &DeInteger<'_>) -> Option<f64> {
    let radix = integer.radix();
    if radix == 10 {
        return integer.as_str().parse().ok();
    }
    let digit = |x: f64, c: char| Some(x * f64::from(radix) + f64::from(c.to_digit(radix)?));
    integer.as_str().chars().try_fold(0.0, digit)
}

/// Not longer than one reads.
pub(super) fn shortened(name: &str) -> String {
    match name.char_indices().nth(64) {
        Some((cut, _)) => format!("{}…", &name[..cut]),
        None => name.to_owned(),
    }
}

fn with_article(noun: &str) -> String {
    let article = if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {noun}")
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn integers_of_any_length_and_base_are_the_numbers_they_are() {
        let long = format!("0x{}e5", "1".repeat(40));
        // 0x11…1 (40 ones) times 256 and 0xe5, in binary floating point: (16⁴⁰ - 1)/15 · 256 to a rounding or two.
        let value = (16.0_f64.powi(40) / 15.0) * 256.0;
        for (text, wanted) in [
            ("12", 12.0),
            ("0x1f", 31.0),
            ("0b101", 5.0),
            ("0o17", 15.0),
            ("1_000", 1000.0),
            ("0x7fff_ffff", 2_147_483_647.0),
            (
                "123456789012345678901234567890123456789012345",
                1.234_567_890_123_456_8e44,
            ),
            (long.as_str(), value),
        ] {
            let source = format!(
                "duration = 1\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [{text}, 0, 0]\n"
            );
            let scene = Scene::parse("s", "s", &source).unwrap_or_else(|why| panic!("{why}"));
            let x = scene.bodies[0].position_w.x;
            assert!(
                (x / wanted - 1.0).abs() < 1e-15,
                "{text} is {x}, not {wanted}"
            );
        }
    }
}
