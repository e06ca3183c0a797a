//! A scene's text with values put into it: all else, comments and layout, stays as it was written.
//!
//! The parser that reads scenes says where each value stands; a value is put there byte by byte. So
//! what is parsed is what is stored, and every byte knows where it came from: a problem in it is told
//! at the argument or the line that wrote it.

use super::amend::Entry;
use super::keys::SCENE;
use super::table::{nearest, shortened};
use crate::effect::EFFECTS;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// A text, and what was done to it.
#[derive(Clone)]
pub(super) struct Text {
    text: String,
    splices: Vec<Splice>,
}

/// `old` bytes at `at` gave way to `new` bytes.
#[derive(Clone, Copy)]
struct Splice {
    at: usize,
    old: usize,
    new: usize,
    from: From,
    /// Where among the new bytes the value is, if they are a value.
    value: usize,
}

/// Where bytes that are put in come from.
#[derive(Clone, Copy)]
pub(super) enum From {
    /// The program: they stand for the place where they are.
    Here,
    /// The argument of that number.
    Argument(usize),
    /// So many bytes at that place of the text as it was after so many splices.
    Place {
        offset: usize,
        length: usize,
        after: usize,
    },
}

/// Where a byte came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    /// An offset of the text as it first was.
    File(usize),
    Argument(usize),
}

impl Text {
    pub fn new(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            splices: Vec::new(),
        }
    }

    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// A place of the text as it is now, for values that are copied from it.
    pub fn place(&self, range: &Range<usize>) -> From {
        From::Place {
            offset: range.start,
            length: range.len(),
            after: self.splices.len(),
        }
    }

    /// Where the byte at `offset` came from.
    pub fn origin(&self, mut offset: usize) -> Origin {
        let mut k = self.splices.len();
        while k > 0 {
            k -= 1;
            let splice = self.splices[k];
            if offset < splice.at {
                continue;
            }
            if offset >= splice.at + splice.new {
                offset = offset - splice.new + splice.old;
                continue;
            }
            match splice.from {
                From::Here => offset = splice.at,
                From::Argument(argument) => return Origin::Argument(argument),
                From::Place {
                    offset: there,
                    after,
                    length,
                } => {
                    let within = (offset - splice.at).saturating_sub(splice.value);
                    (offset, k) = (there + within.min(length.saturating_sub(1)), after);
                }
            }
        }
        Origin::File(offset)
    }

    /// Where a range came from: the one thing that was put into it, if there is one, or where it
    /// begins. A table in which a value is wrong has got the value from there.
    pub fn origin_of(&self, range: Range<usize>) -> Origin {
        let put_in = self.splices.iter().enumerate().filter_map(|(k, splice)| {
            let at = self.place_now(splice.at, k + 1);
            let inside = at > range.start && at < range.end;
            (inside && !matches!(splice.from, From::Here)).then(|| self.origin(at))
        });
        let mut put_in: Vec<Origin> = put_in.collect();
        put_in.dedup();
        match (self.origin(range.start), put_in.as_slice()) {
            (Origin::File(_), [one]) => *one,
            (start, _) => start,
        }
    }

    /// Where what stood at `offset` after so many splices stands now.
    fn place_now(&self, offset: usize, after: usize) -> usize {
        let later = self.splices[after..].iter();
        later.fold(offset, |at, splice| match splice.at <= at {
            true => (at + splice.new).saturating_sub(splice.old),
            false => at,
        })
    }

    /// Gives the value at `path` another text, or adds it. The text must be TOML.
    pub fn set(&mut self, path: &str, value: &str, from: From) -> Result<(), String> {
        let document = parse(&self.text)?;
        let path = expand(document.get_ref(), &segments(path)?, value)?;
        let (range, new) = put(&self.text, document.get_ref(), &path, value)?;
        // What stands before it are keys and brackets.
        let at = new.rfind(value).unwrap_or(0);
        self.splice_value(range, &new, at, from);
        Ok(())
    }

    /// Adds a table at the end of its list.
    pub fn add(&mut self, entry: &Entry, from: From) -> Result<(), String> {
        let document = parse(&self.text)?;
        let list = entry.list();
        let end = self.text.len();
        let (at, new) = match document.get_ref().get(list) {
            None => (end, entry.written(false)),
            Some(node) => {
                let Some(items) = node.get_ref().as_array() else {
                    return Err(format!("`{list}` is no list of tables"));
                };
                let braces = entry.written(true);
                match items.iter().last() {
                    None => (node.span().start + 1, braces),
                    Some(last) if self.text[last.span()].starts_with('{') => {
                        (last.span().end, format!(", {braces}"))
                    }
                    Some(_) => (end, entry.written(false)),
                }
            }
        };
        let open = at == end && !self.text.is_empty() && !self.text.ends_with('\n');
        let new = if open { format!("\n{new}") } else { new };
        self.splice(at..at, &new, from);
        Ok(())
    }

    /// Turns the value at `path`, where there is one, into a comment.
    pub fn drop(&mut self, path: &str) -> Result<(), String> {
        let document = parse(&self.text)?;
        let segments = segments(path)?;
        let (last, parents) = segments.split_last().ok_or("an empty path")?;
        let mut table = document.get_ref();
        let mut inline = false;
        for parent in parents {
            let Some(node) = table.get(parent.as_str()) else {
                return Ok(());
            };
            let Some(inner) = node.get_ref().as_table() else {
                return Ok(());
            };
            inline |= self.text[node.span()].starts_with('{');
            table = inner;
        }
        let Some((key, node)) = table.get_key_value(last.as_str()) else {
            return Ok(());
        };
        let ranges = match inline {
            true => vec![entry(&self.text, key.span().start..node.span().end)],
            false => lines(&self.text, key.span().start, node),
        };
        self.take_out(ranges, inline);
        Ok(())
    }

    /// Turns the events that would begin after `end` into comments.
    pub fn end_at(&mut self, end: f64) -> Result<(), String> {
        let document = parse(&self.text)?;
        let events = document.get_ref().get("event");
        let Some(events) = events.and_then(|node| node.get_ref().as_array()) else {
            return Ok(());
        };
        let late = |event: &&Spanned<DeValue<'_>>| {
            let at = event.get_ref().as_table().and_then(|table| table.get("at"));
            let at = at.and_then(|at| self.text[at.span()].replace('_', "").parse().ok());
            at.is_some_and(|at: f64| at > end)
        };
        let late: Vec<_> = events.iter().filter(late).collect();
        let inline = |event: &Spanned<DeValue<'_>>| self.text[event.span()].starts_with('{');
        let (inlined, headed): (Vec<_>, Vec<_>) = late.into_iter().partition(|event| inline(event));
        let headed = headed
            .into_iter()
            .flat_map(|event| lines(&self.text, event.span().start, event))
            .collect();
        let inlined = inlined
            .into_iter()
            .map(|event| entry(&self.text, event.span()));
        let inlined = inlined.collect();
        self.take_out(inlined, true);
        // One of the two is empty: a list is written in one way.
        self.take_out(headed, false);
        Ok(())
    }

    /// Takes ranges out: cut, or each of their lines made a comment.
    fn take_out(&mut self, mut ranges: Vec<Range<usize>>, cut: bool) {
        ranges.sort_by_key(|range| range.start);
        ranges.dedup();
        for range in ranges.into_iter().rev() {
            if cut {
                self.splice(range, "", From::Here);
                continue;
            }
            let starts = self.text[range.clone()].match_indices('\n');
            let mut starts: Vec<usize> = starts.map(|(k, _)| range.start + k + 1).collect();
            starts.insert(0, range.start);
            for start in starts.into_iter().rev().filter(|&start| start < range.end) {
                self.splice(start..start, "# ", From::Here);
            }
        }
    }

    fn splice(&mut self, range: Range<usize>, new: &str, from: From) {
        self.splice_value(range, new, 0, from);
    }

    fn splice_value(&mut self, range: Range<usize>, new: &str, value: usize, from: From) {
        self.splices.push(Splice {
            at: range.start,
            old: range.len(),
            new: new.len(),
            from,
            value,
        });
        self.text.replace_range(range, new);
    }
}

pub(super) fn parse(text: &str) -> Result<Spanned<DeTable<'_>>, String> {
    DeTable::parse(text).map_err(|error| format!("not TOML: {}", error.message()))
}

/// The parts of a path: `body.cone.mass`, or with quotes `body."cone".mass`.
fn segments(path: &str) -> Result<Vec<String>, String> {
    let mut parts = vec![String::new()];
    let mut quote = None;
    for c in path.trim().chars() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (None, '"' | '\'') => quote = Some(c),
            (None, '.') => parts.push(String::new()),
            _ => parts.last_mut().into_iter().for_each(|part| part.push(c)),
        }
    }
    let parts: Vec<String> = parts.iter().map(|part| part.trim().to_owned()).collect();
    match parts.iter().any(String::is_empty) || quote.is_some() {
        true => Err(format!(
            "`{}` is no path; write one such as body.NAME.mass, stepping.step or duration",
            shortened(path)
        )),
        false => Ok(parts),
    }
}

/// Keys that stand for themselves: they are in no other table.
const SHORT: [(&str, &str); 7] = [
    ("method", "stepping"),
    ("step", "stepping"),
    ("tolerance", "stepping"),
    ("accuracy", "stepping"),
    ("rate", "record"),
    ("state", "record"),
    ("streams", "record"),
];
/// Lists of tables that have names.
const NAMED: [&str; 4] = ["body", "swarm", "effect", "event"];

/// A path from the top: `damping` is `effects.damping…`, `cone.mass` is `body.cone.mass`.
fn expand(top: &DeTable<'_>, path: &[String], value: &str) -> Result<Vec<String>, String> {
    let first = path[0].as_str();
    let within = |parents: &[&str]| {
        let parents = parents.iter().map(|&parent| parent.to_owned());
        parents.chain(path.iter().cloned()).collect()
    };
    if SCENE.has(first) {
        return Ok(path.to_vec());
    }
    if let Some((_, table)) = SHORT.iter().find(|(key, _)| *key == first) {
        return Ok(within(&[table]));
    }
    if EFFECTS.iter().any(|kind| kind.name == first) {
        let mut full: Vec<String> = within(&["effects"]);
        if path.len() == 1 && value.replace('_', "").parse::<f64>().is_ok() {
            full.extend(number_of(top, first)?);
        }
        return Ok(full);
    }
    let holds = |list: &&&str| named(top, list).is_some_and(|list| find(list, first).is_some());
    let lists: Vec<&&str> = NAMED.iter().filter(holds).collect();
    if let [list] = lists.as_slice() {
        return Ok(within(&[list]));
    }
    let mut known = SCENE.names();
    known.extend(SHORT.iter().map(|(key, _)| key));
    known.extend(EFFECTS.iter().map(|kind| kind.name));
    let all = path.join(".");
    Err(format!(
        "unknown path `{}`; {}",
        shortened(&all),
        nearest(first, &known)
    ))
}

/// A path as it is written out in full.
pub(super) fn full_path(top: &DeTable<'_>, path: &str, value: &str) -> Result<Vec<String>, String> {
    expand(top, &segments(path)?, value)
}

/// The reverse.
pub(super) fn written_path(path: &[String]) -> String {
    dotted(path)
}

/// A table of a list by its name, or by its place.
pub(super) fn table_named<'t, 'd>(
    top: &'t DeTable<'d>,
    list: &str,
    name: &str,
) -> Option<&'t DeTable<'d>> {
    find(named(top, list)?, name)?.get_ref().as_table()
}

/// The number that an effect of several is called after: the one that the scene has; damping's is
/// the angular rate.
fn number_of(top: &DeTable<'_>, effect: &str) -> Result<Option<String>, String> {
    let effects = top
        .get("effects")
        .and_then(|node| node.get_ref().as_table());
    let node = effects.and_then(|effects| effects.get(effect));
    let keys: Vec<String> = match node.map(|node| node.get_ref().as_table()) {
        Some(None) => return Ok(None),
        Some(Some(table)) => table.keys().map(|key| key.get_ref().to_string()).collect(),
        None => Vec::new(),
    };
    match keys.as_slice() {
        [] => Ok((effect == "damping").then(|| "angular".to_owned())),
        [key] => Ok(Some(key.clone())),
        several => {
            let paths: Vec<String> = several
                .iter()
                .map(|key| format!("{effect}.{key}"))
                .collect();
            Err(format!(
                "`{effect}` has several values; write which: {}",
                paths.join(" or ")
            ))
        }
    }
}

fn named<'t, 'd>(top: &'t DeTable<'d>, list: &str) -> Option<&'t DeArray<'d>> {
    top.get(list)?.get_ref().as_array()
}

/// A table by its name, or by its place in the list, counted from 0.
fn find<'t, 'd>(list: &'t DeArray<'d>, name: &str) -> Option<&'t Spanned<DeValue<'d>>> {
    let called = |item: &&Spanned<DeValue<'_>>| name_of(item) == Some(name);
    // An effect that has no name is called by its kind.
    let kind = |item: &&Spanned<DeValue<'_>>| {
        let table = item.get_ref().as_table();
        name_of(item).is_none() && table.is_some_and(|table| table.contains_key(name))
    };
    let by_place = || list.get(name.parse::<usize>().ok()?);
    let by_name = list.iter().find(called).or_else(by_place);
    by_name.or_else(|| list.iter().find(kind))
}

fn name_of<'t>(item: &'t Spanned<DeValue<'_>>) -> Option<&'t str> {
    item.get_ref().as_table()?.get("name")?.get_ref().as_str()
}

/// A table that more can be written into: a path's nearest one that the file spells out.
#[derive(Clone, Copy)]
enum Anchor {
    /// The file itself: before its first key, at this offset.
    Top(usize),
    /// `[table]` or `[[table]]`, which ends at this offset.
    Header(usize),
    /// `{ table }`, which begins at this offset; whether it is empty.
    Inline(usize, bool),
}

/// What to replace by what, so that the value at `path` is `value`.
fn put(
    text: &str,
    top: &DeTable<'_>,
    path: &[String],
    value: &str,
) -> Result<(Range<usize>, String), String> {
    let mut anchor = Anchor::Top(first_key(text, top));
    let (mut written, mut depth) = (0, 0);
    let mut table = top;
    while let Some(mut node) = table.get(path[depth].as_str()) {
        depth += 1;
        if let (Some(list), true) = (
            node.get_ref().as_array(),
            NAMED.contains(&path[depth - 1].as_str()),
        ) {
            node = item(list, path, depth)?;
            depth += 1;
        }
        let span = node.span();
        let opens = text[span.clone()].chars().next();
        let Some(inner) = node.get_ref().as_table() else {
            return match depth == path.len() {
                true => Ok((span, value.to_owned())),
                false => Err(no_table(path, depth, node)),
            };
        };
        if depth == path.len() {
            return match opens {
                Some('{') => Ok((span, value.to_owned())),
                _ => Err(whole_table(path, inner)),
            };
        }
        match opens {
            Some('{') => (anchor, written) = (Anchor::Inline(span.start, inner.is_empty()), depth),
            Some('[') => (anchor, written) = (Anchor::Header(span.end), depth),
            // Spelled out by dotted keys, or by a table within it.
            _ => {}
        }
        table = inner;
    }
    if NAMED.contains(&path[0].as_str()) && depth < 2 {
        return Err(format!("the scene has no [[{}]]", path[0]));
    }
    let rest = &path[written..];
    // Where part of it is spelled out already, dotted keys add to that.
    let entry = match depth > written {
        true => format!("{} = {value}", dotted(rest)),
        false => nested(rest, value),
    };
    Ok(insertion(text, anchor, &entry))
}

/// The table of a list that a path names.
fn item<'t, 'd>(
    list: &'t DeArray<'d>,
    path: &[String],
    depth: usize,
) -> Result<&'t Spanned<DeValue<'d>>, String> {
    let kind = &path[depth - 1];
    let Some(name) = path.get(depth) else {
        return Err(format!(
            "`{kind}` is a list; write which, and which of its keys: {kind}.NAME.KEY"
        ));
    };
    let found = find(list, name);
    found.ok_or_else(|| {
        let names: Vec<&str> = list.iter().filter_map(name_of).collect();
        let remedy = match names.is_empty() {
            true => format!(
                "they are counted from 0 to {}",
                list.len().saturating_sub(1)
            ),
            false => nearest(name, &names),
        };
        format!("no {kind} is called `{}`; {remedy}", shortened(name))
    })
}

fn no_table(path: &[String], depth: usize, node: &Spanned<DeValue<'_>>) -> String {
    format!(
        "`{}` is of type {} and has no `{}`",
        path[..depth].join("."),
        node.get_ref().type_str(),
        shortened(&path[depth])
    )
}

fn whole_table(path: &[String], table: &DeTable<'_>) -> String {
    let path = path.join(".");
    let keys: Vec<String> = table
        .keys()
        .map(|key| format!("{path}.{}", key.get_ref()))
        .collect();
    format!(
        "`{path}` is a table; write which of its keys, such as {}",
        keys.join(", ")
    )
}

/// The start of the line of a file's first key or table; its end where it has none.
fn first_key(text: &str, top: &DeTable<'_>) -> usize {
    let first = top.keys().map(|key| key.span().start).min();
    first.map_or(text.len(), |first| line_start(text, first))
}

fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |newline| newline + 1)
}

/// The end of the line of `at`, before what ends it.
fn line_end(text: &str, at: usize) -> usize {
    let end = text[at..]
        .find('\n')
        .map_or(text.len(), |newline| at + newline);
    end - usize::from(text[at..end].ends_with('\r'))
}

fn insertion(text: &str, anchor: Anchor, entry: &str) -> (Range<usize>, String) {
    match anchor {
        Anchor::Top(at) => {
            let open = !text[..at].is_empty() && !text[..at].ends_with('\n');
            let before = if open { "\n" } else { "" };
            (at..at, format!("{before}{entry}\n"))
        }
        Anchor::Header(end) => {
            let at = line_end(text, end);
            (at..at, format!("\n{entry}"))
        }
        Anchor::Inline(start, empty) => {
            let comma = if empty { " " } else { "," };
            (start + 1..start + 1, format!(" {entry}{comma}"))
        }
    }
}

/// `a = { b = { c = value } }`.
fn nested(path: &[String], value: &str) -> String {
    let Some((first, rest)) = path.split_first() else {
        return value.to_owned();
    };
    match rest.is_empty() {
        true => format!("{} = {value}", key(first)),
        false => format!("{} = {{ {} }}", key(first), nested(rest, value)),
    }
}

fn dotted(path: &[String]) -> String {
    let keys: Vec<String> = path.iter().map(|part| key(part)).collect();
    keys.join(".")
}

pub(super) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    match name.chars().all(bare) {
        true => name.to_owned(),
        false => quoted(name),
    }
}

/// A text in TOML's quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out += &format!("\\U{:08X}", u32::from(c)),
            c => out.push(c),
        }
    }
    out + "\""
}

/// Whole lines of a value that is not written inside another on its line: its own, from the line of
/// its key on, or those of all that belongs to its table.
fn lines(text: &str, start: usize, node: &Spanned<DeValue<'_>>) -> Vec<Range<usize>> {
    let span = node.span();
    let whole = |from: usize, to: usize| line_start(text, from)..line_end(text, to);
    let opens = text[span.clone()].chars().next();
    let inner = node.get_ref().as_table().filter(|_| opens != Some('{'));
    let Some(inner) = inner else {
        return vec![whole(start, span.end)];
    };
    let mut ranges = Vec::new();
    if opens == Some('[') {
        ranges.push(whole(span.start, span.end));
    }
    for (key, node) in inner.iter() {
        ranges.extend(lines(text, key.span().start, node));
    }
    ranges
}

/// An entry of an inline table or a list, with the comma that comes after it or before.
fn entry(text: &str, range: Range<usize>) -> Range<usize> {
    let after = text[range.end..].trim_start();
    if after.starts_with(',') {
        return range.start..text.len() - after.len() + 1;
    }
    let before = text[..range.start].trim_end();
    match before.strip_suffix(',') {
        Some(before) => before.len()..range.end,
        None => range,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(text: &str, path: &str, value: &str) -> Result<String, String> {
        let mut edited = Text::new(text);
        edited.set(path, value, From::Argument(0))?;
        parse(edited.as_str()).map_err(|why| format!("{why}:\n{}", edited.as_str()))?;
        Ok(edited.text)
    }

    #[test]
    fn a_value_is_put_where_it_belongs_and_nothing_else_moves() {
        let scene = "# Notes.\nduration = 2.0 # s\n\n[effects] # all\ngravity = [0, 0, 0]\ndamping = { angular = 0.1 }\n\n[[body]]\nname = \"a\"\nmass = 1 # kg\n[body.shape.cone]\nradius = 1\n\n[[body]]\nname = \"b\"\n";
        for (path, value, old, new) in [
            ("duration", "3", "duration = 2.0 #", "duration = 3 #"),
            ("body.a.mass", "2.5", "mass = 1 #", "mass = 2.5 #"),
            ("a.mass", "2.5", "mass = 1 #", "mass = 2.5 #"),
            (
                "body.1.mass",
                "4",
                "[[body]]\nname = \"b\"",
                "[[body]]\nmass = 4\nname = \"b\"",
            ),
            (
                "body.a.shape.cone.height",
                "4",
                "cone]\n",
                "cone]\nheight = 4\n",
            ),
            ("damping", "0.3", "angular = 0.1", "angular = 0.3"),
            (
                "effects.damping.linear",
                "1",
                "{ angular",
                "{ linear = 1, angular",
            ),
            ("gravity", "[1, 2, 3]", "[0, 0, 0]", "[1, 2, 3]"),
            (
                "effects.gyroscopic",
                "true",
                "# all\n",
                "# all\ngyroscopic = true\n",
            ),
            (
                "title",
                "\"x\"",
                "duration = 2.0",
                "title = \"x\"\nduration = 2.0",
            ),
            (
                "stepping.step",
                "0.01",
                "duration",
                "stepping = { step = 0.01 }\nduration",
            ),
            (
                "step",
                "0.01",
                "duration",
                "stepping = { step = 0.01 }\nduration",
            ),
        ] {
            assert_eq!(
                set(scene, path, value).unwrap(),
                scene.replacen(old, new, 1),
                "{path}"
            );
        }
    }

    #[test]
    fn tables_spelled_out_by_dots_or_by_their_children_are_added_to() {
        for (scene, path, want) in [
            (
                "effects.gravity = [0, 0, 0]\n",
                "gyroscopic",
                "effects.gyroscopic = 9\neffects.gravity = [0, 0, 0]\n",
            ),
            (
                "[effects.damping]\nlinear = 1\n",
                "gyroscopic",
                "effects.gyroscopic = 9\n[effects.damping]\nlinear = 1\n",
            ),
            (
                "[effects]\ndamping.linear = 1",
                "effects.damping.angular",
                "[effects]\ndamping.angular = 9\ndamping.linear = 1",
            ),
            (
                "effects = {}",
                "effects.damping.angular",
                "effects = { damping = { angular = 9 } }",
            ),
            (
                "# only words",
                "step",
                "# only words\nstepping = { step = 9 }\n",
            ),
            (
                "body = [{ name = \"a\" }]",
                "body.a.mass",
                "body = [{ mass = 9, name = \"a\" }]",
            ),
        ] {
            assert_eq!(set(scene, path, "9").as_deref(), Ok(want), "{scene}");
        }
    }

    #[test]
    fn what_cannot_be_set_says_what_could() {
        let scene = "[effects]\ndamping = { angular = 0.1, linear = 0.2 }\n[[body]]\nname = \"cone\"\nmass = 1\n";
        for (path, message) in [
            (
                "bdoy.cone.mass",
                "unknown path `bdoy.cone.mass`; did you mean `body`?",
            ),
            (
                "body.cnoe.mass",
                "no body is called `cnoe`; did you mean `cone`?",
            ),
            (
                "body.cone.mass.x",
                "`body.cone.mass` is of type integer and has no `x`",
            ),
            (
                "body.cone",
                "`body.cone` is a table; write which of its keys, such as body.cone.mass, body.cone.name",
            ),
            (
                "body",
                "`body` is a list; write which, and which of its keys: body.NAME.KEY",
            ),
            ("event.0.at", "the scene has no [[event]]"),
            (
                "damping",
                "`damping` has several values; write which: damping.angular or damping.linear",
            ),
            (
                "a..b",
                "`a..b` is no path; write one such as body.NAME.mass, stepping.step or duration",
            ),
        ] {
            assert_eq!(set(scene, path, "1"), Err(message.to_owned()), "{path}");
        }
    }

    #[test]
    fn what_is_dropped_stays_as_a_comment() {
        let scene = "duration = 1\n[sweep] # try\ndamping = [\n  0.1,\n]\n# a word\nmass = [1]\n[stepping]\nstep = 1";
        let mut text = Text::new(scene);
        text.drop("sweep").unwrap();
        let want = "duration = 1\n# [sweep] # try\n# damping = [\n#   0.1,\n# ]\n# a word\n# mass = [1]\n[stepping]\nstep = 1";
        assert_eq!(text.as_str(), want);
        text.drop("stepping.step").unwrap();
        assert_eq!(text.as_str(), want.replace("\nstep", "\n# step"));
        let mut text = Text::new("stepping = { method = \"a\", step = 1 }");
        text.drop("stepping.method").unwrap();
        assert_eq!(text.as_str(), "stepping = {  step = 1 }");
        text.drop("stepping.step").unwrap();
        assert_eq!(text.as_str(), "stepping = {   }");
    }

    #[test]
    fn events_after_the_end_are_comments() {
        let scene = "[[event]]\nat = 1.0\n[[event]]\nat = 2_000.5 # late\nforce = [1, 0, 0]\n[[body]]\nmass = 1\n";
        let mut text = Text::new(scene);
        text.end_at(1.0).unwrap();
        let want = scene.replace(
            "[[event]]\nat = 2_000.5 # late\nforce",
            "# [[event]]\n# at = 2_000.5 # late\n# force",
        );
        assert_eq!(text.as_str(), want);
        let mut text = Text::new("event = [{ at = 3 }, { at = 0 }, { at = 4.0 }]");
        text.end_at(1.0).unwrap();
        assert_eq!(text.as_str(), "event = [ { at = 0 }]");
    }

    #[test]
    fn every_byte_knows_where_it_came_from() {
        let first = "mass = 1\nstep = 22\nlast = 3\n";
        let mut text = Text::new(first);
        text.splice(7..8, "4444", From::Argument(5));
        // `mass = 4444`, `step = 22` three bytes later.
        let at = text.as_str().find("22").unwrap();
        let place = text.place(&(at..at + 2));
        text.splice(0..0, "x = 9\n", From::Here);
        let at = text.as_str().find("3\n").unwrap();
        text.splice(at..at + 1, "22", place);
        for (what, origin) in [
            ("4444", Origin::Argument(5)),
            ("step", Origin::File(9)),
            ("last", Origin::File(19)),
            ("mass", Origin::File(0)),
            ("x = 9", Origin::File(0)),
        ] {
            assert_eq!(
                text.origin(text.as_str().find(what).unwrap()),
                origin,
                "{what}"
            );
        }
        assert_eq!(text.origin(at), Origin::File(first.find("22").unwrap()));
        assert_eq!(text.origin(at + 2), Origin::File(first.len() - 1));
    }
}
