//! `inertial = { urdf = "<inertial>…</inertial>" }`, pasted from a robot's description as it is, or
//! `{ urdf = "arm.urdf", link = "hand" }`, `{ mjcf = "arm.xml", body = "hand" }`: of a file.

use super::files::{self, Files};
use super::problem::Problems;
use super::table::{Node, Table, nearest};
use crate::mass::MassProperties;
use crate::mass::links::{self, Inertial, Language, Lump};
use std::sync::Arc;

/// Mass properties and the solid that has them, of a body that an inertial describes.
pub(super) fn read(
    node: Node<'_>,
    body: &Table<'_>,
    immovable: Option<[bool; 3]>,
    files: &Files<'_>,
    problems: &mut Problems,
) -> Option<(MassProperties, Arc<Lump>)> {
    files::nothing_beside_inertial(body, problems);
    let span = node.span.clone();
    let text = node.text(problems);
    let table = node.table("inertial = {…}".to_owned(), problems)?;
    let inertial = described(&table, files, problems);
    table.check_keys(problems);
    let inertial = inertial?;
    let properties = inertial.properties().and_then(|_| {
        let tensor = inertial.tensor_in_link();
        MassProperties::new(inertial.mass, tensor, immovable.unwrap_or_default())
            .map_err(|why| why.to_string())
    });
    match properties {
        Ok(properties) => {
            immovable?;
            Some((properties, Arc::new(Lump::new(&inertial))))
        }
        Err(why) => {
            problems.add(
                &span,
                format!("{text} cannot belong to a rigid body: {why}"),
            );
            None
        }
    }
}

fn described(table: &Table<'_>, files: &Files<'_>, problems: &mut Problems) -> Option<Inertial> {
    let (urdf, mjcf) = (table.get("urdf"), table.get("mjcf"));
    let (node, language) = match (urdf, mjcf) {
        (Some(node), None) => (node, Language::Urdf),
        (None, Some(node)) => (node, Language::Mjcf),
        _ => {
            let message = "inertial takes one of urdf and mjcf: urdf = '<inertial>…</inertial>', or a file and the link of it: urdf = \"arm.urdf\", link = \"hand\" (mjcf: body = \"hand\")";
            problems.add(table.span(), message);
            return None;
        }
    };
    let part = table.get(language.part());
    if node.str(problems)?.trim_start().starts_with('<') {
        if let Some(part) = part {
            part.problem(
                "says nothing beside a pasted <inertial>; leave it out",
                problems,
            );
        }
        let pasted = links::pasted(language, node.str(problems)?);
        return pasted.map_err(|why| node.problem(why, problems)).ok();
    }
    let Some(part) = part else {
        let message = format!(
            "is a file; say which {0} of it: {0} = \"…\"",
            language.part()
        );
        node.problem(message, problems);
        return None;
    };
    let wanted = part.str(problems)?;
    let robot = files.robot(&node, problems)?;
    if robot.language != language {
        let message = format!("is {}; write it under that key", robot.language.name());
        node.problem(message, problems);
        return None;
    }
    let Some(link) = robot.links.iter().find(|link| link.name == wanted) else {
        let names: Vec<&str> = robot.links.iter().map(|link| link.name.as_str()).collect();
        let remedy = nearest(wanted, &names);
        part.problem(format!("is not in that file; {remedy}"), problems);
        return None;
    };
    match &link.inertial {
        Some(Ok(inertial)) => Some(*inertial),
        Some(Err(why)) => {
            part.problem(format!("cannot be used: {why}"), problems);
            None
        }
        None => {
            part.problem("has no <inertial> in that file", problems);
            None
        }
    }
}
