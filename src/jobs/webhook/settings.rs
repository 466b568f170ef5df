//! What the operator may set about webhooks.

use std::time::Duration;

use super::retry::RetryPlan;
use super::signature::WebhookSecret;
use super::target::{PrivateHosts, WebhookTarget};
use crate::jobs::store::Webhook;
use crate::wire::{Problem, ProblemCode, WebhookRequest};

/// How webhooks are sent.
#[derive(Debug, Clone)]
pub struct WebhookSettings {
    /// What calls are signed with where the job brings no secret.
    pub secrets: Vec<WebhookSecret>,
    /// Hosts that may be called although they are not public.
    pub private_hosts: PrivateHosts,
    /// Time for one call.
    pub timeout: Duration,
    /// How often, and when again.
    pub retry: RetryPlan,
}

impl WebhookSettings {
    /// Takes a webhook that a caller asks for; `None`: webhooks are off.
    ///
    /// # Errors
    /// `webhook-refused`.
    pub(in crate::jobs) fn admit(this: Option<&Self>, asked: WebhookRequest) -> Result<Webhook, Problem> {
        let refused = |detail: String| Problem {
            parameter: Some("webhook".to_owned()),
            ..Problem::new(ProblemCode::WebhookRefused, detail)
        };
        let Some(settings) = this else {
            return Err(refused("this server sends no webhooks (`webhooks` is off)".to_owned()));
        };
        WebhookTarget::parse(&asked.url, &settings.private_hosts)
            .map_err(|error| refused(format!("`url` is not called: {error}")))?;
        match &asked.secret {
            Some(secret) => {
                WebhookSecret::parse(secret).map_err(|error| refused(format!("`secret`: {error}")))?;
            }
            None if settings.secrets.is_empty() => {
                return Err(refused("`secret` is missing, and the server has none of its own".to_owned()));
            }
            None => {}
        }
        Ok(Webhook { url: asked.url, secret: asked.secret })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECRET: &str = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

    fn settings(secrets: Vec<WebhookSecret>) -> WebhookSettings {
        WebhookSettings {
            secrets,
            private_hosts: PrivateHosts::default(),
            timeout: Duration::from_secs(1),
            retry: RetryPlan { attempts_max: 1, first_pause: Duration::from_secs(1) },
        }
    }

    fn asked(url: &str, secret: Option<&str>) -> WebhookRequest {
        WebhookRequest { url: url.to_owned(), secret: secret.map(str::to_owned) }
    }

    #[test]
    fn a_webhook_needs_a_public_url_and_a_secret_of_the_caller_or_the_server() {
        let bare = settings(Vec::new());
        let own = settings(vec![WebhookSecret::parse(SECRET).unwrap()]);
        let admit = |settings, url, secret| {
            WebhookSettings::admit(settings, asked(url, secret)).map_err(|problem| problem.detail)
        };
        assert!(admit(Some(&bare), "https://shop.example/hook", Some(SECRET)).is_ok());
        assert!(admit(Some(&own), "https://shop.example/hook", None).is_ok());
        for (settings, url, secret, word) in [
            (None, "https://shop.example/hook", Some(SECRET), "off"),
            (Some(&bare), "https://shop.example/hook", None, "missing"),
            (Some(&bare), "https://shop.example/hook", Some("whsec_1"), "base64"),
            (Some(&own), "https://10.0.0.1/hook", None, "not public"),
        ] {
            let detail = admit(settings, url, secret).unwrap_err();
            assert!(detail.contains(word), "{detail}");
            assert!(!detail.contains("whsec_1"), "{detail}");
        }
    }
}
