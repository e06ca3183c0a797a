//! Where a recording goes: under a name of its own until it is whole, then to its name at once.
//!
//! `cone.rrd` is written as `cone.partial.rrd` beside it, and renamed when its last byte is there. Whoever
//! is killed leaves a partial file, which opens, and which `torquescope recover` makes whole. What waits in
//! memory longer than it may is written behind the end of what is settled, and written over by it: what a
//! whole file holds does not depend on the clock.

use super::{RecordError, is_recording};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where a recording is to go, and on what terms.
#[derive(Clone, Debug)]
pub struct Destination {
    pub path: PathBuf,
    /// Its name until it is whole, where that is not the usual one.
    pub meanwhile: Option<PathBuf>,
    /// Whether a recording that is there may be replaced.
    pub replace: bool,
    /// How much of the last, in wall time, may be lost when the program is killed.
    pub keeps_up: Duration,
}

/// What a killed program may lose where nobody says.
const HALF_A_SECOND: Duration = Duration::from_millis(500);

impl Destination {
    /// A name that is free.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            meanwhile: None,
            replace: false,
            keeps_up: HALF_A_SECOND,
        }
    }

    /// The same, whatever recording is there.
    pub fn replacing(self, replace: bool) -> Self {
        Self { replace, ..self }
    }

    /// Says before anything is computed what would be said when it is opened.
    pub fn check(&self) -> Result<(), RecordError> {
        must_be_free(&self.path, self.replace)
    }
}

/// The name of a recording that is being written.
pub fn partial_name(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default();
    let mut name = stem.to_os_string();
    name.push(".partial.rrd");
    path.with_file_name(name)
}

/// Takes bytes, one after another.
pub struct Output {
    kind: Kind,
    /// Settled, and not yet in the file.
    buffer: Vec<u8>,
}

enum Kind {
    Nowhere,
    /// A device or a pipe: there is nothing to rename, and no way back.
    Stream(File),
    Partial(Partial),
}

struct Partial {
    file: File,
    /// Its name meanwhile.
    path: PathBuf,
    /// And in the end.
    last: PathBuf,
    replace: bool,
    /// Bytes of it that are settled.
    settled: u64,
    /// Whether there are others behind them.
    tail: bool,
}

/// Bytes that are written at once.
const BUFFER: usize = 1 << 20;

impl Output {
    pub fn nowhere() -> Self {
        Self::of(Kind::Nowhere)
    }

    fn of(kind: Kind) -> Self {
        Self {
            kind,
            buffer: Vec::new(),
        }
    }

    pub fn open(to: &Destination) -> Result<Self, RecordError> {
        must_be_free(&to.path, to.replace)?;
        let fail = |path: &Path, error: &std::io::Error| RecordError::Create {
            path: path.display().to_string(),
            why: error.to_string(),
        };
        if std::fs::metadata(&to.path).is_ok_and(|data| !data.is_file()) {
            let file = OpenOptions::new().write(true).open(&to.path);
            let file = file.map_err(|error| fail(&to.path, &error))?;
            return Ok(Self::of(Kind::Stream(file)));
        }
        // By the name of what is replaced, not of a link to it.
        let last = std::fs::canonicalize(&to.path).unwrap_or_else(|_| to.path.clone());
        let path = to.meanwhile.clone().unwrap_or_else(|| partial_name(&last));
        let file = Partial::create(&path, to.replace)?;
        let file = file.map_err(|error| fail(&to.path, &error))?;
        Ok(Self::of(Kind::Partial(Partial {
            file,
            path,
            last,
            replace: to.replace,
            settled: 0,
            tail: false,
        })))
    }

    /// Where the bytes are as long as they are not whole, if anywhere.
    pub fn partial(&self) -> Option<&Path> {
        match &self.kind {
            Kind::Partial(partial) => Some(&partial.path),
            Kind::Nowhere | Kind::Stream(_) => None,
        }
    }

    pub fn write(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        if matches!(self.kind, Kind::Nowhere) {
            return Ok(());
        }
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() < BUFFER {
            return Ok(());
        }
        self.settle()
    }

    /// Gives everything settled to the system.
    fn settle(&mut self) -> std::io::Result<()> {
        match &mut self.kind {
            Kind::Nowhere => {}
            Kind::Stream(file) => file.write_all(&self.buffer)?,
            Kind::Partial(partial) => partial.settle(&self.buffer)?,
        }
        self.buffer.clear();
        Ok(())
    }

    /// Gives everything settled to the system, and behind it what is not: the next settled bytes take its
    /// place.
    pub fn tail(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.settle()?;
        let Kind::Partial(partial) = &mut self.kind else {
            return Ok(());
        };
        partial.cut_tail()?;
        partial.tail = true;
        partial.file.write_all(bytes)
    }

    /// Everything is there: the file gets its name.
    pub fn finish(&mut self) -> std::io::Result<()> {
        self.settle()?;
        match &mut self.kind {
            Kind::Nowhere => Ok(()),
            Kind::Stream(file) => file.flush(),
            Kind::Partial(partial) => partial.finish(),
        }
    }

    /// Takes away a file in which there is nothing worth keeping.
    pub fn discard(&mut self) {
        if let Kind::Partial(partial) = &self.kind
            && partial.is_in_place()
        {
            // If it cannot be removed, it stays: as good as any other partial file.
            let _ = std::fs::remove_file(&partial.path);
        }
    }

    /// Gives to the system what can still be given, when no more will come.
    pub fn keep(&mut self) {
        // It is said elsewhere why no more comes.
        let _ = self.settle();
    }
}

impl Partial {
    /// A file for nobody else.
    fn create(path: &Path, replace: bool) -> Result<std::io::Result<File>, RecordError> {
        let shown = || path.display().to_string();
        let is_left = std::fs::metadata(path).is_ok_and(|data| data.len() > 0);
        let open = || {
            // Not emptied before it is known to be nobody's.
            let mut options = OpenOptions::new();
            let options = options.read(true).write(true).create(true).truncate(false);
            options.open(path)
        };
        let file = match open() {
            Ok(file) => file,
            Err(error) => return Ok(Err(error)),
        };
        // Where files cannot be locked, nothing is known of others.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(RecordError::Busy { path: shown() });
        }
        if is_left && !replace {
            return Err(RecordError::Left { path: shown() });
        }
        Ok(file.set_len(0).map(|()| file))
    }

    fn settle(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        if bytes.is_empty() {
            return Ok(());
        }
        self.cut_tail()?;
        self.file.write_all(bytes)?;
        self.settled += bytes.len() as u64;
        Ok(())
    }

    fn cut_tail(&mut self) -> std::io::Result<()> {
        if self.tail {
            self.file.set_len(self.settled)?;
            self.file.seek(SeekFrom::Start(self.settled))?;
            self.tail = false;
        }
        Ok(())
    }

    /// Whether its name still leads to it.
    fn is_in_place(&self) -> bool {
        let Ok(own) = self.file.try_clone() else {
            return false;
        };
        let own = same_file::Handle::from_file(own);
        let named = same_file::Handle::from_path(&self.path);
        matches!((own, named), (Ok(own), Ok(named)) if own == named)
    }

    fn finish(&mut self) -> std::io::Result<()> {
        self.cut_tail()?;
        if !self.is_in_place() {
            self.write_again()?;
        }
        if self.replace {
            return std::fs::rename(&self.path, &self.last);
        }
        let named = tempfile::TempPath::try_from_path(&self.path)?;
        match named.persist_noclobber(&self.last) {
            Ok(()) => Ok(()),
            Err(refused) => {
                // Left where it is.
                refused.path.keep()?;
                Err(refused.error)
            }
        }
    }

    /// Somebody has removed it meanwhile; what was written can still be read.
    fn write_again(&mut self) -> std::io::Result<()> {
        let mut again = OpenOptions::new();
        let mut again = again.write(true).create_new(true).open(&self.path)?;
        self.file.seek(SeekFrom::Start(0))?;
        std::io::copy(&mut self.file, &mut again)?;
        again.flush()
    }
}

/// What is there must not be lost: neither a recording, unless it may be replaced, nor anything else.
fn must_be_free(path: &Path, replace: bool) -> Result<(), RecordError> {
    let is_file = std::fs::metadata(path).is_ok_and(|data| data.is_file() && data.len() > 0);
    if !is_file {
        return Ok(());
    }
    let is_recording = is_recording(path);
    let path = path.display().to_string();
    if !is_recording {
        return Err(RecordError::Occupied { path });
    }
    match replace {
        true => Ok(()),
        false => Err(RecordError::Exists { path }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::MAGIC;
    use super::*;

    fn write(to: &Destination, parts: &[&[u8]]) -> Output {
        let mut output = Output::open(to).unwrap();
        for part in parts {
            output.write(part).unwrap();
        }
        output
    }

    #[test]
    fn the_name_appears_when_everything_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[MAGIC, b" first"]);
        assert!(!to.path.exists() && partial_name(&to.path).exists());
        output.finish().unwrap();
        assert!(to.path.exists() && !partial_name(&to.path).exists());
        assert_eq!(std::fs::read(&to.path).unwrap(), b"RRF2 first");
        // Now it is taken.
        assert!(matches!(Output::open(&to), Err(RecordError::Exists { .. })));
        let to = to.replacing(true);
        write(&to, &[MAGIC, b" second"]).finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"RRF2 second");
        std::fs::write(&to.path, "a letter").unwrap();
        assert!(matches!(
            Output::open(&to),
            Err(RecordError::Occupied { .. })
        ));
    }

    #[test]
    fn settled_bytes_take_the_place_of_a_tail() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"settled"]);
        let now = || std::fs::read(partial_name(&to.path)).unwrap();
        output.tail(b" a long tail").unwrap();
        assert_eq!(now(), b"settled a long tail");
        output.tail(b" another").unwrap();
        assert_eq!(now(), b"settled another");
        output.write(b", more").unwrap();
        assert_eq!(now(), b"settled another");
        output.tail(b"!").unwrap();
        assert_eq!(now(), b"settled, more!");
        output.finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"settled, more");
    }

    #[test]
    fn what_others_write_or_have_left_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"mine"]);
        output.keep();
        for replace in [false, true] {
            let other = Output::open(&to.clone().replacing(replace));
            assert!(matches!(other, Err(RecordError::Busy { .. })));
        }
        drop(output);
        assert!(matches!(Output::open(&to), Err(RecordError::Left { .. })));
        assert_eq!(std::fs::read(partial_name(&to.path)).unwrap(), b"mine");
        assert!(Output::open(&to.replacing(true)).is_ok());
    }

    #[test]
    fn a_file_that_is_removed_meanwhile_is_there_in_the_end() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"before"]);
        output.tail(b"").unwrap();
        std::fs::remove_file(partial_name(&to.path)).unwrap();
        output.write(b", after").unwrap();
        output.finish().unwrap();
        assert_eq!(std::fs::read(&to.path).unwrap(), b"before, after");
    }

    #[test]
    fn a_name_that_is_taken_meanwhile_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let to = Destination::new(folder.path().join("a.rrd"));
        let mut output = write(&to, &[b"mine"]);
        std::fs::write(&to.path, "yours").unwrap();
        assert!(output.finish().is_err());
        assert_eq!(std::fs::read(&to.path).unwrap(), b"yours");
        assert_eq!(std::fs::read(partial_name(&to.path)).unwrap(), b"mine");
    }
}
