//! Services that end and begin again on the same directory, and what goes on with their jobs.

use super::*;
use crate::jobs::events::{EventId, Happened};

/// A service that has ended at once, as if the process were gone, and one that takes its place.
async fn crash_and_restart(
    house: House,
    change: impl FnOnce(&mut JobsSettings),
    engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
) -> House {
    let House { jobs, dir } = house;
    let mut settings = jobs.settings().clone();
    change(&mut settings);
    // The runs of the first one are stopped, but what comes of them is not waited for: its files stay locked until then.
    jobs.service().draining.cancel();
    stop_until_slots_are_free(&jobs).await;
    drop(jobs);
    let engine: Engine = Arc::new(move |_: Asked, bytes, _, budget| engine(&bytes, budget));
    House { jobs: started(settings, engine).await, dir }
}

/// Stops what runs, again and again: a claim is in the store before its run can be stopped.
async fn stop_until_slots_are_free(jobs: &Jobs) {
    let mut slots = std::pin::pin!(jobs.service().slots.wait());
    loop {
        for (_, live) in jobs.service().live.all() {
            live.make_void();
        }
        tokio::select! {
            () = &mut slots => return,
            () = tokio::time::sleep(Duration::from_millis(5)) => {}
        }
    }
}

/// A service on a directory that another one of this process has just left.
pub(super) async fn started(settings: JobsSettings, engine: Engine) -> Jobs {
    let mut tries = 0;
    loop {
        match Jobs::start_with(settings.clone(), Arc::clone(&engine)).await {
            Ok(jobs) => return jobs,
            // Tasks of the first one may hold it for a moment more.
            Err(StartError::Stores(StoresError::DataDirInUse { .. })) if tries < 1000 => {
                tries += 1;
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[tokio::test]
async fn what_was_accepted_ends_although_the_process_is_gone() {
    let house = house(|_| {}, work_forever).await;
    let running = house.order(b"running").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let queued = house.order(b"queued").await.unwrap();
    let house = crash_and_restart(house, |_| {}, mend).await;
    for (job, attempts) in [(&running, 1), (&queued, 0)] {
        let ended = house.end_of(job).await;
        assert_eq!((ended.state, ended.attempts), (JobState::Succeeded, attempts), "{:?}", ended.problem);
        assert_eq!(content(house.result(id(job)).await.unwrap()).await, b"mended");
    }
    assert_eq!(house.spool_files(), 6);
}

#[tokio::test]
async fn a_job_that_takes_the_process_with_it_is_given_up() {
    let mut house = house(|settings| settings.attempts_max = 2, work_forever).await;
    let poison = house.order(b"x").await.unwrap();
    for _ in 0..2 {
        house.until("running", |load| load.running == 1).await;
        house = crash_and_restart(house, |_| {}, work_forever).await;
    }
    let ended = house.get(id(&poison)).await.unwrap();
    assert_eq!((ended.state, code(&ended)), (JobState::Failed, Some(ProblemCode::WorkerLost)));
    assert_eq!((ended.attempts, house.load().await.running), (2, 0));
}

#[tokio::test]
async fn a_crash_of_the_engine_is_tried_again_and_then_given_up() {
    let runs = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&runs);
    let house = house(
        |_| {},
        move |bytes, budget| {
            let run = counted.fetch_add(1, Ordering::SeqCst);
            assert!(bytes != b"bad" && run != 3, "a planted panic");
            mend(bytes, budget)
        },
    )
    .await;
    let bad = house.run(b"bad").await;
    assert_eq!(
        (bad.state, code(&bad), bad.attempts),
        (JobState::Failed, Some(ProblemCode::EngineCrashed), 3)
    );
    let unlucky = house.run(b"unlucky").await;
    assert_eq!((unlucky.state, unlucky.attempts), (JobState::Succeeded, 1));
}

#[tokio::test]
async fn results_and_the_cache_outlast_the_process() {
    let house = house(|_| {}, mend).await;
    let first = house.run(b"x").await;
    let house = crash_and_restart(house, |_| {}, work_forever).await;
    assert_eq!(content(house.result(id(&first)).await.unwrap()).await, b"mended");
    let again = house.order(b"x").await.unwrap();
    assert_eq!((again.state, again.cached), (JobState::Succeeded, true));
    assert_eq!(house.load().await.data_bytes, bytes_under(&house.settings().data_dir.join("spool")));
}

#[tokio::test]
async fn the_caller_s_deadline_outlasts_the_process() {
    let house = house(|settings| settings.slots = 0, mend).await;
    let soon = Some(Duration::from_millis(200));
    let job = house.order_with(b"x", Options::default(), soon).await.unwrap();
    let house = crash_and_restart(house, |_| {}, mend).await;
    let ended = house.end_of(&job).await;
    assert_eq!((ended.state, code(&ended)), (JobState::Failed, Some(ProblemCode::EngineTimeout)));
}

#[tokio::test]
async fn files_that_nobody_names_go_at_the_start_and_what_is_named_stays() {
    let house = house(|_| {}, mend).await;
    let job = house.run(b"x").await;
    let spool = house.settings().data_dir.join("spool");
    std::fs::write(spool.join("in/cut-off"), b"half an upload").unwrap();
    std::fs::write(spool.join(format!("out/{}.1.mesh-0", JobId::unique())), b"of a void claim").unwrap();
    std::fs::write(spool.join(format!("out/{}.0.report.json", job.id)), b"of an earlier claim").unwrap();
    let house = crash_and_restart(house, |_| {}, mend).await;
    assert_eq!(house.spool_files(), 3);
    assert_eq!(house.load().await.data_bytes, bytes_under(&spool));
    assert!(house.result(id(&job)).await.is_ok() && house.report(id(&job)).await.is_ok());
}

#[tokio::test]
async fn an_upload_under_way_is_not_taken_for_an_orphan() {
    let house = house(|_| {}, mend).await;
    let mut upload = house.upload(None).await.unwrap();
    upload.write(&vec![1; 1 << 20]).await.unwrap();
    let complete = house.send(b"complete").await.unwrap().stored().await.unwrap();
    house.service().collect_orphans().await.unwrap();
    assert_eq!(house.spool_files(), 2);
    let uploaded = upload.finish().await.unwrap();
    house.service().collect_orphans().await.unwrap();
    assert_eq!(house.spool_files(), 2);
    drop((complete, uploaded));
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn files_of_the_run_that_goes_on_are_not_taken_for_orphans_and_those_of_void_claims_are() {
    let house = house(|_| {}, work_forever).await;
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let out = house.settings().data_dir.join("spool/out");
    let made = |epoch: u32| out.join(format!("{}.{epoch}.mesh-0", job.id));
    for epoch in [1, 2] {
        std::fs::write(made(epoch), b"half a result").unwrap();
    }
    house.service().collect_orphans().await.unwrap();
    let are_there = [1, 2].map(|epoch| made(epoch).exists());
    house.cancel(id(&job)).await.unwrap();
    house.end_of(&job).await;
    assert_eq!(are_there, [true, false]);
    house.service().collect_orphans().await.unwrap();
    assert_eq!(house.spool_files(), 1, "the upload");
}

#[tokio::test]
async fn a_store_of_a_newer_program_is_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("jobs.sqlite3");
    rusqlite::Connection::open(&path).unwrap().pragma_update(None, "user_version", 1000).unwrap();
    let error = Jobs::start(JobsSettings::new(dir.path())).await.unwrap_err();
    assert!(matches!(error, StartError::Stores(StoresError::Rows { .. })), "{error}");
    assert!(error.to_string().contains("version is 1000"), "{error}");
}

#[tokio::test]
async fn a_run_whose_claim_is_void_leaves_nothing() {
    let house = house(|settings| settings.lease = Duration::from_millis(300), work_forever).await;
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let store = Arc::clone(&house.service().store);
    let row = store.get(id(&job)).await.unwrap();
    store.lose(row.claim(), Problem::new(ProblemCode::WorkerLost, "lost"), 1).await.unwrap();
    house.until("the slot is free", |load| load.running == 0).await;
    let ended = house.end_of(&job).await;
    assert_eq!((ended.state, code(&ended)), (JobState::Failed, Some(ProblemCode::WorkerLost)));
    // Nobody tells the run to end but its heartbeat.
    house.drain().await;
    assert_eq!(house.spool_files(), 1, "the upload");
}

#[tokio::test]
async fn a_request_that_is_repeated_with_its_key_gives_one_job() {
    let house = house(|settings| settings.slots = 0, mend).await;
    let order = async |bytes: &[u8], options: Options| {
        let upload = Some(house.send(bytes).await.unwrap());
        let asked = Submission::new(Operation::Repair, options);
        house.submit(Submission { upload, key: Some("k".to_owned()), ..asked }).await
    };
    let first = order(b"x", Options::default()).await.unwrap();
    let again = order(b"x", Options::default()).await.unwrap();
    assert_eq!((&again.id, house.spool_files()), (&first.id, 1), "the second upload is gone");
    let options = Options { samples: Some(1), ..Options::default() };
    for other in [order(b"y", Options::default()).await, order(b"x", options).await] {
        assert_eq!(other.unwrap_err().code, ProblemCode::IdempotencyKeyReused);
    }
    assert_eq!((house.spool_files(), house.load().await.queued), (1, 1));
}

/// The states that the events after `last` tell, and the last event's id.
async fn states(house: &House, job: JobId, last: EventId) -> (Vec<JobState>, usize, EventId) {
    let (mut states, mut passes, mut last) = (Vec::new(), 0, last);
    let Some(mut events) = house.events(job, last).await.unwrap() else { return (states, passes, last) };
    while let Some(event) = tokio::time::timeout(PATIENCE, events.next()).await.unwrap() {
        assert!(event.id > last, "{event:?} after {last}");
        last = event.id;
        match event.what {
            Happened::State { state, .. } => states.push(state),
            Happened::Pass { .. } => passes += 1,
        }
    }
    (states, passes, last)
}

#[tokio::test]
async fn who_follows_a_job_hears_every_change_and_its_passes() {
    let (tell, told) = mpsc::channel();
    let told = Mutex::new(told);
    let house = house(
        |_| {},
        move |_, budget| {
            budget.stage(crate::budget::Stage::Read, || told.lock().unwrap().recv().unwrap());
            Ok(sample::repaired())
        },
    )
    .await;
    let job = id(&house.order(b"x").await.unwrap());
    house.until("running", |load| load.running == 1).await;
    let mut events = house.events(job, EventId::default()).await.unwrap().unwrap();
    let mut heard = Vec::new();
    while heard.len() < 3 {
        heard.push(tokio::time::timeout(PATIENCE, events.next()).await.unwrap().unwrap());
    }
    assert!(matches!(heard[2].what, Happened::Pass { has_ended: false, .. }), "{heard:?}");
    assert_eq!(heard[2].id.to_string(), "2.1");
    tell.send(()).unwrap();
    let (rest, passes, last) = states(&house, job, heard[2].id).await;
    assert_eq!((rest, passes), (vec![JobState::Succeeded], 1));
    assert!(house.events(job, last).await.unwrap().is_none(), "all is heard");
    let (all, _, _) = states(&house, job, EventId::default()).await;
    assert_eq!(all, [JobState::Queued, JobState::Running, JobState::Succeeded]);
}

#[tokio::test]
async fn who_follows_a_job_over_a_crash_hears_its_end_once() {
    let house = house(|_| {}, work_forever).await;
    let job = id(&house.order(b"x").await.unwrap());
    house.until("running", |load| load.running == 1).await;
    let mut events = house.events(job, EventId::default()).await.unwrap().unwrap();
    let mut last = EventId::default();
    for _ in 0..2 {
        last = events.next().await.unwrap().id;
    }
    drop(events);
    let house = crash_and_restart(house, |_| {}, mend).await;
    let (missed, _, end) = states(&house, job, last).await;
    assert_eq!(missed, [JobState::Queued, JobState::Running, JobState::Succeeded]);
    assert_eq!(states(&house, job, end).await.0, []);
    house.delete(job).await.unwrap();
    assert_eq!(house.events(job, end).await.unwrap_err().code, ProblemCode::NotFound);
}
