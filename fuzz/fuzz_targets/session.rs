//! Any lines drive a session or are refused, and what it saves is a scene.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::ops::Range;
use torquescope::scene::{Scene, Script};
use torquescope::session::{Clock, Console, Saver, Session, Settings};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track};

const SCENE: &str = "duration = 0.1\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.01\n[effects]\ngyroscopic = true\ndamping = { angular = 0.1 }\n\
    [[body]]\nname = \"a\"\nshape = { cone = { radius = 1.0, height = 1.0 } }\nmass = 1.0\nangular_velocity = [0, 1, 0]\n";

struct Nothing;

impl Sink for Nothing {
    fn motions(&mut self, _: &Track<'_>) -> Result<(), SinkError> {
        Ok(())
    }
    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }
    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

impl Saver for Nothing {
    fn save(&mut self, _: &str, text: &str) -> Result<String, String> {
        assert!(Scene::parse("s", "s", text).is_ok(), "{text}");
        Ok(String::new())
    }
}

struct Still;

impl Clock for Still {
    fn seconds(&self) -> f64 {
        0.0
    }
}

fuzz_target!(|lines: &str| {
    let script = Script::new("s", "s", SCENE);
    let Ok(session) = Session::open(script, Settings::default(), &mut Nothing) else {
        return;
    };
    let mut console = Console::new(session, Nothing);
    for line in lines.lines().take(32).chain(["save s.toml"]) {
        // A step of the fuzzer is to be short.
        if line.contains("step-size") || line.contains("duration") {
            continue;
        }
        let answer = console.obey(line, &Still, &mut Nothing).unwrap_or_default();
        assert!(answer.starts_with('{') && !answer.contains('\n'));
        let _ = console.turn(&Still, &mut Nothing);
    }
});
