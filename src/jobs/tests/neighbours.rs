//! Tenants beside each other: what one does costs the others nothing that is theirs.

use super::*;

impl House {
    async fn send_of(&self, tenant: &Tenant, bytes: &[u8]) -> Result<Uploaded, Problem> {
        let mut upload = self.upload_of(tenant.clone(), Some(bytes.len() as u64)).await?;
        upload.write(bytes).await?;
        upload.finish().await
    }

    async fn order_of(&self, tenant: &str, bytes: &[u8], is_waited_for: bool) -> Result<Job, Problem> {
        let tenant = Tenant::named(tenant);
        let upload = Some(self.send_of(&tenant, bytes).await?);
        let owner = Some(tenant.name().to_owned());
        let asked = Submission::new(Operation::Repair, Options::default());
        self.submit(Submission { upload, tenant, owner, is_waited_for, ..asked }).await
    }

    async fn run_of(&self, tenant: &str, bytes: &[u8]) -> Job {
        let job = self.order_of(tenant, bytes, false).await.unwrap();
        self.end_of(&job).await
    }
}

#[tokio::test]
async fn many_small_jobs_of_one_push_out_no_job_of_another() {
    let house = house(|settings| settings.jobs_max = 6, mend).await;
    let kept = house.run_of("quiet", b"kept").await;
    for number in 0..20_u8 {
        house.run_of("loud", &[number]).await;
        // Answered from an earlier one.
        house.order_of("loud", &[number], false).await.unwrap();
    }
    assert_eq!(house.get(id(&kept)).await.unwrap().state, JobState::Succeeded);
    assert_eq!(content(house.result(id(&kept)).await.unwrap()).await, b"mended");
}

#[tokio::test]
async fn large_files_of_one_push_out_no_result_of_another() {
    let house = house(|settings| settings.data_bytes_max = 100_000, mend).await;
    let kept = house.run_of("quiet", &[7; 10_000]).await;
    let mut last = None;
    for number in 0..20_u8 {
        last = Some(house.run_of("loud", &[number; 20_000]).await);
    }
    assert_eq!(house.get(id(&kept)).await.unwrap().state, JobState::Succeeded);
    assert_eq!(last.unwrap().state, JobState::Succeeded, "it makes room by its own");
}

#[tokio::test]
async fn the_queue_of_one_leaves_places_for_another() {
    let house = house(|settings| (settings.slots, settings.queue_max) = (0, 8), mend).await;
    let refused = loop {
        if let Err(problem) = house.order_of("loud", b"x", false).await {
            break problem;
        }
    };
    assert_eq!(
        (refused.code, refused.limit_name.as_deref(), refused.limit, refused.actual),
        (ProblemCode::QueueFull, Some("owner_queue_max"), Some(4), Some(5))
    );
    assert!(refused.retry_after_s.is_some());
    house.order_of("quiet", b"y", false).await.unwrap();
    let own = self::house(|settings| (settings.slots, settings.owner_queue_max) = (0, Some(1)), mend).await;
    own.order_of("loud", b"x", false).await.unwrap();
    assert_eq!(own.order_of("loud", b"y", false).await.unwrap_err().limit, Some(1));
}

#[tokio::test]
async fn uploads_of_one_leave_room_for_those_of_another() {
    let change = |settings: &mut JobsSettings| {
        (settings.slots, settings.data_bytes_max, settings.queue_max) = (0, 1000, 100);
    };
    let house = house(change, mend).await;
    house.order_of("loud", &[1; 400], false).await.unwrap();
    let refused = house.order_of("loud", &[2; 300], false).await.unwrap_err();
    assert_eq!(
        (refused.code, refused.limit_name.as_deref()),
        (ProblemCode::StorageFull, Some("owner_data_bytes_max"))
    );
    let coming = house.send_of(&Tenant::named("loud"), &[2; 100]).await.unwrap();
    let problem = house.send_of(&Tenant::named("loud"), &[3; 100]).await.unwrap_err();
    assert_eq!(problem.code, ProblemCode::StorageFull, "also while it is no job yet");
    house.order_of("quiet", &[3; 500], false).await.unwrap();
    drop(coming);
}

#[tokio::test]
async fn a_tenant_may_be_held_to_a_number_of_jobs_and_bytes_of_its_own() {
    let house = house(|settings| settings.owner_jobs_max = Some(2), mend).await;
    let first = house.run_of("a", b"1").await;
    let other = house.run_of("b", b"1").await;
    for bytes in [b"2", b"3"] {
        house.run_of("a", bytes).await;
    }
    assert_eq!(house.get(id(&first)).await.unwrap_err().code, ProblemCode::NotFound);
    assert!(house.get(id(&other)).await.is_ok());
    let house = self::house(|settings| settings.owner_data_bytes_max = Some(50_000), mend).await;
    let first = house.run_of("a", &[1; 30_000]).await;
    house.run_of("a", &[2; 30_000]).await;
    assert_eq!(house.get(id(&first)).await.unwrap().state, JobState::Expired);
    assert_eq!(house.order_of("a", &[3; 60_000], false).await.unwrap_err().code, ProblemCode::StorageFull);
}

#[tokio::test]
async fn no_tenant_has_every_slot() {
    let change = |settings: &mut JobsSettings| {
        (settings.slots, settings.interactive_slots, settings.queue_max) = (2, 2, 100);
        settings.drain_grace = Duration::from_millis(10);
    };
    let house = house(change, work_forever).await;
    for number in 0..3_u8 {
        house.order_of("loud", &[number], false).await.unwrap();
        house.order_of("loud", &[number, 7], true).await.unwrap();
    }
    house.until("one in each kind of slot", |load| (load.running, load.queued) == (2, 4)).await;
    // A large one, which no slot for small ones takes, comes first.
    for (number, is_waited_for) in [false, true].into_iter().enumerate() {
        let job = house.order_of("quiet", &[u8::from(is_waited_for)], is_waited_for).await.unwrap();
        house.until("the other one's", |load| load.running == 3 + number).await;
        assert_eq!(house.get(id(&job)).await.unwrap().state, JobState::Running);
    }
    assert_eq!(house.load().await.queued, 4);
    house.drain().await;
}

#[tokio::test]
async fn a_job_that_takes_longer_than_a_slot_for_small_ones_is_for_goes_on_as_a_large_one() {
    let (tell, told) = mpsc::channel();
    let house = house(
        |settings| {
            settings.interactive_deadline = Duration::from_millis(100);
            settings.slots = 1;
        },
        work_until_told(told),
    )
    .await;
    let large = house.order_of("loud", b"large", false).await.unwrap();
    house.until("running", |load| load.running == 1).await;
    let slow = house.order_of("loud", b"slow", true).await.unwrap();
    let is_demoted = async || {
        let row = house.service().store.get(id(&slow)).await.unwrap();
        (row.lane, row.state, row.epoch, row.attempts) == (Lane::Bulk, JobState::Queued, 1, 0)
    };
    for _ in 0..PATIENCE.as_millis() / 5 {
        if is_demoted().await {
            break;
        }
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    assert!(is_demoted().await);
    for _ in 0..2 {
        tell.send(()).unwrap();
    }
    for job in [large, slow] {
        assert_eq!(house.end_of(&job).await.state, JobState::Succeeded);
    }
}

#[tokio::test]
async fn a_job_that_needs_more_memory_than_was_thought_is_given_all_that_a_job_may_have() {
    let runs = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&runs);
    let house = house(
        |settings| (settings.memory_bytes_max, settings.engine_bytes_max) = (8 << 30, 4 << 30),
        move |bytes, budget| {
            let wanted = if bytes == b"endless" { 5 << 30 } else { 3_u64 << 30 };
            let charged = budget.charge(wanted).map(drop);
            seen.lock().unwrap().push(charged.is_ok());
            charged?;
            mend(bytes, budget)
        },
    )
    .await;
    let job = house.run_of("a", b"large").await;
    assert_eq!((job.state, job.attempts), (JobState::Succeeded, 0), "{:?}", job.problem);
    assert_eq!(*runs.lock().unwrap(), [false, true]);
    let waited_for = house.order_of("a", b"larger", true).await.unwrap();
    assert_eq!(house.end_of(&waited_for).await.state, JobState::Succeeded);
    assert_eq!(*runs.lock().unwrap(), [false, true, false, true]);
    let endless = house.run_of("a", b"endless").await;
    assert_eq!((endless.state, code(&endless)), (JobState::Failed, Some(ProblemCode::EngineOutOfMemory)));
    assert_eq!(runs.lock().unwrap().len(), 6, "twice, not as often as a lost run");
    assert_eq!(endless.problem.unwrap().limit, Some(4 << 30));
}
