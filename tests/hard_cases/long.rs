//! A very long time.

pub fn section() -> String {
    String::new()
}
