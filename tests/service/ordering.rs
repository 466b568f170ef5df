//! The ordering backend of `examples/` against a real server.

use crate::meshes::BROKEN;
use crate::server::{Server, patiently};
use serde_json::Value;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A free port at a loopback address of this process alone. The server has to know the backend's
/// address before the backend listens, and a port of 127.0.0.1 could go to another test meanwhile.
fn own_host() -> String {
    let [_, high, middle, low] = std::process::id().to_be_bytes();
    let address = format!("127.{}.{middle}.{low}:0", 64 | (high & 63));
    TcpListener::bind(address).unwrap().local_addr().unwrap().to_string()
}

struct Backend {
    child: Child,
    url: String,
}

impl Backend {
    fn start(server: &Server, host: &str, folder: &Path) -> Self {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/ordering-backend/backend.py");
        let mut child = Command::new("python3")
            .arg(script)
            .args(["--listen", host, "--pause", "0.2", "--data"])
            .arg(folder)
            .env("MESHMEND_URL", format!("http://{}", server.address))
            .env("WEBHOOK_SECRET", "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw")
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        lines.read_line(&mut line).unwrap();
        let url = line.trim().strip_prefix("listening on ").unwrap().to_owned();
        std::thread::spawn(move || std::io::copy(&mut lines, &mut std::io::sink()));
        Self { child, url }
    }

    fn order(&self, client: &reqwest::blocking::Client, mesh: &str, query: &str) -> u64 {
        let url = format!("{}/orders?policy=sls&{query}", self.url);
        let response = client.post(url).body(mesh.to_owned()).send().unwrap();
        assert_eq!(response.status(), 202);
        response.json::<Value>().unwrap()["order"].as_u64().unwrap()
    }

    fn settled(&self, client: &reqwest::blocking::Client, order: u64) -> Value {
        patiently(|| {
            let response = client.get(format!("{}/orders/{order}", self.url)).send().unwrap();
            let order: Value = response.json().unwrap();
            ["quoted", "asked", "refused"].iter().any(|state| order["state"] == *state).then_some(order)
        })
    }
}

impl Drop for Backend {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A cube of 30 units, turned inside out in one face.
const CUBE: &str = "OFF\n8 12 0\n0 0 0\n30 0 0\n30 30 0\n0 30 0\n0 0 30\n30 0 30\n30 30 30\n0 30 30\n\
    3 0 1 2\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";

/// A tetrahedron of 30 mm without its last face.
const OPEN: &str = "OFF\n4 3 0\n0 0 0\n30 0 0\n0 30 0\n0 0 30\n3 0 2 1\n3 0 1 3\n3 0 3 2\n";

/// A plate of a tenth of a millimetre.
const THIN: &str = "OFF\n8 12 0\n0 0 0\n30 0 0\n30 30 0\n0 30 0\n0 0 0.1\n30 0 0.1\n30 30 0.1\n0 30 0.1\n\
    3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";

fn answered(backend: &Backend, client: &reqwest::blocking::Client, order: &Value, query: &str) -> Value {
    let url = format!("{}/orders/{}/answer?{query}", backend.url, order["number"]);
    assert_eq!(client.post(url).send().unwrap().status(), 202);
    patiently(|| {
        let order = backend.settled(client, order["number"].as_u64().unwrap());
        (order["version"] != 1).then_some(order)
    })
}

#[test]
fn the_customer_is_asked_before_a_price_is_made_of_a_guess() {
    let host = own_host();
    let server = Server::with(&["--webhooks", "--webhook-private-hosts", &host, "--webhook-pause", "100ms"]);
    let folder = tempfile::tempdir().unwrap();
    let backend = Backend::start(&server, &host, folder.path());
    let client = reqwest::blocking::Client::new();
    // 5 units: millimetres or inches?
    let small = CUBE.replace("30", "5");
    let asked = backend.settled(&client, backend.order(&client, &small, ""));
    assert_eq!(asked["state"], "asked", "{asked}");
    assert!(asked["problem"].as_str().unwrap().contains("127 mm (if the unit is in)"), "{asked}");
    let quoted = answered(&backend, &client, &asked, "units=in");
    assert_eq!(quoted["state"], "quoted", "{quoted}");
    assert!((quoted["volume_mm3"].as_f64().unwrap() - 127f64.powi(3)).abs() < 1.0, "{quoted}");
    // A quarter of the surface would be made up.
    let asked = backend.settled(&client, backend.order(&client, OPEN, "units=mm"));
    assert_eq!((&asked["state"], &asked["fidelity"]), (&"asked".into(), &"changed".into()), "{asked}");
    let quoted = answered(&backend, &client, &asked, "accept=changes");
    assert_eq!(quoted["state"], "quoted", "{quoted}");
    // Walls of a tenth of a millimetre are no part for this process.
    let refused = backend.settled(&client, backend.order(&client, THIN, "units=mm"));
    assert_eq!(refused["state"], "refused", "{refused}");
    assert!(refused["problem"].as_str().unwrap().contains("wall"), "{refused}");
}

#[test]
fn an_order_is_repaired_measured_and_quoted_once_and_a_broken_file_is_refused() {
    let host = own_host();
    let server = Server::with(&["--webhooks", "--webhook-private-hosts", &host, "--webhook-pause", "100ms"]);
    let folder = tempfile::tempdir().unwrap();
    let backend = Backend::start(&server, &host, folder.path());
    let client = reqwest::blocking::Client::new();

    let quoted = backend.settled(&client, backend.order(&client, CUBE, "units=mm"));
    assert_eq!((&quoted["state"], &quoted["fidelity"]), (&"quoted".into(), &"exact".into()), "{quoted}");
    assert!(quoted["volume_mm3"].as_f64().unwrap() > 0.0 && quoted["price_cents"].as_u64().unwrap() >= 500);
    let mesh = client.get(format!("{}/orders/{}/mesh", backend.url, quoted["number"])).send().unwrap();
    assert_eq!((mesh.status().as_u16(), mesh.bytes().unwrap().len()), (200, 84 + 12 * 50));
    let refused = backend.settled(&client, backend.order(&client, BROKEN, ""));
    assert_eq!(
        (&refused["state"], &refused["problem"]),
        (&"refused".into(), &"mesh-unparseable".into()),
        "{refused}"
    );

    // A call that nobody signed changes nothing.
    let forged = client
        .post(format!("{}/hooks/meshmend", backend.url))
        .header("webhook-id", "msg_forged")
        .header("webhook-timestamp", jiff::Timestamp::now().as_second())
        .header("webhook-signature", "v1,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=")
        .body("{}");
    assert_eq!(forged.send().unwrap().status(), 401);

    // The same call once more: the webhook is delivered, and the order stays as it is.
    let path = format!("/v1/jobs/{}/deliveries", quoted["job"].as_str().unwrap());
    let list: Value = server.get(&path).send().unwrap().json().unwrap();
    let id = list["deliveries"][0]["id"].as_str().unwrap().to_owned();
    server.post(&format!("{path}/{id}/redeliver")).send().unwrap();
    patiently(|| {
        let list: Value = server.get(&path).send().unwrap().json().unwrap();
        (list["deliveries"][0]["tries"].as_array().unwrap().len() > 1).then_some(())
    });
    assert_eq!(backend.settled(&client, quoted["number"].as_u64().unwrap()), quoted);
}
