//! A trace kept in memory, to be delivered again; and sinks that keep nothing.

use std::ops::Range;
use torquescope::scene::Scene;
use torquescope::sim::Simulation;
use torquescope::trace::{Instant, Motion, Note, Poses, Sample, Sink, SinkError, Subject, Track};

/// Every call, in order.
#[derive(Default)]
pub struct Kept {
    calls: Vec<Call>,
}

enum Call {
    Motions(Range<usize>, Vec<Instant>, Vec<Motion>),
    Samples(Instant, Range<usize>, Vec<Sample>),
    Note(Instant, Note),
    Fingerprint(Instant, u64),
}

impl Kept {
    pub fn of(scene: &Scene) -> Self {
        let mut kept = Self::default();
        let (_, done) = Simulation::new(scene).run(&mut kept);
        done.unwrap_or_else(|error| panic!("{error}"));
        kept
    }

    pub fn play(&self, sink: &mut dyn Sink) -> Result<(), SinkError> {
        self.calls.iter().try_for_each(|call| match call {
            Call::Motions(bodies, instants, motions) => sink.motions(&Track {
                bodies: bodies.clone(),
                instants,
                motions,
            }),
            Call::Samples(at, bodies, samples) => sink.samples(*at, bodies.clone(), samples),
            Call::Note(at, note) => sink.note(*at, note),
            Call::Fingerprint(at, hash) => sink.fingerprint(*at, *hash),
        })
    }

    /// The numbers that a recording has of the state: f32 pose, f64 angular velocity, both times; column by
    /// column, so many rows at a time.
    pub fn state(&self, rows: usize) -> Vec<Vec<u8>> {
        let mut all: Vec<(&Instant, &Motion)> = Vec::new();
        for call in &self.calls {
            if let Call::Motions(_, instants, motions) = call {
                all.extend(instants.iter().zip(motions));
            }
        }
        let chunk = |rows: &[(&Instant, &Motion)]| {
            let mut bytes = Vec::new();
            let single = |x: &f64| (*x as f32).to_le_bytes();
            for (_, m) in rows {
                bytes.extend(m.position_w.iter().flat_map(single));
            }
            for (_, m) in rows {
                bytes.extend(m.q_wb.coords.iter().flat_map(single));
            }
            for (_, m) in rows {
                bytes.extend(m.omega_w.iter().flat_map(|x| x.to_le_bytes()));
            }
            for (at, _) in rows {
                bytes.extend(at.nanoseconds().to_le_bytes());
            }
            for (at, _) in rows {
                bytes.extend(at.step.to_le_bytes());
            }
            bytes
        };
        all.chunks(rows).map(chunk).collect()
    }

    /// The numbers of the derived streams, f64, column by column, so many rows at a time.
    pub fn derived(&self, subject: &Subject, rows: usize) -> Vec<Vec<u8>> {
        let mut all: Vec<(&Instant, &Sample)> = Vec::new();
        for call in &self.calls {
            if let Call::Samples(at, _, samples) = call {
                all.extend(samples.iter().map(|sample| (at, sample)));
            }
        }
        let chunk = |rows: &[(&Instant, &Sample)]| {
            let mut bytes: Vec<u8> = Vec::new();
            let mut values = Vec::new();
            let streams = rows.first().map(|(_, sample)| sample.due);
            for quantity in streams.iter().flat_map(|streams| streams.quantities()) {
                values.clear();
                for (_, sample) in rows {
                    (quantity.write)(subject, sample, &mut values);
                }
                bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
            }
            for (at, _) in rows {
                bytes.extend(at.nanoseconds().to_le_bytes());
            }
            for (at, _) in rows {
                bytes.extend(at.step.to_le_bytes());
            }
            bytes
        };
        all.chunks(rows).map(chunk).collect()
    }
}

impl Sink for Kept {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        let (instants, motions) = (track.instants.to_vec(), track.motions.to_vec());
        let call = Call::Motions(track.bodies.clone(), instants, motions);
        self.calls.push(call);
        Ok(())
    }

    fn samples(
        &mut self,
        at: Instant,
        bodies: Range<usize>,
        samples: &[Sample],
    ) -> Result<(), SinkError> {
        self.calls.push(Call::Samples(at, bodies, samples.to_vec()));
        Ok(())
    }

    fn note(&mut self, at: Instant, note: &Note) -> Result<(), SinkError> {
        self.calls.push(Call::Note(at, note.clone()));
        Ok(())
    }

    fn wants_fingerprints(&self) -> bool {
        true
    }

    fn fingerprint(&mut self, at: Instant, hash: u64) -> Result<(), SinkError> {
        self.calls.push(Call::Fingerprint(at, hash));
        Ok(())
    }
}

/// Takes everything and keeps nothing; motions are computed, or not even that.
pub struct Nowhere {
    pub computes: bool,
}

impl Sink for Nowhere {
    fn motions(&mut self, track: &Track<'_>) -> Result<(), SinkError> {
        std::hint::black_box(track.motions);
        Ok(())
    }

    fn poses(&mut self, poses: Poses) -> Result<(), SinkError> {
        if self.computes {
            std::hint::black_box((poses.motions)());
        }
        Ok(())
    }

    fn samples(&mut self, _: Instant, _: Range<usize>, _: &[Sample]) -> Result<(), SinkError> {
        Ok(())
    }

    fn note(&mut self, _: Instant, _: &Note) -> Result<(), SinkError> {
        Ok(())
    }
}
