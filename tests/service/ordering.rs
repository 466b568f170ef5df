//! The ordering backend of `examples/` against a real server.

use crate::meshes::{BROKEN, OPEN};
use crate::server::{Server, patiently};
use serde_json::Value;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};

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

    fn order(&self, client: &reqwest::blocking::Client, mesh: &str) -> u64 {
        let response =
            client.post(format!("{}/orders?policy=sls", self.url)).body(mesh.to_owned()).send().unwrap();
        assert_eq!(response.status(), 202);
        response.json::<Value>().unwrap()["order"].as_u64().unwrap()
    }

    fn settled(&self, client: &reqwest::blocking::Client, order: u64) -> Value {
        patiently(|| {
            let response = client.get(format!("{}/orders/{order}", self.url)).send().unwrap();
            let order: Value = response.json().unwrap();
            ["quoted", "refused"].iter().any(|state| order["state"] == *state).then_some(order)
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

#[test]
fn an_order_is_repaired_measured_and_quoted_once_and_a_broken_file_is_refused() {
    let host = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
    let server = Server::with(&["--webhooks", "--webhook-private-hosts", &host, "--webhook-pause", "100ms"]);
    let folder = tempfile::tempdir().unwrap();
    let backend = Backend::start(&server, &host, folder.path());
    let client = reqwest::blocking::Client::new();

    let quoted = backend.settled(&client, backend.order(&client, OPEN));
    assert_eq!((&quoted["state"], &quoted["printable"]), (&"quoted".into(), &1.into()), "{quoted}");
    assert!(quoted["volume_mm3"].as_f64().unwrap() > 0.0 && quoted["price_cents"].as_u64().unwrap() >= 500);
    let refused = backend.settled(&client, backend.order(&client, BROKEN));
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
