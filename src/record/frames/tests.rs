//! What goes through stencils is, to the last byte, what Rerun and Arrow make of it.

use super::*;
use crate::record::Destination;
use crate::record::columns::{Column, Times, numbers, strips, texts, vectors};
use crate::trace::Instant;
use rerun::external::re_log_types::StoreKind;

/// Chunks of two entities: columns of every kind, some of them empty, rows of several counts, times that go back.
fn write(path: &std::path::Path, mut put: impl FnMut(&mut Frames, &StoreId, &Rows<'_>)) -> Vec<u8> {
    let to = Destination::new(path);
    let mut frames = Frames::new(Output::open(&to).unwrap()).unwrap();
    let store = StoreId::new(StoreKind::Recording, "test", "a");
    let mut next = 1 << 64;
    for chunk in 0..72_usize {
        // One row more now and then, none of some column, times that go back.
        let count = [5, 64, 1, 9][chunk % 7 % 4];
        let mut times = Times::default();
        for row in 0..count {
            let back = if chunk % 9 == 4 && row == 2 { 3.0 } else { 0.0 };
            times.push(Instant {
                time: chunk as f64 * 7.0 + row as f64 - back,
                step: (chunk * 10 + row) as u64,
            });
        }
        let x = |k: usize| (k * 37 + chunk) as f64 * 0.618;
        let some = Ends::uniform(count, usize::from(chunk % 5 != 2));
        let filled = if chunk % 5 == 2 { 0 } else { count };
        let partial = ComponentDescriptor::partial;
        let three: Vec<f64> = (0..3 * count).map(x).collect();
        let arrows: Vec<f32> = (0..3 * filled).map(|k| x(k) as f32).collect();
        let turns: Vec<f32> = (0..4 * count).map(|k| x(k) as f32).collect();
        let mut columns: Vec<Column> = vec![
            numbers(partial("b"), three, Ends::uniform(count, 3)),
            vectors(partial("c"), arrows.clone(), 3, some.clone()),
            vectors(partial("a"), turns, 4, Ends::uniform(count, 1)),
        ];
        if chunk % 2 == 0 {
            let whole: Vec<u64> = (0..count as u64).collect();
            columns.push(counts(partial("e"), whole, Ends::uniform(count, 1)));
            let points = Ends::uniform(filled, 1);
            columns.push(strips(partial("d"), arrows, points, some));
        }
        let words = (0..filled).map(|k| "é".repeat((k + chunk) % 4)).collect();
        columns.push(texts(
            partial("f"),
            words,
            Ends::uniform(count, usize::from(filled > 0)),
        ));
        let path = ["/bodies/one", "/bodies/two", "/bodies/other"][chunk % 3];
        let rows = Rows {
            path,
            chunk: next,
            first: next + 1,
            times: &times,
            columns: &columns,
        };
        next += 1 + count as u128;
        put(&mut frames, &store, &rows);
        frames.check(&store).unwrap();
    }
    frames.finish(&store).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn stencils_write_what_rerun_would() {
    let folder = tempfile::tempdir().unwrap();
    let built = write(&folder.path().join("a.rrd"), |frames, store, rows| {
        frames
            .put_built(store, &rows.chunk().unwrap(), None)
            .unwrap();
    });
    let mut through = 0;
    let own = write(&folder.path().join("b.rrd"), |frames, store, rows| {
        let form = rows.form();
        let mut stream = Vec::new();
        through += usize::from(frames.stencils.write(&form, rows, &mut stream));
        frames.put_rows(store, rows, form).unwrap();
    });
    let differs = built.iter().zip(&own).position(|(a, b)| a != b);
    assert!(built == own, "byte {differs:?} of {}", built.len());
    assert!(through > 20, "{through}");
}

#[test]
fn what_waits_is_packed_alike() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("a.rrd"), |frames, store, rows| {
        let chunk = rows.chunk().unwrap().to_arrow_msg().unwrap();
        let mut built = Vec::new();
        encode(&LogMsg::ArrowMsg(store.clone(), chunk), &mut built).unwrap();
        for _ in 0..3 {
            assert!(frames.packed(store, rows).unwrap() == built);
        }
    });
}
