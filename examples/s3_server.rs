//! An S3 server on loopback for campaigns, with its files in a folder: `s3_server FOLDER PORT`, until its input ends.

#[path = "../tests/support/s3_server.rs"]
mod server;

use std::io::Read as _;

fn main() {
    let mut args = std::env::args().skip(1);
    let folder = args.next().expect("a folder");
    let port = args.next().expect("a port").parse().expect("a port is a number");
    let running = server::S3Server::start(folder.as_ref(), port);
    assert_eq!(running.address.port(), port);
    let told = std::io::stdin().read_to_end(&mut Vec::new());
    told.expect("an input that ends");
}
