//! The other end of webhooks: takes calls and answers them as the test says.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::sync::mpsc;

use crate::server::PATIENCE;

/// An HTTP server on a free port of loopback.
pub(crate) struct Receiver {
    /// Its host and port.
    pub(crate) host: String,
    calls: mpsc::Receiver<Received>,
}

/// A call.
#[derive(Debug)]
pub(crate) struct Received {
    pub(crate) head: String,
    pub(crate) body: String,
}

impl Receiver {
    /// Answers with these statuses, one after the other, then with the last one.
    pub(crate) fn answering(statuses: &[u16]) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let host = listener.local_addr().unwrap().to_string();
        let (send, calls) = mpsc::channel();
        let mut statuses: Vec<u16> = statuses.iter().rev().copied().collect();
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                let mut stream = stream.unwrap();
                stream.set_read_timeout(Some(PATIENCE)).unwrap();
                let mut bytes = Vec::new();
                let call = loop {
                    if let Some(call) = Received::parse(&bytes) {
                        break call;
                    }
                    let mut piece = [0; 4096];
                    match stream.read(&mut piece) {
                        Ok(count) if count > 0 => bytes.extend_from_slice(&piece[..count]),
                        _ => panic!("half a call: {}", String::from_utf8_lossy(&bytes)),
                    }
                };
                let status = if statuses.len() > 1 { statuses.pop() } else { statuses.last().copied() };
                let answer = format!(
                    "HTTP/1.1 {} Said\r\nContent-Length: 0\r\nConnection: close\r\n\r\n",
                    status.unwrap_or(200)
                );
                stream.write_all(answer.as_bytes()).unwrap();
                if send.send(call).is_err() {
                    return;
                }
            }
        });
        Self { host, calls }
    }

    /// Whether no further call has come so far.
    pub(crate) fn is_left_alone(&self) -> bool {
        self.calls.try_recv().is_err()
    }

    /// The next call.
    pub(crate) fn next(&self) -> Received {
        self.calls.recv_timeout(PATIENCE).unwrap()
    }
}

impl Received {
    /// The call, once it is complete.
    fn parse(bytes: &[u8]) -> Option<Self> {
        let text = std::str::from_utf8(bytes).ok()?;
        let (head, body) = text.split_once("\r\n\r\n")?;
        let call = Self { head: head.to_owned(), body: body.to_owned() };
        let length: usize = call.header("content-length").parse().unwrap();
        (body.len() == length).then_some(call)
    }

    /// A header, or nothing.
    pub(crate) fn header(&self, name: &str) -> &str {
        let of = |line: &'_ str| -> Option<(usize, usize)> {
            let (found, value) = line.split_once(':')?;
            let begin = value.trim().as_ptr() as usize - line.as_ptr() as usize;
            found.eq_ignore_ascii_case(name).then_some((begin, begin + value.trim().len()))
        };
        self.head.lines().find_map(|line| of(line).map(|(begin, end)| &line[begin..end])).unwrap_or_default()
    }
}
