//! Jobs of one machine that are carried over to stores that several servers share.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

use crate::meshes::{BROKEN, OPEN, SOLID, long_job};
use crate::receiver::Receiver;
use crate::server::{Server, link, patiently};
use crate::town::Town;

/// Carries over what is in a data directory.
fn migrate(town: &Town, data: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshmend"));
    command.env_clear().arg("migrate").arg("--data-dir").arg(data).args(town.shared()).output().unwrap()
}

fn refused(town: &Town, data: &Path) -> String {
    let output = migrate(town, data);
    assert!(!output.status.success(), "{output:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// Every file under a folder with its bytes.
fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(content(&path).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else {
            found.insert(name, std::fs::read(path).unwrap());
        }
    }
    found
}

fn bytes(server: &Server, path: &str) -> Vec<u8> {
    server.get(path).send().unwrap().bytes().unwrap().to_vec()
}

#[test]
fn jobs_of_one_machine_go_on_where_several_servers_share_them() {
    let Some(town) = Town::open() else { return };
    let receiver = Receiver::answering(&[204]);
    let hooks = ["--slots", "1", "--webhooks", "--webhook-private-hosts", &receiver.host];
    let server = Server::with(&hooks);
    let webhook = json!({ "url": format!("http://{}/hook", receiver.host), "secret": "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw" });
    let asked =
        json!({ "operation": "repair", "webhook": webhook, "labels": { "order": "7 \u{e9} \"quoted\"" } });
    let form = reqwest::blocking::multipart::Form::new().text("job", asked.to_string()).part(
        "mesh",
        reqwest::blocking::multipart::Part::bytes(OPEN.as_bytes()).file_name("part \u{e9}.off"),
    );
    let finished: Value = server.post("/v1/jobs").multipart(form).send().unwrap().json().unwrap();
    let finished = server.ended(&finished);
    assert_eq!(finished["outcome"], "repaired", "{finished}");
    receiver.next();
    let deliveries = format!("{}/deliveries", link(&finished, "self"));
    let delivered = patiently(|| {
        let list: Value = server.get(&deliveries).send().unwrap().json().unwrap();
        (list["deliveries"][0]["state"] == "delivered").then_some(list)
    });
    let failed = server.ended(&server.job("repair", BROKEN));
    assert_eq!(failed["state"], "failed", "{failed}");
    let data = server.data_dir();
    assert!(refused(&town, &data).contains("in use by a server"));
    let told =
        |server: &Server| ["result", "report", "self"].map(|name| bytes(server, link(&finished, name)));
    let before = told(&server);
    let running = server.job("verify", long_job(700));
    server.until(&running, |job| job["state"] == "running");
    let queued: Vec<_> = (0..3).map(|number| server.job("repair", format!("{SOLID}# {number}\n"))).collect();
    let kept = server.killed();
    let source = content(&data);
    // Cut off after the files, before the rows. The tables are made by a server that has done nothing else.
    drop(town.server("all", &[]));
    town.sql(
        "CREATE FUNCTION refuse() RETURNS trigger LANGUAGE plpgsql AS 'BEGIN RAISE EXCEPTION ''cut off''; END';
         CREATE TRIGGER refuse BEFORE INSERT ON changes EXECUTE FUNCTION refuse()",
    );
    let cut_off = refused(&town, &data);
    assert!(cut_off.contains("cut off"), "{cut_off}");
    let files = town.stored_files().len();
    assert!(files >= 7, "{files}");
    town.sql("DROP TRIGGER refuse ON changes");
    let output = migrate(&town, &data);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("6 jobs") && said.contains(&format!("{files} of them by an earlier try")),
        "{said}"
    );
    assert_eq!(town.stored_files().len(), files);
    assert_eq!(content(&data), source, "the source stays as it was");
    assert!(refused(&town, &data).contains("holds 6 jobs already"));

    let key = data.join("store.key");
    let key = ["--store-key-file", key.to_str().unwrap()];
    let server = town.server("all", &[&hooks[..], &key].concat());
    assert_eq!(told(&server), before);
    let list: Value = server.get(&deliveries).send().unwrap().json().unwrap();
    assert_eq!(list, delivered);
    let now: Value = server.get(link(&failed, "self")).send().unwrap().json().unwrap();
    assert_eq!(now, failed);
    for job in &queued {
        let job = server.ended(job);
        assert_eq!((&job["state"], &job["attempts"]), (&json!("succeeded"), &json!(0)), "{job}");
    }
    let again = server.ended(&running);
    assert_eq!((&again["state"], &again["attempts"]), (&json!("succeeded"), &json!(1)), "{again}");
    let labelled: Value =
        server.get("/v1/jobs?label=order:7%20%C3%A9%20%22quoted%22").send().unwrap().json().unwrap();
    assert_eq!(labelled["jobs"].as_array().map(Vec::len), Some(1), "{labelled}");
    assert!(receiver.is_left_alone(), "what was delivered is not sent again");
    drop(kept);
}

#[test]
fn a_file_that_was_damaged_is_told_and_only_its_job_loses_it() {
    let Some(town) = Town::open() else { return };
    let server = Server::start();
    let [damaged, sound] = [OPEN, SOLID].map(|mesh| server.ended(&server.job("repair", mesh)));
    let data = server.data_dir();
    let id = damaged["id"].as_str().unwrap();
    let kept = server.killed();
    for entry in std::fs::read_dir(data.join("spool/out")).unwrap() {
        let path = entry.unwrap().path();
        if path.file_name().unwrap().to_str().unwrap().starts_with(id) {
            std::fs::write(path, "damaged").unwrap();
        }
    }
    let output = migrate(&town, &data);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains(&format!("out/{id}")) && said.contains("lost or damaged"), "{said}");
    let server = town.server("all", &[]);
    assert_eq!(server.get(link(&damaged, "report")).send().unwrap().status(), 410);
    assert_eq!(server.get(link(&sound, "result")).send().unwrap().text().unwrap(), SOLID);
    drop(kept);
}

#[test]
fn there_is_something_to_be_carried_over_and_somewhere_to_go() {
    let dir = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshmend"));
        let output =
            command.env_clear().arg("migrate").arg("--data-dir").arg(dir.path()).args(more).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, said) = run(&[]);
    assert!(code == Some(2) && said.contains("set database_url and blobs_url"), "{code:?} {said}");
    let (code, said) = run(&["--database-url", "postgresql://a@127.0.0.1:1/b", "--blobs-url", "s3://meshes"]);
    assert!(code == Some(4) && said.contains("holds no jobs"), "{code:?} {said}");
    assert!(std::fs::read_dir(dir.path()).unwrap().next().is_none(), "nothing is made there");
}
