//! A zoo of faulty engines, of right ones that look odd, and of recordings that cannot tell.

mod engine;
mod recordings;
mod turn;

use recordings::{Recording, Want, zoo};
use std::collections::BTreeMap;
use torquescope::diagnose::{Answer, Verdict, diagnose};

fn is_right(recording: &Recording, verdict: &Verdict) -> bool {
    match &recording.want {
        Want::Fault(cause) => {
            verdict.answer == Answer::Fault
                && (verdict.cause == *cause || verdict.one_of.contains(cause))
        }
        Want::Fine => verdict.answer == Answer::NoFault,
        Want::CannotTell => verdict.answer == Answer::CannotTell,
    }
}

/// `ZOO=name` prints what is said of recordings whose name has that.
#[test]
fn tuned() {
    let wanted = std::env::var("ZOO").unwrap_or_default();
    let (mut right, mut all) = (0, 0);
    let mut wrong: BTreeMap<String, usize> = BTreeMap::new();
    for recording in zoo(std::env::var("SEED").map_or(1, |s| s.parse().unwrap()), 8) {
        if !recording.name.contains(&wanted) {
            continue;
        }
        let verdict = diagnose(&recording.logged);
        let good = is_right(&recording, &verdict);
        all += 1;
        right += usize::from(good);
        if !good || !wanted.is_empty() {
            println!(
                "{}{}{}: {} {:?} | {} | ev {:?} | ru {:?} | out {}",
                if good { "" } else { "WRONG " },
                recording.name,
                if recording.noisy { " ~" } else { "" },
                verdict.cause,
                verdict.one_of,
                verdict.why,
                verdict
                    .evidence
                    .iter()
                    .map(|e| format!("{}={:.3e}", e.name, e.value))
                    .collect::<Vec<_>>(),
                verdict
                    .runner_up
                    .as_ref()
                    .map(|r| format!("{} {:.2}", r.cause, r.behind)),
                verdict.left_out.len(),
            );
            *wrong
                .entry(format!(
                    "{} -> {}",
                    recording.name.rsplit_once(' ').unwrap().0,
                    verdict.cause
                ))
                .or_default() += 1;
        }
    }
    println!("{right} of {all}");
}
