//! The compiled web viewer that this program carries, and the native one it may find.

use super::RERUN_VERSION;
use re_web_viewer_server::{WebViewerData, WebViewerDataError};

/// The files of Rerun's web viewer.
pub struct Assets(WebViewerData);

impl Assets {
    pub fn load() -> Result<Self, WebViewerDataError> {
        Ok(Self(WebViewerData::load(None)?))
    }

    pub fn script(&self) -> &[u8] {
        self.0.viewer_js()
    }

    pub fn wasm(&self) -> &[u8] {
        self.0.viewer_wasm()
    }

    pub fn icon(&self) -> &[u8] {
        self.0.favicon()
    }
}

/// Whether what `rerun --version` prints names the version whose files this writes.
pub fn native_version_line(line: &str) -> bool {
    let mut words = line.split_whitespace();
    words.any(|word| word.trim_start_matches('v') == RERUN_VERSION)
}
