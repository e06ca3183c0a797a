//! A sink on a thread of its own: the same calls in the same order, errors and panics that come back, and a stepper that
//! waits where the sink is slow.

mod common;

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use torquescope::scene::Scene;
use torquescope::sim::{SimError, Simulation};
use torquescope::trace::{Instant, Note, Sample, Sink, SinkError, Track, beside};

/// Every call, as it was made.
#[derive(Default)]
struct Calls(Vec<String>);

impl Sink for Calls {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        self.0.push(format!("{track:?}"));
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        self.0.push(format!("{at:?} {bodies:?} {samples:?}"));
        Ok(())
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.0.push(format!("{at:?} {note:?}"));
        Ok(())
    }

    fn wants_fingerprints(&self) -> bool {
        true
    }

    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.0.push(format!("{at:?} {hash}"));
        Ok(())
    }
}

#[test]
fn the_sink_gets_the_same_calls_in_the_same_order() {
    for name in ["cone.toml", "click_storm.toml", "spheres.toml"] {
        let scene = common::load(name);
        let (mut here, mut there) = (Calls::default(), Calls::default());
        Simulation::new(&scene).run(&mut here).1.unwrap();
        let ran = beside(&mut there, |sink| Simulation::new(&scene).run(sink));
        ran.unwrap().1.unwrap();
        assert!(here.0.len() > 100, "{name}");
        assert!(here.0 == there.0, "{name}");
    }
}

/// Bodies whose states fill many batches.
fn long() -> Scene {
    let source = "duration = 20.0\n[record]\nstreams = []\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 2, 2.5]\nangular_velocity = [1, 2, 3]\n";
    Scene::parse("long", "long", source).unwrap()
}

/// Looks at each stretch that it is given.
struct Each<F>(F);

impl<F: FnMut(usize) -> Result<(), SinkError>> Sink for Each<F> {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        (self.0)(track.instants.len())
    }

    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}

/// What a stretch gave is not kept back while the next, which may be long, is computed.
#[test]
fn what_has_come_is_handed_over_before_more_is_computed() {
    let taken = AtomicUsize::new(0);
    let mut sink = Each(|instants| {
        taken.fetch_add(instants, Ordering::SeqCst);
        Ok(())
    });
    let scene = long();
    let start = Simulation::new(&scene).subjects()[0].start;
    beside(&mut sink, |sink| {
        let at = Instant { time: 0.0, step: 0 };
        let one = Track {
            bodies: 0..1,
            instants: &[at],
            motions: &[start],
        };
        for given in 1..=3 {
            std::thread::sleep(std::time::Duration::from_millis(20));
            sink.motions(&one).unwrap();
            sink.caught_up().unwrap();
            // Nothing more comes.
            let since = std::time::Instant::now();
            while taken.load(Ordering::SeqCst) < given {
                assert!(since.elapsed().as_secs() < 60, "{given} is kept back");
                std::thread::yield_now();
            }
        }
    })
    .unwrap();
}

#[test]
fn an_error_of_the_sink_stops_the_run() {
    let mut count = 0;
    let mut sink = Each(|_| {
        count += 1;
        match count {
            3 => Err(SinkError("no room".to_owned())),
            _ => Ok(()),
        }
    });
    let scene = long();
    let (outcome, done) = beside(&mut sink, |sink| Simulation::new(&scene).run(sink))
        .unwrap_or_else(|why| {
            // It may also come only at the end; 20,000 states are too many for that.
            panic!("told too late: {why}")
        });
    match done {
        Err(SimError::Sink(why)) => assert_eq!(why.to_string(), "no room"),
        other => panic!("{other:?}"),
    }
    assert!(outcome.steps < 20_000, "{}", outcome.steps);
    assert_eq!(count, 3);
}

#[test]
fn an_error_in_the_last_batch_is_not_lost() {
    let mut sink = Each(|_| Err(SinkError("no room".to_owned())));
    let mut scene = long();
    scene.duration = 0.1;
    let ran = beside(&mut sink, |sink| Simulation::new(&scene).run(sink));
    assert_eq!(ran.err().unwrap().to_string(), "no room");
}

#[test]
fn a_panic_of_the_sink_is_one_here() {
    let panicked = std::panic::catch_unwind(|| {
        let mut sink = Each(|_| panic!("on purpose"));
        let scene = long();
        let _ = beside(&mut sink, |sink| Simulation::new(&scene).run(sink));
    });
    let panic = panicked.err().unwrap();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"on purpose"));
}

#[test]
fn a_panic_of_the_stepper_ends_both() {
    let panicked = std::panic::catch_unwind(|| {
        let mut sink = Calls::default();
        let _ = beside(&mut sink, |_| panic!("on purpose"));
    });
    assert!(panicked.is_err());
}

#[test]
fn where_the_sink_is_slow_the_stepper_waits() {
    let (taken, sent) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
    let farthest = Mutex::new(0);
    let mut sink = {
        let (taken, sent) = (Arc::clone(&taken), Arc::clone(&sent));
        let farthest = &farthest;
        Each(move |instants| {
            std::thread::sleep(std::time::Duration::from_millis(2));
            let ahead = sent.load(Ordering::SeqCst) - taken.load(Ordering::SeqCst);
            let mut farthest = farthest.lock().unwrap();
            *farthest = ahead.max(*farthest);
            taken.fetch_add(instants, Ordering::SeqCst);
            Ok(())
        })
    };
    // 400 tracks of 1,000 states of 120 bytes: 48 MB.
    let instants: Vec<Instant> = (0..1000).map(|step| Instant { time: 0.0, step }).collect();
    let scene = long();
    let simulation = Simulation::new(&scene);
    let motions = vec![simulation.subjects()[0].start; 1000];
    let done = beside(&mut sink, |sink| {
        (0..400).try_for_each(|_| {
            sent.fetch_add(1000, Ordering::SeqCst);
            sink.motions(&Track {
                bodies: 0..1,
                instants: &instants,
                motions: &motions,
            })
        })
    });
    done.unwrap().unwrap();
    drop(sink);
    assert_eq!(taken.load(Ordering::SeqCst), 400_000);
    // Four batches of a megabyte wait, one is filled and one is being taken: seven megabytes of 120 bytes a state.
    let farthest = *farthest.lock().unwrap();
    assert!(
        (1000..80_000).contains(&farthest),
        "{farthest} states ahead"
    );
}

#[cfg(feature = "cli")]
#[test]
fn a_recording_is_the_same_byte_for_byte() {
    use torquescope::record::{Destination, Heading, Recorder};
    let folder = tempfile::tempdir().unwrap();
    let scene = common::load("cone.toml");
    let write = |name: &str, run: &dyn Fn(&mut Recorder)| {
        let path = folder.path().join(name);
        let simulation = Simulation::new(&scene);
        let heading = Heading::of(&scene, &simulation);
        let mut recorder =
            Recorder::create(&Destination::new(&path), &heading, simulation.subjects()).unwrap();
        run(&mut recorder);
        recorder.finish().unwrap();
        std::fs::read(path).unwrap()
    };
    let here = write("here.rrd", &|recorder| {
        Simulation::new(&scene).run(recorder).1.unwrap();
    });
    let there = write("there.rrd", &|recorder| {
        let ran = beside(recorder, |sink| Simulation::new(&scene).run(sink));
        ran.unwrap().1.unwrap();
    });
    assert!(here.len() > 1 << 20);
    assert!(here == there);
}
