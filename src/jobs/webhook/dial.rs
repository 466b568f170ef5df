//! The calls: to exactly the addresses that were checked, once each, without redirects or proxies.

use std::error::Error;
use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use reqwest::dns::{Addrs, Name, Resolve, Resolving};
use reqwest::redirect::Policy;
use reqwest::{Client, header};

use super::address;
use super::target::WebhookTarget;

/// Time for a connection with its handshake.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);

/// Looks up the addresses of a name.
type Lookup = Arc<dyn Fn(String) -> LookedUp + Send + Sync>;
/// What it finds.
type LookedUp = Pin<Box<dyn Future<Output = io::Result<Vec<SocketAddr>>> + Send>>;

/// Makes the calls.
#[derive(Debug, Clone)]
pub(super) struct Dialer {
    /// Speaks to public addresses only.
    public: Client,
    /// Speaks to the hosts that the operator listed.
    private: Client,
}

/// A message to deliver.
#[derive(Debug)]
pub(super) struct SignedMessage {
    pub(super) id: String,
    pub(super) timestamp: i64,
    pub(super) signature: String,
    pub(super) payload: Vec<u8>,
}

/// What the other end said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Reply {
    pub(super) status: u16,
    /// Seconds of `Retry-After`.
    pub(super) retry_after_s: Option<u64>,
}

impl Dialer {
    /// A dialler that waits for an answer for `timeout`.
    ///
    /// # Errors
    /// The system has no root certificates that can be used.
    pub(super) fn new(timeout: Duration) -> Result<Self, reqwest::Error> {
        Self::with_lookup(timeout, Arc::new(|name| Box::pin(look_up(name))))
    }

    fn with_lookup(timeout: Duration, lookup: Lookup) -> Result<Self, reqwest::Error> {
        // Another part of the process may have chosen the same already.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let client = || {
            Client::builder()
                .redirect(Policy::none())
                .no_proxy()
                .referer(false)
                .connect_timeout(CONNECT_TIMEOUT)
                .timeout(timeout)
                // A kept connection would outlive the look at its address.
                .pool_max_idle_per_host(0)
                .user_agent(concat!("meshmend/", env!("CARGO_PKG_VERSION")))
        };
        let public = client().https_only(true).dns_resolver(PublicOnly(lookup)).build()?;
        Ok(Self { public, private: client().build()? })
    }

    /// Calls `target`. The body of the answer is not read.
    ///
    /// # Errors
    /// Why there was no answer, in words that name no address.
    pub(super) async fn call(&self, target: &WebhookTarget, message: SignedMessage) -> Result<Reply, String> {
        let client = if target.is_private() { &self.private } else { &self.public };
        let request = client
            .post(target.url().clone())
            .header(header::CONTENT_TYPE, "application/json")
            .header("webhook-id", message.id)
            .header("webhook-timestamp", message.timestamp)
            .header("webhook-signature", message.signature)
            .body(message.payload);
        let response = request.send().await.map_err(|error| reason(&error))?;
        let retry_after = response.headers().get(header::RETRY_AFTER);
        let retry_after_s = retry_after.and_then(|value| value.to_str().ok()?.trim().parse().ok());
        Ok(Reply { status: response.status().as_u16(), retry_after_s })
    }
}

/// What the owner hears of a host that cannot be reached, or must not be.
const NO_CONNECTION: &str = "no connection";

/// Why a call failed, for the owner of the job.
fn reason(error: &reqwest::Error) -> String {
    let mut source = error.source();
    while let Some(cause) = source {
        if let Some(refused) = cause.downcast_ref::<AddressRefused>() {
            // For the operator only: to the owner it would tell which names resolve inside this network.
            tracing::warn!("a webhook is not sent: {refused}");
            return NO_CONNECTION.to_owned();
        }
        source = cause.source();
    }
    let text = if error.is_timeout() {
        "no answer in time"
    } else if error.is_connect() {
        NO_CONNECTION
    } else {
        "the connection broke"
    };
    text.to_owned()
}

/// A name has an address that is not public.
#[derive(Debug, thiserror::Error)]
#[error("the host's address is not public: {0}")]
struct AddressRefused(&'static str);

/// Resolves names to public addresses; a name with any other address is refused altogether.
struct PublicOnly(Lookup);

impl Resolve for PublicOnly {
    fn resolve(&self, name: Name) -> Resolving {
        let looked_up = (self.0)(name.as_str().to_owned());
        Box::pin(async move {
            let addresses = looked_up.await?;
            match addresses.iter().find_map(|address| address::not_public(address.ip())) {
                Some(reason) => Err(AddressRefused(reason).into()),
                None => Ok(Box::new(addresses.into_iter()) as Addrs),
            }
        })
    }
}

async fn look_up(name: String) -> io::Result<Vec<SocketAddr>> {
    // The port is that of the URL.
    Ok(tokio::net::lookup_host((name, 0)).await?.collect())
}

#[cfg(test)]
mod tests {
    use super::super::target::PrivateHosts;
    use super::*;
    use std::io::{Read as _, Write as _};
    use std::net::{IpAddr, TcpListener};

    const PATIENCE: Duration = Duration::from_secs(20);

    fn message() -> SignedMessage {
        SignedMessage { id: "msg_1".into(), timestamp: 7, signature: "v1,x".into(), payload: b"{}".to_vec() }
    }

    fn lookup(addresses: &[&str]) -> Lookup {
        let found: Vec<SocketAddr> =
            addresses.iter().map(|text| (text.parse::<IpAddr>().unwrap(), 0).into()).collect();
        Arc::new(move |_| {
            let found = found.clone();
            Box::pin(async move { Ok(found) })
        })
    }

    /// Why a name with these addresses does not resolve.
    async fn resolved(addresses: &[&str]) -> String {
        let resolving = PublicOnly(lookup(addresses)).resolve("rebinding.example".parse().unwrap());
        resolving.await.err().unwrap().to_string()
    }

    /// What a call to a host with these addresses gives.
    async fn called(addresses: &[&str]) -> String {
        let dialer = Dialer::with_lookup(PATIENCE, lookup(addresses)).unwrap();
        let target = WebhookTarget::parse("https://rebinding.example/", &PrivateHosts::default()).unwrap();
        dialer.call(&target, message()).await.unwrap_err()
    }

    #[tokio::test]
    async fn a_name_that_resolves_to_a_place_that_is_not_public_is_not_called() {
        for address in ["127.0.0.1", "::1", "10.0.0.1", "169.254.169.254", "::ffff:127.0.0.1", "0.0.0.0"] {
            let refused = resolved(&[address]).await;
            assert!(refused.contains("not public"), "{address}: {refused}");
            assert_eq!(called(&[address]).await, NO_CONNECTION, "nobody hears that the name resolves");
        }
        let mixed = resolved(&["8.8.8.8", "127.0.0.1"]).await;
        assert!(mixed.contains("not public"), "one bad address is enough: {mixed}");
        assert_eq!(called(&["8.8.8.8", "127.0.0.1"]).await, NO_CONNECTION);
    }

    /// Answers one connection with `answer`; gives what it heard.
    fn endpoint(answer: &'static str) -> (String, std::thread::JoinHandle<String>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let host = listener.local_addr().unwrap().to_string();
        let heard = std::thread::spawn(move || {
            let mut stream = listener.accept().unwrap().0;
            let mut heard = Vec::new();
            while !heard.ends_with(b"{}") {
                let mut bytes = [0; 4096];
                let count = stream.read(&mut bytes).unwrap();
                heard.extend_from_slice(&bytes[..count]);
            }
            stream.write_all(answer.as_bytes()).unwrap();
            String::from_utf8(heard).unwrap()
        });
        (host, heard)
    }

    async fn call(host: &str) -> Result<Reply, String> {
        let private = PrivateHosts::parse(&[host.to_owned()]).unwrap();
        let target = WebhookTarget::parse(&format!("http://{host}/hook?token=7"), &private).unwrap();
        Dialer::new(PATIENCE).unwrap().call(&target, message()).await
    }

    #[tokio::test]
    async fn a_message_is_posted_with_its_three_headers() {
        let (host, heard) = endpoint("HTTP/1.1 204 No Content\r\n\r\n");
        assert_eq!(call(&host).await, Ok(Reply { status: 204, retry_after_s: None }));
        let heard = heard.join().unwrap();
        assert!(heard.starts_with("POST /hook?token=7 HTTP/1.1\r\n"), "{heard}");
        for line in ["webhook-id: msg_1", "webhook-timestamp: 7", "webhook-signature: v1,x"] {
            assert!(heard.contains(line), "{heard}");
        }
    }

    #[tokio::test]
    async fn a_redirect_is_an_answer_and_not_followed() {
        let (host, _) =
            endpoint("HTTP/1.1 302 Found\r\nLocation: http://127.0.0.1:1/\r\nRetry-After: 9\r\n\r\n");
        assert_eq!(call(&host).await, Ok(Reply { status: 302, retry_after_s: Some(9) }));
    }

    #[tokio::test]
    async fn a_host_that_does_not_answer_is_told_without_its_address() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let host = listener.local_addr().unwrap().to_string();
        drop(listener);
        assert_eq!(call(&host).await, Err("no connection".to_owned()));
    }
}
