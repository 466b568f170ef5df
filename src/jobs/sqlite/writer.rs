//! The one thread that writes: changes that wait together are made durable together.
//!
//! Every change is a savepoint of its own inside one transaction, so a change that fails undoes itself alone, and all
//! that wait share one write to the disk. Answers are given after the commit.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rusqlite::Connection;
use tokio::sync::{mpsc, oneshot};

use super::failure;
use crate::jobs::store::{StoreError, StoreFuture};

/// Most changes of one transaction.
const TOGETHER_MAX: usize = 64;
/// Most changes that wait; whoever comes then waits to be let in.
const WAITING_MAX: usize = 1024;

/// A change, told whether there is a transaction to make it in.
type WriteRequest = Box<dyn FnOnce(Result<&Connection, StoreError>) -> CommitReply + Send>;
/// Gives the answer, once it is known whether the transaction is durable.
type CommitReply = Box<dyn FnOnce(Result<(), StoreError>)>;

/// The way to the thread, which ends when this is dropped.
#[derive(Debug)]
pub(super) struct WriterHandle(mpsc::Sender<WriteRequest>);

impl WriterHandle {
    /// Starts the thread.
    pub(super) fn start(connection: Connection) -> std::io::Result<Self> {
        let (send, receive) = mpsc::channel(WAITING_MAX);
        std::thread::Builder::new().name("job-store".to_owned()).spawn(move || serve(connection, receive))?;
        Ok(Self(send))
    }

    /// Makes a change. It is made also when nobody waits for its answer any more.
    pub(super) fn write<T: Send + 'static>(
        &self,
        body: impl FnOnce(&Connection) -> Result<T, StoreError> + Send + 'static,
    ) -> StoreFuture<'_, T> {
        let (tell, told) = oneshot::channel();
        let change: WriteRequest = Box::new(move |connection| {
            let result = connection.and_then(|connection| in_savepoint(connection, body));
            // Nobody may wait for the answer any more.
            Box::new(move |committed| drop(tell.send(committed.and(result))))
        });
        Box::pin(async move {
            let gone = || StoreError::Unavailable("the job store has failed".to_owned());
            self.0.send(change).await.map_err(|_| gone())?;
            told.await.map_err(|_| gone())?
        })
    }
}

/// Makes changes until nobody can ask for more.
#[allow(clippy::needless_pass_by_value, reason = "the thread owns both")]
fn serve(connection: Connection, mut changes: mpsc::Receiver<WriteRequest>) {
    while let Some(first) = changes.blocking_recv() {
        let begun = connection.execute_batch("BEGIN IMMEDIATE").map_err(|error| failure(&error));
        let mut answers = Vec::new();
        let mut next = Some(first);
        while let Some(change) = next {
            let place = begun.as_ref().map(|()| &connection).map_err(Clone::clone);
            // A panic takes its own change with it: dropping its answer tells its caller.
            match catch_unwind(AssertUnwindSafe(|| change(place))) {
                Ok(answer) => answers.push(answer),
                Err(_) => undo(&connection),
            }
            next = if answers.len() < TOGETHER_MAX { changes.try_recv().ok() } else { None };
        }
        let committed =
            begun.and_then(|()| connection.execute_batch("COMMIT").map_err(|error| failure(&error)));
        if let Err(error) = &committed {
            tracing::error!(%error, "the job store cannot write");
            if !connection.is_autocommit() {
                let _ = connection.execute_batch("ROLLBACK");
            }
        }
        for answer in answers {
            answer(committed.clone());
        }
    }
}

/// Makes a change that leaves nothing behind when it fails.
fn in_savepoint<T>(
    connection: &Connection,
    body: impl FnOnce(&Connection) -> Result<T, StoreError>,
) -> Result<T, StoreError> {
    connection.execute_batch("SAVEPOINT change").map_err(|error| failure(&error))?;
    let result = body(connection);
    match &result {
        Ok(_) => connection.execute_batch("RELEASE change").map_err(|error| failure(&error))?,
        Err(_) => undo(connection),
    }
    result
}

/// Undoes the change that is under way, if the transaction itself is not undone already (as when the disk is full).
fn undo(connection: &Connection) {
    let _ = connection.execute_batch("ROLLBACK TO change; RELEASE change");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counter() -> WriterHandle {
        let connection = Connection::open_in_memory().unwrap();
        connection.execute_batch("CREATE TABLE n (n INTEGER PRIMARY KEY)").unwrap();
        WriterHandle::start(connection).unwrap()
    }

    fn insert(connection: &Connection, number: i64) -> Result<(), StoreError> {
        connection.execute("INSERT INTO n VALUES (?1)", [number])?;
        Ok(())
    }

    async fn numbers(writer: &WriterHandle) -> i64 {
        let count = |connection: &Connection| {
            Ok(connection.query_row("SELECT count(*) FROM n", [], |row| row.get(0))?)
        };
        writer.write(count).await.unwrap()
    }

    #[tokio::test]
    async fn a_change_that_fails_or_panics_undoes_itself_alone() {
        let writer = counter();
        let failing = |connection: &Connection| {
            insert(connection, 1)?;
            Err::<(), _>(StoreError::NotFound)
        };
        let panicking = |connection: &Connection| -> Result<(), StoreError> {
            insert(connection, 2)?;
            panic!("a planted panic")
        };
        // All wait together.
        let (a, b, c, d) = tokio::join!(
            writer.write(|connection| insert(connection, 3)),
            writer.write(failing),
            writer.write(panicking),
            writer.write(|connection| insert(connection, 4)),
        );
        assert_eq!((a, b, d), (Ok(()), Err(StoreError::NotFound), Ok(())));
        assert!(matches!(c, Err(StoreError::Unavailable(_))));
        assert_eq!(numbers(&writer).await, 2);
    }

    #[tokio::test]
    async fn a_change_that_nobody_waits_for_is_made_all_the_same() {
        let writer = counter();
        let mut change = writer.write(|connection| insert(connection, 1));
        // Handed over, and then dropped.
        tokio::select! {
            biased;
            _ = &mut change => {}
            () = std::future::ready(()) => {}
        }
        drop(change);
        assert_eq!(numbers(&writer).await, 1);
    }
}
