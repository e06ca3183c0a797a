//! A page that holds the carried viewer and one recording, served on 127.0.0.1 to this machine.

use crate::record::Assets;
use std::fs::File;
use std::io::{Cursor, Read};
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

/// Why the page cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    #[error(
        "port {port} on 127.0.0.1 cannot be served: {why}; choose another, or 0 for a free one"
    )]
    Port { port: u16, why: String },
}

pub struct Page {
    server: Server,
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
        let fail = |why: String| PageError::Port { port, why };
        let server = Server::http(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))
            .map_err(|error| fail(error.to_string()))?;
        let address = server.server_addr().to_ip();
        let port = address.map_or(port, |address| address.port());
        Ok(Self {
            server,
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

    /// Answers until the process ends. A reader that stalls holds up nobody else.
    pub fn serve(&self) {
        for request in self.server.incoming_requests() {
            let content = Arc::clone(&self.content);
            std::thread::spawn(move || content.answer(request));
        }
    }
}

impl Content {
    fn answer(&self, request: Request) {
        // A page of another origin that a resolver points at this machine must not read it.
        let host = request
            .headers()
            .iter()
            .find(|header| header.field.equiv("Host"));
        let known =
            host.is_some_and(|host| self.hosts.iter().any(|own| *own == host.value.as_str()));
        let reading = matches!(request.method(), Method::Get | Method::Head);
        // The browser may have gone away; nothing is owed to it then.
        let _ = match (known && reading, request.url().split('?').next()) {
            (false, _) => respond(request, 403, "text/plain", b"forbidden"),
            (_, Some("/")) => respond(
                request,
                200,
                "text/html; charset=utf-8",
                self.index().as_bytes(),
            ),
            (_, Some("/re_viewer.js")) => {
                respond(request, 200, "text/javascript", self.assets.script())
            }
            (_, Some("/re_viewer_bg.wasm")) => {
                respond(request, 200, "application/wasm", self.assets.wasm())
            }
            (_, Some("/favicon.ico")) => respond(request, 200, "image/x-icon", self.assets.icon()),
            (_, Some("/recording.rrd")) => match File::open(&self.recording) {
                Ok(file) => {
                    let length = file.metadata().ok().map(|data| data.len() as usize);
                    stream(request, 200, "application/octet-stream", file, length)
                }
                Err(error) => respond(request, 404, "text/plain", error.to_string().as_bytes()),
            },
            _ => respond(request, 404, "text/plain", b"not here"),
        };
    }

    fn index(&self) -> String {
        let name = self
            .recording
            .file_name()
            .unwrap_or_default()
            .to_string_lossy();
        INDEX.replace("{name}", &escape(&name))
    }
}

fn respond(request: Request, status: u16, kind: &str, body: &[u8]) -> std::io::Result<()> {
    stream(request, status, kind, Cursor::new(body), Some(body.len()))
}

fn stream(
    request: Request,
    status: u16,
    kind: &str,
    body: impl Read,
    length: Option<usize>,
) -> std::io::Result<()> {
    let headers = [("Content-Type", kind), ("Cache-Control", "no-store")];
    let headers = headers
        .iter()
        .filter_map(|(name, value)| Header::from_bytes(*name, *value).ok());
    request.respond(Response::new(
        StatusCode(status),
        headers.collect(),
        body,
        length,
        None,
    ))
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
