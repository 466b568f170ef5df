//! A streaming reader of `multipart/form-data` (RFC 7578, RFC 2046 section 5.1).
//!
//! Keeps no more of the body than a delimiter, the head of a part and one piece, whatever the client sends.

use bytes::{Bytes, BytesMut};
use memchr::memmem::Finder;

use super::body::IncomingBody;
use crate::wire::{Problem, ProblemCode};

/// Longest head of a part, and longest text before the first part, in bytes.
const HEAD_BYTES_MAX: usize = 16 << 10;
/// Longest boundary (RFC 2046).
const BOUNDARY_BYTES_MAX: usize = 70;

/// A body that is divided into parts.
pub(super) struct Multipart {
    body: IncomingBody,
    /// Received and not yet given out.
    buffer: BytesMut,
    /// What stands before every part and after the last one: line end, two hyphens, boundary.
    delimiter: Finder<'static>,
    at: At,
}

/// Where the reader stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    /// In the data of a part (or in the text before the first one).
    Data,
    /// Behind a delimiter.
    Delimiter,
    /// Behind the last delimiter.
    End,
}

/// What a part says about itself.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct PartHead {
    /// Name of the form's field.
    pub(super) name: String,
    /// Name of the file.
    pub(super) file_name: Option<String>,
    /// Media type, without parameters.
    pub(super) media_type: Option<String>,
}

/// The boundary in a `Content-Type`; `None` without one that the standard allows.
pub(super) fn boundary_of(content_type: &str) -> Option<String> {
    let (_, parameters) = content_type.split_once(';')?;
    let boundary = parameter(parameters, "boundary")?;
    (1..=BOUNDARY_BYTES_MAX).contains(&boundary.len()).then_some(boundary)
}

impl Multipart {
    /// Reads `body`, whose parts are divided by `boundary`.
    pub(super) fn new(body: IncomingBody, boundary: &str) -> Self {
        // The line end before the first delimiter is optional: as if it had been received.
        let buffer = BytesMut::from(&b"\r\n"[..]);
        let delimiter = Finder::new(format!("\r\n--{boundary}").as_bytes()).into_owned();
        Self { body, buffer, delimiter, at: At::Data }
    }

    /// The head of the next part; what is left of the part before is skipped. `None` after the last one.
    pub(super) async fn next_part(&mut self) -> Result<Option<PartHead>, Problem> {
        let is_preamble = self.at == At::Data;
        let mut skipped = 0;
        while let Some(piece) = self.next_piece().await? {
            skipped += piece.len();
            if is_preamble && skipped > HEAD_BYTES_MAX {
                return Err(broken("the boundary does not occur"));
            }
        }
        if self.at == At::End {
            return Ok(None);
        }
        self.fill_to(2).await?;
        if self.buffer.starts_with(b"--") {
            self.at = At::End;
            while self.body.next().await?.is_some() {}
            return Ok(None);
        }
        let head = self.take_head().await?;
        self.at = At::Data;
        PartHead::parse(&head).map(Some)
    }

    /// The next piece of the part, never empty; `None` at its end.
    pub(super) async fn next_piece(&mut self) -> Result<Option<Bytes>, Problem> {
        while self.at == At::Data {
            match self.delimiter.find(&self.buffer) {
                Some(0) => {
                    let _ = self.buffer.split_to(self.delimiter.needle().len());
                    self.at = At::Delimiter;
                }
                Some(end) => return Ok(Some(self.buffer.split_to(end).freeze())),
                None => {
                    let sure = self.buffer.len() - self.begun_delimiter();
                    if sure > 0 {
                        return Ok(Some(self.buffer.split_to(sure).freeze()));
                    }
                    self.fill().await?;
                }
            }
        }
        Ok(None)
    }

    /// Length of the buffer's end that may be the beginning of a delimiter.
    fn begun_delimiter(&self) -> usize {
        let needle = self.delimiter.needle();
        let longest = self.buffer.len().min(needle.len() - 1);
        (1..=longest).rev().find(|&len| self.buffer.ends_with(&needle[..len])).unwrap_or(0)
    }

    /// Takes the head of a part: from the end of the delimiter's line to the empty line.
    async fn take_head(&mut self) -> Result<BytesMut, Problem> {
        loop {
            if let Some(end) = memchr::memmem::find(&self.buffer, b"\r\n\r\n") {
                let mut head = self.buffer.split_to(end + 4);
                head.truncate(end);
                return Ok(head);
            }
            if self.buffer.len() > HEAD_BYTES_MAX {
                return Err(broken("the head of a part is too long"));
            }
            self.fill().await?;
        }
    }

    async fn fill_to(&mut self, len: usize) -> Result<(), Problem> {
        while self.buffer.len() < len {
            self.fill().await?;
        }
        Ok(())
    }

    async fn fill(&mut self) -> Result<(), Problem> {
        let piece = self.body.next().await?.ok_or_else(|| broken("the last boundary is missing"))?;
        self.buffer.extend_from_slice(&piece);
        Ok(())
    }
}

impl PartHead {
    /// Reads the header lines behind a delimiter. The delimiter's own line may end in blanks.
    fn parse(head: &[u8]) -> Result<Self, Problem> {
        let text = String::from_utf8_lossy(head);
        let mut lines = text.split("\r\n");
        if lines.next().is_some_and(|rest| !rest.trim().is_empty()) {
            return Err(broken("a boundary is followed by other text"));
        }
        let mut part = None;
        let mut media_type = None;
        for line in lines {
            let Some((name, value)) = line.split_once(':') else {
                return Err(broken("a header line of a part has no colon"));
            };
            if name.eq_ignore_ascii_case("content-disposition") {
                part = Self::of_disposition(value);
            } else if name.eq_ignore_ascii_case("content-type") {
                media_type = value.split(';').next().map(|media| media.trim().to_ascii_lowercase());
            }
        }
        let part = part.ok_or_else(|| broken("a part has no `Content-Disposition: form-data; name=…`"))?;
        Ok(Self { media_type, ..part })
    }

    fn of_disposition(value: &str) -> Option<Self> {
        let (kind, parameters) = value.split_once(';')?;
        let name = parameter(parameters, "name").filter(|_| kind.trim().eq_ignore_ascii_case("form-data"))?;
        Some(Self { name, file_name: parameter(parameters, "filename"), media_type: None })
    }
}

/// The value of one of `parameters`, `name=value; name="value"`. In quotes a backslash escapes a quote.
fn parameter(parameters: &str, wanted: &str) -> Option<String> {
    let mut rest = parameters;
    while let Some((name, after)) = rest.split_once('=') {
        let (value, next) = value_of(after.trim_start());
        if name.trim_matches([' ', '\t', ';']).eq_ignore_ascii_case(wanted) {
            return Some(value);
        }
        rest = next;
    }
    None
}

/// A value at the beginning of `text`, and what follows it.
fn value_of(text: &str) -> (String, &str) {
    let Some(quoted) = text.strip_prefix('"') else {
        let (value, rest) = text.split_once(';').unwrap_or((text, ""));
        return (value.trim().to_owned(), rest);
    };
    let mut value = String::new();
    let mut chars = quoted.chars();
    while let Some(c) = chars.next() {
        match c {
            '"' => break,
            // Old browsers send paths of Windows unescaped: only a quote is escaped.
            '\\' if chars.as_str().starts_with('"') => value.extend(chars.next()),
            c => value.push(c),
        }
    }
    (value, chars.as_str())
}

fn broken(why: &str) -> Problem {
    Problem::new(ProblemCode::BodyIncomplete, format!("the multipart body is broken: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::http::body::BodyLimits;
    use axum::body::Body;
    use axum::http::HeaderMap;
    use std::convert::Infallible;
    use std::time::Duration;

    const LIMITS: BodyLimits = BodyLimits {
        rate_min: 0,
        idle_timeout: Duration::from_secs(5),
        total_timeout: Duration::from_secs(5),
        bytes_max: 1 << 30,
        bytes_max_name: "upload_bytes_max",
    };

    const FORM: &str = "--cut\r\nContent-Disposition: form-data; name=\"mesh\"; filename=\"a \\\"b\\\".stl\"\r\n\
        Content-Type: Model/STL; x=y\r\n\r\nsolid\r\n--cu\r\n\r--cut\r\n\
        \r\n--cut \t\r\ncontent-disposition:form-data;name=params\r\n\r\n\r\n--cut--\r\nepilogue";

    /// Reads the form in pieces of `step` bytes.
    async fn read(form: &[u8], step: usize) -> Result<Vec<(PartHead, Vec<u8>)>, Problem> {
        let pieces: Vec<_> =
            form.chunks(step).map(|p| Ok::<_, Infallible>(Bytes::copy_from_slice(p))).collect();
        let body = Body::from_stream(futures_util::stream::iter(pieces));
        let mut form = Multipart::new(IncomingBody::new(&HeaderMap::new(), body, LIMITS)?, "cut");
        let mut parts = Vec::new();
        while let Some(head) = form.next_part().await? {
            let mut data = Vec::new();
            while let Some(piece) = form.next_piece().await? {
                assert!(!piece.is_empty());
                data.extend_from_slice(&piece);
            }
            parts.push((head, data));
        }
        Ok(parts)
    }

    #[tokio::test]
    async fn the_parts_are_the_same_however_the_body_is_cut_into_pieces() {
        for step in 1..=FORM.len() {
            let parts = read(FORM.as_bytes(), step).await.unwrap();
            let [(mesh, mesh_data), (params, params_data)] = &parts[..] else {
                panic!("two parts: {parts:?}")
            };
            assert_eq!((mesh.name.as_str(), mesh.file_name.as_deref()), ("mesh", Some("a \"b\".stl")));
            assert_eq!(mesh.media_type.as_deref(), Some("model/stl"));
            assert_eq!(mesh_data, b"solid\r\n--cu\r\n\r--cut\r\n");
            assert_eq!((params.name.as_str(), params_data.as_slice()), ("params", &b""[..]));
        }
    }

    #[tokio::test]
    async fn a_part_that_is_not_read_is_skipped() {
        let body = Body::from(FORM);
        let mut form = Multipart::new(IncomingBody::new(&HeaderMap::new(), body, LIMITS).unwrap(), "cut");
        assert_eq!(form.next_part().await.unwrap().unwrap().name, "mesh");
        assert_eq!(form.next_part().await.unwrap().unwrap().name, "params");
        assert_eq!(form.next_part().await.unwrap(), None);
        assert_eq!(form.next_part().await.unwrap(), None);
    }

    #[tokio::test]
    async fn a_body_that_ends_early_or_breaks_the_rules_is_refused() {
        let head = "--cut\r\nContent-Disposition: form-data; name=x\r\n\r\n";
        let long = "x".repeat(2 * HEAD_BYTES_MAX);
        for form in [
            String::new(),
            "--cu".into(),
            "--cut".into(),
            head.into(),
            format!("{head}data"),
            format!("{head}data\r\n--cut"),
            "--cut\r\n\r\nno head\r\n--cut--".into(),
            "--cut\r\nno colon\r\n\r\n\r\n--cut--".into(),
            "--cutter\r\nContent-Disposition: form-data; name=x\r\n\r\n\r\n--cut--".into(),
            "--cut\r\nContent-Disposition: attachment; name=x\r\n\r\n\r\n--cut--".into(),
            format!("{long}\r\n{head}\r\n--cut--"),
            format!("--cut\r\nX: {long}"),
        ] {
            for step in [1, 7, form.len().max(1)] {
                let code = read(form.as_bytes(), step).await.map_err(|problem| problem.code);
                assert_eq!(code.unwrap_err(), ProblemCode::BodyIncomplete, "{form:.60}");
            }
        }
    }

    #[tokio::test]
    async fn a_form_may_have_no_part_and_text_before_the_first_one() {
        assert_eq!(read(b"preamble\r\n--cut--", 3).await.unwrap(), []);
    }

    #[test]
    fn the_boundary_is_read_with_and_without_quotes() {
        assert_eq!(boundary_of("multipart/form-data; boundary=cut").as_deref(), Some("cut"));
        assert_eq!(boundary_of("multipart/form-data;charset=x; Boundary=\"c;t\"").as_deref(), Some("c;t"));
        assert_eq!(boundary_of("multipart/form-data"), None);
        assert_eq!(boundary_of("multipart/form-data; boundary="), None);
        assert_eq!(boundary_of(&format!("multipart/form-data; boundary={}", "x".repeat(71))), None);
    }
}
