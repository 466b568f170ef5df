//! How many connections one address may have, so that nobody takes all places by saying nothing on them.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::metrics;
use super::tenant::network;

/// Open connections by address.
#[derive(Debug)]
pub(super) struct ConnectionShares {
    of_one: usize,
    /// Proxies: behind each of them are many clients.
    exempt: Vec<IpAddr>,
    open: Mutex<HashMap<IpAddr, usize>>,
}

/// A connection that is counted, until dropped.
#[derive(Debug)]
pub(super) struct ConnectionShare {
    shares: Arc<ConnectionShares>,
    address: IpAddr,
}

impl ConnectionShares {
    /// `of_one` for each address but those that are `exempt`.
    pub(super) fn new(of_one: usize, exempt: Vec<IpAddr>) -> Self {
        Self { of_one, exempt, open: Mutex::default() }
    }

    /// Counts a connection; `None`: its address has as many as it may.
    pub(super) fn take(self: &Arc<Self>, address: IpAddr) -> Option<ConnectionShare> {
        let is_exempt = self.exempt.contains(&address.to_canonical());
        let address = network(address);
        let mut open = self.lock();
        let count = open.entry(address).or_default();
        if *count >= self.of_one && !is_exempt {
            metrics::count_closed_at_once();
            return None;
        }
        *count += 1;
        Some(ConnectionShare { shares: Arc::clone(self), address })
    }

    fn lock(&self) -> MutexGuard<'_, HashMap<IpAddr, usize>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for ConnectionShare {
    fn drop(&mut self) {
        let mut open = self.shares.lock();
        if let Some(count) = open.get_mut(&self.address) {
            *count -= 1;
            if *count == 0 {
                open.remove(&self.address);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_address_has_its_share_and_a_trusted_proxy_any_number() {
        let address = |text: &str| text.parse::<IpAddr>().unwrap();
        let shares = Arc::new(ConnectionShares::new(2, vec![address("10.0.0.7")]));
        let first = shares.take(address("2001:db8::1")).unwrap();
        let second = shares.take(address("2001:db8::2")).unwrap();
        assert!(shares.take(address("2001:db8::3")).is_none(), "one customer has all of them");
        assert!(shares.take(address("2001:db8:0:1::1")).is_some());
        let proxied: Vec<_> = (0..5).map(|_| shares.take(address("::ffff:10.0.0.7")).unwrap()).collect();
        drop(first);
        assert!(shares.take(address("2001:db8::3")).is_some());
        drop((second, proxied));
        assert!(shares.lock().is_empty(), "who has none is forgotten");
    }
}
