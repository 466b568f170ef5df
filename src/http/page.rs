//! The page: see a mesh, choose, repair, compare, download. Embedded as `web/build.sh` made it, so that building the
//! service needs nothing but Rust.

use std::sync::LazyLock;

use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse as _, Response};
use axum::routing::{MethodRouter, get};
use sha2::{Digest as _, Sha256};

use super::mesh_file;
use super::state::HttpService;

/// Paths of the page and of what it loads.
pub(super) static ASSETS: [Asset; 8] = [
    Asset::new("/", "text/html; charset=utf-8", include_bytes!("../../web/index.html")),
    Asset::new("/page.js", SCRIPT, include_bytes!("../../web/bundle/page.js")),
    Asset::new("/worker.js", SCRIPT, include_bytes!("../../web/bundle/worker.js")),
    Asset::new("/page.css", STYLE, include_bytes!("../../web/bundle/page.css")),
    Asset::new("/docs.css", STYLE, include_bytes!("../../web/docs.css")),
    Asset::new("/docs.js", SCRIPT, include_bytes!("../../web/docs.js")),
    Asset::new("/favicon.ico", "image/svg+xml", include_bytes!("../../web/icon.svg")),
    Asset::new("/licences.txt", "text/plain; charset=utf-8", include_bytes!("../../web/bundle/LICENCES.txt")),
];

const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

/// A file of the page.
pub(super) struct Asset {
    pub(super) path: &'static str,
    media_type: &'static str,
    content: &'static [u8],
}

/// Tags of the files, in their order: digests of their bytes.
static TAGS: LazyLock<[String; ASSETS.len()]> = LazyLock::new(|| {
    ASSETS.each_ref().map(|asset| {
        let digest: [u8; 32] = Sha256::digest(asset.content).into();
        format!("\"{}\"", mesh_file::base64(&digest[..12]))
    })
});

impl Asset {
    const fn new(path: &'static str, media_type: &'static str, content: &'static [u8]) -> Self {
        Self { path, media_type, content }
    }

    /// The route that answers with it.
    pub(super) fn route(at: usize) -> MethodRouter<std::sync::Arc<HttpService>> {
        get(move |request: HeaderMap| async move { ASSETS[at].answer(&TAGS[at], &request) })
    }

    /// The file, unless the browser has it. The tag is weak, because the file may be sent compressed.
    fn answer(&self, tag: &str, request: &HeaderMap) -> Response {
        let mut response = if mesh_file::matches_etag(request, tag) {
            StatusCode::NOT_MODIFIED.into_response()
        } else {
            ([(header::CONTENT_TYPE, self.media_type)], self.content).into_response()
        };
        let headers = response.headers_mut();
        if let Ok(tag) = HeaderValue::try_from(format!("W/{tag}")) {
            headers.insert(header::ETAG, tag);
        }
        // A new version may come under the same names.
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-cache"));
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Bytes that browsers load at most for the page, compressed.
    const COMPRESSED_BYTES_MAX: usize = 200_000;

    #[test]
    fn the_bundle_is_made_of_the_sources_that_are_committed() {
        let web = Path::new(env!("CARGO_MANIFEST_DIR")).join("web");
        let listed = std::fs::read_to_string(web.join("bundle/sources.sha256")).unwrap();
        for line in listed.lines() {
            let (digest, path) = line.split_once("  ").unwrap();
            let found = Sha256::digest(std::fs::read(web.join(path)).unwrap());
            let found: String = found.iter().map(|byte| format!("{byte:02x}")).collect();
            assert_eq!(found, digest, "web/{path} has changed: run web/build.sh");
        }
        let mut folders = vec![web.join("src")];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(&web).unwrap().to_str().unwrap().to_owned();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    assert!(listed.contains(&format!("  {name}\n")), "web/{name} is new: run web/build.sh");
                }
            }
        }
    }

    #[test]
    fn the_page_is_small() {
        use std::io::Write as _;
        let loaded =
            ASSETS.iter().filter(|asset| !["/docs.css", "/docs.js", "/licences.txt"].contains(&asset.path));
        let compressed = loaded.map(|asset| {
            let options = zip::write::SimpleFileOptions::default();
            let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
            archive.start_file("file", options).unwrap();
            archive.write_all(asset.content).unwrap();
            archive.finish().unwrap().into_inner().len()
        });
        let bytes: usize = compressed.sum();
        assert!(bytes <= COMPRESSED_BYTES_MAX, "{bytes} bytes");
    }
}
