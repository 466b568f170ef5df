//! The thread that starts children. One child more than there are jobs is always started, confined, and waits for its task:
//! a job does not wait for the loader.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;

use super::launch::Running;
use super::task::ChildSetup;
use super::workspace::Workspaces;

/// How much children step back behind the server, from 0 to 19: also while they start.
const NICENESS: i32 = 5;

/// The first descriptor that is none of standard input, output and error.
const FIRST_BESIDE_STREAMS: i32 = 3;

/// Starts children. The kernel ends a child with the thread that started it, so this one lives as long as the server.
#[derive(Debug)]
pub(super) struct Starter {
    spare: Arc<Spare>,
    asks: mpsc::Sender<Ask>,
    workspaces: Workspaces,
}

/// The child that waits for a task. Held while one is started: who comes meanwhile waits for that one.
#[derive(Debug, Default)]
struct Spare(Mutex<StarterState>);

#[derive(Debug, Default)]
struct StarterState {
    child: Option<Running>,
    /// No more children are wanted.
    is_over: bool,
}

/// What the thread is asked for: a child, or only that there be a spare one again.
type Ask = Option<mpsc::SyncSender<io::Result<Running>>>;

impl Starter {
    /// Starts the thread, and the first child.
    pub(super) fn open(setting: ChildSetup, workspaces: Workspaces) -> io::Result<Self> {
        // What this process was started with besides its standard streams is no child's: its own descriptors close by themselves.
        close_fds::set_fds_cloexec_threadsafe(FIRST_BESIDE_STREAMS, &[]);
        let (asks, asked) = mpsc::channel();
        let spare = Arc::new(Spare::default());
        let shared = Arc::clone(&spare);
        let places = workspaces.clone();
        let start = move || Running::start(&setting, &places);
        thread::Builder::new()
            .name("job-starter".to_owned())
            .spawn(move || serve(&shared, &asked, &start))?;
        Ok(Self { spare, asks, workspaces })
    }

    /// A child without a task. Blocks while one is started, when none waits.
    pub(super) fn child(&self) -> io::Result<Running> {
        let gone = || io::Error::other("the thread that starts processes has ended");
        let waiting = self.spare.lock().child.take();
        // One that has died while it waited serves nobody, nor does one whose folder somebody has removed.
        if let Some(mut child) = waiting
            && matches!(child.status(), Ok(None))
            && child.workspace.rooms.are_there()
        {
            self.asks.send(None).map_err(|_| gone())?;
            return Ok(child);
        }
        let (give, given) = mpsc::sync_channel(1);
        self.asks.send(Some(give)).map_err(|_| gone())?;
        given.recv().map_err(|_| gone())?
    }

    /// Ends the child that waits, for good.
    pub(super) fn close(&self) {
        let mut state = self.spare.lock();
        state.is_over = true;
        state.child = None;
        self.workspaces.close();
    }
}

impl Spare {
    fn lock(&self) -> MutexGuard<'_, StarterState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sees to it that a child waits.
    fn fill(&self, start: &dyn Fn() -> io::Result<Running>) {
        let mut state = self.lock();
        if state.is_over || state.child.is_some() {
            return;
        }
        match start() {
            Ok(child) => state.child = Some(child),
            Err(error) => tracing::warn!(%error, "no process waits for the next job"),
        }
    }
}

/// Starts children until nobody can ask for more.
fn serve(spare: &Spare, asked: &mpsc::Receiver<Ask>, start: &dyn Fn() -> io::Result<Running>) {
    // This thread's alone, and from it every child's. Where it is refused, children run like any other process.
    let _ = rustix::process::nice(NICENESS);
    spare.fill(start);
    while let Ok(ask) = asked.recv() {
        if let Some(give) = ask {
            // Whoever asked may be gone; then the child goes too.
            drop(give.send(start()));
        }
        spare.fill(start);
    }
    // The child is to be reaped before its thread ends.
    spare.lock().child = None;
}
