//! Servers that take requests and servers that run jobs, on one database and one bucket.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, RwLock};

use reqwest::StatusCode;
use reqwest::blocking::Client;
use reqwest::blocking::multipart::{Form, Part};
use serde_json::{Value, json};

use crate::meshes::{OPEN, SOLID, long_job};
use crate::receiver::Receiver;
use crate::server::{PATIENCE, Server, header, link, patiently};
use crate::town::Town;

#[test]
fn apis_take_jobs_workers_run_them_and_each_api_knows_of_all() {
    let Some(town) = Town::open() else { return };
    let receiver = Receiver::answering(&[204]);
    let key = town.dir.path().join("store.key");
    let hooks = [
        "--webhooks",
        "--webhook-private-hosts",
        &receiver.host,
        "--store-key-file",
        key.to_str().unwrap(),
        "--interactive-slots",
        "0",
    ];
    let (first, second) = (town.server("api", &hooks), town.server("api", &hooks));
    let webhook = json!({ "url": format!("http://{}/hook", receiver.host), "secret": "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw" });
    let asked = json!({ "operation": "repair", "webhook": webhook });
    let form = Form::new()
        .part("job", Part::text(asked.to_string()).mime_str("application/json").unwrap())
        .part("mesh", Part::bytes(OPEN.as_bytes().to_vec()));
    let job: Value = first.post("/v1/jobs").multipart(form).send().unwrap().json().unwrap();
    assert_eq!(job["state"], "queued", "{job}");
    // Workers come later. They know no webhooks.
    let workers = [town.server("worker", &["--slots", "1"]), town.server("worker", &["--slots", "1"])];
    for worker in &workers {
        assert_eq!(
            (worker.admin("/livez").status(), worker.admin("/readyz").status()),
            (StatusCode::OK, StatusCode::OK)
        );
        assert!(worker.admin("/metrics").text().unwrap().contains("meshmend_"));
    }
    // Waited for at the other one.
    let ended = second.ended(&job);
    assert_eq!((&ended["state"], &ended["outcome"]), (&json!("succeeded"), &json!("repaired")), "{ended}");
    let id = job["id"].as_str().unwrap();
    let is_told =
        |server: &Server| server.log().lines().any(|line| line.contains("job ended") && line.contains(id));
    patiently(|| (workers.iter().filter(|worker| is_told(worker)).count() == 1).then_some(()));
    assert!(!is_told(&first) && !is_told(&second), "no server for requests ran it");
    let result = |server: &Server| server.get(link(&ended, "result")).send().unwrap().bytes().unwrap();
    assert!(!result(&first).is_empty() && result(&first) == result(&second));
    // Its webhook comes once.
    let call: Value = serde_json::from_str(&receiver.next().body).unwrap();
    assert_eq!(call["data"]["id"], *id);
    for server in [&first, &second] {
        let path = format!("{}/deliveries", link(&job, "self"));
        let list: Value = patiently(|| {
            let list: Value = server.get(&path).send().unwrap().json().unwrap();
            (list["deliveries"][0]["state"] == "delivered").then_some(list)
        });
        assert_eq!(list["deliveries"][0]["tries"].as_array().map(Vec::len), Some(1), "{list}");
    }
    assert!(receiver.is_left_alone());
    // Followed at the other one.
    let followed = first.job("verify", long_job(60));
    let events = second.get(&format!("{}/events", link(&followed, "self"))).send().unwrap().text().unwrap();
    let states: Vec<_> = events.split("\n\n").filter(|event| event.contains("event: state")).collect();
    assert_eq!(states.len(), 3, "{events}");
    for (event, state) in states.iter().zip(["queued", "running", "succeeded"]) {
        assert!(event.contains(&format!("\"state\":\"{state}\"")), "{events}");
    }
    // Cancelled at the other one, long before a claim is renewed.
    let cancelled = first.job("verify", long_job(1500));
    first.until(&cancelled, |job| job["state"] == "running");
    second.post(&format!("{}/cancel", link(&cancelled, "self"))).send().unwrap();
    assert_eq!(first.ended(&cancelled)["state"], "cancelled");
    // Without slots of its own for small jobs, a server for requests leaves those that are waited for to workers, too.
    let answer = second.post("/v1/repair").body(format!("{OPEN}# waited for\n")).send().unwrap();
    assert_eq!((answer.status().as_u16(), header(&answer, "meshmend-outcome")), (200, "repaired"));
}

#[test]
fn a_small_mesh_that_is_waited_for_needs_no_worker() {
    let Some(town) = Town::open() else { return };
    let api = town.server("api", &[]);
    let answer = api.post("/v1/repair").body(OPEN).send().unwrap();
    assert_eq!((answer.status().as_u16(), header(&answer, "meshmend-outcome")), (200, "repaired"));
    let limits: Value = api.get("/v1/limits").send().unwrap().json().unwrap();
    assert_eq!((&limits["slots"], &limits["interactive_slots"]), (&json!(0), &json!(2)));
    let queued = api.job("repair", SOLID);
    let worker = town.server("worker", &[]);
    assert_eq!(api.ended(&queued)["state"], "succeeded");
    drop(worker);
}

/// Servers for requests behind one that sends each request to the next of them, but to none that is being restarted.
struct Balancer {
    apis: Vec<Api>,
    next: AtomicUsize,
}

struct Api {
    server: RwLock<Option<Server>>,
    is_out: AtomicBool,
    under_way: AtomicUsize,
}

impl Balancer {
    /// Sends a request to one of them. Its status and answer.
    fn send(&self, client: &Client, path: &str, body: &str) -> (u16, Value) {
        loop {
            let api = &self.apis[self.next.fetch_add(1, Ordering::SeqCst) % self.apis.len()];
            api.under_way.fetch_add(1, Ordering::SeqCst);
            if api.is_out.load(Ordering::SeqCst) {
                api.under_way.fetch_sub(1, Ordering::SeqCst);
                continue;
            }
            let url = api.server.read().unwrap().as_ref().unwrap().url(path);
            let answer = client.post(url).header("accept", "application/json").body(body.to_owned()).send();
            let told = answer.map(|answer| (answer.status().as_u16(), answer.json().unwrap_or_default()));
            api.under_way.fetch_sub(1, Ordering::SeqCst);
            return told.unwrap_or((0, Value::Null));
        }
    }

    /// Restarts one as it is done behind a balancer: no new requests, those under way are answered, then it ends.
    fn restart(&self, number: usize, settings: &[&str]) {
        let api = &self.apis[number];
        api.is_out.store(true, Ordering::SeqCst);
        patiently(|| (api.under_way.load(Ordering::SeqCst) == 0).then_some(()));
        let server = api.server.write().unwrap().take().unwrap();
        server.signal("TERM");
        *api.server.write().unwrap() = Some(server.restarted(settings));
        api.is_out.store(false, Ordering::SeqCst);
    }
}

/// Raised when it is dropped, also by a test that fails: nobody goes on then.
struct Raised<'f>(&'f AtomicBool);

impl Drop for Raised<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}

#[test]
fn servers_that_are_restarted_one_after_the_other_fail_no_request_and_lose_no_job() {
    let Some(town) = Town::open() else { return };
    let api = town.settings("api", &["--queue-max", "10000"]);
    let worker = town.settings("worker", &["--slots", "2"]);
    let balancer = Balancer {
        apis: (0..2)
            .map(|_| Api {
                server: RwLock::new(Some(Server::with(&api))),
                is_out: AtomicBool::new(false),
                under_way: AtomicUsize::new(0),
            })
            .collect(),
        next: AtomicUsize::new(0),
    };
    let mut workers: Vec<_> = (0..2).map(|_| Server::with(&worker)).collect();
    let (is_over, accepted, failed) =
        (AtomicBool::new(false), Mutex::new(BTreeSet::new()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for thread in 0..2 {
            let (balancer, is_over, accepted, failed) = (&balancer, &is_over, &accepted, &failed);
            scope.spawn(move || {
                let client = Client::builder().timeout(PATIENCE).pool_max_idle_per_host(0).build().unwrap();
                for number in 0.. {
                    if is_over.load(Ordering::SeqCst) {
                        return;
                    }
                    let mesh = format!("{SOLID}# {thread} {number}\n");
                    // Some that are waited for, and more that are not.
                    let path = if number % 4 == 0 { "/v1/verify" } else { "/v1/jobs?operation=repair" };
                    let (status, job) = balancer.send(&client, path, &mesh);
                    match (status, job["id"].as_str()) {
                        (202, Some(id)) => drop(accepted.lock().unwrap().insert(id.to_owned())),
                        (200, _) => {}
                        _ => failed.lock().unwrap().push((status, job)),
                    }
                    std::thread::sleep(std::time::Duration::from_millis(100));
                }
            });
        }
        let _end = Raised(&is_over);
        let until_some_more_are_taken = || {
            let enough = accepted.lock().unwrap().len() + 2;
            patiently(|| {
                let is_enough = accepted.lock().unwrap().len() >= enough;
                (is_enough || !failed.lock().unwrap().is_empty()).then_some(())
            });
        };
        for number in 0..2 {
            until_some_more_are_taken();
            let ending = workers.remove(0);
            ending.signal("TERM");
            until_some_more_are_taken();
            workers.push(ending.restarted(&worker));
            until_some_more_are_taken();
            balancer.restart(number, &api);
        }
        until_some_more_are_taken();
    });
    let (accepted, failed) = (accepted.into_inner().unwrap(), failed.into_inner().unwrap());
    assert!(failed.is_empty(), "{failed:?}");
    let server = balancer.apis[0].server.read().unwrap();
    let server = server.as_ref().unwrap();
    for id in &accepted {
        let ended = server.ended(&json!({ "links": { "self": format!("/v1/jobs/{id}") } }));
        assert_eq!((&ended["state"], &ended["attempts"]), (&json!("succeeded"), &json!(0)), "{ended}");
    }
}
