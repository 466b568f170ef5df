//! What happens beside a run: Ctrl-C, the deadline, and the progress line of a terminal.

use crate::budget::StopFlag;
use crate::pipeline::Operation;
use crate::wire::Progress;
use std::io::{IsTerminal as _, Write as _};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// Pause between two progress lines.
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// How far a run is.
#[derive(Debug, Clone)]
pub(super) struct Share<'s> {
    operation: Operation,
    /// Names of its files.
    subject: &'s str,
    progress: Progress,
}

impl<'s> Share<'s> {
    /// Characters of the bar.
    const WIDTH: usize = 24;
    /// Columns of a line: a longer one would be broken on a terminal, and could not be drawn over.
    const LINE_WIDTH: usize = 79;

    pub(super) fn of(operation: Operation, subject: &'s str, progress: Progress) -> Self {
        Self { operation, subject, progress }
    }

    /// One line: the operation, a bar, the share, the time since the beginning, the pass, and the file.
    fn line(&self, since: Duration) -> String {
        let fraction = self.progress.fraction.clamp(0.0, 1.0);
        let full = (fraction * Self::WIDTH as f64) as usize;
        let bar = format!("{}{}", "#".repeat(full), ".".repeat(Self::WIDTH - full));
        let stage = self.progress.stage.map_or("", |stage| stage.word());
        let seconds = since.as_secs();
        let (operation, percent) = (self.operation.name(), fraction * 100.0);
        let (minutes, seconds) = (seconds / 60, seconds % 60);
        let told = format!(
            "{operation} [{bar}] {percent:3.0} %  {minutes:02}:{seconds:02}  {stage:14}  {}",
            self.subject
        );
        let mut width = 0;
        let fits = |&c: &char| {
            width += columns(c);
            width <= Self::LINE_WIDTH
        };
        told.trim_end().chars().map(|c| if c.is_control() { '?' } else { c }).take_while(fits).collect()
    }
}

/// Columns that a character takes on a terminal, at most.
fn columns(c: char) -> usize {
    if c.is_ascii() { 1 } else { 2 }
}

/// Runs `body` while a second thread raises `stop` on Ctrl-C, on SIGTERM or after `deadline`, and shows `progress` if
/// standard error is a terminal.
pub(super) fn watched<'s, T>(
    stop: &StopFlag,
    deadline: Option<Duration>,
    progress: impl Fn() -> Share<'s> + Send,
    body: impl FnOnce() -> T,
) -> T {
    let (done, is_done) = oneshot::channel::<()>();
    let stop = stop.clone();
    std::thread::scope(|scope| {
        scope.spawn(move || watch(&stop, deadline, progress, is_done));
        let result = body();
        drop(done);
        result
    })
}

fn watch<'s>(
    stop: &StopFlag,
    deadline: Option<Duration>,
    progress: impl Fn() -> Share<'s>,
    mut is_done: oneshot::Receiver<()>,
) {
    // Without a runtime the run still works; it only cannot be stopped gently.
    let Ok(runtime) = tokio::runtime::Builder::new_current_thread().enable_all().build() else { return };
    runtime.block_on(async {
        let mut ticks = tokio::time::interval(PROGRESS_EVERY);
        // The first tick is at once; short runs show nothing.
        ticks.tick().await;
        let mut line = ProgressLine { is_on: std::io::stderr().is_terminal(), width: 0 };
        let begun = Instant::now();
        let mut stopping = std::pin::pin!(interrupted());
        let mut out_of_time = std::pin::pin!(passed(deadline));
        let mut is_stopping = false;
        loop {
            tokio::select! {
                biased;
                _ = &mut is_done => break,
                () = &mut stopping, if !is_stopping => {
                    stop.cancel();
                    is_stopping = true;
                }
                () = &mut out_of_time, if !is_stopping => {
                    stop.pass_deadline();
                    is_stopping = true;
                }
                _ = ticks.tick() => line.draw(&progress().line(begun.elapsed())),
            }
        }
        line.clear();
    });
}

async fn passed(deadline: Option<Duration>) {
    match deadline {
        Some(deadline) => tokio::time::sleep(deadline).await,
        None => std::future::pending().await,
    }
}

/// Ends when the user or the system asks the process to end.
async fn interrupted() {
    #[cfg(unix)]
    let terminated = async {
        match tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()) {
            Ok(mut signals) => {
                signals.recv().await;
            }
            Err(_) => std::future::pending().await,
        }
    };
    #[cfg(not(unix))]
    let terminated = std::future::pending::<()>();
    tokio::select! {
        Ok(()) = tokio::signal::ctrl_c() => {}
        () = terminated => {}
        else => std::future::pending().await,
    }
}

/// A line that is drawn over itself, without control sequences that a terminal may not know.
struct ProgressLine {
    is_on: bool,
    /// Columns that it takes now, at most.
    width: usize,
}

impl ProgressLine {
    fn draw(&mut self, text: &str) {
        if self.is_on {
            let width: usize = text.chars().map(columns).sum();
            let _ = write!(std::io::stderr(), "\r{text}{:1$}", "", self.width.saturating_sub(width));
            self.width = self.width.max(width);
        }
    }

    fn clear(&mut self) {
        if self.width > 0 {
            let _ = write!(std::io::stderr(), "\r{:1$}\r", "", self.width);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Stopped;
    use crate::wire::Stage;

    fn share() -> Share<'static> {
        Share::of(Operation::Repair, "part.stl", Progress { stage: Some(Stage::Read), fraction: 0.5 })
    }

    #[test]
    fn a_line_tells_operation_share_time_pass_and_file_and_fits_a_terminal() {
        let line = share().line(Duration::from_secs(125));
        assert_eq!(line, "repair [############............]  50 %  02:05  read            part.stl");
        let long = Share { subject: &"long ".repeat(40), ..share() }.line(Duration::ZERO);
        assert_eq!(long.chars().count(), Share::LINE_WIDTH);
        let wide = Share { subject: &"部".repeat(40), ..share() }.line(Duration::ZERO);
        assert!(wide.chars().map(columns).sum::<usize>() <= Share::LINE_WIDTH, "{wide}");
        let marked = Share { subject: "\x1b[2J", ..share() }.line(Duration::ZERO);
        assert!(marked.ends_with("?[2J"), "{marked}");
    }

    #[test]
    fn the_deadline_raises_the_flag_of_a_run_that_goes_on() {
        let stop = StopFlag::default();
        let reason = watched(&stop, Some(Duration::from_millis(1)), share, || {
            loop {
                if let Some(reason) = stop.raised() {
                    break reason;
                }
                std::thread::yield_now();
            }
        });
        assert_eq!(reason, Stopped::Deadline);
    }

    #[test]
    fn a_run_that_ends_first_is_not_stopped() {
        let stop = StopFlag::default();
        assert_eq!(watched(&stop, Some(Duration::from_secs(3600)), share, || 7), 7);
        assert_eq!(stop.raised(), None);
    }
}
