//! Any bytes are a log or are refused: rows with finite numbers and growing times, all that is wrong with a place.
#![no_main]

use libfuzzer_sys::fuzz_target;
use torquescope::log::{Options, Reader, Reading, bodies};

fuzz_target!(|bytes: &[u8]| {
    for reading in [Reading::AsDeclared, Reading::AsFound] {
        let options = Options { reading, ..Options::default() };
        let mut reader = match Reader::new("l", bytes, options) {
            Ok(reader) => reader,
            Err(why) => {
                assert!(why.to_string().starts_with("l:"));
                break;
            }
        };
        let (mut rows, mut times) = (0, Vec::new());
        loop {
            match reader.next_row() {
                Ok(Some(row)) => {
                    rows += 1;
                    times.resize(times.len().max(row.body + 1), f64::NEG_INFINITY);
                    assert!(row.time >= times[row.body]);
                    times[row.body] = row.time;
                }
                Ok(None) => break,
                Err(why) => {
                    assert!(why.to_string().starts_with("l:"));
                    break;
                }
            }
        }
        let report = reader.report();
        assert_eq!(report.rows, rows);
        assert!(report.to_string().lines().all(|line| line.starts_with("l:")));
    }
    if let Err(why) = bodies::read("b", bytes) {
        let said = why.to_string();
        assert!(said.lines().all(|line| line.starts_with("b:") || line.starts_with("  ")));
    }
});
