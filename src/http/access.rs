//! Who may use the API: holders of a key, or, without keys, whoever speaks to this host directly.
//!
//! Without keys a page of another site must not be able to use a service that only its visitor can reach. So `Host`
//! must be loopback or listed (a name that an attacker lets point here is neither), `Origin` must be this very host or
//! listed, and forwarding headers, which would mean that others reach the service through a proxy, are refused unless
//! the proxy is trusted. Origins that may read answers (`cors_origins`) may also ask.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};

use axum::http::{HeaderMap, HeaderName, header};

use super::keys::{ApiKeys, Holder};
use crate::wire::{Problem, ProblemCode};

/// Headers that a proxy adds.
const FORWARDING: [HeaderName; 5] = [
    header::FORWARDED,
    HeaderName::from_static("x-forwarded-for"),
    HeaderName::from_static("x-forwarded-host"),
    HeaderName::from_static("x-forwarded-proto"),
    HeaderName::from_static("x-real-ip"),
];

/// Who may use the API.
#[derive(Debug, Clone)]
pub enum Access {
    /// Holders of one of these keys.
    Keys(ApiKeys),
    /// Everybody who reaches the service, under the rules of this module.
    Anonymous(TrustedPeers),
}

/// The hosts and proxies that anonymous access trusts.
#[derive(Debug, Clone, Default)]
pub struct TrustedPeers {
    /// Host names or addresses, without port and besides loopback, that requests may name, and whose pages may send them.
    /// `*` allows any.
    pub allowed_hosts: Vec<String>,
    /// Origins whose pages may use the service.
    pub allowed_origins: Vec<String>,
    /// Addresses of proxies whose forwarding headers are taken.
    pub trusted_proxies: Vec<IpAddr>,
}

impl Access {
    /// Whether a key is asked for.
    pub(super) fn has_keys(&self) -> bool {
        matches!(self, Self::Keys(_))
    }

    /// The holder of the key (`None`: anonymous), or why the request is refused. `peer` is the connection's other end.
    pub(super) fn check(&self, headers: &HeaderMap, peer: Option<IpAddr>) -> Result<Option<Holder>, Problem> {
        match self {
            Self::Keys(keys) => presented_key(headers)
                .and_then(|key| keys.holder_of(key))
                .map(Some)
                .ok_or_else(|| Problem::new(ProblemCode::Unauthenticated, "a valid API key is required")),
            Self::Anonymous(neighbours) => neighbours.check(headers, peer).map(|()| None),
        }
    }
}

/// The key in `Authorization: Bearer KEY` or `X-API-Key: KEY`.
fn presented_key(headers: &HeaderMap) -> Option<&[u8]> {
    if let Some(value) = headers.get(header::AUTHORIZATION) {
        let (scheme, key) = value.as_bytes().split_at_checked(7)?;
        return scheme.eq_ignore_ascii_case(b"bearer ").then_some(key.trim_ascii());
    }
    Some(headers.get("x-api-key")?.as_bytes().trim_ascii())
}

impl TrustedPeers {
    fn check(&self, headers: &HeaderMap, peer: Option<IpAddr>) -> Result<(), Problem> {
        let host = text(headers, &header::HOST).unwrap_or_default();
        if !self.knows(host_of(host)) {
            return Err(forbidden(
                "anonymous access answers only requests to loopback hosts and to those in `allowed_hosts`",
            ));
        }
        if let Some(origin) = headers.get(header::ORIGIN) {
            let origin = origin.to_str().unwrap_or_default();
            let place = origin.split_once("://").map_or("", |(_, rest)| rest);
            let is_same = !place.is_empty() && place.eq_ignore_ascii_case(host);
            let is_listed = self.allowed_origins.iter().any(|allowed| allowed == origin);
            if !is_same && !is_listed && !self.lists(host_of(place)) {
                return Err(forbidden("anonymous access answers no pages of other origins"));
            }
        }
        let is_trusted = peer.is_some_and(|peer| self.trusted_proxies.contains(&peer.to_canonical()));
        match FORWARDING.iter().find(|name| headers.contains_key(*name)) {
            Some(name) if !is_trusted => Err(forbidden(format!(
                "anonymous access takes the header `{name}` only from an address in `trusted_proxies`"
            ))),
            _ => Ok(()),
        }
    }

    fn knows(&self, host: &str) -> bool {
        is_loopback(host) || self.lists(host)
    }

    fn lists(&self, host: &str) -> bool {
        let matches = |allowed: &String| allowed == "*" || host_of(allowed).eq_ignore_ascii_case(host);
        !host.is_empty() && self.allowed_hosts.iter().any(matches)
    }
}

fn forbidden(detail: impl Into<String>) -> Problem {
    Problem::new(ProblemCode::Forbidden, detail)
}

fn text<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    headers.get(name)?.to_str().ok()
}

/// The host of `host[:port]`, without the brackets of an IPv6 address; empty when it is neither.
fn host_of(authority: &str) -> &str {
    let is_port = |port: &str| port.bytes().all(|byte| byte.is_ascii_digit());
    if let Some(rest) = authority.strip_prefix('[') {
        return match rest.split_once(']') {
            Some((host, "")) => host,
            Some((host, behind)) if behind.strip_prefix(':').is_some_and(is_port) => host,
            _ => "",
        };
    }
    // More than one colon without brackets is an IPv6 address without port.
    match authority.split_once(':') {
        Some((host, port)) if is_port(port) => host,
        Some((_, port)) if !port.contains(':') => "",
        _ => authority,
    }
}

fn is_loopback(host: &str) -> bool {
    let name = host.strip_suffix('.').unwrap_or(host);
    let is_localhost = name.rsplit('.').next().is_some_and(|last| last.eq_ignore_ascii_case("localhost"))
        && !name.starts_with('.');
    is_localhost
        || host.parse::<Ipv4Addr>().is_ok_and(|ip| ip.is_loopback())
        || host.parse::<Ipv6Addr>().is_ok_and(|ip| ip.to_canonical().is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    fn answer(headers: &[(&'static str, &'static str)]) -> Result<(), ProblemCode> {
        let neighbours = TrustedPeers {
            allowed_hosts: vec!["mesh.example".into()],
            allowed_origins: vec!["https://shop.example".into()],
            trusted_proxies: vec!["10.0.0.7".parse().unwrap()],
        };
        from_peer(&Access::Anonymous(neighbours), headers, "10.0.0.8").map(|_| ())
    }

    fn from_peer(
        access: &Access,
        headers: &[(&'static str, &'static str)],
        peer: &str,
    ) -> Result<Option<String>, ProblemCode> {
        let pairs = headers
            .iter()
            .map(|&(name, value)| (HeaderName::from_static(name), HeaderValue::from_static(value)));
        let checked = access.check(&HeaderMap::from_iter(pairs), peer.parse().ok());
        checked.map(|holder| holder.map(|holder| holder.owner)).map_err(|problem| problem.code)
    }

    #[test]
    fn loopback_and_listed_hosts_are_answered() {
        for host in ["localhost", "localhost:8080", "LOCALHOST.:1", "127.0.0.1:80", "127.8.8.8", "[::1]:8080"]
        {
            assert_eq!(answer(&[("host", host)]), Ok(()), "{host}");
        }
        assert_eq!(answer(&[("host", "Mesh.Example:443")]), Ok(()));
    }

    #[test]
    fn a_foreign_host_is_refused() {
        for host in [
            "evil.example",
            "192.168.1.4:8080",
            "localhost.evil.example",
            "notlocalhost",
            "",
            "[::2]",
            "::1x",
            "[::1]evil.example",
            "[::1]:80evil",
            "[::1",
            "localhost:evil.example",
        ] {
            assert_eq!(answer(&[("host", host)]), Err(ProblemCode::Forbidden), "{host}");
        }
        assert_eq!(answer(&[]), Err(ProblemCode::Forbidden));
    }

    #[test]
    fn a_page_may_use_its_own_host_and_a_listed_one_may_use_any() {
        assert_eq!(answer(&[("host", "localhost:80"), ("origin", "http://localhost:80")]), Ok(()));
        assert_eq!(answer(&[("host", "localhost:80"), ("origin", "https://mesh.example")]), Ok(()));
        assert_eq!(answer(&[("host", "localhost:80"), ("origin", "https://shop.example")]), Ok(()));
    }

    #[test]
    fn a_page_of_another_origin_is_refused() {
        for origin in [
            "http://localhost:3000",
            "http://evil.example",
            "null",
            "https://mesh.example.evil",
            "http://shop.example",
            "https://shop.example:444",
        ] {
            let headers = [("host", "localhost:80"), ("origin", origin)];
            assert_eq!(answer(&headers), Err(ProblemCode::Forbidden), "{origin}");
        }
    }

    #[test]
    fn forwarding_headers_are_taken_from_a_trusted_proxy_only() {
        let access = |proxies: &[&str]| {
            Access::Anonymous(TrustedPeers {
                trusted_proxies: proxies.iter().map(|p| p.parse().unwrap()).collect(),
                ..TrustedPeers::default()
            })
        };
        let headers = [("host", "localhost"), ("x-forwarded-for", "8.8.8.8")];
        assert_eq!(from_peer(&access(&[]), &headers, "10.0.0.8"), Err(ProblemCode::Forbidden));
        assert_eq!(from_peer(&access(&["10.0.0.8"]), &headers, "10.0.0.8"), Ok(None));
        assert_eq!(from_peer(&access(&["10.0.0.8"]), &headers, "::ffff:10.0.0.8"), Ok(None));
    }

    #[test]
    fn a_key_comes_as_bearer_or_in_its_own_header() {
        let access = Access::Keys(ApiKeys::parse("open-sesame").unwrap());
        let owner = |headers: &[(&'static str, &'static str)]| from_peer(&access, headers, "10.0.0.8");
        let name = owner(&[("authorization", "Bearer open-sesame")]).unwrap();
        assert!(name.is_some());
        assert_eq!(owner(&[("x-api-key", "open-sesame")]), Ok(name));
        for headers in [
            &[("authorization", "Bearer open")][..],
            &[("authorization", "Basic open-sesame")],
            &[("authorization", "B")],
            &[("x-api-key", "")],
            &[],
        ] {
            assert_eq!(owner(headers), Err(ProblemCode::Unauthenticated), "{headers:?}");
        }
    }
}
