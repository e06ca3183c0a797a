//! What is said of a body.

use serde_json::{Map, Value, json};

/// One of three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// This is wrong.
    Fault,
    /// Nothing is wrong, as far as was tested, and enough was.
    NoFault,
    /// This recording cannot tell.
    CannotTell,
}

impl Answer {
    /// As `--json` has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fault => "fault",
            Self::NoFault => "no-fault",
            Self::CannotTell => "cannot-tell",
        }
    }
}

/// A number that speaks for or against.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    pub name: &'static str,
    pub value: f64,
    /// Empty for a ratio.
    pub unit: &'static str,
}

/// The second explanation.
#[derive(Clone, Debug, PartialEq)]
pub struct RunnerUp {
    /// `as-declared` where it is that nothing is wrong.
    pub cause: &'static str,
    /// How many times more it leaves unexplained than the first.
    pub behind: f64,
}

/// Rows that were left out, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// s.
    pub from: f64,
    /// s.
    pub until: f64,
    pub why: &'static str,
}

/// What is said of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub body: String,
    pub answer: Answer,
    /// An id of [`super::CAUSES`]; `none`, or `cannot-tell`. Where nothing is wrong and the sign of the quaternion
    /// flips, `double-cover`.
    pub cause: &'static str,
    /// Where these data do not tell some causes apart: all of them, the likeliest first. Else empty.
    pub one_of: Vec<&'static str>,
    /// From 0 to 1: one less the part that the best explanation leaves of what the second leaves.
    pub confidence: f64,
    pub runner_up: Option<RunnerUp>,
    pub evidence: Vec<Evidence>,
    /// Why: what was seen, in a sentence.
    pub why: String,
    /// What the code most likely does.
    pub does: &'static str,
    /// What is right.
    pub formula: &'static str,
    /// What to change; or, where nothing can be told, what to record instead.
    pub remedy: String,
    /// What is correct physics and may surprise.
    pub surprises: Vec<String>,
    pub left_out: Vec<LeftOut>,
    /// What was not tested, and why.
    pub untested: Vec<String>,
}

impl Verdict {
    pub(super) fn new(body: &str) -> Self {
        Self {
            body: body.to_owned(),
            answer: Answer::CannotTell,
            cause: "cannot-tell",
            one_of: Vec::new(),
            confidence: 0.0,
            runner_up: None,
            evidence: Vec::new(),
            why: String::new(),
            does: "",
            formula: "",
            remedy: String::new(),
            surprises: Vec::new(),
            left_out: Vec::new(),
            untested: Vec::new(),
        }
    }

    /// The entry of `bodies` in what `diagnose --json` prints. A number that is none is `null`.
    pub fn to_json(&self) -> Value {
        let mut evidence = Map::new();
        for e in &self.evidence {
            evidence.insert(e.name.to_owned(), json!({"value": e.value, "unit": e.unit}));
        }
        json!({
            "name": self.body,
            "verdict": self.answer.name(),
            "cause": self.cause,
            "one_of": self.one_of,
            "confidence": self.confidence,
            "runner_up": self.runner_up.as_ref().map(|r| json!({"cause": r.cause, "behind": r.behind})),
            "evidence": evidence,
            "why": self.why,
            "does": self.does,
            "formula": self.formula,
            "remedy": self.remedy,
            "surprises": self.surprises,
            "left_out": self.left_out.iter().map(|l| json!({"from": l.from, "until": l.until, "why": l.why}))
                .collect::<Vec<_>>(),
            "untested": self.untested,
        })
    }
}

/// What a test found.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    /// The likeliest first; more than one where they cannot be told apart.
    pub causes: Vec<&'static str>,
    pub confidence: f64,
    pub runner_up: Option<RunnerUp>,
    pub evidence: Vec<Evidence>,
    pub why: String,
}

impl Found {
    pub fn of(cause: &'static str, why: String) -> Self {
        Self {
            causes: vec![cause],
            why,
            ..Self::default()
        }
    }

    pub fn sure(mut self, confidence: f64) -> Self {
        self.confidence = confidence;
        self
    }

    pub fn with(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.evidence.push(Evidence { name, value, unit });
        self
    }
}

/// What a test says.
#[derive(Clone, Debug)]
pub(super) enum Said {
    /// It has nothing to say against the recording.
    Pass,
    Fault(Found),
    /// What follows has no ground: why, and what to record instead.
    Void(String, String),
}
