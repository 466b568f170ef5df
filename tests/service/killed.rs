//! A server and the processes of its jobs that are killed at random points, again and again, by a client that keeps account.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use reqwest::blocking::{Client, Response};
use serde_json::Value;

use crate::meshes::{SOLID, long_job};
use crate::processes::{all_children_of, children_of, until_gone};
use crate::server::{Server, link, try_signal};
use crate::support::{campaign_part, cases};

const SETTINGS: &[&str] = &["--slots", "2", "--lease", "2s", "--queue-max", "100000"];
/// Pause of the client between a few requests and the next.
const REST: Duration = Duration::from_millis(150);
/// Lost runs after which a job fails: the default.
const ATTEMPTS_MAX: u64 = 3;

/// Numbers without rhyme, the same in every run (splitmix64).
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (mixed ^ (mixed >> 27)) % end
    }
}

/// What the client knows.
#[derive(Default)]
struct Account {
    /// Requests by the number that is their key; the ids of those that were answered.
    asked: BTreeMap<u64, Option<String>>,
    /// When each job ended that was seen to have ended.
    ended: BTreeMap<String, String>,
}

impl Account {
    /// Sends requests until the server is gone: first those that were not answered, then new ones.
    fn send(&mut self, server: &Server, client: &Client, dice: &mut Dice) {
        for _ in 0..3 {
            let unanswered = self.asked.iter().find(|(_, id)| id.is_none()).map(|(&number, _)| number);
            let number = unanswered.unwrap_or(self.asked.len() as u64);
            let known = self.asked.entry(number).or_default();
            let Some(job) = json(
                client
                    .post(
                        server.url(&format!("/v1/jobs?operation=repair&labels=%7B%22n%22:%22{number}%22%7D")),
                    )
                    .header("idempotency-key", number.to_string())
                    .body(mesh(number))
                    .send(),
            ) else {
                return;
            };
            let id = job["id"].as_str().unwrap_or_else(|| panic!("not accepted: {job}")).to_owned();
            assert!(known.is_none());
            *known = Some(id);
            if !self.look_at_one(server, client, dice) {
                return;
            }
        }
    }

    /// A job that has ended stays as it was. False when the server is gone.
    fn look_at_one(&mut self, server: &Server, client: &Client, dice: &mut Dice) -> bool {
        let number = dice.below(self.asked.len() as u64);
        let Some(Some(id)) = self.asked.get(&number).cloned() else { return true };
        let Some(job) = json(client.get(server.url(&format!("/v1/jobs/{id}"))).send()) else { return false };
        assert!(job["attempts"].as_u64().unwrap() <= ATTEMPTS_MAX, "{job}");
        if let Some(at) = job["finished_at"].as_str() {
            let known = self.ended.entry(id).or_insert_with(|| at.to_owned());
            assert_eq!(known, at, "it has ended twice: {job}");
        } else {
            assert!(!self.ended.contains_key(&id), "it had ended: {job}");
        }
        true
    }
}

/// One of the meshes, no two of them equal; a few take a while.
fn mesh(number: u64) -> Vec<u8> {
    if number % 7 == 3 {
        let mut mesh = long_job(30 + (number % 5) as u32);
        mesh[..8].copy_from_slice(&number.to_le_bytes());
        return mesh;
    }
    format!("{SOLID}# {number}\n").into_bytes()
}

/// The answer, unless the server was gone before it was told.
fn json(response: reqwest::Result<Response>) -> Option<Value> {
    response.ok()?.json().ok()
}

#[test]
fn a_server_killed_at_random_points_loses_no_accepted_job() {
    let cycles = cases(5, 500);
    let mut dice = Dice(6 + campaign_part());
    let mut account = Account::default();
    let mut server = Server::with(SETTINGS);
    let (mut server_kills, mut child_kills, mut processes_gone) = (0, 0, 0);
    for _ in 0..cycles {
        let client = Client::builder().timeout(Duration::from_secs(20)).build().unwrap();
        if dice.below(4) > 0 {
            // Otherwise it is killed while it starts.
            server.get("/v1/version").send().unwrap();
        }
        let is_over = Arc::new(AtomicBool::new(false));
        let pause = Duration::from_millis(dice.below(400));
        let is_child = dice.below(3) == 0;
        let children = std::thread::scope(|scope| {
            let over = Arc::clone(&is_over);
            let target = &server;
            let killing = scope.spawn(move || {
                std::thread::sleep(pause);
                over.store(true, Ordering::SeqCst);
                if is_child {
                    let mut children = children_of(target);
                    children.truncate(1);
                    children.retain(|&pid| try_signal(pid, "KILL"));
                    return children;
                }
                let children = all_children_of(target);
                target.signal("KILL");
                children
            });
            while !is_over.load(Ordering::SeqCst) {
                account.send(target, &client, &mut dice);
                // More than can be done between two kills would only make the queue longer.
                std::thread::sleep(REST);
            }
            killing.join().unwrap()
        });
        if is_child {
            child_kills += children.len();
        } else {
            server_kills += 1;
            server = server.killed_and_restarted(SETTINGS);
        }
        processes_gone += children.len();
        children.into_iter().for_each(until_gone);
    }
    let (mut succeeded, mut given_up, mut lost_runs, mut doubles) = (0, 0, 0, 0);
    for (number, known) in &account.asked {
        let page: Value = server.get(&format!("/v1/jobs?label=n:{number}")).send().unwrap().json().unwrap();
        let made = page["jobs"].as_array().unwrap();
        doubles += usize::from(made.len() > 1);
        assert!(made.len() <= 1, "two jobs of one request: {page}");
        let Some(id) = known else { continue };
        assert_eq!(made.len(), 1, "job {id} is lost");
        assert_eq!(made[0]["id"], **id);
        let job = server.ended(&made[0]);
        let attempts = job["attempts"].as_u64().unwrap();
        assert!(attempts <= ATTEMPTS_MAX, "{job}");
        lost_runs += attempts;
        match job["state"].as_str().unwrap() {
            "succeeded" => succeeded += 1,
            "failed" => {
                assert_eq!(
                    (&job["problem"]["code"], attempts),
                    (&"worker-lost".into(), ATTEMPTS_MAX),
                    "{job}"
                );
                given_up += 1;
            }
            other => panic!("{other}: {job}"),
        }
        if let Some(at) = account.ended.get(id) {
            assert_eq!(job["finished_at"], **at, "it has ended twice");
        }
        let events = server.get(&format!("{}/events", link(&job, "self"))).send().unwrap().text().unwrap();
        let ends = events.matches("\"state\":\"succeeded\"").count()
            + events.matches("\"state\":\"failed\"").count();
        doubles += usize::from(ends > 1);
        assert_eq!(ends, 1, "{events}");
    }
    // Files are those that rows name: when the rows go, nothing stays.
    let mut removed = 0;
    loop {
        let page: Value = server.get("/v1/jobs?limit=200").send().unwrap().json().unwrap();
        let jobs = page["jobs"].as_array().unwrap();
        if jobs.is_empty() {
            break;
        }
        for job in jobs {
            server.ended(job);
            assert_eq!(server.request("DELETE", link(job, "self")).send().unwrap().status(), 204);
            removed += 1;
        }
    }
    let files_left = server.stored_files();
    assert!(files_left.is_empty(), "{files_left:?}");
    let accepted = account.asked.values().flatten().count();
    assert!(
        removed >= accepted && succeeded > accepted / 2,
        "{removed} removed, {succeeded} of {accepted} succeeded"
    );
    print_table(&[
        ("kills of the server", server_kills),
        ("kills of a job's process", child_kills),
        ("requests, each with a key", account.asked.len()),
        ("jobs accepted", accepted),
        ("accepted jobs lost", accepted - succeeded - given_up),
        ("jobs that succeeded", succeeded),
        ("runs lost with a kill", lost_runs as usize),
        ("jobs given up after three lost runs", given_up),
        ("requests that made two jobs, jobs that ended twice", doubles),
        (
            "processes that were killed or lost their server, those that waited for a job included, all gone",
            processes_gone,
        ),
        ("files left once all jobs were deleted", files_left.len()),
    ]);
}

#[allow(clippy::print_stdout, reason = "a campaign gathers these lines")]
fn print_table(rows: &[(&str, usize)]) {
    println!("| what | number |\n| --- | --- |");
    for (what, number) in rows {
        println!("| {what} | {number} |");
    }
}
