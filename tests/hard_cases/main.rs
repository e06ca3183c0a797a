//! Hard cases: a matrix, not an anecdote.
//!
//! Every case by every method of [`METHODS`], through the scene reader and the simulation as a user has them.
//! A cell says what it must come to: an error within a bound, an error that a method is known to make there,
//! a refusal, or a loss that is reported; the reason stands beside it. What is true comes from outside: 60
//! digits of mpmath for free bodies (tests/oracles/hard_free.py), closed forms for the others.
//!
//! The same cells make docs/stability.md; `UPDATE_GOLDEN=1 cargo test --test hard_cases` writes it anew.

mod cells;
mod events;
mod frames;
mod free;
mod heavy;
mod long;
mod page;
mod peers;
mod run;

use cells::{Case, Group, Must};
use run::Seen;
use std::sync::OnceLock;
use torquescope::integrator::{METHODS, MethodInfo};

/// The groups of cases, in the order of the page.
const GROUPS: &[fn() -> Group] = &[
    free::shapes,
    free::separatrix,
    free::spins,
    free::sizes,
    free::damping,
    heavy::stiff,
    heavy::tops,
    events::group,
];

/// A case and what every method came to, in the order of [`METHODS`].
pub struct Row {
    pub case: Case,
    pub seen: Vec<Seen>,
}

/// A group and its rows.
pub struct Table {
    pub title: &'static str,
    pub about: &'static str,
    pub rows: Vec<Row>,
}

pub fn infos() -> impl Iterator<Item = &'static MethodInfo> {
    METHODS.iter().map(|method| method.info())
}

/// All cells, run once, however many tests ask.
fn tables() -> &'static [Table] {
    static TABLES: OnceLock<Vec<Table>> = OnceLock::new();
    TABLES.get_or_init(|| GROUPS.iter().map(|group| table(group())).collect())
}

fn table(group: Group) -> Table {
    let row = |case: Case| Row {
        seen: infos().map(|info| run::see(&case, info)).collect(),
        case,
    };
    Table {
        title: group.title,
        about: group.about,
        rows: group.cases.into_iter().map(row).collect(),
    }
}

#[test]
fn every_cell_comes_to_what_it_must() {
    let mut wrong = Vec::new();
    for table in tables() {
        for row in &table.rows {
            for (info, seen) in infos().zip(&row.seen) {
                if let Err(why) = row.case.judge(info, seen) {
                    wrong.push(format!("{}, {}: {why}", row.case.name, info.name));
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} cells:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// No false alarm: of a cell that holds the watchdog tells nothing, but where a method of order 1 holds to its promise
/// and is off by a hundredth all the same.
#[test]
fn the_watchdog_is_silent_where_cells_hold() {
    let mut told = 0;
    for Row { case, seen } in tables().iter().flat_map(|table| &table.rows) {
        for (info, seen) in infos().zip(seen) {
            let Seen::Off { warned, .. } = seen else {
                continue;
            };
            told += usize::from(*warned > 0);
            let holds = matches!(case.must(info), Must::Hold(_));
            assert!(
                !holds || *warned == 0 || info.order == 1,
                "{}, {}: {seen:?}",
                case.name,
                info.name
            );
        }
    }
    assert!(told > 100, "{told}");
}
