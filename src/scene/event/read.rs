//! An `[[event]]` as the file has it: when, how often, and the one thing that it does.

use super::super::body::{self, Bodies};
use super::super::problem::Problems;
use super::super::table::{Node, Table, nearest};
use super::{Action, Event, Target, click, method, note, push, set, switch};
use crate::effect::{PROFILES, Profile};
use crate::scene::SceneEffect;
use std::collections::HashSet;
use std::sync::Arc;

/// The scene's times, as far as they are right: s.
#[derive(Clone, Copy)]
pub struct Clock {
    pub duration: Option<f64>,
    pub step: Option<f64>,
}

/// What events refer to.
pub struct Context<'a> {
    pub bodies: &'a Bodies,
    /// `None` where one of them is wrong: that has been told.
    pub effects: Option<&'a [SceneEffect]>,
    pub clock: Clock,
    /// Whether the scene states an accuracy, so that it names no methods.
    pub by_accuracy: bool,
}

/// One event being read, all but its times.
pub(super) struct Reading<'a, 'd> {
    pub table: &'a Table<'d>,
    /// The key of what it does.
    pub node: Node<'d>,
    pub context: &'a Context<'a>,
    /// How long it lasts, s, and how; `None` for an instant.
    pub lasts: Option<(f64, Profile)>,
}

/// What an event can do.
struct Kind {
    key: &'static str,
    /// The keys that it has besides those of every event.
    keys: &'static [&'static str],
    read: fn(Reading<'_, '_>, &mut Problems) -> Option<(Target, Action)>,
}

const KINDS: [Kind; 9] = [
    Kind {
        key: "force",
        keys: &["body", "frame", "point", "for", "profile"],
        read: push::force,
    },
    Kind {
        key: "impulse",
        keys: &["body", "frame", "point"],
        read: push::impulse,
    },
    Kind {
        key: "torque",
        keys: &["body", "frame", "for", "profile"],
        read: push::torque,
    },
    Kind {
        key: "angular_impulse",
        keys: &["body", "frame"],
        read: push::angular_impulse,
    },
    Kind {
        key: "click",
        keys: &["for", "profile"],
        read: click::read,
    },
    Kind {
        key: "set",
        keys: &["body"],
        read: set::read,
    },
    Kind {
        key: "switch",
        keys: &[],
        read: switch::read,
    },
    Kind {
        key: "method",
        keys: &["tolerance"],
        read: method::read,
    },
    Kind {
        key: "note",
        keys: &["body"],
        read: note::read,
    },
];

/// Keys that belong to some kinds of event.
const OF_SOME: [&str; 6] = ["for", "profile", "body", "frame", "point", "tolerance"];

/// Events of a scene at most, repeats counted: each is a stop of the clock and a line of the log.
const MOST: usize = 100_000;

/// What the clock tells apart, s.
const FINEST: f64 = 1e-9;

pub fn read_all(
    tables: &[Table<'_>],
    context: &Context<'_>,
    problems: &mut Problems,
) -> Vec<Event> {
    let mut events = Vec::new();
    let mut names = HashSet::new();
    let mut room = MOST;
    for (entry, table) in tables.iter().enumerate() {
        let name = name(table, &mut names, problems);
        let times = times(table, context.clock, &mut room, problems);
        let unforeseen = table.get("unforeseen");
        let unforeseen = unforeseen.map(|node| node.boolean(problems));
        let done = read(table, times.as_deref(), context, problems);
        table.check_keys(problems);
        let (Some(times), Some((target, action))) = (times, done) else {
            continue;
        };
        let event = |at| Event {
            name: name.clone(),
            entry,
            at,
            unforeseen: unforeseen.flatten().unwrap_or(false),
            target: target.clone(),
            action: action.clone(),
        };
        events.extend(times.into_iter().map(event));
    }
    events
}

fn name<'d>(
    table: &Table<'d>,
    names: &mut HashSet<&'d str>,
    problems: &mut Problems,
) -> Option<Arc<str>> {
    let node = table.get("name")?;
    let name = node.str(problems)?;
    if !body::is_name(name) {
        let most = body::LONGEST_NAME;
        node.problem(
            format!("is no name: it may hold up to {most} letters, digits, - and _"),
            problems,
        );
    } else if !names.insert(name) {
        node.problem(
            "is the name of an earlier event too; give each its own",
            problems,
        );
    }
    Some(name.into())
}

/// All but its times; `None` where something is wrong.
fn read(
    table: &Table<'_>,
    times: Option<&[f64]>,
    context: &Context<'_>,
    problems: &mut Problems,
) -> Option<(Target, Action)> {
    // Of the last, where the clock is coarsest.
    let at = times.and_then(|times| times.last().copied());
    let lasts = table
        .get("for")
        .map(|node| lasts(&node, at, context.clock, problems));
    let profile = table.get("profile").map(|node| {
        let profile = profile(&node, problems);
        if lasts.is_none() {
            node.problem(
                "says how a time is gone through; add `for`, or leave it out",
                problems,
            );
        }
        profile
    });
    let Some((kind, node)) = only_kind(table, problems) else {
        if let Some(node) = table.get("body") {
            context.bodies.find(&node, problems);
        }
        return None;
    };
    let fits = says_nothing_of_others(table, (kind, &node), problems);
    let (lasts, profile) = (transposed(lasts)?, transposed(profile)?);
    let reading = Reading {
        table,
        node,
        context,
        lasts: lasts.map(|lasts| (lasts, profile.unwrap_or_default())),
    };
    let done = (kind.read)(reading, problems);
    done.filter(|_| fits)
}

/// What is absent, or right; `None` where it is wrong.
fn transposed<T>(given: Option<Option<T>>) -> Option<Option<T>> {
    match given {
        None => Some(None),
        Some(value) => value.map(Some),
    }
}

/// The one thing an event does.
fn only_kind<'d>(table: &Table<'d>, problems: &mut Problems) -> Option<(&'static Kind, Node<'d>)> {
    // Known to every event, so that a slip of the hand is told apart from what does not belong.
    for key in OF_SOME {
        table.get(key);
    }
    let mut given: Vec<(&'static Kind, Node<'d>)> = KINDS
        .iter()
        .filter_map(|kind| Some((kind, table.get(kind.key)?)))
        .collect();
    if given.len() == 1 {
        return given.pop();
    }
    let keys = KINDS.map(|kind| kind.key).join(", ");
    let message = match given.is_empty() {
        true => format!("{} does nothing; add one of {keys}", table.name()),
        false => format!(
            "{} does several things; give each an event of its own ({keys})",
            table.name()
        ),
    };
    problems.add(table.span(), message);
    None
}

/// Reports the keys that mean nothing to a kind of event.
fn says_nothing_of_others(
    table: &Table<'_>,
    (kind, action): (&Kind, &Node<'_>),
    problems: &mut Problems,
) -> bool {
    let mut fits = true;
    let others = OF_SOME.iter().filter(|key| !kind.keys.contains(key));
    for node in others.filter_map(|key| table.get(key)) {
        fits = false;
        let message = match (node.key, kind.key) {
            ("for", "impulse" | "angular_impulse") => {
                let lasting = match kind.key {
                    "impulse" => "force",
                    _ => "torque",
                };
                let message = format!(
                    "happens in an instant, so `for` has no meaning; for a push that lasts write {lasting}"
                );
                action.problem(message, problems);
                continue;
            }
            // Said of `for`.
            ("profile", _) if table.has("for") => continue,
            ("body", "click") => {
                "says nothing of a click, which finds its body by the ray; leave it out".to_owned()
            }
            _ => format!("says nothing of {}; leave it out", article(kind.key)),
        };
        node.problem(message, problems);
    }
    fits
}

fn article(key: &str) -> String {
    match key {
        "angular_impulse" | "impulse" => format!("an {key}"),
        _ => format!("a {key}"),
    }
}

impl Reading<'_, '_> {
    /// The body that it names; a body that is itself wrong has been reported.
    pub fn body(&self, problems: &mut Problems) -> Option<usize> {
        let what = "the name of the body it acts on";
        let node = self.table.require("body", what, problems)?;
        self.context.bodies.find(&node, problems)
    }
}

/// When it happens: once, or at `at + k every` as long as that is not after `until` or the end.
fn times(
    table: &Table<'_>,
    clock: Clock,
    room: &mut usize,
    problems: &mut Problems,
) -> Option<Vec<f64>> {
    let at = time(table, clock.duration, problems);
    let every = table.get("every");
    let until = table.get("until");
    let Some(every) = every else {
        if let Some(node) = until {
            node.problem("ends what repeats; add `every`, or leave it out", problems);
        }
        if *room == 0 {
            let message = format!("{} is more than the {MOST} a scene holds", table.name());
            problems.add(table.span(), message);
            return None;
        }
        *room -= 1;
        return Some(vec![at?]);
    };
    let period = every.positive("s", problems);
    if period.is_some_and(|period| period < FINEST) {
        every.problem(
            "is below a nanosecond, the finest time a recording tells apart",
            problems,
        );
        return None;
    }
    let until = match until {
        None => f64::INFINITY,
        Some(node) => {
            let until = node.number("s", problems)?;
            if at.is_some_and(|at| until < at) {
                node.problem("is before it happens for the first time", problems);
                return None;
            }
            until
        }
    };
    let (at, period) = (at?, period?);
    // Without an end it is not known how many there are: the scene is wrong already.
    let last = until.min(clock.duration?);
    // What is meant to fall on the last instant does, whatever way 0.1 is rounded.
    let slack = 4.0 * f64::EPSILON * (1.0 + last / period);
    let count = ((last - at) / period + slack).floor();
    if count >= *room as f64 {
        every.problem(
            format!(
                "makes {} events; a scene holds at most {MOST}: repeat it less often, or end it by `until`",
                count + 1.0
            ),
            problems,
        );
        return None;
    }
    let times = (0..=count as usize).map(|k| (at + k as f64 * period).min(last));
    let times: Vec<f64> = times.collect();
    *room -= times.len();
    Some(times)
}

fn time(table: &Table<'_>, duration: Option<f64>, problems: &mut Problems) -> Option<f64> {
    let node = table.require("at", "the time it happens, in seconds", problems)?;
    let at = node.number("s", problems)?;
    if at < 0.0 {
        node.problem("is before the scene begins, at 0 s", problems);
        return None;
    }
    if let Some(end) = duration
        && at > end
    {
        node.problem(format!("is after the scene ends, at {end} s"), problems);
        return None;
    }
    Some(at)
}

/// How long it lasts; what the clock cannot tell from an instant is refused, lest it vanish.
fn lasts(node: &Node<'_>, at: Option<f64>, clock: Clock, problems: &mut Problems) -> Option<f64> {
    let lasts = node.positive("s", problems)?;
    let step = clock.step.unwrap_or(0.0);
    let finest = (1e-8 * step)
        .max(8.0 * f64::EPSILON * at.unwrap_or(0.0))
        .max(FINEST);
    if lasts < finest {
        node.problem(
            format!("is shorter than the clock tells apart here ({finest:e} s); write an impulse instead"),
            problems,
        );
        return None;
    }
    Some(lasts)
}

fn profile(node: &Node<'_>, problems: &mut Problems) -> Option<Profile> {
    let text = node.str(problems)?;
    let known = PROFILES.iter().find(|(name, _)| *name == text);
    if known.is_none() {
        let names = PROFILES.map(|(name, _)| name);
        node.problem(
            format!("is no profile; {}", nearest(text, &names)),
            problems,
        );
    }
    known.map(|&(_, profile)| profile)
}
