//! Signatures of the Standard Webhooks specification (symmetric scheme, `v1`).

use std::fmt;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hmac::{Hmac, KeyInit as _, Mac as _};
use sha2::Sha256;

/// Shortest and longest key, in bytes, as the specification asks for.
const KEY_BYTES: std::ops::RangeInclusive<usize> = 24..=64;
const PREFIX: &str = "whsec_";

/// A key that deliveries are signed with. It is never printed.
#[derive(Clone, PartialEq, Eq)]
pub struct WebhookSecret(Vec<u8>);

/// A text that is no secret. The text is not repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a secret is `whsec_` and 24 to 64 random bytes in base64")]
pub struct SecretError;

impl WebhookSecret {
    /// Reads `whsec_` and base64.
    ///
    /// # Errors
    /// Another text, or a key that is too short or too long.
    pub fn parse(text: &str) -> Result<Self, SecretError> {
        let key = text.strip_prefix(PREFIX).and_then(|code| STANDARD.decode(code).ok()).ok_or(SecretError)?;
        if KEY_BYTES.contains(&key.len()) { Ok(Self(key)) } else { Err(SecretError) }
    }

    /// Reads a file of secrets, one a line: the first one signs first, the others are on their way out or in.
    ///
    /// # Errors
    /// A line that is no secret; a file without one.
    pub fn parse_file(text: &str) -> Result<Vec<Self>, SecretError> {
        let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        let secrets = lines.map(Self::parse).collect::<Result<Vec<_>, _>>()?;
        if secrets.is_empty() { Err(SecretError) } else { Ok(secrets) }
    }

    /// The signature of a message: `v1,` and base64.
    pub(super) fn sign(&self, id: &str, timestamp: i64, payload: &[u8]) -> String {
        // The construction takes keys of any length.
        let Ok(mut mac) = Hmac::<Sha256>::new_from_slice(&self.0) else { return String::new() };
        mac.update(format!("{id}.{timestamp}.").as_bytes());
        mac.update(payload);
        format!("v1,{}", STANDARD.encode(mac.finalize().into_bytes()))
    }
}

impl fmt::Debug for WebhookSecret {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("WebhookSecret(..)")
    }
}

/// The value of `webhook-signature`: one signature for each secret.
pub(super) fn signatures(secrets: &[WebhookSecret], id: &str, timestamp: i64, payload: &[u8]) -> String {
    let each: Vec<_> = secrets.iter().map(|secret| secret.sign(id, timestamp, payload)).collect();
    each.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECRET: &str = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

    #[test]
    fn the_example_of_the_specification_is_signed_as_there() {
        let secret = WebhookSecret::parse(SECRET).unwrap();
        let signature =
            secret.sign("msg_p5jXN8AQM9LWM0D4loKWxJek", 1_614_265_330, br#"{"test": 2432232314}"#);
        assert_eq!(signature, "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
    }

    #[test]
    fn two_secrets_sign_side_by_side() {
        let text = format!("# old\n{SECRET}\n\nwhsec_{}\n", STANDARD.encode([7; 32]));
        let secrets = WebhookSecret::parse_file(&text).unwrap();
        let both = signatures(&secrets, "id", 1, b"{}");
        let each: Vec<_> = both.split(' ').collect();
        assert_eq!(each, [secrets[0].sign("id", 1, b"{}"), secrets[1].sign("id", 1, b"{}")]);
        assert_ne!(each[0], each[1]);
    }

    #[test]
    fn a_text_that_is_no_secret_is_refused_and_none_is_printed() {
        let short = format!("whsec_{}", STANDARD.encode([7; 23]));
        let long = format!("whsec_{}", STANDARD.encode([7; 65]));
        for text in ["", "whsec_", "whsec_%%%", &SECRET[6..], &short, &long] {
            assert_eq!(WebhookSecret::parse(text), Err(SecretError), "{text}");
        }
        assert_eq!(WebhookSecret::parse_file("# none\n"), Err(SecretError));
        let printed = format!("{:?}", WebhookSecret::parse(SECRET).unwrap());
        assert!(!printed.contains("MfKQ"), "{printed}");
    }
}
