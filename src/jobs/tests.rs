//! The rules of a job's life, each on the smallest case that shows it, with engines made for the purpose.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use super::*;
use crate::budget::Budget;
use crate::formats::{Place, ReadError, ReadErrorKind};
use crate::pipeline::{Answer, Failure, Operation as Asked};
use crate::wire::{InputRef, Job, JobState, Operation, Options, Outcome, Problem, ProblemCode, sample};

/// Longest wait for something that must happen.
const PATIENCE: Duration = Duration::from_secs(20);

/// A service in a directory of its own.
struct House {
    jobs: Jobs,
    _dir: tempfile::TempDir,
}

impl std::ops::Deref for House {
    type Target = Jobs;

    fn deref(&self) -> &Jobs {
        &self.jobs
    }
}

fn house(
    change: impl FnOnce(&mut JobsSettings),
    engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
) -> House {
    let dir = tempfile::tempdir().unwrap();
    let mut settings = JobsSettings { slots: 1, queue_max: 4, ..JobsSettings::new(dir.path()) };
    change(&mut settings);
    let engine: Engine = Arc::new(move |_: Asked, bytes, _, budget| engine(bytes, budget));
    let jobs = Jobs::start_with(settings, Arc::<MemoryStore>::default(), engine).unwrap();
    House { jobs, _dir: dir }
}

impl House {
    async fn send(&self, bytes: &[u8]) -> Result<Uploaded, Problem> {
        let mut upload = self.upload(Some(bytes.len() as u64)).await?;
        upload.write(bytes).await?;
        upload.finish().await
    }

    async fn order_with(
        &self,
        bytes: &[u8],
        options: Options,
        after: Option<Duration>,
    ) -> Result<Job, Problem> {
        let upload = Some(self.send(bytes).await?);
        let file_name = Some("C:\\parts\\part one.stl".to_owned());
        self.submit(Submission {
            operation: Operation::Repair,
            options,
            upload,
            material: None,
            file_name,
            cancel_after: after,
            owner: None,
        })
        .await
    }

    async fn order(&self, bytes: &[u8]) -> Result<Job, Problem> {
        self.order_with(bytes, Options::default(), None).await
    }

    async fn end_of(&self, job: &Job) -> Job {
        let ended = self.wait(id(job), PATIENCE).await.unwrap();
        assert!(ended.state.is_final(), "{ended:?}");
        ended
    }

    async fn run(&self, bytes: &[u8]) -> Job {
        let job = self.order(bytes).await.unwrap();
        self.end_of(&job).await
    }

    async fn until(&self, what: &str, holds: impl Fn(Load) -> bool) {
        for _ in 0..PATIENCE.as_millis() / 5 {
            if holds(self.load().await) {
                return;
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        panic!("{what} never held");
    }

    fn spool_files(&self) -> usize {
        std::fs::read_dir(self.settings().data_dir.join("spool")).unwrap().count()
    }
}

fn id(job: &Job) -> JobId {
    job.id.parse().unwrap()
}

fn code(job: &Job) -> Option<ProblemCode> {
    job.problem.as_ref().map(|problem| problem.code)
}

fn mend(_: &[u8], _: &Budget) -> Result<Answer, Failure> {
    Ok(sample::repaired())
}

/// Works until it is stopped.
fn work_forever(_: &[u8], budget: &Budget) -> Result<Answer, Failure> {
    loop {
        budget.check()?;
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// An engine that works until it is told to end, or until it is stopped.
fn work_until_told(told: mpsc::Receiver<()>) -> impl Fn(&[u8], &Budget) -> Result<Answer, Failure> {
    let told = Mutex::new(told);
    move |_, budget| loop {
        budget.check()?;
        if told.lock().unwrap().recv_timeout(Duration::from_millis(1)).is_ok() {
            return Ok(sample::repaired());
        }
    }
}

#[tokio::test]
async fn a_repair_gives_a_report_and_a_mesh() {
    let house = house(
        |_| {},
        |bytes, budget| {
            assert_eq!(bytes, b"broken");
            budget.stage(crate::budget::Stage::Repair, || {});
            Ok(sample::repaired())
        },
    );
    let job = house.run(b"broken").await;
    assert_eq!((job.state, job.outcome, job.problem), (JobState::Succeeded, Some(Outcome::Repaired), None));
    assert_eq!(job.progress.fraction, 1.0);
    assert!(job.started_at >= Some(job.created_at) && job.finished_at >= job.started_at);
    assert!(job.timing_ms.unwrap().repair.is_some());
    let mesh = house.result(job.id.parse().unwrap()).await.unwrap();
    assert_eq!((mesh.bytes, mesh.file_name.as_str()), (6, "part_one-repaired.stl"));
    assert_eq!(mesh.read().await.unwrap(), b"mended");
    let report = house.report(job.id.parse().unwrap()).await.unwrap().read().await.unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["verdict"]["outcome"], "repaired");
}

#[tokio::test]
async fn the_engine_itself_closes_a_tetrahedron() {
    let dir = tempfile::tempdir().unwrap();
    let house = House { jobs: Jobs::start(JobsSettings::new(dir.path())).unwrap(), _dir: dir };
    let job = house.run(b"OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n").await;
    assert_eq!((job.state, job.outcome), (JobState::Succeeded, Some(Outcome::Repaired)), "{:?}", job.problem);
    let report = house.report(id(&job)).await.unwrap().read().await.unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["verdict"]["printable"], true);
    assert_eq!(report["before"]["defects"][0]["code"], "boundary-loop");
    let mesh = house.result(id(&job)).await.unwrap();
    let digest: String = mesh.sha256.iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(report["certificate"]["sha256"], digest);
    let job = house.run(b"nothing of the kind").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::MeshUnparseable)));
}

#[tokio::test]
async fn a_valid_mesh_comes_back_as_the_uploaded_file_itself() {
    let house = house(|_| {}, |_, _| Ok(sample::identical()));
    let job = house.run(b"valid").await;
    assert_eq!(house.result(id(&job)).await.unwrap().read().await.unwrap(), b"valid");
    assert_eq!(house.spool_files(), 2, "one mesh, one report");
    house.delete(id(&job)).await.unwrap();
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn a_refused_repair_has_failed_and_keeps_its_report() {
    let house = house(|_| {}, |_, _| Ok(sample::refused()));
    let job = house.run(b"hopeless").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::NotRepairable)));
    assert_eq!(job.outcome, Some(Outcome::Refused));
    assert!(house.report(id(&job)).await.is_ok());
    let problem = house.result(id(&job)).await.unwrap_err();
    assert_eq!((problem.code, problem.status), (ProblemCode::NotRepairable, 422));
    assert_eq!(problem.report.unwrap()["verdict"]["outcome"], "refused");
}

#[tokio::test]
async fn an_unreadable_mesh_fails_with_its_place() {
    let house = house(
        |_| {},
        |_, _| {
            let kind = ReadErrorKind::Truncated;
            Err(ReadError { kind, place: Place::Byte(84), expected: "50 bytes".into() }.into())
        },
    );
    let job = house.run(b"cut").await;
    let problem = job.problem.clone().unwrap();
    assert_eq!((problem.code, problem.byte), (ProblemCode::MeshTruncated, Some(84)));
    assert_eq!(problem.instance, Some(format!("/v1/jobs/{}", job.id)));
    assert_eq!(house.report(id(&job)).await.unwrap_err().code, ProblemCode::MeshTruncated);
}

#[tokio::test]
async fn a_panic_fails_the_job_and_leaves_the_slot_alive() {
    let house = house(
        |_| {},
        |bytes, budget| {
            assert_ne!(bytes, b"bad", "a planted panic");
            mend(bytes, budget)
        },
    );
    let job = house.run(b"bad").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::EngineCrashed)));
    assert_eq!(house.run(b"good").await.state, JobState::Succeeded);
}

#[tokio::test]
async fn a_queued_job_is_cancelled_at_once() {
    let house = house(|settings| settings.slots = 0, mend);
    let job = house.order(b"x").await.unwrap();
    assert_eq!(job.state, JobState::Queued);
    let job = house.cancel(id(&job)).await.unwrap();
    assert_eq!((job.state, code(&job)), (JobState::Cancelled, Some(ProblemCode::Cancelled)));
    assert_eq!(house.load().await.queued, 0);
}

#[tokio::test]
async fn a_running_job_is_cancelled_and_its_waiter_wakes() {
    let house = house(|_| {}, work_forever);
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    assert_eq!(house.get(id(&job)).await.unwrap().state, JobState::Running);
    house.cancel(id(&job)).await.unwrap();
    let job = house.end_of(&job).await;
    assert_eq!((job.state, code(&job)), (JobState::Cancelled, Some(ProblemCode::Cancelled)));
    let again = house.cancel(id(&job)).await.unwrap();
    assert_eq!(again.finished_at, job.finished_at, "an ended job stays as it is");
}

#[tokio::test]
async fn a_running_job_ends_at_the_server_s_deadline() {
    let house = house(|settings| settings.deadline_max = Duration::from_millis(20), work_forever);
    let job = house.run(b"x").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::EngineTimeout)));
}

#[tokio::test]
async fn the_caller_s_deadline_ends_running_and_queued_jobs() {
    let house = house(|_| {}, work_forever);
    let soon = Some(Duration::from_millis(20));
    let first = house.order_with(b"x", Options::default(), soon).await.unwrap();
    let second = house.order_with(b"y", Options::default(), soon).await.unwrap();
    for job in [first, second] {
        let job = house.end_of(&job).await;
        assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::EngineTimeout)));
    }
}

#[tokio::test]
async fn limits_of_a_job_are_those_of_the_settings() {
    let limits =
        |settings: &mut JobsSettings| (settings.engine_bytes_max, settings.engine_work_max) = (1000, 10);
    let house = house(limits, |bytes, budget| {
        if bytes == b"memory" {
            return Err(budget.charge(995).unwrap_err().into());
        }
        budget.spend(11)?;
        mend(bytes, budget)
    });
    let problem = house.run(b"memory").await.problem.unwrap();
    assert_eq!((problem.code, problem.limit), (ProblemCode::EngineOutOfMemory, Some(1000)));
    assert_eq!(problem.actual, Some(995 + 6), "the upload in memory counts");
    let problem = house.run(b"work").await.problem.unwrap();
    assert_eq!((problem.code, problem.limit_name), (ProblemCode::MeshTooLarge, Some("engine_work_max")));
}

#[tokio::test]
async fn a_full_queue_refuses_and_says_when_to_come_back() {
    let house = house(|settings| (settings.slots, settings.queue_max) = (0, 2), mend);
    for bytes in [b"1", b"2"] {
        house.order(bytes).await.unwrap();
    }
    let problem = house.order(b"3").await.unwrap_err();
    assert_eq!((problem.code, problem.status), (ProblemCode::QueueFull, 429));
    assert_eq!((problem.limit, problem.actual), (Some(2), Some(3)));
    assert!(problem.retry_after_s >= Some(1));
    assert_eq!(house.spool_files(), 2, "the refused upload is gone");
}

#[tokio::test]
async fn jobs_run_in_the_order_they_came_in_as_many_at_once_as_there_are_slots() {
    let (now, most) = (AtomicUsize::new(0), Arc::new(AtomicUsize::new(0)));
    let order = Arc::new(Mutex::new(Vec::new()));
    let (peak, seen) = (Arc::clone(&most), Arc::clone(&order));
    let house = house(
        |settings| (settings.slots, settings.queue_max) = (2, 20),
        move |bytes, budget| {
            seen.lock().unwrap().push(bytes[0]);
            peak.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            std::thread::sleep(Duration::from_millis(5));
            now.fetch_sub(1, Ordering::SeqCst);
            mend(bytes, budget)
        },
    );
    let mut jobs = Vec::new();
    for byte in 0..12 {
        jobs.push(house.order(&[byte]).await.unwrap());
    }
    for job in &jobs {
        assert_eq!(house.end_of(job).await.state, JobState::Succeeded);
    }
    assert_eq!(most.load(Ordering::SeqCst), 2);
    // Two slots take jobs in order, but the later one may be first to look at its bytes.
    let order = order.lock().unwrap();
    assert!(
        order.iter().enumerate().all(|(place, &byte)| place.abs_diff(usize::from(byte)) <= 1),
        "{order:?}"
    );
}

#[tokio::test]
async fn an_upload_over_the_limit_is_refused_while_it_comes_in() {
    let house = house(|settings| settings.upload_bytes_max = 10, mend);
    let problem = house.upload(Some(11)).await.unwrap_err();
    assert_eq!(
        (problem.code, problem.limit, problem.actual),
        (ProblemCode::BodyTooLarge, Some(10), Some(11))
    );
    let mut upload = house.upload(None).await.unwrap();
    upload.write(b"0123456789").await.unwrap();
    assert_eq!(upload.write(b"a").await.unwrap_err().code, ProblemCode::BodyTooLarge);
    drop(upload);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn an_upload_of_many_blocks_is_stored_whole_with_its_digest() {
    use sha2::{Digest, Sha256};
    let house = house(|_| {}, mend);
    let bytes: Vec<u8> = (0..1_000_003_u32).map(|i| (i % 251) as u8).collect();
    let mut upload = house.upload(None).await.unwrap();
    for piece in bytes.chunks(70_001) {
        upload.write(piece).await.unwrap();
    }
    let uploaded = upload.finish().await.unwrap();
    let blob = uploaded.blob().unwrap();
    assert_eq!(blob.sha256, <[u8; 32]>::from(Sha256::digest(&bytes)));
    assert_eq!(std::fs::read(house.service().spool.path(&blob.key)).unwrap(), bytes);
    assert_eq!(house.load().await.data_bytes, bytes.len() as u64);
    drop(uploaded);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn a_result_expires_after_its_time_and_its_files_go() {
    let house = house(|settings| settings.result_ttl = Duration::ZERO, mend);
    let job = house.run(b"x").await;
    assert_eq!(job.state, JobState::Expired);
    assert_eq!((job.links.report, job.links.result), (None, None));
    assert_eq!(house.result(job.id.parse().unwrap()).await.unwrap_err().code, ProblemCode::Expired);
    assert_eq!(house.report(job.id.parse().unwrap()).await.unwrap_err().status, 410);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn the_sweep_takes_what_is_due_and_the_caller_may_ask_for_less_time() {
    let house = house(|_| {}, mend);
    let short = Options { result_ttl: Some(60), ..Options::default() };
    let short = house.order_with(b"short", short, None).await.unwrap();
    let (short, long) = (house.end_of(&short).await, house.run(b"long").await);
    let in_two_minutes = short.finished_at.unwrap() + Duration::from_secs(120);
    house.service().sweep(in_two_minutes).await;
    assert_eq!(house.get(id(&short)).await.unwrap().state, JobState::Expired);
    assert_eq!(house.get(id(&long)).await.unwrap().state, JobState::Succeeded);
    assert_eq!(house.spool_files(), 3, "upload, report and mesh of the other one");
}

#[tokio::test]
async fn the_oldest_results_make_room_for_a_new_upload() {
    let house = house(|_| {}, mend);
    let report_bytes = {
        let job = house.run(b"probe").await;
        let bytes = house.load().await.data_bytes - 5;
        house.delete(id(&job)).await.unwrap();
        bytes
    };
    drop(house);
    // Room for two jobs with uploads of 10,000 bytes; a few bytes of a report are times and vary.
    let bytes_max = 2 * (10_000 + report_bytes + 100);
    let house = self::house(|settings| settings.data_bytes_max = bytes_max, mend);
    let mut jobs = Vec::new();
    for byte in 1..=3 {
        jobs.push(house.run(&[byte; 10_000]).await);
    }
    let mut states = Vec::new();
    for job in &jobs {
        states.push(house.get(id(job)).await.unwrap().state);
    }
    assert_eq!(states, [JobState::Expired, JobState::Succeeded, JobState::Succeeded]);
    assert!(house.load().await.data_bytes <= bytes_max);
}

#[tokio::test]
async fn an_upload_that_cannot_fit_is_refused_and_queued_jobs_are_kept() {
    let house = house(|settings| (settings.slots, settings.data_bytes_max) = (0, 1000), mend);
    let job = house.order(&[1; 900]).await.unwrap();
    let problem = house.order(&[2; 900]).await.unwrap_err();
    assert_eq!((problem.code, problem.limit), (ProblemCode::StorageFull, Some(1000)));
    assert_eq!(house.upload(Some(1001)).await.unwrap_err().code, ProblemCode::StorageFull);
    assert_eq!(house.get(id(&job)).await.unwrap().state, JobState::Queued);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (1, 900));
}

#[tokio::test]
async fn a_result_without_room_fails_its_job_and_leaves_no_file() {
    let house = house(|settings| settings.data_bytes_max = 1000, mend);
    let job = house.run(&[1; 990]).await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::StorageFull)));
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (1, 990));
}

#[tokio::test]
async fn the_number_of_kept_jobs_is_bounded() {
    let house = house(|settings| settings.jobs_max = 3, mend);
    let first = house.run(b"0").await;
    for bytes in [b"1", b"2", b"3", b"4"] {
        house.run(bytes).await;
    }
    assert_eq!(house.get(id(&first)).await.unwrap_err().code, ProblemCode::NotFound);
    assert_eq!(house.spool_files(), 3 * 3);
}

#[tokio::test]
async fn a_deleted_job_is_gone_with_its_files_even_while_it_runs() {
    let house = house(|_| {}, work_forever);
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let waiter = house.jobs.clone();
    let waiting = tokio::spawn(async move { waiter.wait(id(&job), PATIENCE).await });
    let job = house.order(b"y").await.unwrap();
    let running = house.service().live.all().into_iter().map(|(id, _)| id).min().unwrap();
    house.delete(running).await.unwrap();
    assert_eq!(waiting.await.unwrap().unwrap_err().code, ProblemCode::NotFound);
    house.until("the slot takes the next job", |load| (load.queued, load.running) == (0, 1)).await;
    assert_eq!(house.delete(running).await.unwrap_err().code, ProblemCode::NotFound);
    house.delete(id(&job)).await.unwrap();
    house.until("nothing is left", |load| load.data_bytes == 0).await;
    assert_eq!(house.spool_files(), 0);
}

#[tokio::test]
async fn a_job_deleted_in_its_last_moment_leaves_no_result() {
    let (tell, told) = mpsc::channel::<()>();
    let told = Mutex::new(told);
    let house = house(
        |_| {},
        move |_, _| {
            // Hears no stop flag: the result comes after the job is deleted.
            told.lock().unwrap().recv().unwrap();
            Ok(sample::repaired())
        },
    );
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    house.delete(id(&job)).await.unwrap();
    tell.send(()).unwrap();
    // The next job runs after the slot has cleaned up behind the first one.
    let next = house.order(b"y").await.unwrap();
    tell.send(()).unwrap();
    house.end_of(&next).await;
    assert_eq!(house.spool_files(), 3);
}

#[tokio::test]
async fn an_upload_is_used_again_and_stays_as_long_as_a_job_uses_it() {
    let house = house(
        |_| {},
        |bytes, budget| {
            assert_eq!(bytes, b"shared");
            mend(bytes, budget)
        },
    );
    let first = house.run(b"shared").await;
    let input = InputRef { job: first.id.clone() };
    let again = |operation, options: Options| Submission {
        operation,
        options: Options { input: Some(input.clone()), ..options },
        upload: None,
        material: None,
        file_name: None,
        owner: None,
        cancel_after: None,
    };
    let second = house.submit(again(Operation::Analyze, Options::default())).await.unwrap();
    house.delete(id(&first)).await.unwrap();
    let second = house.end_of(&second).await;
    assert_eq!(second.state, JobState::Succeeded);
    let problem = house.submit(again(Operation::Verify, Options::default())).await.unwrap_err();
    assert_eq!((problem.code, problem.parameter.as_deref()), (ProblemCode::NotFound, Some("input")));
    house.delete(id(&second)).await.unwrap();
    assert_eq!(house.spool_files(), 0);
}

#[tokio::test]
async fn one_mesh_is_needed_and_only_one() {
    let house = house(|settings| settings.slots = 0, mend);
    let job = house.order(b"x").await.unwrap();
    let options = Options { input: Some(InputRef { job: job.id }), ..Options::default() };
    let both = house.order_with(b"y", options, None).await.unwrap_err();
    assert_eq!(both.code, ProblemCode::InvalidParameter);
    let options = Options::default();
    let none = Submission {
        operation: Operation::Verify,
        options,
        upload: None,
        material: None,
        file_name: None,
        owner: None,
        cancel_after: None,
    };
    assert_eq!(house.submit(none).await.unwrap_err().code, ProblemCode::InvalidParameter);
    let options = Options { input: Some(InputRef { job: "seven".into() }), ..Options::default() };
    let strange = Submission {
        operation: Operation::Verify,
        options,
        upload: None,
        material: None,
        file_name: None,
        owner: None,
        cancel_after: None,
    };
    assert_eq!(house.submit(strange).await.unwrap_err().code, ProblemCode::NotFound);
}

#[tokio::test]
async fn the_same_bytes_and_options_are_answered_from_the_earlier_job() {
    let runs = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&runs);
    let house = house(
        |_| {},
        move |bytes, budget| {
            counted.fetch_add(1, Ordering::SeqCst);
            mend(bytes, budget)
        },
    );
    let first = house.run(b"x").await;
    let second = house.order(b"x").await.unwrap();
    assert_eq!((second.state, second.cached), (JobState::Succeeded, true));
    assert_ne!(first.id, second.id);
    assert_eq!(runs.load(Ordering::SeqCst), 1);
    house.delete(id(&first)).await.unwrap();
    assert_eq!(house.result(id(&second)).await.unwrap().read().await.unwrap(), b"mended");
    let other = Options { samples: Some(1), ..Options::default() };
    let third = house.order_with(b"x", other, None).await.unwrap();
    assert!(!house.end_of(&third).await.cached);
    assert_eq!(runs.load(Ordering::SeqCst), 2);
}

#[tokio::test]
async fn waiting_ends_with_the_job_or_with_patience() {
    let (tell, told) = mpsc::channel();
    let house = house(|_| {}, work_until_told(told));
    let job = house.order(b"x").await.unwrap();
    let early = house.wait(id(&job), Duration::from_millis(10)).await.unwrap();
    assert!(!early.state.is_final());
    assert_eq!(house.result(id(&job)).await.unwrap_err().code, ProblemCode::JobNotFinished);
    tell.send(()).unwrap();
    assert_eq!(house.end_of(&job).await.state, JobState::Succeeded);
}

#[tokio::test]
async fn a_draining_service_takes_nothing_new_and_lets_running_jobs_end() {
    let (tell, told) = mpsc::channel();
    let house = house(|_| {}, work_until_told(told));
    let running = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let queued = house.order(b"y").await.unwrap();
    let draining = house.jobs.clone();
    let drain = tokio::spawn(async move { draining.drain().await });
    let queued = house.end_of(&queued).await;
    assert_eq!((queued.state, code(&queued)), (JobState::Failed, Some(ProblemCode::Draining)));
    assert!(house.is_draining());
    assert_eq!(house.upload(None).await.unwrap_err().status, 503);
    tell.send(()).unwrap();
    drain.await.unwrap();
    assert_eq!(house.get(id(&running)).await.unwrap().state, JobState::Succeeded);
}

#[tokio::test]
async fn a_job_that_outlasts_the_grace_is_ended_as_drained() {
    let house = house(|settings| settings.drain_grace = Duration::from_millis(10), work_forever);
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    house.drain().await;
    let job = house.get(id(&job)).await.unwrap();
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::Draining)));
}

#[tokio::test]
async fn two_services_cannot_share_a_directory() {
    let house = house(|_| {}, mend);
    let second = Jobs::start(JobsSettings::new(&house.settings().data_dir));
    assert!(matches!(second, Err(StartError::DataDirInUse { .. })));
}

#[tokio::test]
async fn only_the_latest_claim_may_finish_a_job() {
    let house = house(|settings| settings.slots = 0, mend);
    house.order(b"x").await.unwrap();
    let store = &house.service().store;
    let row = store.claim(super::service::now()).await.unwrap().unwrap();
    let finish = house.service().finish(&row, JobState::Succeeded, None);
    assert_eq!(store.finish(row.id, row.epoch + 1, finish.clone()).await, Err(StoreError::ClaimVoid));
    assert_eq!(store.finish(row.id, row.epoch, finish.clone()).await, Ok(()));
    assert_eq!(store.finish(row.id, row.epoch, finish).await, Err(StoreError::ClaimVoid), "only once");
}
