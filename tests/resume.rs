//! A run that is halted, taken up again, set back and carried over has the bits of the run from start to end.

use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;
use torquescope::integrator::{Accepts, Kind, METHODS, MethodInfo};
use torquescope::scene::Scene;
use torquescope::sim::{Checkpoint, Limit, Run, Simulation, Stated};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track};

/// What it is given, as text.
#[derive(Default, Clone, PartialEq)]
struct Written {
    /// With every step.
    states: Vec<String>,
    samples: Vec<String>,
    notes: Vec<String>,
    hashes: Vec<(u64, u64)>,
}

impl Sink for Written {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        let width = track.bodies.len();
        for (k, at) in track.instants.iter().enumerate() {
            for (i, body) in track.bodies.clone().enumerate() {
                let motion = &track.motions[k * width + i];
                self.states.push(format!("{at:?} {body} {motion:?}"));
            }
        }
        Ok(())
    }
    fn samples(&mut self, at: Instant, _: Range<usize>, of: &[Sample]) -> Result<(), SinkError> {
        self.samples.push(format!("{at:?} {of:?}"));
        Ok(())
    }
    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.notes.push(format!("{at:?} {note:?}"));
        Ok(())
    }
    fn wants_fingerprints(&self) -> bool {
        true
    }
    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.hashes.push((at.step, hash));
        Ok(())
    }
}

/// Eleven bodies of all sorts, struck, pushed, set and switched at times on the grid and off it.
fn text(info: &MethodInfo) -> String {
    let tolerance = match info.kind {
        Kind::Adaptive => "\ntolerance = 1e-11",
        _ => "",
    };
    let mut text = format!(
        "duration = 0.3\n[stepping]\nmethod = \"{}\"\nstep = 0.004{tolerance}\n[record]\nrate = 250\nstreams = [\"torque\", \"alpha\", \"error\", \"drift\"]\n[effects]\ngyroscopic = true\ngravity = [0.3, -9.81, 0.1]\n",
        info.name
    );
    for k in 0..11_u32 {
        let x = f64::from(k);
        let _ = write!(
            text,
            "[[body]]\nname = \"b{k}\"\nmass = {}\ninertia = [[1.3, 0.1, 0.02], [0.1, {}, -0.2], [0.02, -0.2, 1.9]]\n\
             orientation = {{ axis = [1, {x}, -2], degrees = {} }}\nangular_velocity = [{}, -1.7, {}]\n",
            1.0 + 0.3 * x,
            1.6 + 0.01 * x,
            17.0 * x,
            0.3 * x - 1.0,
            2.0 - 0.7 * x,
        );
    }
    // Those that take no torque could not take one that lasts.
    let lasts = match info.accepts {
        Accepts::Free => "",
        _ => "for = 0.05",
    };
    let _ = write!(
        text,
        "[[event]]\nat = 0.0513\nbody = \"b3\"\nimpulse = [1, 2, -3]\npoint = {{ body = [0.1, 0.5, 0] }}\n\
         [[event]]\nat = 0.1\nclick = {{ from = [90, 0, 0], direction = [1, 0, 0], force = 1.0 }}\n{lasts}\n\
         [[event]]\nat = 0.12\nbody = \"b2\"\nset = {{ angular_velocity = [0, 3, 0.1] }}\n\
         [[event]]\nat = 0.2\nswitch = {{ effect = \"gravity\", on = false }}\n\
         [[event]]\nat = 0.2101\nnote = \"still going\"\n"
    );
    text
}

fn parse(text: &str) -> Arc<Scene> {
    Arc::new(Scene::parse("r", "r", text).unwrap_or_else(|why| panic!("{why}")))
}

fn scenes() -> Vec<(&'static MethodInfo, Arc<Scene>)> {
    let all = METHODS.iter().map(|method| method.info());
    let read = |info| Some((info, Arc::new(Scene::parse("r", "r", &text(info)).ok()?)));
    let found: Vec<_> = all.filter_map(read).collect();
    assert!(found.len() > 20, "{}", found.len());
    found
}

fn whole(scene: &Scene) -> Written {
    let mut written = Written::default();
    let (_, done) = Simulation::new(scene).on_threads(1).run(&mut written);
    done.unwrap();
    written
}

/// By body and in order of time, whatever stretches it came in.
fn sorted(mut written: Written) -> Written {
    written.states.sort();
    written
}

#[test]
fn step_by_step_is_what_the_whole_run_is() {
    for (info, scene) in scenes() {
        let want = sorted(whole(&scene));
        for limit in [1, 3, 1000] {
            let mut stated = Stated::of(&scene).unwrap();
            let mut run = Run::new(Arc::clone(&scene));
            let mut written = Written::default();
            let mut steps = 0;
            while !run.is_over() {
                run.go(Limit::steps(limit), &mut stated, &mut written)
                    .unwrap();
                assert!(run.now().step - steps <= limit, "{}", info.name);
                steps = run.now().step;
            }
            let got = sorted(written);
            assert!(got == want, "{} by {limit}", info.name);
        }
    }
}

#[test]
fn set_back_to_any_checkpoint_it_has_the_bits_again() {
    for (info, scene) in scenes() {
        let mut stated = Stated::of(&scene).unwrap();
        let mut run = Run::new(Arc::clone(&scene));
        let mut stored: Vec<(Checkpoint, u64)> = Vec::new();
        let mut sink = Written::default();
        while !run.is_over() {
            run.go(Limit::steps(1), &mut stated, &mut sink).unwrap();
            stored.push((run.checkpoint(), run.fingerprint()));
        }
        // 75 steps, and three that events divide.
        assert_eq!(stored.len(), 76, "{}", info.name);
        for from in [70, 0, 13, 25, 26, 50, 51] {
            run.restore(&stored[from].0);
            assert_eq!(run.fingerprint(), stored[from].1, "{} at {from}", info.name);
            for (k, (checkpoint, hash)) in stored.iter().enumerate().skip(from + 1) {
                run.go(Limit::steps(1), &mut stated, &mut sink).unwrap();
                assert_eq!(run.now(), checkpoint.at());
                assert_eq!(run.fingerprint(), *hash, "{} from {from} at {k}", info.name);
            }
        }
    }
}

#[test]
fn what_is_unforeseen_changes_no_bit_before_it_and_can_be_added_to_a_run() {
    for (info, scene) in scenes() {
        let known = scene.events.len();
        let mut stated = Stated::of(&scene).unwrap();
        for after in [1_u64, 9, 26, 32, 60] {
            let mut run = Run::new(Arc::clone(&scene));
            let mut live = Written::default();
            run.go(Limit::steps(after), &mut stated, &mut live).unwrap();
            let at = run.latest_here();
            let more = format!(
                "{}[[event]]\nat = {at:?}\nfor = 0.03\nbody = \"b1\"\ntorque = [0.1, 0.2, 0.3]\nunforeseen = true\n\
                 [[event]]\nat = {at:?}\nbody = \"b4\"\nangular_impulse = [0.1, 0.2, 0.3]\nunforeseen = true\n",
                text(info)
            );
            let Ok(more) = Scene::parse("r", "r", &more) else {
                // It takes no torque.
                continue;
            };
            let more = Arc::new(more);
            let mut run = Run::carried(Arc::clone(&more), &run.checkpoint(), known).unwrap();
            run.go(Limit::steps(u64::MAX), &mut stated, &mut live)
                .unwrap();
            let (want, got) = (sorted(whole(&more)), sorted(live));
            for (name, got, want) in [
                ("states", &got.states, &want.states),
                ("samples", &got.samples, &want.samples),
                ("notes", &got.notes, &want.notes),
            ] {
                assert_eq!(got.len(), want.len(), "{} {name} after {after}", info.name);
                for (got, want) in got.iter().zip(want) {
                    assert_eq!(got, want, "{} {name} after {after}", info.name);
                }
            }
            // Where something has happened already there is one of after that too.
            let last = |written: &Written| -> std::collections::BTreeMap<u64, u64> {
                written.hashes.iter().copied().collect()
            };
            assert_eq!(last(&got), last(&want), "{} after {after}", info.name);
        }
    }
}

#[test]
fn a_time_to_halt_at_cuts_no_step() {
    let scene = parse(&text(METHODS[0].info()));
    let mut stated = Stated::of(&scene).unwrap();
    let mut run = Run::new(scene);
    let mut sink = Written::default();
    // An event at 0.0513 divides a step.
    for (until, step, time) in [
        (0.0, 0, 0.0),
        (0.0399, 9, 9.0 * 0.004),
        (0.04, 10, 0.04),
        (0.0512, 12, 12.0 * 0.004),
        (0.0513, 13, 0.0513),
        (0.0515, 13, 0.0513),
        (0.052, 14, 13.0 * 0.004),
        // It does not go back.
        (0.03, 14, 13.0 * 0.004),
        (7.0, 76, 0.3),
    ] {
        run.go(Limit::time(until), &mut stated, &mut sink).unwrap();
        assert_eq!(
            (run.now().step, run.now().time),
            (step, time),
            "until {until}"
        );
    }
    assert!(run.is_over());
}

#[test]
fn a_method_may_change_on_the_way() {
    let text = |event: &str| {
        format!(
            "duration = 0.4\n[stepping]\nmethod = \"semi-implicit\"\nstep = 0.01\n[effects]\ngyroscopic = true\n\
             [[body]]\nname = \"a\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 2, 3]\n\
             [[body]]\nname = \"b\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 2, 3]\nmethod = \"rk4\"\n{event}"
        )
    };
    let energies = |scene: &Arc<Scene>, until: f64| {
        let mut run = Run::new(Arc::clone(scene));
        let mut stated = Stated::of(scene).unwrap();
        run.go(Limit::time(until), &mut stated, &mut Written::default())
            .unwrap();
        let samples = run.samples();
        let energy = |body: usize| run.subjects()[body].energy(&samples[body].motion);
        (energy(0), energy(1), run.method_of(0), run.method_of(1))
    };
    let plain = parse(&text(""));
    let changed = parse(&text("[[event]]\nat = 0.2\nmethod = \"closed-form\"\n"));
    let (before, own, ..) = energies(&plain, 0.2);
    // The closed form keeps what the tutorial's method had lost by then.
    let (after, own_after, by, own_by) = energies(&changed, 0.4);
    assert!((after - before).abs() < 1e-12, "{after} {before}");
    assert!((own_after - own).abs() < 1e-8);
    assert_eq!((by, own_by), ("closed-form", "rk4"));
    let (lost, ..) = energies(&plain, 0.4);
    assert!((lost - before).abs() > 1e-4, "{lost} {before}");
    // Until then nothing is else.
    let run = |scene: &Arc<Scene>| {
        let mut run = Run::new(Arc::clone(scene));
        let mut stated = Stated::of(scene).unwrap();
        run.go(Limit::time(0.19), &mut stated, &mut Written::default())
            .unwrap();
        run.fingerprint()
    };
    assert_eq!(run(&plain), run(&changed));
    // A method is refused where it does not take what acts in its time, and only there.
    let torque = |at: f64| {
        format!(
            "[[event]]\nat = {at}\nfor = 0.05\nbody = \"a\"\ntorque = [1, 0, 0]\n[[event]]\nat = 0.2\nmethod = \"closed-form\"\n"
        )
    };
    assert!(Scene::parse("r", "r", &text(&torque(0.1))).is_ok());
    let wrong = Scene::parse("r", "r", &text(&torque(0.3))).err().unwrap();
    let wrong = wrong.to_string();
    assert!(
        wrong.contains("a torque on a: closed-form is for bodies that no torque turns"),
        "{wrong}"
    );
    let wrong = Scene::parse(
        "r",
        "r",
        &text("[[event]]\nat = 0.2\nmethod = \"closed-from\"\n"),
    );
    assert!(wrong.err().unwrap().to_string().contains("closed-form"));
}
