//! A line as words, and words as a command.

use super::{
    Along, CLICK_LASTS, CLICK_SPIN, Click, Command, FORMS, Form, LONGEST, Strength, Wrong,
};
use crate::mass::ray::Ray;
use crate::session::hand::{Place, Push, What};
use crate::trace::nearest;
use crate::trace::short;
use nalgebra::Vector3;

/// Reads a line; blanks around it and a line's end do not count.
pub fn parse(line: &str) -> Result<Command, Wrong> {
    let mut words = Words::new(line)?;
    let name = words.word("a command; `help` lists them")?;
    let Some(form) = FORMS.iter().find(|form| form.name == name.text) else {
        let names: Vec<&str> = FORMS.iter().map(|form| form.name).collect();
        return Err(name.wrong(format!(
            "`{}` is no command; {}",
            shown(name.text),
            nearest(name.text, &names)
        )));
    };
    words.form = Some(form);
    let command = command(form.name, &mut words)?;
    match words.next() {
        None => Ok(command),
        Some(more) => Err(more.wrong(format!(
            "`{}` is one word too many; {}",
            shown(more.text),
            words.usage()
        ))),
    }
}

/// Simulated seconds a second that no machine comes near to; times that count it stay finite.
const FASTEST: f64 = 1e12;

fn command(name: &str, words: &mut Words<'_>) -> Result<Command, Wrong> {
    Ok(match name {
        "play" => Command::Play,
        "pause" => Command::Pause,
        "step" => Command::Step(words.count()?),
        "back" => Command::Back(words.count()?),
        "seek" => Command::Seek(words.not_negative("a time, s")?),
        "speed" => Command::Speed(match words.takes("max") {
            true => f64::INFINITY,
            // What is faster than this is as fast as it goes.
            false => match words.positive("simulated seconds a second, or `max`")? {
                speed if speed < FASTEST => speed,
                _ => f64::INFINITY,
            },
        }),
        "loop" => Command::Loop(words.switch()?),
        "reset" => Command::Reset,
        "push" => {
            let body = words.name("a body")?;
            let point = words.vector("a point, m")?;
            let force = words.vector("a force, N")?;
            Command::Push(at_point(words, body, point, force)?)
        }
        "spin" => {
            let body = words.name("a body")?;
            let point = words.vector("a point, m")?;
            let direction = words.vector("a direction")?;
            let spin = words.number("a spin, rad/s")?;
            Command::Spin(at_point(words, body, point, direction)?, spin)
        }
        "torque" => {
            let body = words.name("a body")?;
            let torque = words.vector("a torque, N·m")?;
            Command::Push(turning(words, body, torque)?)
        }
        "twist" => {
            let body = words.name("a body")?;
            let direction = words.vector("a direction")?;
            let spin = words.number("a spin, rad/s")?;
            Command::Spin(turning(words, body, direction)?, spin)
        }
        "click" => Command::Click(click(words)?),
        "again" => Command::Again,
        "set" => set(words)?,
        "method" => {
            let name = words.name("a method")?;
            let tolerance = match words.takes("tolerance") {
                true => Some(words.positive("a relative error")?),
                false => None,
            };
            Command::Method {
                name,
                tolerance,
                from_start: words.takes_from_start()?,
            }
        }
        "step-size" => Command::StepSize {
            step: words.positive("a step, s")?,
            from_start: words.takes_from_start()?,
        },
        "effect" => Command::Effect {
            name: words.name("an effect")?,
            on: words.switch()?,
        },
        "break" => {
            words.must("when")?;
            let (column, condition) = words.rest("a condition")?;
            Command::Break(condition, column)
        }
        "breaks" => Command::Breaks,
        "clear" => Command::Clear(words.whole("a breakpoint's number")?),
        "save" => Command::Save(words.name("a file")?),
        "branches" => Command::Branches,
        "branch" => Command::Branch(words.name("a branch")?),
        "state" => Command::State(words.name("a body")?),
        "where" => Command::Where,
        "help" => Command::Help(match words.next() {
            None => None,
            Some(word) => {
                let names: Vec<&str> = FORMS.iter().map(|form| form.name).collect();
                let found = FORMS.iter().find(|form| form.name == word.text);
                Some(found.ok_or_else(|| {
                    let remedy = nearest(word.text, &names);
                    word.wrong(format!("`{}` is no command; {remedy}", shown(word.text)))
                })?)
            }
        }),
        // FORMS has no other name; a test goes through all.
        _ => Command::Quit,
    })
}

/// What may come behind a push: for how long, and in which axes.
fn manner(words: &mut Words<'_>) -> Result<(Option<f64>, bool), Wrong> {
    let (mut lasts, mut in_body) = (None, None);
    loop {
        if lasts.is_none() && words.takes("for") {
            lasts = Some(words.positive("how long, s")?);
        } else if in_body.is_none() && words.takes("body") {
            in_body = Some(true);
        } else if in_body.is_none() && words.takes("world") {
            in_body = Some(false);
        } else {
            return Ok((lasts, in_body.unwrap_or(false)));
        }
    }
}

fn at_point(
    words: &mut Words<'_>,
    body: String,
    point: Vector3<f64>,
    force: Vector3<f64>,
) -> Result<Push, Wrong> {
    let (lasts, in_body) = manner(words)?;
    let at = match in_body {
        true => Place::Body(point),
        false => Place::World(point),
    };
    Ok(Push {
        body,
        what: What::Force { force, at },
        in_body,
        lasts,
    })
}

fn turning(words: &mut Words<'_>, body: String, torque: Vector3<f64>) -> Result<Push, Wrong> {
    let (lasts, in_body) = manner(words)?;
    Ok(Push {
        body,
        what: What::Torque(torque),
        in_body,
        lasts,
    })
}

fn click(words: &mut Words<'_>) -> Result<Click, Wrong> {
    let origin = words.vector("the eye, m")?;
    let at = words.column();
    let direction = words.vector("a direction")?;
    if direction == Vector3::zeros() {
        return Err(Wrong {
            column: at,
            why: "a direction of no length looks nowhere".to_owned(),
        });
    }
    let (mut strength, mut lasts, mut along, mut couple) = (None, None, None, false);
    loop {
        if strength.is_none() && words.takes("force") {
            strength = Some(Strength::Force(words.number("a force, N")?));
        } else if strength.is_none() && words.takes("spin") {
            strength = Some(Strength::Spin(words.number("a spin, rad/s")?));
        } else if lasts.is_none() && words.takes("for") {
            lasts = Some(Some(words.positive("how long, s")?));
        } else if lasts.is_none() && words.takes("blow") {
            lasts = Some(None);
        } else if along.is_none() && words.takes("normal") {
            along = Some(Along::Normal);
        } else if along.is_none() && words.takes("ray") {
            along = Some(Along::Ray);
        } else if along.is_none() && words.takes("along") {
            along = Some(Along::Axis(words.vector("a direction")?));
        } else if !couple && words.takes("couple") {
            couple = true;
        } else {
            break;
        }
    }
    Ok(Click {
        ray: Ray { origin, direction },
        strength: strength.unwrap_or(Strength::Spin(CLICK_SPIN)),
        lasts: lasts.unwrap_or(Some(CLICK_LASTS)),
        along: along.unwrap_or(Along::Normal),
        couple,
    })
}

/// The value is all that stands before `from start`.
fn set(words: &mut Words<'_>) -> Result<Command, Wrong> {
    let path = words.name("a path, such as damping.angular")?;
    let (_, rest) = words.rest("a value")?;
    let (value, from_start) = match without_from_start(&rest) {
        Some(value) => (value.to_owned(), true),
        None => (rest, false),
    };
    if value.is_empty() {
        return Err(words.lacks("a value"));
    }
    Ok(Command::Set {
        path,
        value,
        from_start,
    })
}

fn without_from_start(text: &str) -> Option<&str> {
    let text = text.strip_suffix("start")?;
    let before = text.trim_end();
    let before = before
        .strip_suffix("from")
        .filter(|_| before.len() < text.len())?;
    (before.is_empty() || before.ends_with(char::is_whitespace)).then(|| before.trim_end())
}

#[derive(Clone, Copy)]
struct Word<'l> {
    text: &'l str,
    /// In characters, from 1.
    column: usize,
    /// In bytes.
    at: usize,
}

impl Word<'_> {
    fn wrong(self, why: impl Into<String>) -> Wrong {
        Wrong {
            column: self.column,
            why: why.into(),
        }
    }
}

struct Words<'l> {
    line: &'l str,
    all: Vec<Word<'l>>,
    next: usize,
    form: Option<&'static Form>,
}

impl<'l> Words<'l> {
    fn new(line: &'l str) -> Result<Self, Wrong> {
        let wrong = |column, why: String| Wrong { column, why };
        if line.len() > LONGEST {
            let why = format!(
                "a line has at most {LONGEST} bytes, and this has {}",
                line.len()
            );
            return Err(wrong(1, why));
        }
        let line = line.trim_end();
        if let Some(at) = line.chars().position(|c| c.is_control() && c != '\t') {
            let why = "a character that is none to read".to_owned();
            return Err(wrong(at + 1, why));
        }
        let mut all: Vec<Word<'l>> = Vec::new();
        let mut inside = false;
        for (column, (at, c)) in line.char_indices().enumerate() {
            match (c.is_whitespace(), inside) {
                (false, false) => {
                    let end = line[at..].find(char::is_whitespace);
                    let end = end.map_or(line.len(), |length| at + length);
                    all.push(Word {
                        text: &line[at..end],
                        column: column + 1,
                        at,
                    });
                    inside = true;
                }
                (true, true) => inside = false,
                _ => {}
            }
        }
        Ok(Self {
            line,
            all,
            next: 0,
            form: None,
        })
    }

    fn next(&mut self) -> Option<Word<'l>> {
        let word = self.all.get(self.next).copied();
        self.next += 1;
        word
    }

    /// Of the next word, or of the line's end.
    fn column(&self) -> usize {
        let end = || self.line.chars().count() + 1;
        self.all.get(self.next).map_or_else(end, |word| word.column)
    }

    fn usage(&self) -> String {
        match self.form {
            Some(form) => format!("write `{}`", format!("{} {}", form.name, form.takes).trim()),
            None => "`help` lists the commands".to_owned(),
        }
    }

    fn lacks(&self, what: &str) -> Wrong {
        Wrong {
            column: self.line.chars().count() + 1,
            why: match self.form {
                Some(_) => format!("here is missing: {what}; {}", self.usage()),
                None => format!("here is missing: {what}"),
            },
        }
    }

    fn word(&mut self, what: &str) -> Result<Word<'l>, Wrong> {
        match self.next() {
            Some(word) => Ok(word),
            None => Err(self.lacks(what)),
        }
    }

    fn name(&mut self, what: &str) -> Result<String, Wrong> {
        Ok(self.word(what)?.text.to_owned())
    }

    /// All of the line from the next word on, with its column.
    fn rest(&mut self, what: &str) -> Result<(usize, String), Wrong> {
        let word = self.word(what)?;
        self.next = self.all.len();
        Ok((word.column, self.line[word.at..].to_owned()))
    }

    /// Takes a word that may stand here.
    fn takes(&mut self, word: &str) -> bool {
        let is = self
            .all
            .get(self.next)
            .is_some_and(|next| next.text == word);
        self.next += usize::from(is);
        is
    }

    fn must(&mut self, word: &'static str) -> Result<(), Wrong> {
        let given = self.word(&format!("`{word}`"))?;
        match given.text == word {
            true => Ok(()),
            false => Err(given.wrong(format!(
                "`{}` where `{word}` belongs; {}",
                shown(given.text),
                self.usage()
            ))),
        }
    }

    fn takes_from_start(&mut self) -> Result<bool, Wrong> {
        if !self.takes("from") {
            return Ok(false);
        }
        self.must("start")?;
        Ok(true)
    }

    fn switch(&mut self) -> Result<bool, Wrong> {
        let word = self.word("on or off")?;
        match word.text {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err(word.wrong(format!("`{}` is neither on nor off", shown(word.text)))),
        }
    }

    fn number_word(&mut self, what: &str) -> Result<(Word<'l>, f64), Wrong> {
        let word = self.word(what)?;
        // Rust reads words like `inf` and `nan` too.
        let plain = word
            .text
            .bytes()
            .all(|c| c.is_ascii_digit() || b"+-.eE_".contains(&c));
        let number = word.text.replace('_', "").parse::<f64>().ok();
        match number.filter(|number| plain && number.is_finite()) {
            Some(number) => Ok((word, number)),
            None => Err(word.wrong(format!(
                "`{}` is no number; here belongs {what}",
                shown(word.text)
            ))),
        }
    }

    fn number(&mut self, what: &str) -> Result<f64, Wrong> {
        Ok(self.number_word(what)?.1)
    }

    fn positive(&mut self, what: &str) -> Result<f64, Wrong> {
        let (word, number) = self.number_word(what)?;
        match number > 0.0 {
            true => Ok(number),
            false => Err(word.wrong(format!(
                "{} is not above zero; here belongs {what}",
                short(number)
            ))),
        }
    }

    fn not_negative(&mut self, what: &str) -> Result<f64, Wrong> {
        let (word, number) = self.number_word(what)?;
        match number >= 0.0 {
            true => Ok(number),
            false => Err(word.wrong(format!(
                "{} is below zero; here belongs {what}",
                short(number)
            ))),
        }
    }

    fn whole(&mut self, what: &str) -> Result<u64, Wrong> {
        let word = self.word(what)?;
        word.text.parse().map_err(|_| {
            let shown = shown(word.text);
            word.wrong(format!("`{shown}` is no whole number; here belongs {what}"))
        })
    }

    /// How many steps; 1 where nothing is said.
    fn count(&mut self) -> Result<u64, Wrong> {
        match self.next < self.all.len() {
            true => self.whole("a number of steps"),
            false => Ok(1),
        }
    }

    fn vector(&mut self, what: &str) -> Result<Vector3<f64>, Wrong> {
        let what = format!("{what}: three numbers");
        let mut number = || self.number(&what);
        Ok(Vector3::new(number()?, number()?, number()?))
    }
}

/// As much of a word as one reads.
fn shown(word: &str) -> String {
    const MOST: usize = 40;
    match word.chars().count() > MOST {
        true => word.chars().take(MOST).collect::<String>() + "…",
        false => word.to_owned(),
    }
}
