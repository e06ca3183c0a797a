//! docs/stability.md, from the cells.

use crate::cells::Must;
use crate::run::Seen;
use crate::{Row, Table, infos, long, peers, tables};
use std::collections::BTreeSet;
use std::fmt::Write as _;

const HEAD: &str = "# Stability

Written from the hard cases (tests/hard_cases) by `UPDATE_GOLDEN=1 cargo test --test hard_cases`; a test holds it to what they
come to. Every case goes through the scene reader and the simulation, by every method.

- `4e-16`: the error, within the bound that the method's order, or the line under the table, promises.
- **`4e-3`**: it degrades here, to within the bounds and for the reason of the line under the table.
- *`2`*: nothing is promised: a step is so long, or a body so thin, that its order means nothing. The motion is some motion.
- !: the watchdog warns of it: energy, angular momentum or attitude is off by more than the method declares, by a hundredth or by half a
  radian. An error without a mark keeps energy and momentum, and no exact motion is known beside it.
- lost: the run stops, with the time, the step, the body, the method and the likeliest cause. refused: the scene is, with the reason.
- –: not run, for the reason below.

Promised: of order p with steps h, 5 φ (h ω)^p over φ radians, and two roundings a step and a radian; of steps by a tolerance, a
hundred of them a radian; of a free body in closed form (`closed-form`, and all that kick), 4e-15. ω is |L|/I_min for methods that keep
q and L (`buss`, `buss3`, `dlm`, `dmv…`): of a thin body that is far more than it turns. Numbers are rounded to one digit.
";

/// One digit.
pub fn coarse(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{x:.0e}");
    let value: f64 = text.parse().unwrap_or(x);
    if (1e-2..10.0).contains(&value) {
        format!("{value}")
    } else {
        text
    }
}

fn entry(must: Must, seen: &Seen) -> String {
    match (seen, must) {
        (Seen::Off { off, warned }, must) => {
            let told = if *warned > 0 { "!" } else { "" };
            match must {
                Must::Degrade(..) => format!("**{}**{told}", coarse(*off)),
                Must::RunOrBeLost => format!("*{}*{told}", coarse(*off)),
                _ => coarse(*off) + told,
            }
        }
        (Seen::Refused(_), _) => "refused".to_owned(),
        (Seen::Lost { .. }, _) => "lost".to_owned(),
        (Seen::NotRun, _) => "–".to_owned(),
    }
}

fn matrix(table: &Table) -> String {
    let mut text = format!("\n## {}\n\n{}\n\n| method |", table.title, table.about);
    for row in &table.rows {
        let _ = write!(text, " {} |", row.case.name);
    }
    text += "\n| --- |";
    text += &" --: |".repeat(table.rows.len());
    for (k, info) in infos().enumerate() {
        let _ = write!(text, "\n| {} |", info.name);
        for Row { case, seen } in &table.rows {
            let _ = write!(text, " {} |", entry(case.must(info), &seen[k]));
        }
    }
    text + "\n\n" + &reasons(table)
}

/// What is hard, and the cells that stand out.
fn reasons(table: &Table) -> String {
    let mut text = String::new();
    for Row { case, .. } in &table.rows {
        let _ = writeln!(text, "- **{}**: {}.", case.name, case.hard);
        for cell in &case.cells {
            let who = match cell.who {
                [] => "the others".to_owned(),
                names => names.join(", "),
            };
            let must = match cell.must {
                Must::Hold(bound) => format!("at most {}", coarse(bound)),
                Must::Degrade(least, most) => format!("{} to {}", coarse(least), coarse(most)),
                Must::BeRefused(_) => "refused".to_owned(),
                Must::BeLost(_) => "lost".to_owned(),
                Must::RunOrBeLost => "nothing promised".to_owned(),
                Must::NotRun => "not run".to_owned(),
            };
            let _ = writeln!(text, "  {who}: {must}; {}.", cell.why);
        }
    }
    text
}

/// Every message there was, once, without what differs from cell to cell.
fn messages() -> String {
    let (mut refused, mut lost) = (BTreeSet::new(), BTreeSet::new());
    for Row { seen, .. } in tables().iter().flat_map(|table| &table.rows) {
        for (info, seen) in infos().zip(seen) {
            match seen {
                Seen::Refused(said) => {
                    let why = said
                        .lines()
                        .next()
                        .and_then(|line| line.split("hard: ").nth(1))
                        .unwrap_or(said);
                    refused.insert(why.replace(info.name, "METHOD"));
                }
                Seen::Lost { said, .. } => {
                    let why = said
                        .split(&format!("by {}: ", info.name))
                        .nth(1)
                        .unwrap_or(said);
                    let turned = why
                        .split(" rad a step")
                        .next()
                        .and_then(|start| start.split("turned ").nth(1));
                    let decays = why
                        .split(" a step is too")
                        .next()
                        .and_then(|start| start.split("c h = ").nth(1));
                    let varies = turned.or(decays).unwrap_or("…");
                    lost.insert(why.replace(varies, "…"));
                }
                _ => {}
            }
        }
    }
    let mut text = "\n## What is said\n\nOf a loss, after *BODY is no longer finite at t = … s, step …, by METHOD*:\n\n".to_owned();
    lost.iter().for_each(|why| text += &format!("- {why}\n"));
    text += "\nOf a refusal, after the place in the scene and the body:\n\n";
    refused.iter().for_each(|why| text += &format!("- {why}\n"));
    text
}

#[test]
fn the_page_is_what_the_cells_came_to() {
    let mut page = HEAD.to_owned();
    tables().iter().for_each(|table| page += &matrix(table));
    page += &long::section();
    page += &messages();
    page += &peers::section();
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/stability.md");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = there.lines().zip(page.lines()).find(|(a, b)| a != b);
    assert!(
        there == page,
        "docs/stability.md is not what the cells came to: {differs:?}"
    );
}
