//! Any text is a scene or is refused, each problem with a place.
#![no_main]

use libfuzzer_sys::fuzz_target;
use torquescope::scene::Script;

fuzz_target!(|text: &str| {
    match Script::new("s", "s", text).judge() {
        Ok((scenes, warnings)) => {
            for scene in &scenes {
                assert!(scene.duration.is_finite() && !scene.bodies.is_empty());
            }
            warnings.iter().for_each(|warning| drop(warning.to_string()));
        }
        Err(problems) => {
            let said = problems.to_string();
            assert!(said.lines().all(|line| line.starts_with("s:") || line.starts_with("  ")));
        }
    }
});
