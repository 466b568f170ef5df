//! API keys: who may use the service, and whose job is whose.

use super::scope::Scopes;
use sha2::{Digest as _, Sha256};
use subtle::{ConditionallySelectable as _, ConstantTimeEq as _};

/// The keys that are let in. Only digests are kept.
#[derive(Debug, Clone, Default)]
pub struct ApiKeys(Vec<ApiKey>);

#[derive(Debug, Clone)]
struct ApiKey {
    owner: String,
    sha256: [u8; 32],
    scopes: Scopes,
}

/// Who presents a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Holder {
    /// The key's name; jobs belong to it.
    pub(super) owner: String,
    /// What the key may be used for.
    pub(super) scopes: Scopes,
}

/// A line of a key file that says nothing usable. The line's text is not repeated: it may hold a key.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum KeyFileError {
    /// The file has no key, so nobody could come in.
    #[error("the key file holds no key")]
    Empty,
    /// A line with a colon whose right side is not a digest.
    #[error(
        "line {line} of the key file is neither `name:SHA-256 of the key in 64 hexadecimal digits`, perhaps with \
         `:read`, `:submit` or `:read,submit` behind it, nor a plain key without a colon"
    )]
    Line {
        /// Number of the line, from 1.
        line: usize,
    },
    /// Two lines give the same key.
    #[error("line {line} of the key file repeats the key of an earlier line")]
    KeyTaken {
        /// Number of the line, from 1.
        line: usize,
    },
}

impl ApiKeys {
    /// Reads a key file: one key a line, either `name:sha256[:scopes]` (64 hexadecimal digits, as
    /// `printf %s "$KEY" | sha256sum` prints them) or the plain key, which may not contain a colon. A plain key is
    /// named after its digest. Keys of one name are one caller, so that a new key can be given out before the old one
    /// goes. Empty lines and lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// No key, a line that is neither form, or a key given twice.
    pub fn parse(text: &str) -> Result<Self, KeyFileError> {
        let mut keys = Vec::<ApiKey>::new();
        for (at, line) in text.lines().enumerate() {
            let content = line.trim();
            if content.is_empty() || content.starts_with('#') {
                continue;
            }
            let key = ApiKey::parse(content).ok_or(KeyFileError::Line { line: at + 1 })?;
            if keys.iter().any(|other| other.sha256 == key.sha256) {
                return Err(KeyFileError::KeyTaken { line: at + 1 });
            }
            keys.push(key);
        }
        if keys.is_empty() { Err(KeyFileError::Empty) } else { Ok(Self(keys)) }
    }

    /// The key's holder. Takes the same time whichever key matches, and when none does.
    pub(super) fn holder_of(&self, presented: &[u8]) -> Option<Holder> {
        let digest: [u8; 32] = Sha256::digest(presented).into();
        let mut found = u32::MAX;
        for (at, key) in (0_u32..).zip(&self.0) {
            found.conditional_assign(&at, key.sha256.ct_eq(&digest));
        }
        let key = self.0.get(found as usize)?;
        Some(Holder { owner: key.owner.clone(), scopes: key.scopes })
    }
}

impl ApiKey {
    fn parse(line: &str) -> Option<Self> {
        let parts: Vec<_> = line.split(':').map(str::trim).collect();
        let (name, digest, scopes) = match parts[..] {
            [_] => return Some(Self::plain(line)),
            [name, digest] => (name, digest, Scopes::ALL),
            [name, digest, scopes] => (name, digest, Scopes::parse(scopes)?),
            _ => return None,
        };
        let sha256 = digest_from_hex(digest)?;
        (!name.is_empty()).then(|| Self { owner: name.to_owned(), sha256, scopes })
    }

    fn plain(key: &str) -> Self {
        let sha256: [u8; 32] = Sha256::digest(key.as_bytes()).into();
        let [a, b, c, d, ..] = sha256;
        Self { owner: format!("key-{a:02x}{b:02x}{c:02x}{d:02x}"), sha256, scopes: Scopes::ALL }
    }
}

fn digest_from_hex(text: &str) -> Option<[u8; 32]> {
    let mut digest = [0; 32];
    let (pairs, rest) = text.as_bytes().as_chunks::<2>();
    if pairs.len() != digest.len() || !rest.is_empty() {
        return None;
    }
    for (byte, &[high, low]) in digest.iter_mut().zip(pairs) {
        let digit = |c: u8| char::from(c).to_digit(16);
        *byte = u8::try_from(digit(high)? * 16 + digit(low)?).ok()?;
    }
    Some(digest)
}

#[cfg(test)]
mod tests {
    use super::*;

    // SHA-256 of `open sesame`.
    const SESAME: &str = "41ef4bb0b23661e66301aac36066912dac037827b4ae63a7b1165a5aa93ed4eb";

    fn owner(keys: &ApiKeys, presented: &[u8]) -> Option<String> {
        keys.holder_of(presented).map(|holder| holder.owner)
    }

    #[test]
    fn a_key_is_known_by_its_digest_or_by_itself() {
        let keys = ApiKeys::parse(&format!("# farm\n\nshop:{SESAME}\nplain-key\n")).unwrap();
        assert_eq!(owner(&keys, b"open sesame").as_deref(), Some("shop"));
        assert!(owner(&keys, b"plain-key").unwrap().starts_with("key-"));
        assert_eq!(owner(&keys, b"open"), None);
        assert_eq!(owner(&keys, SESAME.as_bytes()), None);
    }

    #[test]
    fn a_key_has_the_scopes_behind_its_digest_or_all() {
        let scopes = |line: &str| {
            ApiKeys::parse(line)
                .ok()
                .and_then(|keys| keys.holder_of(b"open sesame"))
                .map(|holder| holder.scopes)
        };
        assert_eq!(scopes(&format!("shop:{SESAME}")), Some(Scopes::ALL));
        assert_eq!(scopes(&format!("shop:{SESAME}:read")), Scopes::parse("read"));
        assert_eq!(scopes(&format!("shop : {SESAME} : read, submit")), Some(Scopes::ALL));
        assert_eq!(scopes("open sesame"), Some(Scopes::ALL));
        assert_eq!(scopes(&format!("shop:{SESAME}:write")), None);
        assert_eq!(scopes(&format!("shop:{SESAME}:read:submit")), None);
    }

    #[test]
    fn two_keys_of_one_name_are_one_caller() {
        let keys = ApiKeys::parse(&format!("shop:{SESAME}\nshop:{}", "0".repeat(64))).unwrap();
        assert_eq!(owner(&keys, b"open sesame").as_deref(), Some("shop"));
    }

    #[test]
    fn a_key_file_that_lets_nobody_in_is_an_error() {
        assert_eq!(ApiKeys::parse("\n# none\n").unwrap_err(), KeyFileError::Empty);
    }

    #[test]
    fn a_line_that_is_neither_form_is_named_by_its_number() {
        assert_eq!(ApiKeys::parse("good\nshop:1234").unwrap_err(), KeyFileError::Line { line: 2 });
        assert_eq!(ApiKeys::parse(&format!(":{SESAME}")).unwrap_err(), KeyFileError::Line { line: 1 });
    }

    #[test]
    fn one_key_has_one_line() {
        let text = format!("shop:{SESAME}\nfarm:{SESAME}:read");
        assert_eq!(ApiKeys::parse(&text).unwrap_err(), KeyFileError::KeyTaken { line: 2 });
    }
}
