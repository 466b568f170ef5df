//! The thread that starts children. One child more than there are jobs is always started, and waits for its task: a job
//! does not wait for the loader.

use std::io;
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;

use super::launch::Running;

/// How much children step back behind the server, from 0 to 19: also while they start.
const NICENESS: i32 = 5;

/// Starts children. The kernel ends a child with the thread that started it, so this one lives as long as the server.
#[derive(Debug)]
pub(super) struct Starter {
    spare: Arc<Spare>,
    asks: mpsc::Sender<Ask>,
}

/// The child that waits for a task, when there is one.
type Spare = Mutex<Option<Running>>;

/// What the thread is asked for: a child, or only that there be a spare one again.
type Ask = Option<mpsc::SyncSender<io::Result<Running>>>;

impl Starter {
    /// Starts the thread, and the first child.
    pub(super) fn open() -> io::Result<Self> {
        let (asks, asked) = mpsc::channel();
        let spare = Arc::new(Spare::default());
        let shared = Arc::clone(&spare);
        thread::Builder::new().name("job-starter".to_owned()).spawn(move || serve(&shared, &asked))?;
        Ok(Self { spare, asks })
    }

    /// A child without a task. Blocks while one is started, when none waits.
    pub(super) fn child(&self) -> io::Result<Running> {
        let gone = || io::Error::other("the thread that starts processes has ended");
        let waiting = self.spare.lock().unwrap_or_else(PoisonError::into_inner).take();
        // One that has died while it waited serves nobody.
        if let Some(mut child) = waiting
            && matches!(child.status(), Ok(None))
        {
            self.asks.send(None).map_err(|_| gone())?;
            return Ok(child);
        }
        let (give, given) = mpsc::sync_channel(1);
        self.asks.send(Some(give)).map_err(|_| gone())?;
        given.recv().map_err(|_| gone())?
    }
}

/// Starts children until nobody can ask for more.
fn serve(spare: &Spare, asked: &mpsc::Receiver<Ask>) {
    // This thread's alone, and from it every child's. Where it is refused, children run like any other process.
    let _ = rustix::process::nice(NICENESS);
    loop {
        let is_wanted = spare.lock().unwrap_or_else(PoisonError::into_inner).is_none();
        if is_wanted {
            match Running::start() {
                Ok(child) => *spare.lock().unwrap_or_else(PoisonError::into_inner) = Some(child),
                Err(error) => tracing::warn!(%error, "no process waits for the next job"),
            }
        }
        match asked.recv() {
            // Whoever asked may be gone; then the child goes too.
            Ok(Some(give)) => drop(give.send(Running::start())),
            Ok(None) => {}
            Err(mpsc::RecvError) => break,
        }
    }
    // The child is to be reaped before its thread ends.
    drop(spare.lock().unwrap_or_else(PoisonError::into_inner).take());
}
