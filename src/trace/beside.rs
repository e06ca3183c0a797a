//! A sink on a thread of its own, so that a stepper hardly waits for what is recorded.
//!
//! What is delivered is copied into batches of about a megabyte, or of what came within a tenth of a second; before more
//! has to be computed, of what came within a hundredth. A few of them may be on their way; then the stepper waits, so
//! nothing is lost and memory does not grow with the length of a run. The sink gets the same calls in the same order as
//! without it.

use super::{Instant, Motion, Note, Poses, Sample, Sink, SinkError, Track};
use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant as Clock};

/// Bytes of a batch: some hundred microseconds of work, beside which handing it over is nothing.
const BATCH: usize = 1 << 20;
/// How long a call waits for others at most, and a sink to hear that none comes.
const SOON: Duration = Duration::from_millis(100);
/// How long a call may have waited where it is not known when the next comes: handing a batch over takes some
/// microseconds.
const AT_ONCE: Duration = Duration::from_millis(10);
/// Batches that wait for the sink at most.
const WAITING: usize = 4;

/// Does `work` with a sink whose calls reach the real one on another thread. What goes wrong there comes back at a later
/// call, where there is one, and else from here; a panic there is one here.
pub fn beside<T>(
    sink: &mut (dyn Sink + Send),
    work: impl FnOnce(&mut dyn Sink) -> T,
) -> Result<T, SinkError> {
    let wants_fingerprints = sink.wants_fingerprints();
    std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(WAITING);
        let thread = std::thread::Builder::new().name("recording".to_owned());
        let thread = match thread.spawn_scoped(scope, move || relay(&receiver, sink)) {
            Ok(thread) => thread,
            Err(error) => {
                let why = format!(
                    "no thread to record on: {error}; end other programs, or allow more threads"
                );
                return Err(SinkError(why));
            }
        };
        let mut beside = Beside {
            batch: Batch::default(),
            sent: Clock::now(),
            to: Some((sender, thread)),
            wants_fingerprints,
        };
        let done = work(&mut beside);
        beside.finish().map(|()| done)
    })
}

/// The far end: what it came to.
type Far<'scope> = ScopedJoinHandle<'scope, Result<(), SinkError>>;

/// The near end.
struct Beside<'scope> {
    batch: Batch,
    /// When one was last sent.
    sent: Clock,
    /// The far end, as long as it takes anything.
    to: Option<(SyncSender<Batch>, Far<'scope>)>,
    wants_fingerprints: bool,
}

/// Calls in their order, and what they were given.
#[derive(Default)]
struct Batch {
    calls: Vec<Call>,
    samples: Vec<Sample>,
    bytes: usize,
}

enum Call {
    Motions {
        bodies: Range<usize>,
        instants: Vec<Instant>,
        motions: Vec<Motion>,
    },
    Poses(Poses),
    /// As many of the batch's samples as bodies.
    Samples(Instant, Range<usize>),
    Note(Instant, Note),
    Fingerprint(Instant, u64),
}

fn relay(batches: &Receiver<Batch>, sink: &mut (dyn Sink + Send)) -> Result<(), SinkError> {
    loop {
        match batches.recv_timeout(SOON) {
            Ok(batch) => batch.play(sink)?,
            Err(RecvTimeoutError::Timeout) => sink.idle()?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
    }
}

impl Batch {
    fn play(self, sink: &mut (dyn Sink + Send)) -> Result<(), SinkError> {
        let mut samples = self.samples.as_slice();
        for call in self.calls {
            match call {
                Call::Motions {
                    bodies,
                    instants,
                    motions,
                } => sink.motions(&Track {
                    bodies,
                    instants: &instants,
                    motions: &motions,
                })?,
                Call::Poses(poses) => sink.poses(poses)?,
                Call::Samples(at, bodies) => {
                    let (these, rest) = samples.split_at(bodies.len().min(samples.len()));
                    sink.samples(at, bodies, these)?;
                    samples = rest;
                }
                Call::Note(at, note) => sink.note(at, &note)?,
                Call::Fingerprint(at, hash) => sink.fingerprint(at, hash)?,
            }
        }
        Ok(())
    }
}

impl Beside<'_> {
    fn call(&mut self, call: Call, bytes: usize) -> Result<(), SinkError> {
        self.batch.calls.push(call);
        self.batch.bytes += bytes + size_of::<Call>();
        match self.batch.bytes < BATCH && self.sent.elapsed() < SOON {
            true => Ok(()),
            false => self.send(),
        }
    }

    /// Waits while too many batches do.
    fn send(&mut self) -> Result<(), SinkError> {
        let batch = std::mem::take(&mut self.batch);
        self.sent = Clock::now();
        match &self.to {
            Some((sender, _)) if sender.send(batch).is_err() => self.join(),
            _ => Ok(()),
        }
    }

    /// Sends the rest, and waits until all is done.
    fn finish(&mut self) -> Result<(), SinkError> {
        self.send()?;
        self.join()
    }

    fn join(&mut self) -> Result<(), SinkError> {
        let Some((sender, thread)) = self.to.take() else {
            return Ok(());
        };
        drop(sender);
        let joined = thread.join();
        joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

impl Sink for Beside<'_> {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        let bytes = size_of_val(track.instants) + size_of_val(track.motions);
        let call = Call::Motions {
            bodies: track.bodies.clone(),
            instants: track.instants.to_vec(),
            motions: track.motions.to_vec(),
        };
        self.call(call, bytes)
    }

    fn poses(&mut self, poses: Poses) -> Result<(), SinkError> {
        let bytes = poses.bytes;
        self.call(Call::Poses(poses), bytes)
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        self.batch.samples.extend_from_slice(samples);
        self.call(Call::Samples(at, bodies), size_of_val(samples))
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        let bytes = size_of::<Note>() + note.text.len();
        self.call(Call::Note(at, note.clone()), bytes)
    }

    fn caught_up(&mut self) -> Result<(), SinkError> {
        match self.batch.calls.is_empty() || self.sent.elapsed() < AT_ONCE {
            true => Ok(()),
            false => self.send(),
        }
    }

    fn wants_fingerprints(&self) -> bool {
        self.wants_fingerprints
    }

    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.call(Call::Fingerprint(at, hash), 0)
    }
}
