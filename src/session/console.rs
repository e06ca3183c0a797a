//! A session by lines of text, at the pace of a clock.

use super::numbers::vector;
use super::pace::{Clock, Pace, Pacing};
use super::protocol::{self, Along, Click, Command, FORMS, Form, Strength};
use super::{Broke, Push, Pushed, Session, SessionError, Stop, What, place_of, refused};
use crate::sim::Limit;
use crate::trace::{Condition, Sink, SinkError, Vocabulary};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Where scenes are saved.
pub trait Saver {
    /// What it was written to; or why not.
    fn save(&mut self, name: &str, text: &str) -> Result<String, String>;
}

/// Into one folder, by plain names; what another wrote is not overwritten.
pub struct IntoFolder {
    folder: PathBuf,
    own: BTreeSet<String>,
}

impl IntoFolder {
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            own: BTreeSet::new(),
        }
    }
}

impl Saver for IntoFolder {
    fn save(&mut self, name: &str, text: &str) -> Result<String, String> {
        let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
        let stem = name.strip_suffix(".toml").unwrap_or_default();
        if stem.is_empty() || stem.starts_with('.') || !name.chars().all(plain) {
            return Err(format!(
                "`{name}` is no name for a scene: letters, digits, -, _ and ., and .toml at the end"
            ));
        }
        let path = self.folder.join(name);
        let shown = path.display().to_string();
        let written = match self.own.contains(name) {
            true => std::fs::write(&path, text),
            false => std::fs::File::create_new(&path)
                .and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes())),
        };
        match written {
            Ok(()) => {
                self.own.insert(name.to_owned());
                Ok(shown)
            }
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
                Err(format!("{shown} is there already; choose another name"))
            }
            Err(error) => Err(format!("{shown} cannot be written: {error}")),
        }
    }
}

/// What a turn of the clock brought.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// Lines of JSON: that it stopped, and why; that it began again.
    pub lines: Vec<String>,
    /// None where it stands.
    pub pacing: Option<Pacing>,
}

/// A session, its pace, and what reads and answers lines.
pub struct Console {
    session: Session,
    pace: Pace,
    looping: bool,
    quit: bool,
    /// Steps at a time between two looks at the clock.
    chunk: u64,
    saver: Box<dyn Saver>,
}

/// s of the wall that one turn steps for at most: commands are answered in between.
const TURN: f64 = 0.02;
/// Steps between two looks at the clock at most.
const LONGEST_CHUNK: u64 = 4096;
/// Steps of one command at most: as many as some minutes take.
const MOST_STEPS: u64 = 1_000_000_000;

type Answer = Result<Map<String, Value>, SessionError>;

impl Console {
    /// Standing at the scene's start.
    pub fn new(session: Session, saver: impl Saver + 'static) -> Self {
        Self {
            session,
            pace: Pace::default(),
            looping: false,
            quit: false,
            chunk: 1,
            saver: Box::new(saver),
        }
    }

    pub fn session(&self) -> &Session {
        &self.session
    }

    pub fn is_playing(&self) -> bool {
        self.pace.is_going()
    }

    /// Whether it was told to end.
    pub fn has_quit(&self) -> bool {
        self.quit
    }

    /// Does what a line says; one line of JSON answers it: `ok`, and what the command brings, or `error`, and its
    /// `column` where it is about the line. An empty line and one that begins with # do nothing.
    pub fn obey(
        &mut self,
        line: &str,
        clock: &dyn Clock,
        sink: &mut dyn Sink,
    ) -> Result<String, SinkError> {
        let words = line.trim();
        if words.is_empty() || words.starts_with('#') {
            return Ok(self.answer(Map::new()));
        }
        let command = match protocol::parse(line) {
            Ok(command) => command,
            Err(wrong) => return Ok(error(&wrong.why, Some(wrong.column))),
        };
        if let Command::Break(condition, column) = &command {
            return Ok(self.break_when(condition, *column));
        }
        match self.run(command, words, clock, sink) {
            Ok(more) => Ok(self.answer(more)),
            Err(SessionError::Refused(why)) => Ok(error(&why, None)),
            Err(SessionError::Sink(why)) => Err(why),
        }
    }

    fn answer(&self, more: Map<String, Value>) -> String {
        let now = self.session.now();
        let mut answer = Map::new();
        answer.insert("ok".to_owned(), json!(true));
        answer.insert("time".to_owned(), json!(now.time));
        answer.insert("step".to_owned(), json!(now.step));
        answer.insert("branch".to_owned(), json!(self.session.branch().name));
        answer.insert("playing".to_owned(), json!(self.is_playing()));
        if let Some(why) = self.session.failure() {
            answer.insert("lost".to_owned(), json!(why));
        }
        answer.extend(more);
        Value::Object(answer).to_string()
    }

    fn run(
        &mut self,
        command: Command,
        words: &str,
        clock: &dyn Clock,
        sink: &mut dyn Sink,
    ) -> Answer {
        let session = &mut self.session;
        let mut more = Map::new();
        match command {
            Command::Play => {
                if let Some(why) = session.failure() {
                    return refused(format!("{why}; go back before that"));
                }
                if session.is_over() && !self.looping {
                    return refused("the scene is over; `reset`, `back` or `loop on` first");
                }
                self.pace.set_out(clock.seconds(), session.now().time);
            }
            Command::Pause => self.pace.stand(),
            Command::Step(steps) => {
                self.pace.stand();
                let limit = Limit::steps(few(steps)?);
                if let Some(stop) = session.advance(limit, sink)? {
                    more.insert("stopped".to_owned(), stopped(&stop));
                }
            }
            Command::Back(steps) => {
                self.pace.stand();
                session.back(steps, sink)?;
            }
            Command::Seek(time) => {
                few(((time - session.now().time) / session.scene().step) as u64)?;
                session.seek(time, sink)?;
                self.set_out_again(clock);
            }
            Command::Speed(speed) => {
                let reached = session.now().time;
                self.pace.set_speed(speed, clock.seconds(), reached);
            }
            Command::Loop(on) => self.looping = on,
            Command::Reset => {
                session.reset(sink)?;
                self.set_out_again(clock);
            }
            Command::Push(push) => return Ok(told(&session.push(push, words, sink)?)),
            Command::Spin(push, spin) => {
                return Ok(told(&session.push_giving(spin, push, words, sink)?));
            }
            Command::Click(click) => return self.click(&click, words, sink),
            Command::Again => return Ok(told(&session.again(words, sink)?)),
            Command::Set {
                path,
                value,
                from_start,
            } => match from_start {
                true => {
                    session.set_from_start(&path, &value, words, sink)?;
                    self.set_out_again(clock);
                }
                false => session.set(&path, &value, words, sink)?,
            },
            Command::Method {
                name,
                tolerance,
                from_start,
            } => match from_start {
                true => {
                    session.method_from_start(&name, tolerance, words, sink)?;
                    self.set_out_again(clock);
                }
                false => session.method(&name, tolerance, words, sink)?,
            },
            Command::StepSize { step, from_start } => {
                if !from_start {
                    return refused(format!(
                        "the step is the clock's, and all its instants are multiples of it: it cannot change on the way; `step-size {step:?} from start` makes a branch that has it from the start"
                    ));
                }
                session.step_from_start(step, words, sink)?;
                self.set_out_again(clock);
            }
            Command::Effect { name, on } => session.switch(&name, on, words, sink)?,
            // Done before.
            Command::Break(..) => {}
            Command::Breaks => {
                let breaks = session.breaks().iter();
                let breaks: Vec<Value> = breaks
                    .map(|one| json!({ "id": one.id, "condition": one.condition.to_string() }))
                    .collect();
                more.insert("breaks".to_owned(), json!(breaks));
            }
            Command::Clear(id) => session.clear_break(id)?,
            Command::Save(name) => match self.saver.save(&name, session.text()) {
                Ok(place) => {
                    more.insert("saved".to_owned(), json!(place));
                }
                Err(why) => return refused(why),
            },
            Command::Branches => {
                more.insert("branches".to_owned(), branches(session));
            }
            Command::Branch(name) => {
                session.enter(&name, sink)?;
                self.set_out_again(clock);
            }
            Command::State(body) => {
                more.insert("state".to_owned(), session.numbers(&body)?.json());
            }
            Command::Where => more.extend(self.settings()),
            Command::Help(None) => {
                let all: Vec<Value> = FORMS.iter().map(help).collect();
                more.insert("commands".to_owned(), json!(all));
            }
            Command::Help(Some(form)) => {
                more.insert("command".to_owned(), help(form));
            }
            Command::Quit => {
                self.pace.stand();
                self.quit = true;
            }
        }
        Ok(more)
    }

    /// Counts time from here.
    fn set_out_again(&mut self, clock: &dyn Clock) {
        if self.pace.is_going() {
            self.pace.set_out(clock.seconds(), self.session.now().time);
        }
    }

    fn settings(&self) -> Map<String, Value> {
        let speed = self.pace.speed();
        let (states, bytes) = self.session.stored();
        let mut more = Map::new();
        more.insert(
            "speed".to_owned(),
            match speed.is_finite() {
                true => json!(speed),
                false => json!("max"),
            },
        );
        more.insert("loop".to_owned(), json!(self.looping));
        more.insert("over".to_owned(), json!(self.session.is_over()));
        more.insert("duration".to_owned(), json!(self.session.scene().duration));
        more.insert("stored_states".to_owned(), json!(states));
        more.insert("stored_bytes".to_owned(), json!(bytes));
        more
    }

    fn break_when(&mut self, text: &str, column: usize) -> String {
        let vocabulary = Vocabulary::of(self.session.subjects());
        let condition = match Condition::parse(text, &vocabulary) {
            Ok(condition) => condition,
            Err(wrong) => return error(&wrong.why, Some(column + wrong.column - 1)),
        };
        match self.session.break_when(condition) {
            Ok((id, holds)) => {
                let mut more = Map::new();
                more.insert("id".to_owned(), json!(id));
                more.insert("holds".to_owned(), json!(holds));
                self.answer(more)
            }
            Err(why) => error(&why.to_string(), None),
        }
    }

    fn click(&mut self, click: &Click, words: &str, sink: &mut dyn Sink) -> Answer {
        let session = &mut self.session;
        let Some((body, picked)) = session.pick(&click.ray) else {
            let mut more = Map::new();
            more.insert("hit".to_owned(), Value::Null);
            return Ok(more);
        };
        let direction = match click.along {
            Along::Normal => -picked.normal_w,
            Along::Ray => click.ray.direction / click.ray.direction.amax(),
            Along::Axis(axis) => axis,
        };
        let subject = &session.subjects()[body];
        let at = place_of(subject, picked.point_b);
        let length = direction.norm();
        if length <= 0.0 || !length.is_finite() {
            return refused("a direction of no length pushes nothing");
        }
        let mut push = Push {
            body: subject.name.clone(),
            what: What::Force {
                force: direction / length,
                at,
            },
            in_body: false,
            lasts: click.lasts,
        };
        let spin = match click.strength {
            Strength::Spin(spin) => Some(spin),
            Strength::Force(force) => {
                push.what = What::Force {
                    force: direction / length * force,
                    at,
                };
                None
            }
        };
        if click.couple {
            push = session.couple_of(push)?;
        }
        let pushed = match spin {
            Some(spin) => session.push_giving(spin, push, words, sink)?,
            None => session.push(push, words, sink)?,
        };
        let mut more = told(&pushed);
        more.insert("hit".to_owned(), vector(picked.point_w));
        more.insert("normal".to_owned(), vector(picked.normal_w));
        Ok(more)
    }

    /// Goes on as far as is due by the clock, for a fiftieth of a second at most. To be called some hundred times a
    /// second, or whenever there is nothing else to do.
    pub fn turn(&mut self, clock: &dyn Clock, sink: &mut dyn Sink) -> Result<Said, SinkError> {
        let mut said = Said::default();
        let began = clock.seconds();
        let Some(goal) = self.pace.goal(began, self.session.now().time) else {
            return Ok(said);
        };
        let until = goal.is_finite().then_some(goal);
        loop {
            let before = (self.session.now().step, clock.seconds());
            let limit = Limit {
                steps: self.chunk,
                until,
            };
            let stop = match self.session.advance(limit, sink) {
                Ok(stop) => stop,
                Err(SessionError::Sink(why)) => return Err(why),
                Err(SessionError::Refused(why)) => {
                    self.pace.stand();
                    said.lines.push(error(&why, None));
                    break;
                }
            };
            let now = clock.seconds();
            if let Some(stop) = stop {
                self.stopped(&stop, sink, &mut said)?;
                break;
            }
            let taken = self.session.now().step.saturating_sub(before.0);
            let whole = taken == self.chunk;
            // As many at a time as take a tenth of a turn.
            match now - before.1 < 0.1 * TURN {
                true if whole => self.chunk = (2 * self.chunk).min(LONGEST_CHUNK),
                true => {}
                false => self.chunk = (self.chunk / 2).max(1),
            }
            if !whole || now - began >= TURN {
                break;
            }
        }
        said.pacing = self.pace.pacing(clock.seconds(), self.session.now().time);
        Ok(said)
    }

    fn stopped(
        &mut self,
        stop: &Stop,
        sink: &mut dyn Sink,
        said: &mut Said,
    ) -> Result<(), SinkError> {
        let mut more = Map::new();
        match stop {
            Stop::End if self.looping => {
                let ended = self.pace.wall_of(self.session.now().time);
                match self.session.reset(sink) {
                    Ok(()) => {}
                    Err(SessionError::Sink(why)) => return Err(why),
                    Err(SessionError::Refused(why)) => {
                        said.lines.push(error(&why, None));
                    }
                }
                if let Some(ended) = ended {
                    self.pace.set_out(ended, 0.0);
                }
                more.insert("looped".to_owned(), json!(true));
            }
            _ => {
                self.pace.stand();
                more.insert("stopped".to_owned(), stopped(stop));
            }
        }
        said.lines.push(self.answer(more));
        Ok(())
    }
}

fn few(steps: u64) -> Result<u64, SessionError> {
    match steps <= MOST_STEPS {
        true => Ok(steps),
        false => refused(format!(
            "{steps} steps are more than {MOST_STEPS}, which one command takes at most"
        )),
    }
}

fn error(why: &str, column: Option<usize>) -> String {
    let mut answer = Map::new();
    answer.insert("ok".to_owned(), json!(false));
    answer.insert("error".to_owned(), json!(why));
    if let Some(column) = column {
        answer.insert("column".to_owned(), json!(column));
    }
    Value::Object(answer).to_string()
}

fn stopped(stop: &Stop) -> Value {
    match stop {
        Stop::End => json!({ "why": "end" }),
        Stop::Lost(why) => json!({ "why": "lost", "error": why }),
        Stop::Broke(Broke {
            id,
            condition,
            at,
            body,
            met,
        }) => json!({
            "why": "break",
            "id": id,
            "condition": condition,
            "time": at.time,
            "step": at.step,
            "body": body,
            "quantity": met.quantity,
            "value": met.value,
        }),
    }
}

fn told(pushed: &Pushed) -> Map<String, Value> {
    let mut answer = Map::new();
    let mut put = |name: &str, value: Value| {
        answer.insert(name.to_owned(), value);
    };
    let blow = pushed.push.lasts.is_none();
    put("body", json!(pushed.push.body));
    put("for", json!(pushed.push.lasts));
    put("point", json!(pushed.point_w.map(vector)));
    put("arm", json!(pushed.arm_w.map(vector)));
    put("lever_arm", json!(pushed.lever));
    put(
        if blow { "impulse" } else { "force" },
        json!(pushed.force_w.map(vector)),
    );
    put(
        if blow { "angular_impulse" } else { "torque" },
        vector(pushed.torque_w),
    );
    put(
        if blow {
            "spin_added"
        } else {
            "angular_acceleration_added"
        },
        vector(pushed.alpha_w),
    );
    put("angular_acceleration", vector(pushed.total_alpha_w));
    let mut more = Map::new();
    more.insert("pushed".to_owned(), Value::Object(answer));
    more
}

fn branches(session: &Session) -> Value {
    let all = session.branches().iter().map(|branch| {
        let parent = branch.parent.map(|parent| {
            json!({
                "branch": session.branches()[parent.branch].name,
                "time": parent.at.time,
                "step": parent.at.step,
                "from_start": parent.from_start,
            })
        });
        json!({
            "name": branch.name,
            "parent": parent,
            "changes": branch.changes,
            "stepped_to": branch.head.time,
        })
    });
    json!(all.collect::<Vec<_>>())
}

fn help(form: &Form) -> Value {
    json!({
        "command": form.name,
        "takes": form.takes,
        "about": form.about,
        "example": form.example,
    })
}
