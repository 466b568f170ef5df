//! The URLs that may be called.

use std::net::IpAddr;

use url::{Host, Url};

use super::address;

/// Longest URL, in bytes.
pub const URL_BYTES_MAX: usize = 2048;

/// Names that never leave this machine or this network (RFC 6761, RFC 6762, RFC 8375 and the names of metadata
/// services). Whatever else resolves to such a place is refused by its address.
const LOCAL_NAMES: [&str; 8] =
    ["localhost", "local", "internal", "localdomain", "home.arpa", "lan", "intranet", "onion"];

/// Why a URL is not called.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TargetError {
    /// It is no URL.
    #[error("it is no URL: {0}")]
    NotAUrl(url::ParseError),
    /// It is longer than [`URL_BYTES_MAX`].
    #[error("it is longer than {URL_BYTES_MAX} bytes")]
    TooLong,
    /// Neither https nor, for a private host, http.
    #[error("it must begin with https://")]
    NotHttps,
    /// It holds a user name or password.
    #[error("it must not hold a user name or a password")]
    Credentials,
    /// It has a fragment, which is never sent.
    #[error("it must not have a fragment")]
    Fragment,
    /// Its host is a name of this machine or network.
    #[error("its host is not public")]
    LocalName,
    /// Its host is an address that is not public.
    #[error("its address is not public: {0}")]
    NotPublic(&'static str),
}

/// Hosts that the operator lets be called although they are not public, as `host:port`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PrivateHosts(Vec<(String, u16)>);

impl PrivateHosts {
    /// Reads a list of `host:port`.
    ///
    /// # Errors
    /// The first item that is something else.
    pub fn parse(items: &[String]) -> Result<Self, String> {
        let host_and_port = |item: &String| {
            let url = Url::parse(&format!("http://{item}/")).ok()?;
            let is_bare = url.username().is_empty() && url.password().is_none() && url.path() == "/";
            let names_port = item.rsplit_once(':').is_some_and(|(_, port)| port.parse::<u16>().is_ok());
            (is_bare && names_port && url.query().is_none() && url.fragment().is_none())
                .then(|| Some((host_of(&url)?, url.port_or_known_default()?)))
                .flatten()
        };
        let parsed = items.iter().map(|item| host_and_port(item).ok_or_else(|| item.clone()));
        Ok(Self(parsed.collect::<Result<_, _>>()?))
    }

    fn lists(&self, url: &Url) -> bool {
        let is_it = |(host, port): &(String, u16)| {
            host_of(url).as_ref() == Some(host) && url.port_or_known_default() == Some(*port)
        };
        self.0.iter().any(is_it)
    }
}

/// A URL that may be called, as far as it tells by itself. A name may still resolve to an address that may not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WebhookTarget {
    url: Url,
    is_private: bool,
}

impl WebhookTarget {
    /// Checks a URL.
    ///
    /// # Errors
    /// What speaks against it.
    pub fn parse(text: &str, private: &PrivateHosts) -> Result<Self, TargetError> {
        if text.len() > URL_BYTES_MAX {
            return Err(TargetError::TooLong);
        }
        let url = Url::parse(text).map_err(TargetError::NotAUrl)?;
        let is_private = private.lists(&url);
        if !(url.scheme() == "https" || (is_private && url.scheme() == "http")) {
            return Err(TargetError::NotHttps);
        }
        if !url.username().is_empty() || url.password().is_some() {
            return Err(TargetError::Credentials);
        }
        if url.fragment().is_some() {
            return Err(TargetError::Fragment);
        }
        if !is_private {
            check_host(&url)?;
        }
        Ok(Self { url, is_private })
    }

    /// The URL to call.
    pub(super) fn url(&self) -> &Url {
        &self.url
    }

    /// The operator listed the host, so its address does not matter.
    pub(super) fn is_private(&self) -> bool {
        self.is_private
    }
}

/// The host in its one spelling: an address as such, a name in lower case without a dot at its end.
fn host_of(url: &Url) -> Option<String> {
    match url.host()? {
        Host::Domain(name) => Some(name.strip_suffix('.').unwrap_or(name).to_owned()),
        Host::Ipv4(address) => Some(address.to_string()),
        Host::Ipv6(address) => Some(address.to_string()),
    }
}

fn check_host(url: &Url) -> Result<(), TargetError> {
    let address: IpAddr = match url.host() {
        None => return Err(TargetError::LocalName),
        Some(Host::Ipv4(address)) => address.into(),
        Some(Host::Ipv6(address)) => address.into(),
        Some(Host::Domain(name)) => {
            let name = name.strip_suffix('.').unwrap_or(name);
            let ends_in = |local: &str| name == local || name.ends_with(&format!(".{local}"));
            // A name without a dot is completed by the search list of this machine.
            let is_local = !name.contains('.') || LOCAL_NAMES.iter().any(|local| ends_in(local));
            return if is_local { Err(TargetError::LocalName) } else { Ok(()) };
        }
    };
    match address::not_public(address) {
        Some(reason) => Err(TargetError::NotPublic(reason)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// URLs that reach, or try to reach, what is not public, and URLs that hide where they go.
    pub(in crate::jobs::webhook) const REFUSED: [&str; 84] = [
        // Loopback in every spelling.
        "https://127.0.0.1/",
        "https://127.1/",
        "https://127.0.1/",
        "https://127.255.255.254/",
        "https://2130706433/",
        "https://0x7f000001/",
        "https://0x7f.1/",
        "https://0x7f.0x0.0x0.0x1/",
        "https://017700000001/",
        "https://0177.0.0.01/",
        "https://0177.1/",
        "https://127.0.0.1./",
        "https://%31%32%37.0.0.1/",
        "https://%6c%6f%63alhost/",
        "https://①②⑦.⓪.⓪.①/",
        "https://127。0。0。1/",
        "https://[::1]/",
        "https://[0:0:0:0:0:0:0:1]/",
        "https://[0000::0001]/",
        "https://[::ffff:127.0.0.1]/",
        "https://[::ffff:7f00:1]/",
        "https://[::127.0.0.1]/",
        "https://[64:ff9b::127.0.0.1]/",
        "https://[64:ff9b:1::127.0.0.1]/",
        "https://[2002:7f00:1::]/",
        "https://[2001:0:7f00:1::]/",
        "https://localhost/",
        "https://LOCALHOST/",
        "https://localhost./",
        "https://ｌocalhost/",
        "https://a.localhost/",
        "https://localhost.localdomain/",
        "https://ip6-localhost/",
        // This host and every host.
        "https://0/",
        "https://0.0.0.0/",
        "https://0x0/",
        "https://00/",
        "https://[::]/",
        "https://255.255.255.255/",
        "https://4294967295/",
        // Private networks.
        "https://10.0.0.1/",
        "https://10.1/",
        "https://167772161/",
        "https://0xa000001/",
        "https://012.0.0.1/",
        "https://172.16.0.1/",
        "https://172.31.255.255/",
        "https://192.168.1.1/",
        "https://3232235777/",
        "https://0xc0.0xa8.1.1/",
        "https://100.64.0.1/",
        "https://[fc00::1]/",
        "https://[fd12:3456:789a::1]/",
        "https://[fec0::1]/",
        "https://[::ffff:192.168.1.1]/",
        "https://[2002:c0a8:101::1]/",
        // Link-local addresses and metadata services.
        "https://169.254.169.254/latest/meta-data/",
        "https://2852039166/",
        "https://0xa9fea9fe/",
        "https://0251.0376.0251.0376/",
        "https://169.254.43518/",
        "https://[::ffff:169.254.169.254]/",
        "https://[64:ff9b::a9fe:a9fe]/",
        "https://[fd00:ec2::254]/",
        "https://[fe80::1]/",
        "https://[fe80::1%25eth0]/",
        "https://100.100.100.200/",
        "https://192.0.0.192/",
        "https://168.63.129.16/",
        "https://metadata.google.internal/",
        "https://metadata.google.internal./",
        "https://metadata/",
        "https://printer.local/",
        // Special ranges.
        "https://192.0.2.1/",
        "https://198.18.0.1/",
        "https://224.0.0.1/",
        "https://240.0.0.1/",
        "https://[ff02::1]/",
        "https://[2001:db8::1]/",
        // Hosts that are not what they seem, and other schemes.
        "https://example.com@127.0.0.1/",
        "https://user:secret@example.com/",
        "https://127.0.0.1\\@example.com/",
        "http://example.com/",
        "file:///etc/passwd",
    ];

    #[test]
    fn no_spelling_of_a_place_that_is_not_public_is_taken() {
        for text in REFUSED {
            assert!(WebhookTarget::parse(text, &PrivateHosts::default()).is_err(), "{text}");
        }
    }

    #[test]
    fn what_is_no_place_to_call_is_refused_with_its_reason() {
        let error = |text: &str| WebhookTarget::parse(text, &PrivateHosts::default()).unwrap_err();
        assert_eq!(error("gopher://example.com/"), TargetError::NotHttps);
        assert_eq!(error("https://example.com/#a"), TargetError::Fragment);
        assert_eq!(error("https://example.com/ @[::1]/#a"), TargetError::Fragment);
        assert_eq!(
            error(&format!("https://example.com/{}", "a".repeat(URL_BYTES_MAX))),
            TargetError::TooLong
        );
        for text in ["", "https://", "https://[::1", "https://256.256.256.256/", "https://exa mple.com/"] {
            assert!(matches!(error(text), TargetError::NotAUrl(_)), "{text}");
        }
    }

    #[test]
    fn a_public_host_is_taken() {
        for text in ["https://example.com/hook?token=1", "https://EXAMPLE.com:8443/", "https://8.8.8.8/"] {
            assert!(WebhookTarget::parse(text, &PrivateHosts::default()).is_ok(), "{text}");
        }
    }

    #[test]
    fn a_listed_host_may_be_private_and_without_encryption_at_its_port_only() {
        let items = ["127.0.0.1:9000".to_owned(), "orders.internal:80".to_owned()];
        let private = PrivateHosts::parse(&items).unwrap();
        let is_taken = |text: &str| WebhookTarget::parse(text, &private).is_ok();
        assert!(is_taken("http://127.0.0.1:9000/hook") && is_taken("http://orders.internal/hook"));
        assert!(is_taken("http://2130706433:9000/"), "the same address in another spelling");
        assert!(!is_taken("http://127.0.0.1:9001/") && !is_taken("http://127.0.0.2:9000/"));
        assert!(!is_taken("http://example.com:9000/"));
        for item in ["orders.internal", "http://a:1", "a:1/x", "a@b:1", "", "a:99999"] {
            assert_eq!(PrivateHosts::parse(&[item.to_owned()]), Err(item.to_owned()), "{item}");
        }
    }
}
