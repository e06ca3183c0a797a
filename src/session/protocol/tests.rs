use super::*;
use crate::session::{Place, What};
use proptest::prelude::*;

fn wrong(line: &str) -> (usize, String) {
    let wrong = parse(line).unwrap_err();
    (wrong.column, wrong.why)
}

#[test]
fn every_form_has_an_example_that_is_it() {
    for form in FORMS {
        let command = parse(form.example).unwrap_or_else(|why| panic!("{}: {why}", form.name));
        assert!(form.example.starts_with(form.name));
        // Nothing but quit falls through to it.
        assert_eq!(
            command == Command::Quit,
            form.name == "quit",
            "{}",
            form.name
        );
        assert!(parse(&format!("help {}", form.name)).is_ok());
        let mut names = FORMS.iter().filter(|other| other.name == form.name);
        assert_eq!(names.by_ref().count(), 1);
    }
}

#[test]
fn lines_are_understood() {
    let v = Vector3::new;
    let push = |in_body, lasts| Push {
        body: "cone".to_owned(),
        what: What::Force {
            force: v(-10.0, 0.0, 0.0),
            at: match in_body {
                true => Place::Body(v(0.0, 1.0, 0.0)),
                false => Place::World(v(0.0, 1.0, 0.0)),
            },
        },
        in_body,
        lasts,
    };
    for (line, command) in [
        (" step ", Command::Step(1)),
        ("step 10\r\n", Command::Step(10)),
        ("push cone 0 1 0  -10 0 0", Command::Push(push(false, None))),
        (
            "push cone 0 1 0 -1e1 0 0 body for 0.1",
            Command::Push(push(true, Some(0.1))),
        ),
        (
            "push cone 0 1 0 -1_0 0 0 for .1 world",
            Command::Push(push(false, Some(0.1))),
        ),
        (
            "spin cone 0 1 0  -10 0 0 3",
            Command::Spin(push(false, None), 3.0),
        ),
        ("speed max", Command::Speed(f64::INFINITY)),
        (
            "break when  a > 1  ",
            Command::Break("a > 1".to_owned(), 13),
        ),
        (
            "set effects.motor { axis = [0, 1, 0] } from start",
            Command::Set {
                path: "effects.motor".to_owned(),
                value: "{ axis = [0, 1, 0] }".to_owned(),
                from_start: true,
            },
        ),
        (
            "set a fromstart",
            Command::Set {
                path: "a".to_owned(),
                value: "fromstart".to_owned(),
                from_start: false,
            },
        ),
        (
            "click 0 0 5 0 0 -1 blow couple force 3",
            Command::Click(Click {
                ray: Ray {
                    origin: v(0.0, 0.0, 5.0),
                    direction: v(0.0, 0.0, -1.0),
                },
                strength: Strength::Force(3.0),
                lasts: None,
                along: Along::Normal,
                couple: true,
            }),
        ),
    ] {
        assert_eq!(parse(line).as_ref(), Ok(&command), "{line}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_column() {
    for (line, column, why) in [
        ("", 1, "here is missing: a command"),
        ("puhs cone", 1, "did you mean `push`?"),
        (
            "push cone 0 1 x 0 0 0",
            15,
            "`x` is no number; here belongs a point, m: three numbers",
        ),
        (
            "push cone 0 1",
            14,
            "here is missing: a point, m: three numbers; write `push BODY PX PY PZ",
        ),
        ("push cône 0 1 é 0 0 0", 15, "`é` is no number"),
        ("push cone 0 1 0 0 0 0 for 0", 27, "0 is not above zero"),
        (
            "push cone 0 1 0 0 0 0 for 1 for 2",
            29,
            "`for` is one word too many",
        ),
        ("step 1.5", 6, "no whole number"),
        ("step -1", 6, "no whole number"),
        ("seek -1", 6, "-1 is below zero"),
        ("seek inf", 6, "`inf` is no number"),
        ("seek 1e999", 6, "is no number"),
        ("loop maybe", 6, "neither on nor off"),
        ("break wen a > 1", 7, "`wen` where `when` belongs"),
        ("break when", 11, "here is missing: a condition"),
        ("set a from start", 17, "here is missing: a value"),
        ("method rk4 from", 16, "here is missing: `start`"),
        ("play now", 6, "`now` is one word too many; write `play`"),
        ("click 0 0 0 0 0 0", 13, "no length"),
        ("play\u{7}", 5, "none to read"),
    ] {
        let (at, said) = wrong(line);
        assert_eq!(at, column, "{line}: {said}");
        assert!(said.contains(why), "{line}: {said}");
    }
    let long = format!("set a {}", "x".repeat(LONGEST));
    assert!(wrong(&long).1.contains("at most 4096 bytes"));
    // Of a word as long as a line only the beginning is said again.
    assert!(wrong(&"x".repeat(LONGEST)).1.len() < 1000);
}

proptest! {
    #[test]
    fn nothing_panics(line in "\\PC{0,200}") {
        let _ = parse(&line);
    }

    #[test]
    fn nothing_made_of_its_own_words_panics(
        words in proptest::collection::vec(
            prop_oneof![
                Just("push"), Just("click"), Just("set"), Just("for"), Just("body"), Just("from"), Just("start"),
                Just("when"), Just("along"), Just("1"), Just("-1e3"), Just("é"), Just("cone"), Just("break"),
            ],
            0..20,
        ),
        first in 0..FORMS.len(),
    ) {
        let line = format!("{} {}", FORMS[first].name, words.join(" "));
        if let Err(wrong) = parse(&line) {
            prop_assert!(wrong.column >= 1 && wrong.column <= line.chars().count() + 1);
        }
    }
}
