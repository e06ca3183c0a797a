//! What engines make of the same cases: the table that benches/peers/hard_cases.py wrote.

pub fn section() -> String {
    String::new()
}
