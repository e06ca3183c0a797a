//! What is declared in `keys.rs` is what the reader asks for.

use super::Script;
use super::keys::{BODY, Keys, SCENE, Takes};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

type Asked = BTreeSet<(&'static str, &'static str)>;

thread_local! {
    static ASKED: RefCell<Asked> = RefCell::default();
}

/// The reader asks for a key.
pub(super) fn asked(keys: &Keys, key: &'static str) {
    ASKED.with_borrow_mut(|asked| asked.insert((keys.name, key)));
}

/// Every table that is reached from one.
fn tables(keys: &'static Keys, found: &mut Vec<&'static Keys>) {
    if found.iter().any(|known| known.name == keys.name) {
        return;
    }
    found.push(keys);
    for key in keys.all() {
        inside(&key.takes, found);
    }
}

fn inside(takes: &'static Takes, found: &mut Vec<&'static Keys>) {
    match takes {
        Takes::Table(keys) | Takes::Tables(keys) => tables(keys, found),
        Takes::List(takes) => inside(takes, found),
        Takes::Either(several) => several.iter().for_each(|takes| inside(takes, found)),
        _ => {}
    }
}

fn scenes(folder: &Path, paths: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            scenes(&path, paths);
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            paths.push(path);
        }
    }
}

#[test]
fn every_key_that_is_declared_is_asked_for() {
    // That none is asked for undeclared is asserted where it is asked for.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    scenes(&root.join("scenes"), &mut paths);
    scenes(&root.join("tests/fixtures"), &mut paths);
    assert!(paths.len() > 35);
    for path in &paths {
        let _ = Script::load(path).map(|script| script.judge());
    }
    let mut all = Vec::new();
    tables(&SCENE, &mut all);
    assert!(all.len() >= 20, "{}", all.len());
    let declared: Asked = all
        .iter()
        .flat_map(|keys| keys.all().map(|key| (keys.name, key.name)))
        .collect();
    let asked = ASKED.with_borrow(Clone::clone);
    let missing: Vec<_> = declared.difference(&asked).collect();
    assert!(missing.is_empty(), "declared, never asked for: {missing:?}");
}

#[test]
fn no_name_is_declared_twice() {
    let mut all = Vec::new();
    tables(&SCENE, &mut all);
    for keys in all {
        let names = keys.names();
        let distinct: BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(names.len(), distinct.len(), "{}", keys.name);
        assert!(!keys.about.is_empty() && !names.is_empty(), "{}", keys.name);
    }
    assert!(
        BODY.all()
            .any(|key| key.name == "pivot" && !key.about.is_empty())
    );
}
