//! Several servers on one database and one bucket.

use super::blobs::s3::S3Server;
use super::stores::{Database, leave_out};
use super::*;
use tokio::io::AsyncWriteExt as _;

/// What several servers share, and a service of each.
struct Street {
    shared: SharedStores,
    _bucket: S3Server,
}

impl Street {
    async fn open(database: &Database) -> Self {
        let bucket = S3Server::start();
        let shared = SharedStores { database: database.access().await, bucket: bucket.access() };
        Self { shared, _bucket: bucket }
    }

    /// A server in a directory of its own.
    async fn house(
        &self,
        slots: usize,
        engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
    ) -> House {
        self.house_with(|settings| (settings.slots, settings.lease) = (slots, Duration::from_secs(1)), engine)
            .await
    }

    /// One that looks at what others do, and renews its claims, once in an hour.
    async fn listening_house(
        &self,
        slots: usize,
        engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
    ) -> House {
        let change = |settings: &mut JobsSettings| {
            (settings.slots, settings.lease, settings.look_every) = (slots, HOURS, HOURS);
        };
        let house = self.house_with(change, engine).await;
        house.hears(true).await;
        house
    }

    async fn house_with(
        &self,
        change: impl FnOnce(&mut JobsSettings),
        engine: impl Fn(&[u8], &Budget) -> Result<Answer, Failure> + Send + Sync + 'static,
    ) -> House {
        let change = |settings: &mut JobsSettings| {
            settings.shared = Some(self.shared.clone());
            settings.interactive_slots = 0;
            change(settings);
        };
        house(change, engine).await
    }

    /// The connections by which servers tell each other what they do are lost. How many there were.
    async fn cut_the_lines(&self) -> i64 {
        let (client, connection) =
            tokio_postgres::connect(&self.shared.database.url, tokio_postgres::NoTls).await.unwrap();
        tokio::spawn(connection);
        let sql = "SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity
            WHERE datname = current_database() AND application_name = 'meshmend hints'";
        client.query_one(sql, &[]).await.unwrap().get(0)
    }
}

/// A way to the database on which the answer to a commit can be lost.
struct Line {
    url: String,
    /// What the values of the transaction hold whose answer is to be lost.
    marker: Arc<Mutex<Option<Vec<u8>>>>,
}

impl Line {
    async fn to(url: &str) -> Self {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let (host, rest) = url.strip_prefix("host=").unwrap().split_once(' ').unwrap();
        let (socket, marker) = (format!("{host}/.s.PGSQL.5432"), Arc::default());
        let line = Self { url: format!("host=127.0.0.1 port={port} {rest}"), marker: Arc::clone(&marker) };
        tokio::spawn(async move {
            while let Ok((client, _)) = listener.accept().await {
                let server = tokio::net::UnixStream::connect(&socket).await.unwrap();
                tokio::spawn(pass_on(client, server, Arc::clone(&marker)));
            }
        });
        line
    }

    /// The answer to the commit of the next transaction with this among its values is lost, or to the success of the job with this id.
    fn lose(&self, marker: &[u8]) {
        *self.marker.lock().unwrap() = Some(marker.to_vec());
    }
}

/// Passes on what both sides say, until one of them ends or an answer is to be lost.
async fn pass_on(
    mut client: tokio::net::TcpStream,
    mut server: tokio::net::UnixStream,
    marker: Arc<Mutex<Option<Vec<u8>>>>,
) {
    let has = |bytes: &[u8], part: &[u8]| bytes.windows(part.len()).any(|window| window == part);
    let (mut asked, mut answered) = (vec![0; 64 << 10], vec![0; 64 << 10]);
    let (mut is_marked, mut is_lost) = (false, false);
    loop {
        tokio::select! {
            read = client.read(&mut asked) => {
                let Ok(bytes @ 1..) = read else { return };
                let said = &asked[..bytes];
                let is_named = marker.lock().unwrap().as_ref().is_some_and(|marker| has(said, marker));
                is_marked |= is_named;
                // The end of a job is one statement, which is a transaction by itself.
                if is_marked && has(said, b"COMMIT") || is_named && has(said, b"succeeded") {
                    is_lost = marker.lock().unwrap().take().is_some();
                }
                server.write_all(said).await.unwrap();
            }
            read = server.read(&mut answered) => {
                let Ok(bytes @ 1..) = read else { return };
                // The database has done it, and nobody hears of that.
                if is_lost || client.write_all(&answered[..bytes]).await.is_err() {
                    return;
                }
            }
        }
    }
}

/// Longer than any test.
const HOURS: Duration = Duration::from_secs(3 * 60 * 60);

impl House {
    /// Waits until it hears what others tell, or until it does not.
    async fn hears(&self, hears: bool) {
        let hints = self.service().store.hints().unwrap();
        for _ in 0..PATIENCE.as_millis() / 5 {
            if hints.are_heard() == hears {
                return;
            }
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        panic!("hears others: {}", hints.are_heard());
    }
}

/// A test that is left out where there is no PostgreSQL.
macro_rules! shared_tests {
    ($(async fn $name:ident($street:ident) $body:block)+) => { $(
        #[tokio::test(flavor = "multi_thread", worker_threads = 4)]
        async fn $name() {
            match Database::installed() {
                Ok(database) => {
                    let $street = Street::open(&database).await;
                    $body
                }
                Err(missing) => leave_out(missing),
            }
        }
    )+ };
}

shared_tests! {
    async fn a_job_is_sent_to_one_server_run_by_another_and_read_from_a_third(street) {
        let (first, third) = (street.house(0, mend).await, street.house(0, mend).await);
        let _second = street.house(1, |bytes, _| {
            assert_eq!(bytes, b"a mesh", "the upload came from the first one");
            Ok(sample::repaired())
        }).await;
        let job = first.order(b"a mesh").await.unwrap();
        let ended = first.end_of(&job).await;
        assert_eq!(ended.state, JobState::Succeeded, "{:?}", ended.problem);
        let here = content(first.result(id(&job)).await.unwrap()).await;
        let there = content(third.result(id(&job)).await.unwrap()).await;
        assert!(!here.is_empty() && here == there);
        third.delete(id(&job)).await.unwrap();
        assert!(first.get(id(&job)).await.is_err());
    }

    async fn a_job_is_cancelled_by_a_server_that_does_not_run_it(street) {
        let (first, second) = (street.house(0, mend).await, street.house(1, work_forever).await);
        let job = first.order(b"a mesh").await.unwrap();
        first.until("running", |load| load.running == 1).await;
        first.cancel(id(&job)).await.unwrap();
        assert_eq!(first.end_of(&job).await.state, JobState::Cancelled);
        drop(second);
    }

    async fn what_others_do_is_heard_by_servers_that_do_not_look(street) {
        let (told, heard) = mpsc::channel();
        let first = street.listening_house(0, mend).await;
        let _second = street.listening_house(1, work_until_told(heard)).await;
        let job = first.order(b"a mesh").await.unwrap();
        let mut events = first.events(id(&job), EventId::default()).await.unwrap().unwrap();
        let mut states = Vec::new();
        while let Some(event) = events.next().await {
            if let Happened::State { state, .. } = event.what {
                states.push(state);
                if state == JobState::Running {
                    told.send(()).unwrap();
                }
            }
        }
        assert_eq!(states, [JobState::Queued, JobState::Running, JobState::Succeeded]);
        let stopped = first.order(b"another mesh").await.unwrap();
        first.until("running", |load| load.running == 1).await;
        first.cancel(id(&stopped)).await.unwrap();
        assert_eq!(first.end_of(&stopped).await.state, JobState::Cancelled, "long before the claim is renewed");
    }

    async fn servers_that_do_not_hear_each_other_look(street) {
        let (told, heard) = mpsc::channel();
        let first = street.listening_house(0, mend).await;
        let second = street.listening_house(1, work_until_told(heard)).await;
        let job = first.order(b"a mesh").await.unwrap();
        second.until("running", |load| load.running == 1).await;
        assert_eq!(street.cut_the_lines().await, 2);
        first.hears(false).await;
        told.send(()).unwrap();
        assert_eq!(first.end_of(&job).await.state, JobState::Succeeded);
        for house in [&first, &second] {
            house.hears(true).await;
        }
        told.send(()).unwrap();
        assert_eq!(first.run(b"another mesh").await.state, JobState::Succeeded, "and they hear each other again");
    }

    async fn the_next_start_of_one_server_leaves_the_jobs_of_others_alone(street) {
        let (told, heard) = mpsc::channel();
        let working = street.house(1, work_until_told(heard)).await;
        let job = working.order(b"a mesh").await.unwrap();
        working.until("running", |load| load.running == 1).await;
        let other = street.house(0, mend).await;
        assert_eq!(other.get(id(&job)).await.unwrap().state, JobState::Running);
        told.send(()).unwrap();
        assert_eq!(other.end_of(&job).await.state, JobState::Succeeded);
        assert_eq!(working.service().store.get(id(&job)).await.unwrap().attempts, 0);
    }

    async fn files_stay_where_nobody_knows_whether_a_row_names_them(street) {
        let line = Line::to(&street.shared.database.url).await;
        let (tell, told) = mpsc::channel();
        let url = line.url.clone();
        let change = move |settings: &mut JobsSettings| {
            (settings.slots, settings.lease) = (1, HOURS);
            settings.shared.as_mut().unwrap().database.url = url;
        };
        let house = street.house_with(change, work_until_told(told)).await;
        let order = async || {
            let upload = Some(house.send(b"a mesh").await.unwrap());
            let asked = Submission::new(Operation::Repair, Options::default());
            house.submit(Submission { upload, key: Some("a key of mine".to_owned()), ..asked }).await
        };
        line.lose(b"a key of mine");
        assert!(order().await.is_err(), "the answer is lost");
        let job = order().await.unwrap();
        house.until("running", |load| load.running == 1).await;
        line.lose(uuid::Uuid::from(id(&job)).as_bytes());
        tell.send(()).unwrap();
        let ended = house.end_of(&job).await;
        assert_eq!((ended.state, ended.attempts), (JobState::Succeeded, 0), "{:?}", ended.problem);
        // Whoever made the end known has come to know of the loss by now.
        tokio::time::sleep(2 * crate::jobs::settle::STORE_PAUSE).await;
        assert!(line.marker.lock().unwrap().is_none(), "the answer is lost");
        assert!(!content(house.result(id(&job)).await.unwrap()).await.is_empty());
    }

    async fn a_piece_stays_where_nobody_knows_whether_a_row_names_it(street) {
        let line = Line::to(&street.shared.database.url).await;
        let url = line.url.clone();
        let change = move |settings: &mut JobsSettings| {
            settings.shared.as_mut().unwrap().database.url = url;
        };
        let house = street.house_with(change, mend).await;
        let tenant = Tenant::named("key:a".to_owned());
        let asked = AskedUpload { owner: None, tenant, file_name: None, metadata: None, length: 6 };
        let id = house.create_upload(asked).await.unwrap().id;
        let mut pieces = house.receive_pieces(id, None, 0).await.unwrap();
        pieces.write(b"a mesh").await.unwrap();
        line.lose(uuid::Uuid::from(id).as_bytes());
        assert_eq!(pieces.keep().await.unwrap_err().code, ProblemCode::StoreUnavailable, "the answer is lost");
        assert!(line.marker.lock().unwrap().is_none(), "the answer is lost");
        assert_eq!(house.get_upload(id, None).await.unwrap().received, 6, "the row names it");
        let named = house.take_upload(&id.to_string(), None, true).await.unwrap();
        assert!(matches!(named, NamedUpload::Mesh(..)), "{named:?}");
    }

    async fn a_bucket_of_another_database_is_refused(street) {
        let first = street.house(0, mend).await;
        first.order(b"a mesh").await.unwrap();
        let dir = tempfile::tempdir().unwrap();
        let another = Database::installed().unwrap().access().await;
        let shared = SharedStores { database: another, ..street.shared.clone() };
        let settings = JobsSettings { shared: Some(shared), ..JobsSettings::new(dir.path()) };
        let error = Jobs::start(settings).await.unwrap_err().to_string();
        assert!(error.contains("another database"), "{error}");
    }
}
