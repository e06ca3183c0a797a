//! A log as a whole: rows gathered by body, and what there is to say of them.

use super::super::{Log, Logged, Rows};
use super::{LogError, NoRows, Note, Options, Reader, Report, Row};
use nalgebra::Vector3;
use std::io::BufRead;

/// How far reading has come, in bytes of the log; called now and then.
pub type Progress<'a> = &'a mut dyn FnMut(u64);

/// Rows between two calls.
const BETWEEN: u64 = 8192;

impl Log {
    /// Reads all of a log. `file` is what messages call it.
    pub fn read(
        file: &str,
        input: impl BufRead,
        options: Options,
    ) -> Result<(Self, Report), LogError> {
        Self::read_telling(file, input, options, &mut |_| {})
    }

    /// The same, telling how far it is.
    pub fn read_telling(
        file: &str,
        input: impl BufRead,
        options: Options,
        progress: Progress<'_>,
    ) -> Result<(Self, Report), LogError> {
        let mut reader = Reader::new(file, input, options)?;
        let mut gathered: Vec<Rows> = Vec::new();
        let mut rows = 0;
        while let Some(row) = reader.next_row()? {
            if gathered.len() <= row.body {
                gathered.resize_with(row.body + 1, Rows::default);
            }
            gathered[row.body].push(&row);
            rows += 1;
            if rows % BETWEEN == 0 {
                progress(reader.bytes_read());
            }
        }
        progress(reader.bytes_read());
        let mut report = reader.report();
        if rows == 0 {
            return Err(LogError::NoRows(NoRows(Box::new(report))));
        }
        let own = reader.columns().is_own_export();
        let names: Vec<String> = reader.bodies().map(str::to_owned).collect();
        let mut bodies = Vec::new();
        for (name, mut rows) in names.into_iter().zip(gathered) {
            report.notes.extend(rows.finish(&name, own));
            // A body all of whose rows are left out is said, and is none.
            if !rows.is_empty() {
                bodies.push(Logged {
                    name,
                    declared: None,
                    rows,
                });
            }
        }
        Ok((Self { bodies }, report))
    }
}

/// While they come, NaN stands where a quantity is missing; one that was never there is empty.
impl Rows {
    fn push(&mut self, row: &Row) {
        // The last row of an instant is what the next step begins with; what it does not say of the state still holds.
        if row.again {
            self.times.pop();
        }
        let at = self.times.len();
        self.times.push(row.time);
        put(&mut self.attitudes, at, row.attitude, row.again);
        put(&mut self.positions, at, row.position, row.again);
        put(&mut self.omegas, at, row.omega, row.again);
        put(&mut self.velocities, at, row.velocity, row.again);
        put(&mut self.torques, at, row.torque, false);
        put(&mut self.forces, at, row.force, false);
        put(&mut self.points, at, row.point, false);
    }

    /// Makes them whole; what there is to say of it.
    fn finish(&mut self, name: &str, own: bool) -> Vec<Note> {
        let mut notes = Vec::new();
        let mut note = |code, what: String| notes.push(Note::new(code, what).of(name));
        self.whole(&mut note);
        self.loads(own, &mut note);
        notes
    }

    /// Keeps the rows that have the whole state.
    fn whole(&mut self, note: &mut impl FnMut(&'static str, String)) {
        let count = self.times.len();
        let mut keep = vec![true; count];
        let mut because = Vec::new();
        let mut require = |there: Vec<bool>, what: &'static str, keep: &mut Vec<bool>| {
            let missing = there.iter().filter(|there| !**there).count();
            if missing > 0 {
                because.push(format!("{missing} have no {what}"));
            }
            keep.iter_mut()
                .zip(there)
                .for_each(|(k, there)| *k &= there);
        };
        // What turns is what it is about.
        if !self.attitudes.is_empty() {
            require(there(&self.attitudes), "attitude", &mut keep);
        }
        if !self.omegas.is_empty() {
            require(there(&self.omegas), "angular velocity", &mut keep);
        }
        for (list, what) in [
            (&mut self.positions, "position"),
            (&mut self.velocities, "velocity"),
        ] {
            if list.is_empty() {
                continue;
            }
            let there = there(list);
            let both = there.iter().zip(&keep).filter(|(a, b)| **a && **b).count();
            let kept = keep.iter().filter(|keep| **keep).count();
            if 2 * both >= kept {
                require(there, what, &mut keep);
            } else {
                note(
                    "quantity-left-out",
                    format!("only {both} of {kept} rows have a {what}: it is left out"),
                );
                list.clear();
            }
        }
        let kept = keep.iter().filter(|keep| **keep).count();
        if kept == count {
            return;
        }
        note(
            "rows-left-out",
            format!(
                "{} of {count} rows do not have the whole state and are left out: {}",
                count - kept,
                because.join(", ")
            ),
        );
        retain(&mut self.times, &keep);
        retain(&mut self.attitudes, &keep);
        retain(&mut self.positions, &keep);
        retain(&mut self.omegas, &keep);
        retain(&mut self.velocities, &keep);
        retain(&mut self.torques, &keep);
        retain(&mut self.forces, &keep);
        retain(&mut self.points, &keep);
    }

    /// Gives every row its torque and force: none where none is written.
    fn loads(&mut self, own: bool, note: &mut impl FnMut(&'static str, String)) {
        for (list, what) in [(&mut self.torques, "torque"), (&mut self.forces, "force")] {
            let empty = list.iter().filter(|v| !is_there(v)).count();
            list.iter_mut()
                .filter(|v| !is_there(v))
                .for_each(|v| *v = [0.0; 3]);
            // Our own export has no force where none acts.
            if empty > 0 && !own {
                let all = list.len();
                note(
                    "nothing-acts",
                    format!("{empty} of {all} rows have no {what}: taken as none acting"),
                );
            }
        }
        if self.forces.is_empty() {
            self.points.clear();
            return;
        }
        let acts = |force: &[f64; 3]| force.iter().any(|x| *x != 0.0);
        self.points.resize(self.times.len(), [f64::NAN; 3]);
        let mut without = 0;
        for (k, point) in self.points.iter_mut().enumerate() {
            if is_there(&*point) {
                continue;
            }
            without += usize::from(acts(&self.forces[k]));
            *point = self.positions.get(k).copied().unwrap_or_default();
        }
        if without > 0 && self.positions.is_empty() {
            note(
                "quantity-left-out",
                format!(
                    "{without} forces have no point, and there is no position: forces are left out"
                ),
            );
            self.forces.clear();
            self.points.clear();
            return;
        }
        if without > 0 {
            note(
                "force-without-point",
                format!("{without} forces have no point: taken to act at the logged position"),
            );
        }
        if own && !self.torques.is_empty() && !self.positions.is_empty() {
            note(
                "torque-of-everything",
                "the torque of this program's own export is that of all that acts: what the force makes of it is taken out"
                    .to_owned(),
            );
            for (k, torque) in self.torques.iter_mut().enumerate() {
                let arm = Vector3::from(self.points[k]) - Vector3::from(self.positions[k]);
                let of_force = arm.cross(&Vector3::from(self.forces[k]));
                *torque = (Vector3::from(*torque) - of_force).into();
            }
        }
    }
}

/// Puts a value into a row, NaN where there is none; a row that is there already keeps it where it may.
fn put<const N: usize>(
    list: &mut Vec<[f64; N]>,
    at: usize,
    value: Option<[f64; N]>,
    still_holds: bool,
) {
    let before = list.get(at).copied().filter(|_| still_holds);
    list.truncate(at);
    match value.or(before) {
        Some(value) => {
            list.resize(at, [f64::NAN; N]);
            list.push(value);
        }
        None if list.is_empty() => {}
        None => list.push([f64::NAN; N]),
    }
}

fn is_there<const N: usize>(value: &[f64; N]) -> bool {
    !value[0].is_nan()
}

fn there<const N: usize>(list: &[[f64; N]]) -> Vec<bool> {
    list.iter().map(is_there).collect()
}

fn retain<T>(list: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    list.retain(|_| keep.next().copied().unwrap_or(true));
}
