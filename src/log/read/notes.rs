//! What is worth knowing of a log beside its bad rows.

use super::super::columns::{Found as Columns, shown};
use super::super::conventions::{self, Conventions, Order};
use super::super::spellings::{Frame, Quantity};
use super::track::{Tally, Track};
use super::{Bad, CannotTell, Found, Note, Reader, Reading};
use crate::log::conventions::Verdict;

/// Bodies that are told one by one of each kind of note.
const TOLD: usize = 4;

impl<R: std::io::BufRead> Reader<R> {
    pub(super) fn notes(&self) -> Vec<Note> {
        let mut notes = self.of_columns();
        notes.extend(self.of_time());
        notes.extend(self.of_bodies());
        notes.extend(self.of_attitudes());
        notes.extend(self.of_conventions());
        notes
    }

    fn of_columns(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        for found in self.columns.found() {
            if let Some(assumed) = &found.assumed {
                notes.push(Note::new("assumed", assumed.clone()));
            }
        }
        let unread = self.columns.unread();
        if !unread.is_empty() {
            const MOST: usize = 12;
            let mut names: Vec<String> = unread.iter().take(MOST).map(|n| shown(n)).collect();
            if unread.len() > MOST {
                names.push(format!("and {} more", unread.len() - MOST));
            }
            notes.push(Note::new(
                "columns-not-read",
                format!("not read: {}", names.join(", ")),
            ));
        }
        notes
    }

    fn of_time(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        if let Some(origin) = self.origin() {
            let what = format!("times are counted from the first, {origin} s");
            notes.push(Note::new("time-origin", what));
            // s: the year 3000 since 1970.
            let clock = self.columns.of(Quantity::Time);
            if origin.abs() > 3.25e10 && clock.is_some_and(|clock| !clock.unit_said) {
                notes.push(
                    Note::new("time-unit", format!("{origin:e} s is beyond the year 3000"))
                        .remedy("say the unit: --map time=:ms, us or ns"),
                );
            }
        }
        // Where most rows go back, the clock is another column.
        let back = self.report.count(Bad::TimeBack);
        if back > self.report.rows
            && let Some(k) = self.beginning.clock()
            && let Some(name) = self.columns.names().get(k)
        {
            notes.push(
                Note::new(
                    "columns-swapped",
                    format!(
                        "{back} rows go back in time, and column {} ({}) grows",
                        k + 1,
                        shown(name)
                    ),
                )
                .remedy(format!("if that is the time: --map time=#{}", k + 1)),
            );
        }
        self.tally(
            &mut notes,
            |track| track.gaps,
            |track, tally| {
                Note::new(
                    "time-jumps",
                    format!(
                        "time jumps ({}) by {} s at most, where rows are {:.3e} s apart",
                        such(tally),
                        tally.most,
                        track.interval
                    ),
                )
            },
        );
        self.tally(
            &mut notes,
            |track| track.repeats,
            |_, tally| {
                Note::new(
                    "time-repeats",
                    format!("a row has the time of the row before ({})", such(tally)),
                )
                .remedy("of one instant the last row counts for the step that follows")
            },
        );
        notes
    }

    /// A note for each of the first bodies with something, and how many more there are.
    fn tally(
        &self,
        notes: &mut Vec<Note>,
        of: impl Fn(&Track) -> Tally,
        told: impl Fn(&Track, &Tally) -> Note,
    ) {
        let mut more = 0;
        let mut count = 0;
        for track in &self.bodies.tracks {
            let tally = of(track);
            if tally.count == 0 {
                continue;
            }
            count += 1;
            match count <= TOLD {
                true => notes.push(told(track, &tally).of(&track.name).at(tally.line)),
                false => more += 1,
            }
        }
        if more > 0
            && let Some(last) = notes.last()
        {
            let what = format!("the same of {more} bodies more");
            notes.push(Note::new(last.code, what));
        }
    }

    fn of_bodies(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let firsts = self.bodies.tracks.iter().filter_map(|track| track.first);
        let Some(start) = firsts.map(|(time, _)| time).reduce(f64::min) else {
            return notes;
        };
        let late = |track: &Track| {
            let mut tally = Tally::default();
            if let Some((time, line)) = track.first
                // Within a row of the others it is with them.
                && time - start > 1.5 * track.interval.max(f64::MIN_POSITIVE)
            {
                tally.count = 1;
                tally.line = line;
                tally.most = time - start;
            }
            tally
        };
        self.tally(&mut notes, late, |_, tally| {
            Note::new(
                "appears-late",
                format!("appears {} s after the first body", tally.most),
            )
        });
        let alone = |track: &Track| {
            let mut tally = Tally::default();
            if let Some((_, line)) = track.first.filter(|_| track.rows == 1) {
                tally.count = 1;
                tally.line = line;
            }
            tally
        };
        self.tally(&mut notes, alone, |_, _| {
            Note::new("one-row", "has one row, from which nothing moves")
        });
        notes
    }

    fn of_attitudes(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let Some(found) = self.columns.of(Quantity::Attitude) else {
            return notes;
        };
        self.tally(
            &mut notes,
            |track| track.lengths,
            |track, tally| {
                let note = Note::new(
                    "quaternion-length",
                    format!(
                        "{} of {} quaternions are not of length one, off by {:.3e} at most",
                        tally.count, track.rows, tally.most
                    ),
                );
                match self.beginning.quaternion() {
                    Some(first) if 2 * tally.count > track.rows && tally.most > 0.1 => {
                        self.swapped(note, found, first)
                    }
                    _ => note,
                }
            },
        );
        notes
    }

    /// Other columns are a quaternion.
    fn swapped(&self, note: Note, found: &Columns, first: usize) -> Note {
        let all: Vec<usize> = (first..first + 4).collect();
        let names = self.columns.names();
        if all.iter().all(|k| found.columns.contains(k)) || names.len() < first + 4 {
            return note;
        }
        let listed: Vec<String> = all.iter().map(|k| shown(&names[*k])).collect();
        let numbers: Vec<String> = all.iter().map(|k| format!("#{}", k + 1)).collect();
        Note {
            code: "columns-swapped",
            ..note
        }
        .remedy(format!(
            "columns {} to {} ({}) are of length one in every row: if they are the attitude, --map attitude={}:xyzw",
            first + 1,
            first + 4,
            listed.join(", "),
            numbers.join(",")
        ))
    }

    fn of_conventions(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let (mut fit, mut least) = (0, None);
        for (body, found) in self.conventions() {
            match found {
                Ok(found) if found.verdict() == Verdict::AsDeclared => {
                    fit += 1;
                    let clear = found.next.map_or(f64::INFINITY, |next| next.residual);
                    let worse = least.as_ref().is_none_or(|(_, before, _)| clear < *before);
                    if worse {
                        least = Some((body, clear, found));
                    }
                }
                Ok(found) => notes.push(self.other(&found).of(body)),
                Err(why @ (CannotTell::NoOmega | CannotTell::Aliased(_))) => {
                    notes.push(Note::new("conventions-unknown", why.to_string()).of(body));
                }
                Err(CannotTell::TooFew(_) | CannotTell::NoTurn) => {}
            }
        }
        if let Some((body, _, found)) = least {
            let mut what = found.to_string();
            if fit > 1 {
                what += &format!(", and so of {} bodies more", fit - 1);
            }
            if found.fitting.len() > 1 {
                let others = found.fitting[1..].iter();
                let told = others.map(|fit| fit.conventions.told(&found.declared.conventions));
                let told: Vec<String> = told.take(2).collect();
                what += &format!(
                    "; this motion would be the same if {}",
                    told.join("; or if ")
                );
            }
            notes.push(Note::new("conventions", what).of(body));
        }
        notes
    }

    /// That the numbers look like something else, and what would settle it.
    fn other(&self, found: &Found) -> Note {
        let code = match found.verdict() {
            Verdict::NoneFits => "conventions-none-fit",
            _ => "conventions-differ",
        };
        let note = Note::new(code, found.to_string());
        let Verdict::LooksLike(conventions) = found.verdict() else {
            return note;
        };
        let mut remedy = match self.options.reading {
            Reading::AsDeclared => "read as declared".to_owned(),
            Reading::AsFound | Reading::As(_) => return note,
        };
        let mappings = self.mappings(&conventions, &found.declared.conventions);
        if !mappings.is_empty() {
            remedy += &format!("; if so: {}", mappings.join(" "));
        }
        note.remedy(remedy)
    }

    /// What would declare these conventions.
    fn mappings(&self, found: &Conventions, declared: &Conventions) -> Vec<String> {
        let mut mappings = Vec::new();
        let name = |k: &usize| self.columns.names()[*k].as_str();
        if let Some(attitude) = self.columns.of(Quantity::Attitude) {
            // The columns in the order that they were read in as x, y, z, w.
            let [x, y, z, w] = [0, 1, 2, 3].map(|k| name(&attitude.columns[k]));
            let (listed, order) = match found.order {
                Order::AsRead | Order::ScalarFirst => ([x, y, z, w], "wxyz"),
                Order::ScalarLast => ([w, x, y, z], "xyzw"),
            };
            let conjugated = if found.conjugated { ":conjugated" } else { "" };
            if found.order != Order::AsRead {
                let listed = listed.join(",");
                mappings.push(format!("--map attitude={listed}:{order}{conjugated}"));
            } else if found.conjugated != declared.conjugated && found.conjugated {
                mappings.push("--map attitude=:conjugated".to_owned());
            }
        }
        let mut omega = String::new();
        if let Some(found_at) = self.columns.of(Quantity::Omega) {
            if found.omega.factor != 1.0
                && let Some(unit) = rescaled(Quantity::Omega, found_at, found.omega)
            {
                omega += &format!(":{unit}");
            }
            if found.frame != declared.frame {
                omega += match found.frame {
                    Frame::Body => ":body",
                    Frame::World => ":world",
                };
            }
        }
        if !omega.is_empty() {
            mappings.push(format!("--map omega={omega}"));
        }
        if found.time.factor != 1.0
            && let Some(clock) = self.columns.of(Quantity::Time)
            && let Some(unit) = rescaled(Quantity::Time, clock, found.time)
        {
            mappings.push(format!("--map time=:{unit}"));
        }
        mappings
    }
}

/// The unit of a quantity that is so many times the one it was read in.
fn rescaled(
    quantity: Quantity,
    found: &Columns,
    factor: &conventions::Factor,
) -> Option<&'static str> {
    let size = found.units.first().copied().flatten()?.size() * factor.factor;
    // Rounding of a product.
    let is_it = |unit: &&'static super::Unit| (unit.size() / size - 1.0).abs() < 1e-12;
    quantity.units().find(is_it).map(|unit| unit.name)
}

fn such(tally: &Tally) -> String {
    match tally.count {
        1 => "1 such row".to_owned(),
        count => format!("{count} such rows"),
    }
}
