//! Asks the service on this machine whether it is ready, for container runtimes.

use std::io::{Read as _, Write as _};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream};
use std::time::Duration;

use anyhow::{Context as _, bail, ensure};

use crate::config::Config;

/// Time for each step of the exchange.
const PATIENCE: Duration = Duration::from_secs(2);
/// How much of an answer is read: its status line is all that counts.
const ANSWER_BYTES_MAX: u64 = 4096;

/// Asks `/readyz` of the admin listener.
///
/// # Errors
/// No admin listener, no answer, or one that is not 200.
pub fn healthcheck(config: &Config) -> anyhow::Result<()> {
    let Some(address) = config.admin_listen else {
        bail!("there is no admin listener to ask: `admin_listen` is off")
    };
    let address = reachable(address);
    let status = ask(address).with_context(|| format!("no answer from {address}"))?;
    ensure!(status.split(' ').nth(1) == Some("200"), "not ready: {status}");
    Ok(())
}

/// An address that listens on all interfaces is reached by way of loopback.
fn reachable(address: SocketAddr) -> SocketAddr {
    let ip = match address.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    SocketAddr::new(ip, address.port())
}

/// The status line of the answer.
fn ask(address: SocketAddr) -> std::io::Result<String> {
    let mut stream = TcpStream::connect_timeout(&address, PATIENCE)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let request = format!("GET /readyz HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n");
    stream.write_all(request.as_bytes())?;
    let mut answer = Vec::new();
    stream.take(ANSWER_BYTES_MAX).read_to_end(&mut answer)?;
    Ok(String::from_utf8_lossy(&answer).lines().next().unwrap_or_default().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// What the check says of a service that answers with `answer`.
    fn check(answer: &'static str) -> anyhow::Result<()> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let address = format!("0.0.0.0:{}", listener.local_addr().unwrap().port());
        let server = std::thread::spawn(move || {
            let mut stream = listener.accept().unwrap().0;
            let mut request = [0; 1024];
            let _ = stream.read(&mut request).unwrap();
            stream.write_all(answer.as_bytes()).unwrap();
        });
        let flags = vec![("admin_listen".to_owned(), address)];
        let loaded = crate::config::Sources { flags, ..Default::default() }.load().unwrap();
        let result = healthcheck(&loaded.config);
        server.join().unwrap();
        result
    }

    #[test]
    fn a_ready_service_is_healthy_and_no_other() {
        assert!(check("HTTP/1.1 200 OK\r\n\r\nready\n").is_ok());
        assert!(check("HTTP/1.1 503 Service Unavailable\r\n\r\n").is_err());
        assert!(check("").is_err());
    }
}
