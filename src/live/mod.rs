//! Level 6: what is served to a browser.

pub mod page;
