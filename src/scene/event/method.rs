//! Another method from an instant on, for every body that has none of its own.

use super::super::body::OwnMethod;
use super::super::problem::Problems;
use super::super::read;
use super::read::Reading;
use super::{Action, Target};

pub(super) fn read(reading: Reading<'_, '_>, problems: &mut Problems) -> Option<(Target, Action)> {
    if reading.context.by_accuracy {
        let why =
            "beside [stepping] accuracy: with an accuracy the program chooses; keep one of the two";
        reading.node.problem(why, problems);
        return None;
    }
    let method = read::method(&reading.node, problems);
    let tolerance = match reading.table.get("tolerance") {
        None => Some(read::DEFAULT_TOLERANCE),
        Some(node) => read::tolerance(&node, method, problems),
    };
    let (method, tolerance) = (method?, tolerance?);
    let action = Action::Method(OwnMethod { method, tolerance });
    Some((Target::All, action))
}
