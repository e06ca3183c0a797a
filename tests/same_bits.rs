//! The same scene gives the same bits: run after run, on any number of threads, in debug and release, recorded or not.
//!
//! The hashes in tests/fixtures/same_bits.txt are of every bit of every state, by every method; they are the same in
//! every build. `UPDATE_GOLDEN=1 cargo test --test same_bits` writes them anew, after a change that is meant to change bits.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;
use torquescope::integrator::{Kind, METHODS, MethodInfo};
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::{Instant, Motion, Note, Sample, Sink, SinkError, Track};

/// FNV-1a over the bits of what it is given.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn number(&mut self, x: f64) {
        // Both zeros are one number.
        for byte in (x + 0.0).to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn motion(&mut self, motion: &Motion) {
        let vectors = [motion.position_w, motion.velocity_w, motion.omega_w];
        vectors.iter().flatten().for_each(|&x| self.number(x));
        motion.q_wb.coords.iter().for_each(|&x| self.number(x));
    }

    fn sample(&mut self, sample: &Sample) {
        self.motion(&sample.motion);
        let vectors = [sample.tau_w, sample.alpha_w];
        vectors.iter().flatten().for_each(|&x| self.number(x));
        let deviation = [
            sample.deviation.attitude,
            sample.deviation.energy,
            sample.deviation.momentum,
        ];
        deviation.iter().flatten().for_each(|&x| self.number(x));
    }
}

/// Hashes all that it is given; or takes nothing, as where nobody records.
enum Recording {
    On(Hash),
    Off,
}

impl Sink for Recording {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        if let Self::On(hash) = self {
            track.motions.iter().for_each(|motion| hash.motion(motion));
        }
        Ok(())
    }
    fn samples(
        &mut self,
        at: Instant,
        _: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        if let Self::On(hash) = self {
            hash.number(at.time);
            samples.iter().for_each(|sample| hash.sample(sample));
        }
        Ok(())
    }
    fn note(&mut self, _: Instant, note: &Note) -> Result<(), SinkError> {
        if let Self::On(hash) = self {
            note.text
                .bytes()
                .for_each(|byte| hash.number(f64::from(byte)));
        }
        Ok(())
    }
}

/// What was recorded, and the end.
fn hashes(scene: &Scene, threads: usize, mut sink: Recording) -> (Option<u64>, u64) {
    let (outcome, done) = Simulation::new(scene).on_threads(threads).run(&mut sink);
    done.unwrap_or_else(|why| panic!("{why}"));
    let mut end = Hash::new();
    outcome
        .end
        .iter()
        .for_each(|sample| end.motion(&sample.motion));
    let recorded = match sink {
        Recording::On(hash) => Some(hash.0),
        Recording::Off => None,
    };
    (recorded, end.0)
}

fn parse(text: &str) -> Option<Scene> {
    Scene::parse("bits", "bits", text).ok()
}

/// Bodies of all shapes, tilted, damped, free, struck on the way.
fn scene(info: &MethodInfo, record: &str, gyroscopic: bool, heavy: bool) -> Option<Scene> {
    let tolerance = match info.kind {
        Kind::Adaptive => "\ntolerance = 1e-11",
        _ => "",
    };
    let mut text = format!(
        "duration = 2.0\n[stepping]\nmethod = \"{}\"\nstep = 0.004{tolerance}\n[record]\n{record}\n[effects]\n\
         gyroscopic = {gyroscopic}\ngravity = [0.3, -9.81, 0.1]\ndamping = {{ angular = 0.07, linear = 0.2 }}\n",
        info.name
    );
    for k in 0..11_u32 {
        let x = f64::from(k);
        let pivot = if heavy && k % 2 == 0 {
            "pivot = [0.1, -0.4, 0.2]"
        } else {
            ""
        };
        let _ = write!(
            text,
            "[[body]]\nname = \"b{k}\"\nmass = {}\ninertia = [[1.3, 0.1, 0.02], [0.1, {}, -0.2], [0.02, -0.2, 1.9]]\n\
             orientation = {{ axis = [1, {x}, -2], degrees = {} }}\nangular_velocity = [{}, -1.7, {}]\n{pivot}\n",
            1.0 + 0.3 * x,
            1.6 + 0.01 * x,
            17.0 * x,
            0.3 * x - 1.0,
            2.0 - 0.7 * x,
        );
    }
    text += "[[event]]\nat = 0.5013\nbody = \"b3\"\nimpulse = [1, 2, -3]\npoint = { body = [0.1, 0.5, 0] }\n";
    parse(&text)
}

const ALL: &str = "rate = 50";

#[test]
fn every_method_has_the_bits_it_had() {
    let mut text = String::new();
    for info in METHODS.iter().map(|method| method.info()) {
        let _ = write!(text, "{}", info.name);
        for (gyroscopic, heavy) in [(true, false), (true, true), (false, false), (false, true)] {
            // A method that refuses one has no bits there.
            let hash = scene(info, ALL, gyroscopic, heavy)
                .map(|scene| hashes(&scene, 1, Recording::On(Hash::new())).0);
            let _ = match hash.flatten() {
                Some(hash) => write!(text, " {hash:016x}"),
                None => write!(text, " refused"),
            };
        }
        text += "\n";
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/same_bits.txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    for (now, then) in text.lines().zip(there.lines()) {
        assert_eq!(
            now, then,
            "other bits than before, or than in another build"
        );
    }
    assert_eq!(text, there);
}

#[test]
fn runs_and_recording_change_no_bit() {
    for info in METHODS.iter().map(|method| method.info()) {
        let of =
            |record| scene(info, record, true, false).unwrap_or_else(|| panic!("{}", info.name));
        let (all, few) = (of(ALL), of("rate = 3\nstate = 2\nstreams = [\"omega\"]"));
        let (first, end) = hashes(&all, 1, Recording::On(Hash::new()));
        assert_eq!(
            hashes(&all, 1, Recording::On(Hash::new())),
            (first, end),
            "{}: run again",
            info.name
        );
        assert_eq!(
            hashes(&all, 1, Recording::Off).1,
            end,
            "{}: not recorded",
            info.name
        );
        assert_eq!(
            hashes(&few, 1, Recording::Off).1,
            end,
            "{}: other streams",
            info.name
        );
    }
}

#[test]
fn threads_change_no_bit() {
    // 88 bodies are 11 groups, and 1,000 steps of them are worth threads.
    for name in [
        "rk4",
        "rapier",
        "dlm",
        "rkn4",
        "dmv6",
        "dop853",
        "closed-form",
    ] {
        let mut text = format!(
            "duration = 1.0\n[stepping]\nmethod = \"{name}\"\nstep = 0.001\n[record]\nstate = 100\nrate = 20\n[effects]\ngyroscopic = true\n"
        );
        for k in 0..88 {
            let x = f64::from(k);
            let _ = write!(
                text,
                "[[body]]\nname = \"b{k}\"\nmass = 1.0\ninertia = [1.0, {}, 1.9]\nangular_velocity = [{}, 1.0, 0.2]\n",
                1.2 + 0.005 * x,
                0.1 * x
            );
        }
        let scene = parse(&text).unwrap_or_else(|| panic!("{name}"));
        let one = hashes(&scene, 1, Recording::On(Hash::new()));
        for threads in [2, 3, 7, 64] {
            assert_eq!(
                hashes(&scene, threads, Recording::On(Hash::new())),
                one,
                "{name} on {threads}"
            );
        }
    }
}
