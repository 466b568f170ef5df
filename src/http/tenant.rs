//! Whom a request is charged to.

use std::net::IpAddr;

use axum::http::{HeaderMap, HeaderName};

use crate::jobs::Tenant;

const FORWARDED_FOR: HeaderName = HeaderName::from_static("x-forwarded-for");

/// The holder of the keys of this name, or whoever comes from this address.
pub(super) fn tenant(owner: Option<&str>, address: Option<IpAddr>) -> Tenant {
    match (owner, address) {
        (Some(owner), _) => Tenant::named(format!("key:{owner}")),
        (None, Some(address)) => Tenant::named(format!("address:{}", network(address))),
        (None, None) => Tenant::named("address:unknown"),
    }
}

/// The address, or of an IPv6 address the first half, which one customer has to himself.
pub(super) fn network(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(address) => IpAddr::V6((u128::from(address) >> 64 << 64).into()),
        address => address,
    }
}

/// The client's address: the connection's other end, or what the last of the trusted proxies says of it.
pub(super) fn client(headers: &HeaderMap, peer: Option<IpAddr>, trusted: &[IpAddr]) -> Option<IpAddr> {
    let is_trusted = |address: &IpAddr| trusted.contains(&address.to_canonical());
    let peer = peer?;
    if !is_trusted(&peer) {
        return Some(peer);
    }
    let lines = headers.get_all(FORWARDED_FOR).iter().filter_map(|value| value.to_str().ok());
    let said: Vec<&str> = lines.flat_map(|line| line.split(',')).map(str::trim).collect();
    // Each proxy adds the address that it sees at the end; what stands before a stranger's address is the stranger's word.
    for address in said.iter().rev() {
        match address.parse() {
            Ok(address) if is_trusted(&address) => {}
            Ok(address) => return Some(address),
            Err(_) => break,
        }
    }
    Some(peer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    #[test]
    fn without_a_key_an_address_is_charged_and_of_ipv6_its_first_half() {
        let of = |peer: &str| tenant(None, peer.parse().ok());
        assert_eq!(of("::ffff:10.0.0.1"), of("10.0.0.1"));
        assert_ne!(of("10.0.0.1"), of("10.0.0.2"));
        assert_eq!(of("2001:db8::1"), of("2001:db8::ffff:1"));
        assert_ne!(of("2001:db8::1"), of("2001:db8:0:1::1"));
        assert_ne!(tenant(Some("10.0.0.1"), None), of("10.0.0.1"), "a key may be called like an address");
        assert!(!tenant(None, None).is_nobody());
    }

    #[test]
    fn behind_trusted_proxies_the_last_address_that_they_say_counts_and_nobody_else_is_believed() {
        let trusted = ["10.0.0.7".parse().unwrap(), "10.0.0.8".parse().unwrap()];
        let of = |peer: &str, said: &'static str| {
            let headers = HeaderMap::from_iter([(FORWARDED_FOR, HeaderValue::from_static(said))]);
            client(&headers, peer.parse().ok(), &trusted).unwrap().to_string()
        };
        assert_eq!(of("10.0.0.7", "1.1.1.1, 9.9.9.9"), "9.9.9.9");
        assert_eq!(of("10.0.0.7", "1.1.1.1, 9.9.9.9, 10.0.0.8"), "9.9.9.9");
        assert_eq!(of("10.0.0.9", "1.1.1.1"), "10.0.0.9", "anybody can say so");
        assert_eq!(of("10.0.0.7", "unknown"), "10.0.0.7");
        assert_eq!(of("10.0.0.7", "9.9.9.9, _hidden"), "10.0.0.7");
    }
}
