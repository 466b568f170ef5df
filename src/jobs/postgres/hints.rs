//! Servers tell each other what they have changed, by LISTEN and NOTIFY on one connection of each, so that nobody has to look
//! all the time.
//!
//! A notification is sent after the change, in a transaction of its own that is not synced, many in one statement: PostgreSQL
//! commits those that notify one after the other, under a lock of the whole database.

use std::collections::HashSet;
use std::sync::atomic::{AtomicI32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use futures_util::TryStreamExt as _;
use futures_util::stream::poll_fn;
use tokio::sync::{Notify, broadcast, watch};
use tokio_postgres::{AsyncMessage, Client, Connection, Notification};
use tokio_util::sync::{CancellationToken, DropGuard};

use super::DatabaseAccess;
use super::access::{self, TlsStream};
use super::told;
use crate::jobs::store::{Hint, Hints};

/// The name under which servers of one database notify each other.
const CHANNEL: &str = "meshmend_jobs";
/// What stands for [`Hint::Work`]; a job stands for itself.
const WORK: &str = "work";
/// Most hints that wait for one who does not read them, and most that are sent in one statement.
const HINTS_MAX: usize = 1024;
/// Pause before a connection that was lost is made again.
const PAUSE: Duration = Duration::from_secs(1);

/// What goes to other servers and comes from them.
pub(super) struct HintLine {
    shared: Arc<HintChannel>,
    /// Ends the connection.
    _open: DropGuard,
}

struct HintChannel {
    /// What is to be told.
    waiting: Mutex<HashSet<Hint>>,
    has_some: Notify,
    heard: broadcast::Sender<Hint>,
    is_connected: watch::Sender<bool>,
    /// The process of the database that serves this connection: what it notifies of is known here.
    own_process: AtomicI32,
}

impl HintLine {
    /// Opens the line and keeps it open until it is dropped.
    pub(super) fn open(access: DatabaseAccess) -> Self {
        let shared = Arc::new(HintChannel {
            waiting: Mutex::default(),
            has_some: Notify::new(),
            heard: broadcast::channel(HINTS_MAX).0,
            is_connected: watch::channel(false).0,
            own_process: AtomicI32::new(0),
        });
        let stop = CancellationToken::new();
        let (keeping, stopped) = (Arc::clone(&shared), stop.clone());
        tokio::spawn(async move { stopped.run_until_cancelled(keeping.keep(&access)).await });
        Self { shared, _open: stop.drop_guard() }
    }

    /// Tells others, soon. While there is no connection nothing is told: they look by themselves.
    pub(super) fn tell(&self, hints: impl IntoIterator<Item = Hint>) {
        if *self.shared.is_connected.borrow() {
            self.shared.waiting().extend(hints);
            self.shared.has_some.notify_one();
        }
    }

    pub(super) fn hints(&self) -> Hints {
        Hints::new(self.shared.heard.subscribe(), self.shared.is_connected.subscribe())
    }
}

impl HintChannel {
    fn waiting(&self) -> MutexGuard<'_, HashSet<Hint>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Connects, again and again.
    async fn keep(&self, access: &DatabaseAccess) {
        loop {
            let lost = match access::connect(access).await {
                Ok((client, connection)) => {
                    self.use_connection(&client, connection).await.map_err(|e| told(&e))
                }
                Err(error) => Err(error.to_string()),
            };
            if self.is_connected.send_replace(false) {
                let error = lost.err();
                tracing::warn!(error, "what other servers do is looked for, since they are not heard");
                self.waiting().clear();
                // Whoever follows looks from now on. An error says that nobody does.
                let _ = self.heard.send(Hint::Missed);
            }
            tokio::time::sleep(PAUSE).await;
        }
    }

    /// Tells and hears, until the connection is lost.
    async fn use_connection(
        &self,
        client: &Client,
        mut connection: Connection<tokio_postgres::Socket, TlsStream>,
    ) -> Result<(), tokio_postgres::Error> {
        let messages = poll_fn(move |context| connection.poll_message(context));
        let hearing = messages.try_for_each(|message| {
            if let AsyncMessage::Notification(notification) = message {
                self.hear(&notification);
            }
            std::future::ready(Ok(()))
        });
        tokio::select! {
            lost = hearing => lost,
            lost = self.send(client) => lost,
        }
    }

    fn hear(&self, notification: &Notification) {
        if notification.process_id() == self.own_process.load(Ordering::Relaxed) {
            return;
        }
        let hint = match notification.payload() {
            WORK => Some(Hint::Work),
            // Another version may tell what this one does not know.
            job => job.parse().ok().map(Hint::Job),
        };
        if let Some(hint) = hint {
            // An error says that nobody follows.
            let _ = self.heard.send(hint);
        }
    }

    /// Sends what waits, all that there is at one time.
    async fn send(&self, client: &Client) -> Result<(), tokio_postgres::Error> {
        let own: i32 = client.query_one("SELECT pg_backend_pid()", &[]).await?.try_get(0)?;
        self.own_process.store(own, Ordering::Relaxed);
        client.batch_execute(&format!("SET synchronous_commit = off; LISTEN {CHANNEL}")).await?;
        let notify = client.prepare("SELECT pg_notify($1, hint) FROM unnest($2::text[]) AS hint").await?;
        self.is_connected.send_replace(true);
        // As above.
        let _ = self.heard.send(Hint::Missed);
        loop {
            self.has_some.notified().await;
            loop {
                let hints: Vec<String> = {
                    let mut waiting = self.waiting();
                    let some: HashSet<Hint> = waiting.iter().take(HINTS_MAX).copied().collect();
                    waiting.retain(|hint| !some.contains(hint));
                    some.into_iter().filter_map(word_of).collect()
                };
                if hints.is_empty() {
                    break;
                }
                client.execute(&notify, &[&CHANNEL, &hints]).await?;
            }
        }
    }
}

fn word_of(hint: Hint) -> Option<String> {
    match hint {
        Hint::Work => Some(WORK.to_owned()),
        Hint::Job(id) => Some(id.to_string()),
        Hint::Missed => None,
    }
}
