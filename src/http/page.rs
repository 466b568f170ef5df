//! The page: upload a mesh, read its report, download the result. Embedded; plain modules, no build step.

use axum::http::header;
use axum::response::{IntoResponse as _, Response};

/// The page.
pub(super) async fn index() -> Response {
    asset("text/html; charset=utf-8", include_str!("../../web/index.html"))
}

/// What it does.
pub(super) async fn script() -> Response {
    asset("text/javascript; charset=utf-8", include_str!("../../web/page.js"))
}

/// How page and documentation look.
pub(super) async fn style() -> Response {
    asset("text/css; charset=utf-8", include_str!("../../web/style.css"))
}

/// The picture on a browser's tab.
pub(super) async fn icon() -> Response {
    asset("image/svg+xml", include_str!("../../web/icon.svg"))
}

fn asset(media_type: &'static str, text: &'static str) -> Response {
    // A new version may come under the same names.
    ([(header::CONTENT_TYPE, media_type), (header::CACHE_CONTROL, "no-cache")], text).into_response()
}
