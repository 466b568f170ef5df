//! A delivery as its owner sees it.

use url::Url;

use crate::jobs::store::{self, DeliveryState};
use crate::wire::{self, DeliveryTry};

/// The public view: no secret, and no query of the URL, where tokens stand.
pub(in crate::jobs) fn view(delivery: &store::Delivery) -> wire::Delivery {
    let tried = |one: &store::DeliveryTry| {
        let (status, error) = match &one.outcome {
            store::TryOutcome::Answered(status) => (Some(*status), None),
            store::TryOutcome::Failed(error) => (None, Some(error.clone())),
        };
        DeliveryTry { at: one.at, status, error }
    };
    wire::Delivery {
        id: delivery.id.clone(),
        state: match delivery.state {
            DeliveryState::Pending => wire::DeliveryState::Pending,
            DeliveryState::Delivered => wire::DeliveryState::Delivered,
            DeliveryState::Failed => wire::DeliveryState::Failed,
        },
        url: shown(&delivery.webhook.url),
        created_at: delivery.created_at,
        next_at: delivery.next_at,
        tries: delivery.tries.iter().map(tried).collect(),
    }
}

/// Scheme, host, port and path.
fn shown(url: &str) -> String {
    // It was a URL when the job was taken.
    let Ok(mut url) = Url::parse(url) else { return String::new() };
    url.set_query(None);
    url.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_url_is_shown_without_its_query() {
        assert_eq!(shown("https://shop.example:8443/hook?token=7"), "https://shop.example:8443/hook");
    }
}
