//! The limit: the same numbers as flat columns through LZ4, and nothing else.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

/// Packs and writes; how many bytes there are then.
pub fn pack(chunks: &[Vec<u8>], path: &Path) -> usize {
    let file = File::create(path).expect("a place for files");
    let mut file = BufWriter::with_capacity(1 << 20, file);
    let mut bytes = 0;
    for chunk in chunks {
        let packed = lz4_flex::block::compress(chunk);
        bytes += packed.len();
        file.write_all(&packed).expect("room for files");
    }
    file.flush().expect("room for files");
    bytes
}
