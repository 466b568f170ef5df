//! Which addresses may be dialled for a caller: the public ones, and no other.
//!
//! A caller who names a host makes this server speak to it. The server may reach what the caller may not: itself, its
//! private network, the metadata service of a cloud. So an address is refused unless it is certainly public. The tables
//! are the special-purpose registries of IANA (RFC 6890 and its updates); whatever is in them is refused, also the few
//! ranges that are reachable, because none of them is a place for a web server.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};

use ipnet::{Ipv4Net, Ipv6Net};

const fn v4(a: u8, b: u8, c: u8, d: u8, bits: u8) -> Ipv4Net {
    Ipv4Net::new_assert(Ipv4Addr::new(a, b, c, d), bits)
}

const fn v6(a: u16, b: u16, c: u16, d: u16, bits: u8) -> Ipv6Net {
    Ipv6Net::new_assert(Ipv6Addr::new(a, b, c, d, 0, 0, 0, 0), bits)
}

/// IPv4 ranges that are not public.
const SPECIAL_V4: [(Ipv4Net, &str); 18] = [
    (v4(0, 0, 0, 0, 8), "this network"),
    (v4(10, 0, 0, 0, 8), "private"),
    (v4(100, 64, 0, 0, 10), "shared by carriers"),
    (v4(127, 0, 0, 0, 8), "loopback"),
    (v4(168, 63, 129, 16, 32), "metadata of a cloud"),
    (v4(169, 254, 0, 0, 16), "link-local"),
    (v4(172, 16, 0, 0, 12), "private"),
    (v4(192, 0, 0, 0, 24), "protocol assignments"),
    (v4(192, 0, 2, 0, 24), "documentation"),
    (v4(192, 31, 196, 0, 24), "AS112"),
    (v4(192, 52, 193, 0, 24), "multicast tunnels"),
    (v4(192, 88, 99, 0, 24), "6to4 relays"),
    (v4(192, 168, 0, 0, 16), "private"),
    (v4(192, 175, 48, 0, 24), "AS112"),
    (v4(198, 18, 0, 0, 15), "benchmarks"),
    (v4(198, 51, 100, 0, 24), "documentation"),
    (v4(203, 0, 113, 0, 24), "documentation"),
    // Multicast 224/4, reserved 240/4 and the broadcast address.
    (v4(224, 0, 0, 0, 3), "multicast or reserved"),
];

/// The only IPv6 range in which public addresses are assigned.
const GLOBAL_UNICAST: Ipv6Net = v6(0x2000, 0, 0, 0, 3);

/// Ranges inside [`GLOBAL_UNICAST`] that are not public.
const SPECIAL_V6: [(Ipv6Net, &str); 5] = [
    // Teredo, benchmarks, ORCHID and other protocols.
    (v6(0x2001, 0, 0, 0, 23), "protocol assignments"),
    (v6(0x2001, 0xdb8, 0, 0, 32), "documentation"),
    (v6(0x2002, 0, 0, 0, 16), "6to4"),
    (v6(0x2620, 0x4f, 0x8000, 0, 48), "AS112"),
    (v6(0x3fff, 0, 0, 0, 20), "documentation"),
];

/// What a translator between the two families hides an IPv4 address in.
const NAT64: Ipv6Net = v6(0x64, 0xff9b, 0, 0, 96);

/// Why `address` is not public; `None`: it is.
pub(super) fn not_public(address: IpAddr) -> Option<&'static str> {
    match address {
        IpAddr::V4(address) => {
            SPECIAL_V4.iter().find(|(net, _)| net.contains(&address)).map(|&(_, name)| name)
        }
        IpAddr::V6(address) => not_public_v6(address),
    }
}

fn not_public_v6(address: Ipv6Addr) -> Option<&'static str> {
    // These reach the IPv4 address that they hold, so that one counts.
    if let Some(inner) = address.to_ipv4_mapped() {
        return not_public(inner.into());
    }
    if NAT64.contains(&address) {
        let [.., a, b, c, d] = address.octets();
        return not_public(Ipv4Addr::new(a, b, c, d).into());
    }
    if !GLOBAL_UNICAST.contains(&address) {
        return Some("not global unicast");
    }
    SPECIAL_V6.iter().find(|(net, _)| net.contains(&address)).map(|&(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reason(address: &str) -> Option<&'static str> {
        not_public(address.parse().unwrap())
    }

    #[test]
    fn public_addresses_are_public_whatever_they_are_wrapped_in() {
        for address in [
            "1.1.1.1",
            "8.8.8.8",
            "93.184.216.34",
            "172.15.255.255",
            "172.32.0.0",
            "100.63.255.255",
            "100.128.0.0",
            "223.255.255.255",
            "2606:4700:4700::1111",
            "2a00:1450:4001:82a::200e",
            "::ffff:8.8.8.8",
            "64:ff9b::8.8.8.8",
        ] {
            assert_eq!(reason(address), None, "{address}");
        }
    }

    #[test]
    fn the_first_and_the_last_address_of_every_special_range_are_refused() {
        for (net, name) in SPECIAL_V4 {
            assert_eq!(not_public(net.network().into()), Some(name));
            assert_eq!(not_public(net.broadcast().into()), Some(name));
        }
        for (net, name) in SPECIAL_V6 {
            assert_eq!(not_public(net.network().into()), Some(name));
            assert_eq!(not_public(net.broadcast().into()), Some(name));
        }
    }

    #[test]
    fn an_address_that_hides_another_one_is_judged_by_it_or_refused() {
        for address in [
            "::ffff:127.0.0.1",
            "::ffff:169.254.169.254",
            "::127.0.0.1",
            "::8.8.8.8",
            "64:ff9b::10.0.0.1",
            "64:ff9b:1::8.8.8.8",
            "2002:7f00:1::",
            "2001:0:4136:e378:8000:63bf:3fff:fdd2",
        ] {
            assert!(reason(address).is_some(), "{address}");
        }
    }

    #[test]
    fn what_is_outside_of_global_unicast_is_refused() {
        for address in [
            "::",
            "::1",
            "100::1",
            "5f00::1",
            "fc00::1",
            "fd00:ec2::254",
            "fe80::1",
            "fec0::1",
            "ff02::1",
            "4000::1",
        ] {
            assert_eq!(reason(address), Some("not global unicast"), "{address}");
        }
    }
}
