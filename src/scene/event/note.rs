//! A note: a line in the event log and a mark on the timeline, at an exact time. It moves nothing, and cuts no
//! step.

use super::super::problem::Problems;
use super::read::Reading;
use super::{Action, Target};

/// Bytes of a note: a line that one reads at a glance.
const LONGEST: usize = 256;

pub(super) fn read(reading: Reading<'_, '_>, problems: &mut Problems) -> Option<(Target, Action)> {
    let text = reading.node.str(problems);
    if let Some(text) = text
        && (text.is_empty() || text.len() > LONGEST || text.contains(char::is_control))
    {
        reading.node.problem(
            format!("is no note: one line of up to {LONGEST} bytes"),
            problems,
        );
        return None;
    }
    let body = match reading.table.has("body") {
        true => Some(reading.body(problems)?),
        false => None,
    };
    Some((Target::Log(body), Action::Note(text?.into())))
}
