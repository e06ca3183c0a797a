//! A page that holds the carried viewer and one recording, served on 127.0.0.1 to this machine.
//!
//! Five fixed documents, read only: the request is parsed by `httparse`, nothing of a body is ever
//! read, and every connection is closed after its answer. (The small server crates at hand read or
//! allocate what a request merely announces, which one hostile local request could use.)

use crate::record::Assets;
use std::fs::File;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Bytes of a request's head at most.
const LONGEST_HEAD: usize = 16 * 1024;
const MOST_HEADERS: usize = 64;
/// A browser sends its request at once, and reads on without long pauses.
const PATIENCE: Duration = Duration::from_secs(30);

/// Why the page cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    #[error(
        "port {port} on 127.0.0.1 cannot be served: {why}; choose another, or 0 for a free one"
    )]
    Port { port: u16, why: String },
}

pub struct Page {
    listener: TcpListener,
    content: Arc<Content>,
}

struct Content {
    assets: Assets,
    recording: PathBuf,
    /// `127.0.0.1:PORT` and `localhost:PORT`: what a browser on this machine calls us.
    hosts: [String; 2],
}

impl Page {
    /// Takes the port at once, so that one already taken is an error now.
    pub fn bind(port: u16, recording: &Path, assets: Assets) -> Result<Self, PageError> {
        let fail = |why: std::io::Error| PageError::Port {
            port,
            why: why.to_string(),
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(fail)?;
        let port = listener.local_addr().map_err(fail)?.port();
        Ok(Self {
            listener,
            content: Arc::new(Content {
                assets,
                recording: recording.to_owned(),
                hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")],
            }),
        })
    }

    pub fn address(&self) -> String {
        format!("http://{}", self.content.hosts[0])
    }

    pub fn recording(&self) -> &Path {
        &self.content.recording
    }

    /// Answers until the process ends. A reader that stalls holds up nobody else.
    pub fn serve(&self) {
        for stream in self.listener.incoming().flatten() {
            let content = Arc::clone(&self.content);
            // The browser may have gone away; nothing is owed to it then.
            std::thread::spawn(move || content.answer(stream).ok());
        }
    }
}

/// What a request asks for.
enum Asked {
    Get(String),
    Head(String),
    Refused(&'static str),
}

impl Content {
    fn answer(&self, mut stream: TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let (path, wants_body) = match self.asked(&mut stream)? {
            Asked::Get(path) => (path, true),
            Asked::Head(path) => (path, false),
            Asked::Refused(status) => {
                return respond(&mut stream, status, "text/plain", status.as_bytes(), true);
            }
        };
        let index;
        let (kind, body): (&str, &[u8]) = match path.as_str() {
            "/" => {
                index = self.index();
                ("text/html; charset=utf-8", index.as_bytes())
            }
            "/re_viewer.js" => ("text/javascript", self.assets.script()),
            "/re_viewer_bg.wasm" => ("application/wasm", self.assets.wasm()),
            "/favicon.ico" => ("image/x-icon", self.assets.icon()),
            "/recording.rrd" => return self.send_recording(&mut stream, wants_body),
            _ => {
                return respond(
                    &mut stream,
                    "404 Not Found",
                    "text/plain",
                    b"not here",
                    wants_body,
                );
            }
        };
        respond(&mut stream, "200 OK", kind, body, wants_body)
    }

    /// Reads the head of a request. Only reading is answered, and only to a page that calls this
    /// machine by its own name: one that a resolver points here must not read a recording.
    fn asked(&self, stream: &mut TcpStream) -> std::io::Result<Asked> {
        let mut head = Vec::new();
        let mut piece = [0; 2048];
        loop {
            let read = stream.read(&mut piece)?;
            head.extend_from_slice(&piece[..read]);
            let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
            let mut request = httparse::Request::new(&mut headers);
            match request.parse(&head) {
                Ok(httparse::Status::Complete(_)) => return Ok(self.judged(&request)),
                Ok(httparse::Status::Partial) if read > 0 && head.len() < LONGEST_HEAD => {}
                _ => return Ok(Asked::Refused("400 Bad Request")),
            }
        }
    }

    fn judged(&self, request: &httparse::Request<'_, '_>) -> Asked {
        let hosts = request
            .headers
            .iter()
            .filter(|h| h.name.eq_ignore_ascii_case("host"));
        let hosts: Vec<&[u8]> = hosts.map(|h| h.value).collect();
        let known = match hosts[..] {
            [host] => self
                .hosts
                .iter()
                .any(|own| host.eq_ignore_ascii_case(own.as_bytes())),
            _ => false,
        };
        if !known {
            return Asked::Refused("403 Forbidden");
        }
        let path = request.path.unwrap_or_default();
        let path = path.split('?').next().unwrap_or_default().to_owned();
        match request.method {
            Some("GET") => Asked::Get(path),
            Some("HEAD") => Asked::Head(path),
            _ => Asked::Refused("405 Method Not Allowed"),
        }
    }

    fn send_recording(&self, stream: &mut TcpStream, wants_body: bool) -> std::io::Result<()> {
        let opened =
            File::open(&self.recording).and_then(|file| Ok((file.metadata()?.len(), file)));
        match opened {
            Ok((length, file)) => {
                head(stream, "200 OK", "application/octet-stream", length)?;
                if wants_body {
                    std::io::copy(&mut file.take(length), stream)?;
                }
                Ok(())
            }
            Err(error) => {
                let why = error.to_string();
                respond(
                    stream,
                    "404 Not Found",
                    "text/plain",
                    why.as_bytes(),
                    wants_body,
                )
            }
        }
    }

    fn index(&self) -> String {
        let name = self.recording.file_name().unwrap_or_default();
        INDEX.replace("{name}", &escape(&name.to_string_lossy()))
    }
}

fn respond(
    stream: &mut TcpStream,
    status: &str,
    kind: &str,
    body: &[u8],
    wants_body: bool,
) -> std::io::Result<()> {
    head(stream, status, kind, body.len() as u64)?;
    if wants_body {
        stream.write_all(body)?;
    }
    Ok(())
}

fn head(stream: &mut TcpStream, status: &str, kind: &str, length: u64) -> std::io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
    )
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

const INDEX: &str = r#"<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>{name} · torquescope</title>
<link rel="icon" href="favicon.ico">
<style>
  html, body { margin: 0; height: 100%; background: #101418; color: #d0d4d8; font: 16px system-ui, sans-serif }
  canvas { width: 100%; height: 100%; display: block }
  #note { position: fixed; inset: 0; display: grid; place-items: center; text-align: center; padding: 2em }
</style>
<div id="note" role="status">Loading the viewer…</div>
<canvas id="viewer" aria-label="{name} in the Rerun viewer"></canvas>
<script src="re_viewer.js"></script>
<script>
(async () => {
  const note = document.getElementById("note");
  try {
    await wasm_bindgen({ module_or_path: "re_viewer_bg.wasm" });
    const viewer = new wasm_bindgen.WebHandle({
      url: [location.origin + "/recording.rrd"],
      render_backend: new URLSearchParams(location.search).get("renderer"),
      hide_welcome_screen: true,
      persist: false,
    });
    await viewer.start(document.getElementById("viewer"));
    note.remove();
  } catch (error) {
    note.textContent = "The viewer did not start (" + error + "). It needs a browser with WebGPU or WebGL 2; "
      + "a native viewer opens the file too (rerun FILE.rrd).";
  }
})();
</script>
</html>
"#;
