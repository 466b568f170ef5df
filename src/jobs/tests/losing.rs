//! Disks that lose files or change them, and stores that are gone.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use super::restarting::started;
use super::*;

fn files_in(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files_in(&path) } else { vec![path] }).collect()
}

impl House {
    /// The stored file with this at the end of its name.
    fn stored(&self, end: &str) -> PathBuf {
        let files = files_in(&self.settings().data_dir.join("spool"));
        let found: Vec<_> = files.iter().filter(|path| path.to_string_lossy().ends_with(end)).collect();
        assert_eq!(found.len(), 1, "{files:?}");
        found[0].clone()
    }

    /// The upload of the only job there is.
    fn stored_upload(&self) -> PathBuf {
        let uploads = files_in(&self.settings().data_dir.join("spool/in"));
        assert_eq!(uploads.len(), 1, "{uploads:?}");
        uploads[0].clone()
    }
}

/// Changes a file as a failing disk does.
type Harm = fn(&Path);

const HARMS: [(&str, Harm); 4] = [
    ("flipped", |path| {
        let mut bytes = fs::read(path).unwrap();
        bytes[2] ^= 1;
        rewrite(path, &bytes);
    }),
    ("truncated", |path| {
        let bytes = fs::read(path).unwrap();
        rewrite(path, &bytes[..bytes.len() - 1]);
    }),
    ("emptied", |path| rewrite(path, b"")),
    ("lost", |path| fs::remove_file(path).unwrap()),
];

/// Writes a file anew; clocks of file systems may be too coarse to tell two writes of one moment apart.
fn rewrite(path: &Path, bytes: &[u8]) {
    fs::write(path, bytes).unwrap();
    let later = std::time::SystemTime::now() + Duration::from_secs(1);
    fs::File::options().append(true).open(path).unwrap().set_modified(later).unwrap();
}

/// A service whose engine counts its runs.
async fn counting_house() -> (House, Arc<AtomicUsize>) {
    let runs = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&runs);
    let house = house(
        |_| {},
        move |bytes, budget| {
            counted.fetch_add(1, Ordering::SeqCst);
            mend(bytes, budget)
        },
    )
    .await;
    (house, runs)
}

#[tokio::test]
async fn a_result_or_report_that_is_not_as_it_was_made_is_given_to_nobody() {
    for (harm, change) in HARMS {
        for end in ["mesh-0", "report.json"] {
            let (house, _) = counting_house().await;
            let job = house.run(b"x").await;
            change(&house.stored(end));
            let problem = match end {
                "mesh-0" => house.result(id(&job)).await.unwrap_err(),
                _ => house.report(id(&job)).await.unwrap_err(),
            };
            assert_eq!(problem.code, ProblemCode::Expired, "{end} {harm}");
            assert_eq!(house.get(id(&job)).await.unwrap().state, JobState::Expired, "{end} {harm}");
            assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0), "{end} {harm}");
        }
    }
}

#[tokio::test]
async fn a_job_whose_files_are_not_as_they_were_made_answers_no_other_one() {
    for (harm, change) in HARMS {
        for end in ["mesh-0", "report.json"] {
            let (house, runs) = counting_house().await;
            let first = house.run(b"x").await;
            assert!(house.order(b"x").await.unwrap().cached);
            change(&house.stored(end));
            let again = house.run(b"x").await;
            assert_eq!((again.state, again.cached), (JobState::Succeeded, false), "{end} {harm}");
            assert_eq!(runs.load(Ordering::SeqCst), 2, "{end} {harm}");
            assert_eq!(content(house.result(id(&again)).await.unwrap()).await, b"mended");
            assert_eq!(house.get(id(&first)).await.unwrap().state, JobState::Expired, "{end} {harm}");
        }
    }
}

#[tokio::test]
async fn an_upload_that_is_not_as_it_was_sent_is_not_used() {
    for (harm, change) in HARMS {
        let (house, runs) = counting_house().await;
        let first = house.run(b"whole").await;
        change(&house.stored_upload());
        let input = Some(InputRef::Job(first.id.clone()));
        let again = Submission::new(Operation::Verify, Options { input, ..Options::default() });
        let problem = house.submit(again).await.unwrap_err();
        assert_eq!((problem.status, problem.parameter.as_deref()), (410, Some("input")), "{harm}");
        assert_eq!(runs.load(Ordering::SeqCst), 1, "{harm}");
    }
}

#[tokio::test]
async fn a_job_whose_upload_changes_while_it_waits_fails_and_says_so() {
    for (harm, change) in HARMS {
        let (tell, told) = mpsc::channel();
        let house = house(|settings| settings.interactive_slots = 0, work_until_told(told)).await;
        let first = house.order(b"first").await.unwrap();
        house.until("running", |load| load.running == 1).await;
        let waiting = house.order(b"second").await.unwrap();
        let uploads = files_in(&house.settings().data_dir.join("spool/in"));
        let upload = uploads.iter().find(|path| fs::read(path).unwrap() == b"second").unwrap();
        change(upload);
        tell.send(()).unwrap();
        house.end_of(&first).await;
        let ended = house.end_of(&waiting).await;
        assert_eq!((ended.state, code(&ended)), (JobState::Failed, Some(ProblemCode::Expired)), "{harm}");
        assert!(ended.problem.unwrap().detail.contains("upload"), "{harm}");
    }
}

/// Ends a service; its store is treated so, and another one is started.
async fn with_another_store(
    house: House,
    change: impl FnOnce(&Path),
    lost_store: LostStore,
) -> Result<House, (String, tempfile::TempDir)> {
    let House { jobs, dir } = house;
    let settings = JobsSettings { lost_store, ..jobs.settings().clone() };
    jobs.drain().await;
    drop(jobs);
    let engine: Engine = Arc::new(|_: Asked, bytes: Vec<u8>, _: &_, budget: &Budget| mend(&bytes, budget));
    // With the last connection goes the file beside the store.
    while settings.data_dir.join("jobs.sqlite3-wal").exists() {
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    change(&settings.data_dir);
    loop {
        match Jobs::start_with(settings.clone(), Arc::clone(&engine)).await {
            Err(StartError::Stores(StoresError::DataDirInUse { .. })) => {
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
            Err(error) => return Err((error.to_string(), dir)),
            Ok(jobs) => return Ok(House { jobs, dir }),
        }
    }
}

fn remove_store(dir: &Path) {
    for end in ["", "-wal", "-shm"] {
        // There may be none beside it.
        let _ = fs::remove_file(dir.join(format!("jobs.sqlite3{end}")));
    }
}

fn empty_store(dir: &Path) {
    remove_store(dir);
    fs::write(dir.join("jobs.sqlite3"), b"").unwrap();
}

fn other_store(dir: &Path) {
    remove_store(dir);
    let path = dir.join("jobs.sqlite3");
    drop(SqliteStore::open(&path).unwrap());
    SqliteStore::set_mark(&path, "another").unwrap();
}

#[tokio::test]
async fn a_store_that_is_gone_or_another_one_keeps_the_service_from_starting_and_every_file_stays() {
    for change in [remove_store, empty_store, other_store] {
        let house = house(|_| {}, mend).await;
        house.run(b"x").await;
        let (error, dir) = with_another_store(house, change, LostStore::Refuse).await.unwrap_err();
        assert!(
            error.contains("3 files") && error.contains("--adopt") && error.contains("--discard"),
            "{error}"
        );
        assert_eq!(files_under(&dir.path().join("spool")), 3);
        // Also the next time, when a store was made in vain.
        let settings = JobsSettings::new(dir.path());
        assert!(matches!(Jobs::start(settings).await, Err(StartError::Stores(StoresError::Rows { .. }))));
        assert_eq!(files_under(&dir.path().join("spool")), 3);
    }
}

#[tokio::test]
async fn the_files_of_a_lost_store_are_kept_apart_or_removed_as_the_operator_says() {
    for (decision, kept) in [(LostStore::Adopt, 3), (LostStore::Discard, 0)] {
        let house = house(|_| {}, mend).await;
        let lost = house.run(b"x").await;
        let house = with_another_store(house, remove_store, decision).await.unwrap();
        assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0), "{decision:?}");
        let adopted = house.settings().data_dir.join("adopted");
        assert_eq!(if adopted.exists() { files_under(&adopted) } else { 0 }, kept, "{decision:?}");
        assert_eq!(house.get(id(&lost)).await.unwrap_err().code, ProblemCode::NotFound);
        // From now on they belong together.
        let job = house.run(b"y").await;
        let house = with_another_store(house, |_| {}, LostStore::Refuse).await.unwrap();
        assert_eq!(content(house.result(id(&job)).await.unwrap()).await, b"mended");
    }
}

#[tokio::test]
async fn a_store_that_is_put_back_is_the_store_of_its_files() {
    let house = house(|_| {}, mend).await;
    let job = house.run(b"x").await;
    let kept = tempfile::tempdir().unwrap();
    let saved = kept.path().join("store");
    let take = |dir: &Path| {
        // One file is enough after a service that ended in order.
        fs::copy(dir.join("jobs.sqlite3"), &saved).unwrap();
        remove_store(dir);
    };
    let (_, dir) = with_another_store(house, take, LostStore::Refuse).await.unwrap_err();
    remove_store(dir.path());
    fs::copy(&saved, dir.path().join("jobs.sqlite3")).unwrap();
    let engine: Engine = Arc::new(|_: Asked, bytes: Vec<u8>, _: &_, budget: &Budget| mend(&bytes, budget));
    let house = House { jobs: started(JobsSettings::new(dir.path()), engine).await, dir };
    assert_eq!(content(house.result(id(&job)).await.unwrap()).await, b"mended");
}

#[tokio::test]
async fn the_files_of_a_service_are_for_its_user_alone() {
    let house = house(|settings| settings.data_dir = settings.data_dir.join("data"), mend).await;
    house.run(b"x").await;
    let mut looked_at = 0;
    let mut folders = vec![house.settings().data_dir.clone()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).chain([folder.clone()])
        {
            let mode = path.metadata().unwrap().permissions().mode() & 0o777;
            assert_eq!(mode & 0o077, 0, "{} is open to others: {mode:o}", path.display());
            looked_at += 1;
            if path.is_dir() && path != folder {
                folders.push(path);
            }
        }
    }
    assert!(looked_at > 8, "{looked_at}");
}

#[tokio::test]
async fn a_secret_of_a_job_is_in_no_file_of_the_store() {
    const SECRET: &str = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";
    let webhooks = WebhookSettings {
        secrets: Vec::new(),
        private_hosts: PrivateHosts::default(),
        timeout: Duration::from_millis(10),
        retry: RetryPlan { attempts_max: 1, first_pause: Duration::from_secs(1) },
    };
    let house = house(|settings| settings.webhooks = Some(webhooks), mend).await;
    let webhook = Some(Webhook {
        url: "https://unknown-host.invalid/hook".to_owned(),
        secret: Some(SECRET.to_owned()),
    });
    let order = async || {
        let asked = Submission::new(Operation::Repair, Options::default());
        let upload = Some(house.send(b"x").await.unwrap());
        let key = Some("order-17".to_owned());
        house.submit(Submission { upload, webhook: webhook.clone(), key, ..asked }).await.unwrap()
    };
    let job = order().await;
    assert_eq!(
        order().await.id,
        job.id,
        "the same request, although no secret is sealed twice in the same way"
    );
    house.end_of(&job).await;
    let row = house.service().store.get(id(&job)).await.unwrap();
    let sealed = row.webhook.unwrap().secret.unwrap();
    assert_eq!(house.service().vault.as_ref().unwrap().unsealed(&sealed).as_deref(), Ok(SECRET));
    for path in files_in(&house.settings().data_dir) {
        let bytes = fs::read(&path).unwrap();
        let has = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
        assert!(!has("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"), "{}", path.display());
    }
}
