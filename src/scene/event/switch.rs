//! An effect of the scene switched on or off, on all the bodies that it acts on.

use super::super::problem::Problems;
use super::super::table::nearest;
use super::read::Reading;
use super::{Action, Target};

pub(super) fn read(reading: Reading<'_, '_>, problems: &mut Problems) -> Option<(Target, Action)> {
    let effects = reading.context.effects?;
    let table = reading.node.table("switch = {…}".to_owned(), problems)?;
    let effect = table.require("effect", "the name of an effect of the scene", problems);
    let effect = effect.and_then(|node| {
        let name = node.str(problems)?;
        let found = effects.iter().position(|effect| &*effect.name == name);
        if found.is_none() {
            let names: Vec<&str> = effects.iter().map(|effect| &*effect.name).collect();
            let remedy = match names.is_empty() {
                true => "the scene has none".to_owned(),
                false => nearest(name, &names),
            };
            node.problem(format!("names no effect of the scene; {remedy}"), problems);
        }
        found
    });
    let on = table.require("on", "on = true or on = false", problems);
    let on = on.and_then(|node| node.boolean(problems));
    table.check_keys(problems);
    let action = Action::Switch {
        effect: effect?,
        on: on?,
    };
    Some((Target::All, action))
}
