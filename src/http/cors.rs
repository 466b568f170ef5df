//! Pages of other origins: none may read answers unless the operator lists it.

use std::time::Duration;

use axum::http::{HeaderName, HeaderValue, Method, header};
use tower_http::cors::CorsLayer;
use url::Url;

/// Time for which a browser may keep the answer to a preflight.
const MAX_AGE: Duration = Duration::from_secs(600);

/// The origins in `items`, as browsers spell them.
///
/// # Errors
/// The first item that is no origin.
pub(super) fn origins(items: &[String]) -> Result<Vec<String>, String> {
    let origin = |item: &String| {
        let url = Url::parse(item).ok()?;
        let origin = url.origin().ascii_serialization();
        let is_bare = matches!(url.scheme(), "http" | "https") && item.trim_end_matches('/') == origin;
        is_bare.then_some(origin)
    };
    items.iter().map(|item| origin(item).ok_or_else(|| item.clone())).collect()
}

/// The layer that answers preflights and lets pages of `origins` read answers; `None` without an origin.
pub(super) fn layer(origins: &[String]) -> Option<CorsLayer> {
    if origins.is_empty() {
        return None;
    }
    let named = HeaderName::from_static;
    let values: Vec<_> = origins.iter().filter_map(|origin| HeaderValue::from_str(origin).ok()).collect();
    let layer = CorsLayer::new()
        .allow_origin(values)
        .allow_methods([Method::GET, Method::HEAD, Method::POST, Method::PATCH, Method::DELETE])
        .allow_headers([
            header::ACCEPT,
            header::AUTHORIZATION,
            header::CONTENT_ENCODING,
            header::CONTENT_TYPE,
            header::IF_MATCH,
            header::IF_NONE_MATCH,
            header::IF_RANGE,
            header::RANGE,
            named("cancel-after"),
            named("idempotency-key"),
            named("last-event-id"),
            named("prefer"),
            named("traceparent"),
            named("tus-resumable"),
            named("upload-length"),
            named("upload-metadata"),
            named("upload-offset"),
            named("x-api-key"),
            named("x-request-id"),
        ])
        .expose_headers([
            header::ACCEPT_RANGES,
            header::CONTENT_DISPOSITION,
            header::CONTENT_RANGE,
            header::ETAG,
            header::LINK,
            header::LOCATION,
            header::RETRY_AFTER,
            named("meshmend-fidelity"),
            named("meshmend-outcome"),
            named("preference-applied"),
            named("ratelimit"),
            named("ratelimit-policy"),
            named("repr-digest"),
            named("server-timing"),
            named("tus-extension"),
            named("tus-max-size"),
            named("tus-resumable"),
            named("tus-version"),
            named("upload-expires"),
            named("upload-length"),
            named("upload-metadata"),
            named("upload-offset"),
            named("x-request-id"),
        ])
        .max_age(MAX_AGE);
    Some(layer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_is_a_scheme_a_host_and_perhaps_a_port() {
        let items = ["https://shop.example", "http://127.0.0.1:3000/"].map(str::to_owned);
        assert_eq!(origins(&items).unwrap(), ["https://shop.example", "http://127.0.0.1:3000"]);
        for item in
            ["*", "null", "shop.example", "https://shop.example/a", "https://a@shop.example", "file:///"]
        {
            assert_eq!(origins(&[item.to_owned()]), Err(item.to_owned()), "{item}");
        }
    }

    #[test]
    fn without_an_origin_there_is_no_layer() {
        assert!(layer(&[]).is_none());
    }
}
