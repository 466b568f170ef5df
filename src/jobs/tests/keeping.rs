//! Uploads and results: what is kept, for how long, and what makes room.

use super::*;

#[tokio::test]
async fn an_upload_over_the_limit_is_refused_while_it_comes_in() {
    let house = house(|settings| settings.upload_bytes_max = 10, mend).await;
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
    let house = house(|_| {}, mend).await;
    let bytes: Vec<u8> = (0..1_000_003_u32).map(|i| (i % 251) as u8).collect();
    let mut upload = house.upload(None).await.unwrap();
    for piece in bytes.chunks(70_001) {
        upload.write(piece).await.unwrap();
    }
    let uploaded = upload.finish().await.unwrap();
    let blob = uploaded.blob().unwrap();
    assert_eq!(blob.sha256, <[u8; 32]>::from(Sha256::digest(&bytes)));
    assert_eq!(std::fs::read(house.service().spool.path(&blob.key).unwrap()).unwrap(), bytes);
    assert_eq!(house.load().await.data_bytes, bytes.len() as u64);
    drop(uploaded);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn a_result_expires_after_its_time_and_its_files_go() {
    let house = house(|settings| settings.result_ttl = Duration::ZERO, mend).await;
    let job = house.run(b"x").await;
    assert_eq!(job.state, JobState::Expired);
    assert_eq!((job.links.report, job.links.result), (None, None));
    assert_eq!(house.result(job.id.parse().unwrap()).await.unwrap_err().code, ProblemCode::Expired);
    assert_eq!(house.report(job.id.parse().unwrap()).await.unwrap_err().status, 410);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn the_sweep_takes_what_is_due_and_the_caller_may_ask_for_less_time() {
    let house = house(|_| {}, mend).await;
    let short = Options { result_ttl: Some(1), ..Options::default() };
    let short = house.order_with(b"short", short, None).await.unwrap();
    let (short, long) = (house.end_of(&short).await, house.run(b"long").await);
    tokio::time::sleep(Duration::from_millis(1050)).await;
    house.service().sweep().await;
    assert_eq!(house.get(id(&short)).await.unwrap().state, JobState::Expired);
    assert_eq!(house.get(id(&long)).await.unwrap().state, JobState::Succeeded);
    assert_eq!(house.spool_files(), 3, "upload, report and mesh of the other one");
}

#[tokio::test]
async fn the_oldest_results_make_room_for_a_new_upload() {
    let house = house(|_| {}, mend).await;
    let report_bytes = {
        let job = house.run(b"probe").await;
        let bytes = house.load().await.data_bytes - 5;
        house.delete(id(&job)).await.unwrap();
        bytes
    };
    drop(house);
    // Room for two jobs with uploads of 10,000 bytes; a few bytes of a report are times and vary.
    let bytes_max = 2 * (10_000 + report_bytes + 100);
    let house = self::house(|settings| settings.data_bytes_max = bytes_max, mend).await;
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
    let house = house(|settings| (settings.slots, settings.data_bytes_max) = (0, 1000), mend).await;
    let job = house.order(&[1; 900]).await.unwrap();
    let problem = house.order(&[2; 900]).await.unwrap_err();
    assert_eq!((problem.code, problem.limit), (ProblemCode::StorageFull, Some(1000)));
    assert_eq!(house.upload(Some(1001)).await.unwrap_err().code, ProblemCode::StorageFull);
    assert_eq!(house.get(id(&job)).await.unwrap().state, JobState::Queued);
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (1, 900));
}

#[tokio::test]
async fn a_result_without_room_fails_its_job_and_leaves_no_file() {
    let house = house(|settings| settings.data_bytes_max = 1000, mend).await;
    let job = house.run(&[1; 990]).await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::StorageFull)));
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (1, 990));
}

#[tokio::test]
async fn the_number_of_kept_jobs_is_bounded() {
    let house = house(|settings| settings.jobs_max = 3, mend).await;
    let first = house.run(b"0").await;
    for bytes in [b"1", b"2", b"3", b"4"] {
        house.run(bytes).await;
    }
    assert_eq!(house.get(id(&first)).await.unwrap_err().code, ProblemCode::NotFound);
    assert_eq!(house.spool_files(), 3 * 3);
}

#[tokio::test]
async fn a_deleted_job_is_gone_with_its_files_even_while_it_runs() {
    let house = house(|_| {}, work_forever).await;
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
    )
    .await;
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
    )
    .await;
    let first = house.run(b"shared").await;
    let input = InputRef::Job(first.id.clone());
    let again = |operation, options: Options| {
        Submission::new(operation, Options { input: Some(input.clone()), ..options })
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
    let house = house(|settings| settings.slots = 0, mend).await;
    let job = house.order(b"x").await.unwrap();
    let options = Options { input: Some(InputRef::Job(job.id)), ..Options::default() };
    let both = house.order_with(b"y", options, None).await.unwrap_err();
    assert_eq!(both.code, ProblemCode::InvalidParameter);
    let options = Options::default();
    let none = Submission::new(Operation::Verify, options);
    assert_eq!(house.submit(none).await.unwrap_err().code, ProblemCode::InvalidParameter);
    let options = Options { input: Some(InputRef::Job("seven".into())), ..Options::default() };
    let strange = Submission::new(Operation::Verify, options);
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
    )
    .await;
    let first = house.run(b"x").await;
    let meshes = house.settings().data_dir.join("spool/in");
    let last_change = || std::fs::metadata(&meshes).unwrap().modified().unwrap();
    let before = last_change();
    let second = house.order(b"x").await.unwrap();
    assert_eq!((second.state, second.cached), (JobState::Succeeded, true));
    assert_eq!(last_change(), before, "a small upload is written for a job that runs only");
    assert_ne!(first.id, second.id);
    assert_eq!(runs.load(Ordering::SeqCst), 1);
    house.delete(id(&first)).await.unwrap();
    assert_eq!(content(house.result(id(&second)).await.unwrap()).await, b"mended");
    let other = Options { samples: Some(1), ..Options::default() };
    let third = house.order_with(b"x", other, None).await.unwrap();
    assert!(!house.end_of(&third).await.cached);
    assert_eq!(runs.load(Ordering::SeqCst), 2);
}

#[tokio::test]
async fn an_upload_that_is_there_holds_a_place_in_the_queue_and_one_that_trickles_in_does_not() {
    let house = house(|settings| settings.queue_max = 1, mend).await;
    let mut slow = house.upload(None).await.unwrap();
    slow.write(b"x").await.unwrap();
    let whole = house.send(b"whole").await.unwrap().stored().await.unwrap();
    assert_eq!(house.upload(None).await.unwrap_err().code, ProblemCode::QueueFull);
    // What was let in before is refused before it touches the disk.
    assert_eq!(slow.finish().await.unwrap_err().code, ProblemCode::QueueFull);
    assert_eq!(house.spool_files(), 1);
    // A material needs no place of its own.
    house.upload_beside(Tenant::nobody()).await.unwrap().finish().await.unwrap();
    drop(whole);
    house.run(b"next").await;
}

#[tokio::test]
async fn two_services_cannot_share_a_directory() {
    let house = house(|_| {}, mend).await;
    let second = Jobs::start(JobsSettings::new(&house.settings().data_dir)).await;
    assert!(matches!(second, Err(StartError::Stores(StoresError::DataDirInUse { .. }))));
}

#[tokio::test]
async fn a_disk_that_is_nearly_full_takes_no_upload_and_no_result_goes_for_it() {
    let house = house(|_| {}, mend).await;
    let job = house.run(b"x").await;
    let dir = house.settings().data_dir.clone();
    let House { jobs, dir: _kept } = house;
    jobs.drain().await;
    drop(jobs);
    let settings = JobsSettings { disk_free_bytes_min: u64::MAX, ..JobsSettings::new(&dir) };
    let engine: Engine = Arc::new(|_: Asked, bytes: Vec<u8>, _: &_, budget: &Budget| mend(&bytes, budget));
    let jobs = restarting::started(settings, engine).await;
    let problem = jobs.upload(Some(5)).await.unwrap_err();
    assert_eq!(
        (problem.code, problem.limit_name.as_deref()),
        (ProblemCode::StorageFull, Some("disk_free_bytes_min"))
    );
    let mut unannounced = jobs.upload(None).await.unwrap();
    unannounced.write(b"hello").await.unwrap();
    assert_eq!(unannounced.finish().await.unwrap_err().code, ProblemCode::StorageFull);
    assert_eq!(content(jobs.result(id(&job)).await.unwrap()).await, b"mended");
}
