//! Which of the representations on offer the client wants (`Accept`, RFC 9110 section 12.5.1).

use axum::http::{HeaderMap, header};

/// The media type of problems.
const PROBLEM: &str = "application/problem+json";

/// One media range of an `Accept` header.
#[derive(Debug, Clone, PartialEq)]
struct Range {
    /// `type/subtype`, `type/*` or `*/*`, in lower case.
    pattern: String,
    /// Weight, from 0 (not wanted) to 1.
    weight: f32,
}

impl Range {
    fn parse(text: &str) -> Option<Self> {
        let mut parts = text.split(';').map(str::trim);
        let pattern = parts.next()?.to_ascii_lowercase();
        // `*` alone is not in the standard, but old clients send it.
        let pattern = if pattern == "*" { "*/*".to_owned() } else { pattern };
        if !pattern.contains('/') {
            return None;
        }
        let weight = parts
            .filter_map(|parameter| parameter.split_once('='))
            .find(|(name, _)| name.trim().eq_ignore_ascii_case("q"))
            .and_then(|(_, value)| value.trim().parse::<f32>().ok())
            .map_or(1.0, |q| q.clamp(0.0, 1.0));
        Some(Self { pattern, weight })
    }

    /// How closely the range names `media`: 3 exactly, 2 by type, 1 by `*/*`, 0 not at all.
    fn closeness(&self, media: &str) -> u8 {
        if self.pattern == media {
            return 3;
        }
        match self.pattern.split_once('/') {
            Some(("*", "*")) => 1,
            Some((kind, "*")) if media.split('/').next() == Some(kind) => 2,
            _ => 0,
        }
    }
}

/// What the client accepts.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Accept(Vec<Range>);

impl Accept {
    /// Reads the header; without one, or with an empty one, everything is accepted. Problems are told as such whatever is
    /// accepted, so that a client which names their media type alone, as generated ones do, says nothing of other answers.
    pub(super) fn from_headers(headers: &HeaderMap) -> Self {
        let lines = headers.get_all(header::ACCEPT).iter().filter_map(|value| value.to_str().ok());
        let ranges = lines.flat_map(|line| line.split(',')).filter_map(|range| Range::parse(range.trim()));
        Self(ranges.filter(|range| range.pattern != PROBLEM).collect())
    }

    /// The weight of `media` and how closely the header names it; `None` when it is not accepted.
    fn weigh(&self, media: &str) -> Option<(f32, u8)> {
        if self.0.is_empty() {
            return Some((1.0, 1));
        }
        let closest = self.0.iter().max_by_key(|range| range.closeness(media))?;
        let closeness = closest.closeness(media);
        (closeness > 0 && closest.weight > 0.0).then_some((closest.weight, closeness))
    }

    /// The offer that is wanted most: by weight, then by how closely it is named where only some are named at all,
    /// then by the order of `offers`. `None` when none is accepted.
    pub(super) fn choose<'o, T>(&self, offers: &'o [(&str, T)]) -> Option<&'o T> {
        let mut best: Option<(f32, u8, &T)> = None;
        for (media, offer) in offers {
            let Some((weight, closeness)) = self.weigh(media) else { continue };
            if best.is_none_or(|(w, c, _)| weight > w || (weight == w && closeness > c)) {
                best = Some((weight, closeness, offer));
            }
        }
        best.map(|(_, _, offer)| offer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    const OFFERS: [(&str, &str); 5] = [
        ("model/stl", "stl"),
        ("model/obj", "obj"),
        ("application/json", "report"),
        ("multipart/mixed", "mixed"),
        ("application/zip", "zip"),
    ];

    fn chosen(accept: &'static str) -> Option<&'static str> {
        let headers = HeaderMap::from_iter([(header::ACCEPT, HeaderValue::from_static(accept))]);
        Accept::from_headers(&headers).choose(&OFFERS).copied()
    }

    #[test]
    fn without_a_wish_the_first_offer_is_made() {
        assert_eq!(Accept::from_headers(&HeaderMap::new()).choose(&OFFERS), Some(&"stl"));
        assert_eq!(chosen("*/*"), Some("stl"));
        assert_eq!(chosen(""), Some("stl"));
        assert_eq!(chosen("application/problem+json"), Some("stl"));
        assert_eq!(chosen("application/problem+json, application/json"), Some("report"));
    }

    #[test]
    fn a_named_type_is_preferred_to_a_wildcard_of_the_same_weight() {
        assert_eq!(chosen("*/*, application/json"), Some("report"));
        assert_eq!(chosen("multipart/*"), Some("mixed"));
        assert_eq!(chosen("application/*"), Some("report"));
    }

    #[test]
    fn weights_decide_and_zero_excludes() {
        assert_eq!(chosen("model/stl;q=0.1, application/zip;q=0.9"), Some("zip"));
        assert_eq!(chosen("model/*, model/stl;q=0"), Some("obj"));
        assert_eq!(chosen("text/html, */*;q=0.8"), Some("stl"));
    }

    #[test]
    fn a_type_that_is_not_on_offer_gives_nothing() {
        assert_eq!(chosen("text/html"), None);
        assert_eq!(chosen("application/json;q=0"), None);
    }
}
