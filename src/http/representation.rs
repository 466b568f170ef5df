//! Which form the answer of a repair or conversion takes.

use axum::http::{HeaderMap, HeaderValue, header};

use super::accept::Accept;
use crate::wire::{Format, Problem, ProblemCode, media_type_of};

/// Any bytes.
pub(super) const OCTET_STREAM: &str = "application/octet-stream";

/// A picture.
pub(super) const PNG: &str = "image/png";

/// The media type of a picture that is kept.
pub(super) fn media_type_of_picture(content: &[u8]) -> &'static str {
    if content.starts_with(b"glTF") { media_type_of(Format::Glb) } else { PNG }
}

/// A form of the answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Representation {
    /// The mesh.
    Mesh {
        /// The format that the client's media type asks for; `None`: it leaves it open.
        format: Option<Format>,
        /// The type must be [`OCTET_STREAM`] instead of the mesh's own.
        is_opaque: bool,
    },
    /// The report.
    Report,
    /// The picture.
    Picture,
    /// Both as `multipart/mixed`.
    Multipart,
    /// Both as a zip archive.
    Zip,
}

impl Representation {
    /// The form that `Accept` asks for; the mesh when it does not matter. `output_format`: what the options ask for.
    pub(super) fn choose(headers: &HeaderMap, output_format: Option<Format>) -> Result<Self, Problem> {
        let own = Self::Mesh { format: None, is_opaque: false };
        // A type of which every mesh is one, so that `model/*` and `*/*` find it before any format.
        let mut offers = vec![(output_format.map_or("model/*", media_type_of), own)];
        if output_format.is_none() {
            let of = |&format: &Format| {
                (media_type_of(format), Self::Mesh { format: Some(format), is_opaque: false })
            };
            offers.extend(Format::ALL.iter().map(of));
        }
        offers.extend([
            ("application/json", Self::Report),
            ("multipart/mixed", Self::Multipart),
            ("application/zip", Self::Zip),
            (OCTET_STREAM, Self::Mesh { format: None, is_opaque: true }),
        ]);
        Accept::from_headers(headers).choose(&offers).copied().ok_or_else(|| {
            let problem = not_acceptable(offers.iter().map(|(media, _)| *media));
            // A form is what comes in; what goes out in parts has another name.
            let wants_form = headers.get_all(header::ACCEPT).iter().any(names_form);
            Problem {
                suggestion: wants_form.then(|| "multipart/mixed".into()).or(problem.suggestion.clone()),
                ..problem
            }
        })
    }
}

/// Refuses a client that does not accept JSON, where there is nothing else.
pub(super) fn json_only(headers: &HeaderMap) -> Result<(), Problem> {
    one_of(headers, &["application/json"]).map(|_| ())
}

/// The media type that the client wants most.
pub(super) fn one_of(headers: &HeaderMap, offers: &[&'static str]) -> Result<&'static str, Problem> {
    let pairs: Vec<_> = offers.iter().map(|&media| (media, media)).collect();
    Accept::from_headers(headers)
        .choose(&pairs)
        .copied()
        .ok_or_else(|| not_acceptable(offers.iter().copied()))
}

fn names_form(accept: &HeaderValue) -> bool {
    accept.to_str().is_ok_and(|text| text.to_ascii_lowercase().contains("multipart/form-data"))
}

fn not_acceptable(offers: impl Iterator<Item = &'static str>) -> Problem {
    let allowed: Vec<_> = offers.collect();
    let detail = format!("`Accept` allows none of {}", allowed.join(", "));
    Problem::new(ProblemCode::NotAcceptable, detail).with_allowed(allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(accept: &'static str, output_format: Option<Format>) -> Option<Representation> {
        let headers = HeaderMap::from_iter([(header::ACCEPT, HeaderValue::from_static(accept))]);
        Representation::choose(&headers, output_format).ok()
    }

    const fn mesh(format: Option<Format>) -> Option<Representation> {
        Some(Representation::Mesh { format, is_opaque: false })
    }

    #[test]
    fn without_a_wish_the_mesh_comes_in_its_own_format() {
        assert_eq!(chosen("*/*", None), mesh(None));
        assert_eq!(chosen("*/*", Some(Format::Ply)), mesh(None));
        assert_eq!(chosen("model/*", None), mesh(None));
        assert_eq!(chosen("text/html, application/xml;q=0.9, */*;q=0.8", None), mesh(None));
    }

    #[test]
    fn a_mesh_type_asks_for_its_format() {
        assert_eq!(chosen("model/stl", None), mesh(Some(Format::Stl)));
        assert_eq!(chosen("text/off", None), mesh(Some(Format::Off)));
        assert_eq!(chosen("model/stl, */*;q=0.1", None), mesh(Some(Format::Stl)));
        assert_eq!(chosen("model/stl", Some(Format::Stl)), mesh(None));
        assert_eq!(chosen("model/stl", Some(Format::Obj)), None);
    }

    #[test]
    fn report_and_both_are_asked_for_by_their_types() {
        assert_eq!(chosen("application/json", None), Some(Representation::Report));
        assert_eq!(chosen("multipart/mixed", None), Some(Representation::Multipart));
        assert_eq!(chosen("application/zip", None), Some(Representation::Zip));
        let opaque = Some(Representation::Mesh { format: None, is_opaque: true });
        assert_eq!(chosen("application/octet-stream", None), opaque);
    }

    #[test]
    fn what_is_not_on_offer_is_refused_with_what_is() {
        let headers = HeaderMap::from_iter([(header::ACCEPT, HeaderValue::from_static("text/html"))]);
        let problem = Representation::choose(&headers, Some(Format::Stl)).unwrap_err();
        assert_eq!(problem.code, ProblemCode::NotAcceptable);
        assert!(problem.allowed.iter().any(|media_type| media_type == "model/stl"));
        assert!(json_only(&headers).is_err());
        let form = HeaderMap::from_iter([(header::ACCEPT, HeaderValue::from_static("multipart/form-data"))]);
        let problem = Representation::choose(&form, None).unwrap_err();
        assert_eq!(problem.suggestion.as_deref(), Some("multipart/mixed"));
    }
}
