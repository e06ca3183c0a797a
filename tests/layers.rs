//! Imports point down: numerics never hear of scenes, scenes never of recordings.

use std::path::Path;

/// The rooms, lowest first; rooms of one level may see each other.
const LEVELS: [&[&str]; 9] = [
    &["math"],
    &["mass"],
    &["body"],
    &["effect", "exact"],
    &["integrator"],
    &["log", "scene", "trace"],
    &["diagnose", "sim"],
    &["cost"],
    &["record", "live", "session"],
];

fn level(room: &str) -> usize {
    LEVELS
        .iter()
        .position(|rooms| rooms.contains(&room))
        .unwrap_or(LEVELS.len())
}

fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        if entry.path().is_dir() {
            sources(&entry.path(), found);
        } else if entry.path().extension().is_some_and(|e| e == "rs") {
            found.push(entry.path());
        }
    }
}

#[test]
fn imports_point_down() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let mut seen = 0;
    for file in files {
        let inside = file.strip_prefix(&src).unwrap();
        let Some(room) = inside
            .parent()
            .and_then(|p| p.iter().next())
            .and_then(|r| r.to_str())
        else {
            continue;
        };
        // Tests beside the code may reach up for their fixtures.
        if inside.ends_with("tests.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        for used in text.split("crate::").skip(1) {
            let target: String = used
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect();
            seen += 1;
            assert!(
                level(&target) <= level(room),
                "{} uses crate::{target}, which lies above {room}",
                inside.display()
            );
        }
        if room == "exact" {
            for used in text.split("crate::").skip(1) {
                // An oracle shares no code with the steppers it judges.
                assert!(
                    used.starts_with("math") || used.starts_with("exact"),
                    "{}",
                    inside.display()
                );
            }
        }
        let says = |word: &str| {
            text.contains(&format!("use {word}::")) || text.contains(&format!("{word}::external"))
        };
        assert!(
            !says("rerun") || room == "record",
            "{} says rerun",
            inside.display()
        );
        assert!(
            !says("clap") || room == "cli",
            "{} says clap",
            inside.display()
        );
    }
    assert!(seen > 40, "the test reads nothing: {seen} imports");
}
