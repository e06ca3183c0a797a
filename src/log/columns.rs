//! From the names of a log's columns to where each quantity stands.
//!
//! What is mapped stands as it is said. The rest is recognised by [`SPELLINGS`]: a name as a whole, or without a unit
//! in it (`time_us`, `wx [deg/s]`), or without the path that goes before it (`/odom/pose/pose/position/x`). What may
//! be two things is asked for.

use super::mapping::{Mapping, Source};
use super::spellings::{Counted, Frame, Quantity, SPELLINGS, Spelling};
use super::units::{Unit, plain};
use std::collections::HashMap;
use std::fmt;

/// Where a quantity stands and how it is to be taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    pub quantity: Quantity,
    /// By number, from 0; of an attitude x, y, z, w; of a time in two columns seconds and their fraction.
    pub columns: Vec<usize>,
    /// One a column; nothing where it has none.
    pub units: Vec<Option<&'static Unit>>,
    pub frame: Frame,
    pub conjugated: bool,
    /// Whether the header or a mapping says the unit.
    pub unit_said: bool,
    /// What was assumed that no name says.
    pub assumed: Option<String>,
}

/// Where every quantity of a log stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    names: Vec<String>,
    found: Vec<Found>,
}

/// A question that only the user can answer, and what would.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    pub what: String,
    pub remedy: String,
}

/// Bytes of a name beyond which nothing is looked for in it: no spelling is longer, whatever goes before it.
const LONGEST_NAME: usize = 256;

/// Columns beyond which a table is no log of bodies.
pub const MOST_COLUMNS: usize = 4096;

impl Columns {
    /// Finds everything among the names of columns.
    pub fn find(names: &[String], mappings: &[Mapping]) -> Result<Self, Vec<Question>> {
        let mut search = Search {
            names,
            mappings,
            spoken_for: vec![false; names.len()],
            found: Vec::new(),
            questions: Vec::new(),
        };
        search.mapped();
        search.recognised();
        search.judge();
        match search.questions.is_empty() {
            true => Ok(Self {
                names: names.to_vec(),
                found: search.found,
            }),
            false => Err(search.questions),
        }
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    pub fn of(&self, quantity: Quantity) -> Option<&Found> {
        self.found.iter().find(|found| found.quantity == quantity)
    }

    pub fn found(&self) -> &[Found] {
        &self.found
    }

    /// Names of columns that nothing is read from.
    pub fn unread(&self) -> Vec<&str> {
        let read = |k: usize| self.found.iter().any(|found| found.columns.contains(&k));
        (0..self.names.len())
            .filter(|&k| !read(k))
            .map(|k| self.names[k].as_str())
            .collect()
    }

    /// Whether it is this program's own export, whose torque is of everything that acts, forces included.
    pub fn is_own_export(&self) -> bool {
        is_own_export(&self.names)
    }
}

/// `time from t (ms); attitude from qx, qy, qz, qw; …`
impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, found) in self.found.iter().enumerate() {
            let names: Vec<String> = found
                .columns
                .iter()
                .map(|&c| shown(&self.names[c]))
                .collect();
            let separator = if k > 0 { "; " } else { "" };
            write!(
                f,
                "{separator}{} from {}",
                found.quantity.name(),
                names.join(", ")
            )?;
            let mut notes = Vec::new();
            if let Some(Some(unit)) = found.units.first()
                && !unit.is_si()
            {
                notes.push(unit.name);
            }
            if found.frame == Frame::Body {
                notes.push("body axes");
            }
            if found.conjugated {
                notes.push("world to body");
            }
            if !notes.is_empty() {
                write!(f, " ({})", notes.join(", "))?;
            }
        }
        Ok(())
    }
}

fn is_own_export(names: &[String]) -> bool {
    let has = |name: &str| names.iter().any(|n| n == name);
    let begins = |name: &str| names.iter().any(|n| n.starts_with(name));
    has("recording") && has("body") && has("sim_time") && begins("angular_velocity")
}

struct Search<'a> {
    names: &'a [String],
    mappings: &'a [Mapping],
    /// Columns that a mapping names: they mean nothing else.
    spoken_for: Vec<bool>,
    found: Vec<Found>,
    questions: Vec<Question>,
}

/// A way in which a column's name can be read.
struct Reading {
    column: usize,
    unit: Option<String>,
}

/// Columns of a quantity under one spelling.
struct Candidate {
    spelling: &'static Spelling,
    columns: Vec<usize>,
    units: Vec<Option<String>>,
    counted: Counted,
    /// Names of the path that were left out.
    left_out: usize,
}

impl Candidate {
    fn key(&self) -> (usize, u8) {
        (self.left_out, self.spelling.rank)
    }
}

impl Search<'_> {
    fn ask(&mut self, what: String, remedy: String) {
        self.questions.push(Question { what, remedy });
    }

    fn mapping(&self, quantity: Quantity) -> Option<&Mapping> {
        self.mappings.iter().find(|m| m.quantity == quantity)
    }

    fn has(&self, quantity: Quantity) -> bool {
        self.found.iter().any(|found| found.quantity == quantity)
    }

    /// What the mappings name.
    fn mapped(&mut self) {
        for (k, mapping) in self.mappings.iter().enumerate() {
            if self.mappings[..k]
                .iter()
                .any(|m| m.quantity == mapping.quantity)
            {
                let what = format!("{} is mapped twice", mapping.quantity.name());
                self.ask(what, "keep one".to_owned());
                continue;
            }
            let Source::Named(names) = &mapping.columns else {
                continue;
            };
            match self.named(mapping, names) {
                Ok(found) => {
                    found
                        .columns
                        .iter()
                        .for_each(|&c| self.spoken_for[c] = true);
                    self.found.push(found);
                }
                Err(question) => self.questions.push(question),
            }
        }
    }

    fn named(&self, mapping: &Mapping, names: &[String]) -> Result<Found, Question> {
        let width = mapping.quantity.width();
        let columns = match names {
            [one] if width > 1 => self.beginning(mapping, one)?,
            _ => names
                .iter()
                .map(|name| self.column(mapping, name))
                .collect::<Result<_, _>>()?,
        };
        let mut found = Found {
            quantity: mapping.quantity,
            units: vec![mapping.unit.or(mapping.quantity.si()); columns.len()],
            columns,
            frame: mapping.frame.unwrap_or_default(),
            conjugated: mapping.conjugated,
            unit_said: mapping.unit.is_some(),
            assumed: None,
        };
        if let Some(order) = mapping.order {
            found.columns = order.map(|k| found.columns[k]).to_vec();
        }
        if mapping.unit.is_none() {
            // The header may say it.
            for (slot, &column) in found.units.iter_mut().zip(&found.columns) {
                if let Some(unit) = unit_in(&self.names[column], mapping.quantity) {
                    *slot = Some(unit);
                    found.unit_said = true;
                }
            }
        }
        if mapping.quantity == Quantity::Time && found.columns.len() == 2 {
            found.units = vec![Quantity::Time.unit("s"), Quantity::Time.unit("ns")];
        }
        Ok(found)
    }

    fn column(&self, mapping: &Mapping, name: &str) -> Result<usize, Question> {
        let number = name.strip_prefix('#').and_then(|n| n.parse::<usize>().ok());
        let same = |k: &usize| self.names[*k] == name;
        let alike = |k: &usize| plain(&self.names[*k]) == plain(name);
        let all = || 0..self.names.len();
        let found = all().find(same).or_else(|| all().find(alike));
        let numbered = number
            .and_then(|n| n.checked_sub(1))
            .filter(|&n| n < self.names.len());
        if all().filter(same).count() > 1 {
            return Err(Question {
                what: format!("{mapping}: several columns are called `{}`", shown(name)),
                remedy: "name it by its number, such as #3".to_owned(),
            });
        }
        found.or(numbered).ok_or_else(|| {
            let known: Vec<&str> = self.names.iter().map(String::as_str).collect();
            Question {
                what: format!("{mapping}: there is no column `{}`", shown(name)),
                remedy: crate::trace::nearest(name, &known),
            }
        })
    }

    /// The columns of a quantity by what their names begin with.
    fn beginning(&self, mapping: &Mapping, start: &str) -> Result<Vec<usize>, Question> {
        let (quantity, start) = (mapping.quantity, plain(start));
        let width = quantity.width();
        let sets: [Vec<String>; 3] = [
            ["x", "y", "z", "w"].map(|e| format!("{start}{e}")).to_vec(),
            ["0", "1", "2", "3"].map(|e| format!("{start}{e}")).to_vec(),
            ["1", "2", "3", "4"].map(|e| format!("{start}{e}")).to_vec(),
        ];
        for (k, set) in sets.iter().enumerate() {
            let place = |key: &String| self.names.iter().position(|name| plain(name) == *key);
            let places: Option<Vec<usize>> = set[..width].iter().map(place).collect();
            let Some(places) = places else { continue };
            if k > 0 && quantity == Quantity::Attitude && mapping.order.is_none() {
                return Err(Question {
                    what: format!("{mapping}: numbers do not say whether w comes first or last"),
                    remedy: format!("write {mapping}:wxyz or {mapping}:xyzw"),
                });
            }
            return Ok(places);
        }
        Err(Question {
            what: format!(
                "{mapping}: no {width} columns begin with `{}`",
                shown(&start)
            ),
            remedy: format!("name {width} columns, with commas between"),
        })
    }

    /// What the table of spellings knows.
    fn recognised(&mut self) {
        let readings = self.readings();
        let mut candidates: Vec<Candidate> = SPELLINGS
            .iter()
            .flat_map(|spelling| candidates(spelling, &readings))
            .collect();
        candidates.retain(|c| c.columns.iter().all(|&k| !self.spoken_for[k]));
        let said = |quantity| {
            let mapping = self.mappings.iter().find(|m| m.quantity == quantity);
            mapping.is_some_and(|m| m.columns != Source::Recognised)
        };
        // Of what may be two things the other may be meant.
        candidates.retain(|c| c.spelling.either || !said(c.spelling.quantity));
        // Of several free bodies no number says whose it is.
        if self
            .names
            .iter()
            .any(|name| matches!(plain(name).as_str(), "qpos7" | "qvel6"))
        {
            let joint = |&k: &usize| {
                let key = plain(&self.names[k]);
                key.starts_with("qpos") || key.starts_with("qvel")
            };
            candidates.retain(|c| !c.columns.iter().any(joint));
        }
        self.clocks(&mut candidates);
        for quantity in Quantity::ALL {
            self.choose(quantity, &candidates);
        }
        self.either(&candidates);
    }

    /// Every key that a column can be read as, under what goes before it.
    fn readings(&self) -> HashMap<(String, usize, String), Vec<Reading>> {
        let mut readings: HashMap<_, Vec<Reading>> = HashMap::new();
        let names = self.names.iter().enumerate();
        for (column, name) in names.filter(|(_, name)| name.len() <= LONGEST_NAME) {
            for (before, left_out, rest) in without_paths(name) {
                for (key, unit) in without_units(rest) {
                    let place = (before.to_owned(), left_out, key);
                    readings
                        .entry(place)
                        .or_default()
                        .push(Reading { column, unit });
                }
            }
        }
        readings
    }

    /// A time in two columns, whole seconds and nanoseconds, is one.
    fn clocks(&mut self, candidates: &mut Vec<Candidate>) {
        if self.has(Quantity::Time) {
            return;
        }
        let time = |c: &Candidate| c.spelling.quantity == Quantity::Time;
        let unit = |c: &Candidate| {
            let name = c.units[0].as_deref()?;
            Some(Quantity::Time.unit(name)?.name)
        };
        let pair = candidates.iter().filter(|c| time(c)).find_map(|a| {
            let other = |b: &&Candidate| {
                time(b) && std::ptr::eq(a.spelling, b.spelling) && unit(b) == Some("ns")
            };
            let b = candidates.iter().find(other)?;
            (unit(a) == Some("s")).then(|| (a.columns[0], b.columns[0]))
        });
        let Some((seconds, rest)) = pair else { return };
        candidates.retain(|c| !time(c));
        self.found.push(Found {
            quantity: Quantity::Time,
            columns: vec![seconds, rest],
            units: vec![Quantity::Time.unit("s"), Quantity::Time.unit("ns")],
            frame: Frame::World,
            conjugated: false,
            unit_said: true,
            assumed: None,
        });
    }

    /// Takes the best of a quantity's candidates, or asks.
    fn choose(&mut self, quantity: Quantity, candidates: &[Candidate]) {
        if self.has(quantity) {
            return;
        }
        let mut of: Vec<&Candidate> = candidates
            .iter()
            .filter(|c| c.spelling.quantity == quantity && !c.spelling.either)
            .collect();
        if quantity == Quantity::Position {
            // x, y, z beside w may be an attitude.
            let bare = |c: &&Candidate| matches!(c.spelling.names, super::spellings::Names::Exactly(n) if n[0] == "x");
            let quaternion = candidates
                .iter()
                .any(|c| c.spelling.quantity == Quantity::Attitude && c.spelling.either);
            if quaternion
                && !self.has(Quantity::Attitude)
                && self.mapping(Quantity::Attitude).is_none()
            {
                let attitude_elsewhere = candidates
                    .iter()
                    .any(|c| c.spelling.quantity == Quantity::Attitude && !c.spelling.either);
                if !attitude_elsewhere {
                    of.retain(|c| !bare(c));
                }
            }
        }
        let Some(best) = of.iter().map(|c| c.key()).min() else {
            return;
        };
        of.retain(|c| c.key() == best);
        let first = of[0];
        // The same columns by another reading are the same.
        of.retain(|c| c.columns != first.columns);
        if !of.is_empty() {
            let mut lists = vec![self.listed(&first.columns)];
            lists.extend(of.iter().map(|c| self.listed(&c.columns)));
            let what = format!("{} may be {}", quantity.name(), lists.join(" or "));
            let remedy = format!("say which: --map {}={}", quantity.name(), lists[0]);
            self.ask(what, remedy);
            return;
        }
        self.take(first);
    }

    fn take(&mut self, candidate: &Candidate) {
        let quantity = candidate.spelling.quantity;
        let mapping = self.mapping(quantity).cloned();
        let mapping = mapping.as_ref();
        let numbered = matches!(candidate.counted, Counted::Unknown);
        let own = is_own_export(self.names).then_some([0, 1, 2, 3]);
        let order = mapping.and_then(|m| m.order).or(own.filter(|_| numbered));
        if numbered && order.is_none() {
            let listed = self.listed(&candidate.columns);
            let what = format!(
                "{listed} may be x, y, z, w or w, x, y, z: numbers do not say where the scalar is"
            );
            let remedy = format!("say it: --map attitude={listed}:wxyz, or :xyzw");
            self.ask(what, remedy);
            return;
        }
        let said = |name: &Option<String>| name.as_deref().and_then(|n| quantity.unit(n));
        let units: Vec<Option<&'static Unit>> = candidate
            .units
            .iter()
            .map(|name| {
                let mapped = mapping.and_then(|m| m.unit);
                mapped.or_else(|| said(name)).or(quantity.si())
            })
            .collect();
        let mut columns = candidate.columns.clone();
        let mut assumed = None;
        match (candidate.counted, order) {
            (Counted::No, None) => {}
            (Counted::No, Some(_)) => {
                let what = "attitude's columns have names, x, y, z and w, which say their order"
                    .to_owned();
                let remedy =
                    "leave the order out, or name the columns too: --map attitude=A,B,C,D:wxyz"
                        .to_owned();
                self.ask(what, remedy);
                return;
            }
            // Kept in the order x, y, z, w: back to as they are counted, then by what is said.
            (Counted::ScalarFirst, Some(order)) => {
                let counted = [columns[3], columns[0], columns[1], columns[2]];
                columns = order.map(|k| counted[k]).to_vec();
            }
            (Counted::Unknown, Some(order)) => {
                columns = order.map(|k| columns[k]).to_vec();
            }
            (Counted::ScalarFirst, None) => {
                let counted = [columns[3], columns[0], columns[1], columns[2]];
                let listed = self.listed(&counted);
                assumed = Some(format!(
                    "{listed} are taken as w, x, y, z, as ULog has them; --map attitude={listed}:xyzw says otherwise"
                ));
            }
            (Counted::Unknown, None) => unreachable!("asked for above"),
        }
        let frame = match mapping.and_then(|m| m.frame) {
            Some(frame) => frame,
            None => {
                let frame = candidate.spelling.frame;
                if frame == Frame::Body {
                    let listed = self.listed(&columns);
                    assumed = Some(format!(
                        "{listed} are taken along the body's axes ({}); --map {}=:world says otherwise",
                        candidate.spelling.note,
                        quantity.name()
                    ));
                }
                frame
            }
        };
        self.found.push(Found {
            quantity,
            columns,
            units,
            frame,
            conjugated: mapping.is_some_and(|m| m.conjugated),
            unit_said: mapping.is_some_and(|m| m.unit.is_some())
                || candidate.units.iter().any(|name| said(name).is_some()),
            assumed,
        });
    }

    /// Names that may be two things: `px` (a position, or where a force acts), `tx` (a torque, or a translation),
    /// `x y z w` (an attitude, or a position beside something else).
    fn either(&mut self, candidates: &[Candidate]) {
        let of = |quantity: Quantity| {
            candidates
                .iter()
                .filter(move |c| c.spelling.quantity == quantity && c.spelling.either)
        };
        if !self.has(Quantity::Attitude) && self.wants(Quantity::Attitude) {
            let has_position =
                self.has(Quantity::Position) || of(Quantity::Position).next().is_some();
            match of(Quantity::Attitude).min_by_key(|c| c.key()) {
                Some(candidate) if has_position => self.take(candidate),
                Some(candidate) => {
                    let listed = self.listed(&candidate.columns);
                    let xyz = self.listed(&candidate.columns[..3]);
                    self.ask(
                        format!("{listed} may be an attitude, or {xyz} a position"),
                        format!("say which: --map attitude={listed}:xyzw or --map position={xyz}"),
                    );
                }
                None => {}
            }
        }
        if let Some(candidate) = of(Quantity::Position).min_by_key(|c| c.key()) {
            let listed = self.listed(&candidate.columns);
            let claimed = self.claimed(&candidate.columns);
            match (self.has(Quantity::Position), self.has(Quantity::Force)) {
                _ if claimed => {}
                (false, false) if self.wants(Quantity::Position) => self.take(candidate),
                (true, true) if !self.has(Quantity::Point) && self.wants(Quantity::Point) => {
                    self.take(&Candidate {
                        spelling: POINT_AS_P,
                        columns: candidate.columns.clone(),
                        units: candidate.units.clone(),
                        ..*candidate
                    });
                }
                (false, true) if self.wants(Quantity::Position) && !self.has(Quantity::Point) => {
                    self.ask(
                        format!("{listed} may be the position, or where the force acts"),
                        format!("say which: --map position={listed} or --map point={listed}"),
                    )
                }
                _ => {}
            }
        }
        if !self.has(Quantity::Torque)
            && self.wants(Quantity::Torque)
            && let Some(candidate) = of(Quantity::Torque).min_by_key(|c| c.key())
            && !self.claimed(&candidate.columns)
        {
            let listed = self.listed(&candidate.columns);
            let said_none = !self.wants(Quantity::Position);
            match self.has(Quantity::Position) || said_none {
                true => self.take(candidate),
                false => self.ask(
                    format!(
                        "{listed} may be a torque, or a translation: no other column is a position"
                    ),
                    format!("say which: --map torque={listed} or --map position={listed}"),
                ),
            }
        }
    }

    /// Whether no mapping says that the quantity is elsewhere or not read.
    fn wants(&self, quantity: Quantity) -> bool {
        self.mapping(quantity)
            .is_none_or(|m| m.columns == Source::Recognised)
    }

    fn claimed(&self, columns: &[usize]) -> bool {
        let found = |k: &usize| self.found.iter().any(|f| f.columns.contains(k));
        columns.iter().any(found)
    }

    /// What must be there, and what cannot be used.
    fn judge(&mut self) {
        // What is asked for may be what is missing.
        if !self.questions.is_empty() {
            return;
        }
        let mut mappings = self.mappings.iter();
        let lacking = |m: &&Mapping| m.columns == Source::Recognised && !self.has(m.quantity);
        if let Some(mapping) = mappings.find(lacking) {
            let (what, name) = (
                format!(
                    "{mapping}: no column is recognised as {}",
                    mapping.quantity.about()
                ),
                mapping.quantity.name(),
            );
            self.ask(what, format!("name them: --map {name}=…; {}", self.there()));
            return;
        }
        if !self.has(Quantity::Time) {
            let remedy = format!("name it: --map time=COLUMN; {}", self.there());
            self.ask("no column is recognised as the time".to_owned(), remedy);
        }
        if !self.has(Quantity::Attitude) && !self.has(Quantity::Omega) {
            let (what, remedy) = self.nothing_turns();
            self.ask(what, remedy);
        }
        let along_body = |f: &&Found| f.frame == Frame::Body;
        if !self.has(Quantity::Attitude)
            && let Some(found) = self.found.iter().find(along_body)
        {
            let (listed, name) = (self.listed(&found.columns), found.quantity.name());
            self.ask(
                format!("{name} ({listed}) is along the body's axes, and no column is an attitude to turn it by"),
                format!("name the attitude: --map attitude=…, or leave it out: --map {name}=none"),
            );
        }
        if self.has(Quantity::Point) && !self.has(Quantity::Force) {
            self.found.retain(|f| f.quantity != Quantity::Point);
        }
    }

    fn nothing_turns(&self) -> (String, String) {
        let keys: Vec<String> = self.names.iter().map(|name| plain(name)).collect();
        let has = |key: &str| keys.iter().any(|k| k.ends_with(key));
        let what = "no columns are recognised as an attitude or an angular velocity";
        let part = ["x", "y", "z", "w"]
            .iter()
            .filter(|c| has(&format!("q{c}")))
            .count();
        if part > 0 {
            return (
                format!("{what}: of the four of a quaternion there are {part}"),
                format!("name all: --map attitude=A,B,C,D:xyzw; {}", self.there()),
            );
        }
        if has("roll") && has("pitch") && has("yaw") {
            return (
                format!("{what}: roll, pitch and yaw are of no agreed order"),
                "turn them into a quaternion where they are logged, and log that".to_owned(),
            );
        }
        (
            what.to_owned(),
            format!(
                "name them: --map attitude=A,B,C,D:xyzw, --map omega=A,B,C; {}",
                self.there()
            ),
        )
    }

    fn there(&self) -> String {
        const MOST: usize = 24;
        let mut names: Vec<String> = self.names.iter().take(MOST).map(|n| shown(n)).collect();
        if self.names.len() > MOST {
            names.push(format!("and {} more", self.names.len() - MOST));
        }
        format!("the columns are {}", names.join(", "))
    }

    fn listed(&self, columns: &[usize]) -> String {
        let name = |&k: &usize| {
            let name = &self.names[k];
            let twice = self.names.iter().filter(|n| *n == name).count() > 1;
            match twice || name.contains([',', '"']) || name.is_empty() {
                true => format!("#{}", k + 1),
                false => shown(name),
            }
        };
        let names: Vec<String> = columns.iter().map(name).collect();
        names.join(",")
    }
}

static POINT_AS_P: &Spelling = &Spelling {
    quantity: Quantity::Point,
    names: super::spellings::Names::Exactly(&["px", "py", "pz"]),
    frame: Frame::World,
    rank: 1,
    either: true,
    note: "",
};

/// All the columns that make a spelling whole.
fn candidates(
    spelling: &'static Spelling,
    readings: &HashMap<(String, usize, String), Vec<Reading>>,
) -> Vec<Candidate> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for way in spelling.ways() {
        // Where its first column is, under whatever goes before.
        let mut starts: Vec<&(String, usize, String)> = readings
            .keys()
            .filter(|(_, _, key)| *key == way.keys[0])
            .collect();
        starts.sort();
        for (before, left_out, _) in starts {
            let of = |key: &String| readings.get(&(before.clone(), *left_out, key.clone()));
            let columns: Option<Vec<&Vec<Reading>>> = way.keys.iter().map(of).collect();
            let Some(columns) = columns else { continue };
            let fits = |r: &&Reading| {
                r.unit
                    .as_deref()
                    .is_none_or(|unit| spelling.quantity.unit(unit).is_some())
            };
            let most = columns.iter().map(|c| c.iter().filter(fits).count());
            let Some(most) = most.max() else { continue };
            for nth in 0..most {
                let pick = |all: &&Vec<Reading>| {
                    let fitting: Vec<&Reading> = all.iter().filter(fits).collect();
                    let one = fitting.get(nth.min(fitting.len().checked_sub(1)?))?;
                    Some((one.column, one.unit.clone()))
                };
                let picked: Option<Vec<_>> = columns.iter().map(pick).collect();
                let Some(picked) = picked else { continue };
                let (columns, units): (Vec<_>, Vec<_>) = picked.into_iter().unzip();
                if candidates.iter().any(|c| c.columns == columns) {
                    continue;
                }
                candidates.push(Candidate {
                    spelling,
                    columns,
                    units,
                    counted: way.counted,
                    left_out: *left_out,
                });
            }
        }
    }
    candidates
}

/// A name whole, and without the first parts of its path: what goes before, how many parts, the rest.
fn without_paths(name: &str) -> Vec<(&str, usize, &str)> {
    /// What these mark is not what the body does.
    const OTHER: [&str; 16] = [
        "accel",
        "acc",
        "desired",
        "setpoint",
        "target",
        "cmd",
        "command",
        "ref",
        "reference",
        "error",
        "prev",
        "previous",
        "next",
        "covariance",
        "momentum",
        "sp",
    ];
    let mut ways = vec![("", 0, name)];
    let mut start = 0;
    for part in 1.. {
        let Some(end) = name[start..].find(['/', '.', ':']) else {
            break;
        };
        let segment = &name[start..start + end];
        let words = segment.to_lowercase();
        if words.split('_').any(|word| OTHER.contains(&word)) {
            break;
        }
        start += end + 1;
        // A bare component says nothing once its path is gone.
        let rest = &name[start..];
        if plain(rest).len() < 2 {
            break;
        }
        if !segment.is_empty() {
            ways.push((&name[..start], part, rest));
        }
    }
    ways
}

/// A name as a key, and the keys that are left where words of it are a unit.
fn without_units(name: &str) -> Vec<(String, Option<String>)> {
    let mut ways = vec![(plain(name), None)];
    let is_part = |c: char| c.is_alphanumeric() || c == '°';
    let words: Vec<&str> = name
        .split(|c| !is_part(c))
        .filter(|w| !w.is_empty())
        .collect();
    for length in [3, 2, 1] {
        // Not the first word, which says what it is.
        for start in (1..words.len().saturating_sub(length - 1)).rev() {
            let unit = words[start..start + length].concat();
            if !Quantity::ALL.iter().any(|q| q.unit(&unit).is_some()) {
                continue;
            }
            let rest = [&words[..start], &words[start + length..]].concat();
            let key = plain(&rest.concat());
            ways.push((key, Some(unit)));
        }
    }
    // What rostopic prints.
    if name == "%time" {
        ways = vec![("time".to_owned(), Some("ns".to_owned()))];
    }
    ways
}

/// The unit that a column's name says, if it says one.
fn unit_in(name: &str, quantity: Quantity) -> Option<&'static Unit> {
    let mut ways = without_units(name).into_iter();
    ways.find_map(|(_, unit)| quantity.unit(&unit?))
}

/// Not longer than one reads, and on one line.
pub(super) fn shown(name: &str) -> String {
    let name = name.replace(char::is_control, " ");
    match name.char_indices().nth(48) {
        Some((cut, _)) => format!("{}…", &name[..cut]),
        None => name,
    }
}
