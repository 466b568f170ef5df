//! Jobs in slots: what they give, how they end, and in which order they run.

use super::*;

#[tokio::test]
async fn a_repair_gives_a_report_and_a_mesh() {
    let house = house(
        |_| {},
        |bytes, budget| {
            assert_eq!(bytes, b"broken");
            budget.stage(crate::budget::Stage::Repair, || {});
            Ok(sample::repaired())
        },
    )
    .await;
    let job = house.run(b"broken").await;
    assert_eq!((job.state, job.outcome, job.problem), (JobState::Succeeded, Some(Outcome::Repaired), None));
    assert_eq!(job.progress.fraction, 1.0);
    assert!(job.started_at >= Some(job.created_at) && job.finished_at >= job.started_at);
    assert!(job.timing_ms.unwrap().repair.is_some());
    let mesh = house.result(job.id.parse().unwrap()).await.unwrap();
    assert_eq!((mesh.bytes, mesh.file_name.as_str()), (6, "part one-repaired.stl"));
    assert_eq!(content(mesh).await, b"mended");
    let report = house.report(job.id.parse().unwrap()).await.unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["verdict"]["outcome"], "repaired");
}

#[tokio::test]
async fn the_engine_itself_closes_a_tetrahedron() {
    let dir = tempfile::tempdir().unwrap();
    let house = House { jobs: Jobs::start(JobsSettings::new(dir.path())).await.unwrap(), dir };
    let job = house.run(b"OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n").await;
    assert_eq!((job.state, job.outcome), (JobState::Succeeded, Some(Outcome::Repaired)), "{:?}", job.problem);
    let report = house.report(id(&job)).await.unwrap();
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
    let house = house(|_| {}, |_, _| Ok(sample::identical())).await;
    let job = house.run(b"valid").await;
    assert_eq!(content(house.result(id(&job)).await.unwrap()).await, b"valid");
    assert_eq!(house.spool_files(), 2, "one mesh, one report");
    house.delete(id(&job)).await.unwrap();
    assert_eq!((house.spool_files(), house.load().await.data_bytes), (0, 0));
}

#[tokio::test]
async fn a_refused_repair_has_failed_and_keeps_its_report() {
    let house = house(|_| {}, |_, _| Ok(sample::refused())).await;
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
    )
    .await;
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
    )
    .await;
    let job = house.run(b"bad").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::EngineCrashed)));
    assert_eq!(house.run(b"good").await.state, JobState::Succeeded);
}

#[tokio::test]
async fn a_queued_job_is_cancelled_at_once() {
    let house = house(|settings| settings.slots = 0, mend).await;
    let job = house.order(b"x").await.unwrap();
    assert_eq!(job.state, JobState::Queued);
    let job = house.cancel(id(&job)).await.unwrap();
    assert_eq!((job.state, code(&job)), (JobState::Cancelled, Some(ProblemCode::Cancelled)));
    assert_eq!(house.load().await.queued, 0);
}

#[tokio::test]
async fn a_running_job_is_cancelled_and_its_waiter_wakes() {
    let house = house(|_| {}, work_forever).await;
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
    let house = house(|settings| settings.deadline_max = Duration::from_millis(20), work_forever).await;
    let job = house.run(b"x").await;
    assert_eq!((job.state, code(&job)), (JobState::Failed, Some(ProblemCode::EngineTimeout)));
}

#[tokio::test]
async fn the_caller_s_deadline_ends_running_and_queued_jobs() {
    let house = house(|_| {}, work_forever).await;
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
    })
    .await;
    let problem = house.run(b"memory").await.problem.unwrap();
    assert_eq!((problem.code, problem.limit), (ProblemCode::EngineOutOfMemory, Some(1000)));
    assert_eq!(problem.actual, Some(995 + 6), "the upload in memory counts");
    let problem = house.run(b"work").await.problem.unwrap();
    assert_eq!(
        (problem.code, problem.limit_name.as_deref()),
        (ProblemCode::MeshTooLarge, Some("engine_work_max"))
    );
}

#[tokio::test]
async fn a_full_queue_refuses_and_says_when_to_come_back() {
    let house = house(|settings| (settings.slots, settings.queue_max) = (0, 2), mend).await;
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
            // Until there have been two at once; a slot that sleeps on ends the wait and fails the test.
            for _ in 0..2000 {
                if peak.load(Ordering::SeqCst) > 1 {
                    break;
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            now.fetch_sub(1, Ordering::SeqCst);
            mend(bytes, budget)
        },
    )
    .await;
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
async fn waiting_ends_with_the_job_or_with_patience() {
    let (tell, told) = mpsc::channel();
    let house = house(|_| {}, work_until_told(told)).await;
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
    let house = house(|_| {}, work_until_told(told)).await;
    let running = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let queued = house.order(b"y").await.unwrap();
    let (draining, waiting) = (house.jobs.clone(), house.jobs.clone());
    let queued = id(&queued);
    let waiter = tokio::spawn(async move { waiting.wait(queued, PATIENCE).await });
    let drain = tokio::spawn(async move { draining.drain().await });
    let seen = waiter.await.unwrap().unwrap();
    assert_eq!(seen.state, JobState::Queued, "who waits for a queued job is not kept");
    assert!(house.is_draining());
    assert_eq!(house.upload(None).await.unwrap_err().status, 503);
    tell.send(()).unwrap();
    drain.await.unwrap();
    assert_eq!(house.get(id(&running)).await.unwrap().state, JobState::Succeeded);
    assert_eq!(house.get(queued).await.unwrap().state, JobState::Queued, "it stays for the next start");
}

#[tokio::test]
async fn a_job_that_outlasts_the_grace_is_queued_again_without_a_penalty() {
    let house = house(|settings| settings.drain_grace = Duration::from_millis(10), work_forever).await;
    let job = house.order(b"x").await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let (waiting, id) = (house.jobs.clone(), id(&job));
    let waiter = tokio::spawn(async move { waiting.wait(id, PATIENCE).await });
    house.drain().await;
    assert_eq!(waiter.await.unwrap().unwrap().state, JobState::Queued);
    let job = house.get(id).await.unwrap();
    assert_eq!((job.state, job.attempts, job.problem), (JobState::Queued, 0, None));
}
