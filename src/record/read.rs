//! Recordings read back: what they were made from.

use super::provenance::{Parts, Provenance};
use super::rrd::APPLICATION;
use super::{MAGIC, RERUN_VERSION};
use re_protos::common::v1alpha1::Compression;
use re_protos::log_msg::v1alpha1::ArrowMsg;
use re_protos::log_msg::v1alpha1::log_msg::Msg;
use rerun::external::arrow::ipc::root_as_message;
use rerun::external::re_log_encoding::{
    CachingApplicationIdInjector, Decodable as _, DecoderTransport, MessageHeader, MessageKind,
    StreamHeader, ToApplication as _,
};
use rerun::external::re_log_types::{LogMsg, StoreId};
use rerun::log::Chunk;
use std::cell::Cell;
use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Once;

/// A file of recordings that this program made.
#[derive(Clone, Debug)]
pub struct Made {
    /// In the order of the file.
    pub recordings: Vec<Provenance>,
    pub(super) stores: Vec<StoreId>,
    /// Why there is less than was meant to be, where that is so.
    pub cut: Option<String>,
}

/// Why a file is not read as recordings of this program.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    #[error("{path}: cannot be read: {why}; `torquescope run SCENE` makes recordings")]
    Unreadable { path: String, why: String },
    #[error("{path}: is no Rerun recording; `torquescope run SCENE` makes one from a scene")]
    NoRecording { path: String },
    #[error("{path}: is cut or broken before its scene: {why}; there is nothing in it to run")]
    Cut { path: String, why: String },
    #[error(
        "{path}: was made by {by}, not by torquescope: there is no scene in it to run; `torquescope view` opens it"
    )]
    Foreign { path: String, by: String },
    #[error(
        "{path}: holds no scene: `torquescope cost` made it, or a version that stored none; there is nothing in it to run"
    )]
    NoScene { path: String },
}

/// What a file begins with tells a recording.
pub fn is_recording(path: &Path) -> bool {
    let mut magic = [0; MAGIC.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut magic));
    read.is_ok() && &magic == MAGIC
}

/// The messages of a file, one after another, until it ends or cannot be read.
pub(super) struct Messages {
    decoder: Box<dyn Iterator<Item = Result<LogMsg, String>> + Send>,
    /// What stopped it.
    pub stopped: Option<String>,
    /// Whether the file's mark of its end comes after the last message.
    pub ended: bool,
}

/// Bytes of one message at most, unpacked: chunks are written by a few hundred rows, and a scene's
/// text is no longer than 64 MB.
const LARGEST_MESSAGE: u64 = 1 << 30;
/// LZ4 packs no tighter.
const TIGHTEST: u64 = 255;

impl Messages {
    pub fn open(path: &Path) -> std::io::Result<Self> {
        let file = File::open(path)?;
        let bytes = file.metadata()?.len();
        let (end, ended) = end_of_messages(&mut BufReader::new(&file), bytes)?;
        let mut file = file;
        file.seek(SeekFrom::Start(0))?;
        let reader = BufReader::with_capacity(1 << 20, file.take(end));
        let mut names = CachingApplicationIdInjector::default();
        // A length that says more than there can be asks for memory that there is not.
        let most = LARGEST_MESSAGE.min(TIGHTEST * bytes + 64);
        let decoder = DecoderTransport::decode_lazy(reader).map(move |message| {
            let message = message.map_err(|error| error.to_string())?;
            if message.byte_size_uncompressed() > most {
                return Err("a message in it is longer than it can be".to_owned());
            }
            if let Msg::ArrowMsg(message) = &message {
                must_be_whole(message)?;
            }
            let message = message.to_application((&mut names, None));
            message.map_err(|error| error.to_string())
        });
        Ok(Self {
            decoder: Box::new(decoder),
            stopped: None,
            ended,
        })
    }

    pub fn next(&mut self) -> Option<LogMsg> {
        if self.stopped.is_some() {
            return None;
        }
        match quietly(|| self.decoder.next()) {
            Ok(None) => None,
            Ok(Some(Ok(message))) => Some(message),
            Ok(Some(Err(why))) | Err(why) => self.stop(&why),
        }
    }

    fn stop<T>(&mut self, why: &str) -> Option<T> {
        self.stopped = Some(why.replace(char::is_control, " "));
        None
    }

    /// The next chunk of a recording that is read, with its store.
    pub fn next_chunk(&mut self) -> Option<(StoreId, Chunk)> {
        loop {
            let LogMsg::ArrowMsg(store, message) = self.next()? else {
                continue;
            };
            if !store.is_recording() {
                continue;
            }
            return match quietly(|| Chunk::from_arrow_msg(&message)) {
                Ok(Ok(chunk)) => Some((store, chunk)),
                Ok(Err(error)) => self.stop(&error.to_string()),
                Err(why) => self.stop(&why),
            };
        }
    }
}

/// Whether the parts of an Arrow message say no more of their lengths than there is: the decoder asks for
/// as much memory as they say.
fn must_be_whole(message: &ArrowMsg) -> Result<(), String> {
    let size = usize::try_from(message.uncompressed_size).unwrap_or(usize::MAX);
    let mut unpacked = Vec::new();
    let mut rest: &[u8] = match message.compression() {
        Compression::Lz4 => {
            unpacked.resize(size, 0);
            lz4_flex::block::decompress_into(&message.payload, &mut unpacked)
                .map_err(|error| format!("a message in it cannot be unpacked: {error}"))?;
            &unpacked
        }
        _ => &message.payload,
    };
    let cut = || "a message in it says that it is longer than it is".to_owned();
    // Each part: -1, the length of its head, the head, the body (Arrow's IPC streaming format).
    while let Some((mark, after)) = rest.split_first_chunk::<4>() {
        let (length, after) = match *mark {
            [0xff, 0xff, 0xff, 0xff] => after.split_first_chunk::<4>().ok_or_else(cut)?,
            _ => (mark, after),
        };
        let length = usize::try_from(i32::from_le_bytes(*length)).map_err(|_| cut())?;
        if length == 0 {
            break;
        }
        let (head, after) = after.split_at_checked(length).ok_or_else(cut)?;
        let head = root_as_message(head).map_err(|error| error.to_string())?;
        let body = usize::try_from(head.bodyLength()).map_err(|_| cut())?;
        rest = after.get(body..).ok_or_else(cut)?;
    }
    Ok(())
}

/// Where the last message ends of which every byte is there, and whether the end is marked after it.
fn end_of_messages(file: &mut BufReader<&File>, bytes: u64) -> std::io::Result<(u64, bool)> {
    let mut at = StreamHeader::ENCODED_SIZE_BYTES as u64;
    let mut header = [0; MessageHeader::ENCODED_SIZE_BYTES];
    file.seek(SeekFrom::Start(at))?;
    while at + (header.len() as u64) <= bytes {
        file.read_exact(&mut header)?;
        let Ok(message) = MessageHeader::from_rrd_bytes(&header) else {
            break;
        };
        if matches!(message.kind, MessageKind::End) {
            return Ok((at, true));
        }
        let start = at + header.len() as u64;
        let next = start.saturating_add(message.len);
        let (true, Ok(ahead)) = (next <= bytes, i64::try_from(message.len)) else {
            break;
        };
        file.seek_relative(ahead)?;
        at = next;
    }
    Ok((at.min(bytes), false))
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Runs what may panic: decoders do, on bytes that are no longer what was written. Says what it said,
/// and prints nothing.
fn quietly<T>(run: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let loud = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                loud(panic);
            }
        }));
    });
    QUIET.set(true);
    // What was half decoded is not looked at again: reading stops there.
    let done = catch_unwind(AssertUnwindSafe(run));
    QUIET.set(false);
    done.map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
        format!("it cannot be decoded: {}", text.unwrap_or_default())
    })
}

/// Reads what the recordings of a file were made from.
pub fn read(path: &Path) -> Result<Made, ReadError> {
    let name = || path.display().to_string();
    let unreadable = |error: std::io::Error| ReadError::Unreadable {
        path: name(),
        why: error.to_string(),
    };
    std::fs::metadata(path).map_err(unreadable)?;
    if !is_recording(path) {
        return Err(ReadError::NoRecording { path: name() });
    }
    let mut messages = Messages::open(path).map_err(unreadable)?;
    let mut found: Vec<(StoreId, Parts)> = Vec::new();
    while let Some((store, chunk)) = messages.next_chunk() {
        let known = found.iter().position(|(known, _)| *known == store);
        let index = known.unwrap_or_else(|| {
            found.push((store, Parts::default()));
            found.len() - 1
        });
        found[index].1.read(&chunk);
    }
    let broken = (!messages.ended).then(|| "a message in it is broken".to_owned());
    let cut = messages.stopped.take();
    let cut = cut.or_else(|| lacks_footer(path)).or(broken);
    let (own, foreign): (Vec<_>, Vec<_>) = found
        .into_iter()
        .partition(|(store, _)| store.application_id().as_str() == APPLICATION);
    if let ([], Some((other, _))) = (own.as_slice(), foreign.first()) {
        let by = format!("`{}`", other.application_id());
        return Err(ReadError::Foreign { path: name(), by });
    }
    let whole = |(store, parts): (StoreId, Parts)| Some((store, parts.whole()?));
    let (stores, recordings): (Vec<_>, Vec<_>) = own.into_iter().filter_map(whole).unzip();
    match (recordings.is_empty(), cut) {
        (true, Some(why)) => Err(ReadError::Cut { path: name(), why }),
        (true, None) => Err(ReadError::NoScene { path: name() }),
        (false, cut) => Ok(Made {
            recordings,
            stores,
            cut,
        }),
    }
}

/// A file that was closed whole ends with the marks of its footer.
fn lacks_footer(path: &Path) -> Option<String> {
    const MARKS: &[u8; 8] = b"RRF2FOOT";
    let mut end = [0; MARKS.len()];
    let read = File::open(path).and_then(|mut file| {
        file.seek(SeekFrom::End(-12))?;
        file.read_exact(&mut end)
    });
    let whole = read.is_ok() && &end == MARKS;
    (!whole).then(|| format!("it lacks the footer that rerun {RERUN_VERSION} ends a file with"))
}
