//! Going down in two steps: first drain, then at once.

use tokio_util::sync::CancellationToken;

/// Tells the service to end. Clones share the two signals.
#[derive(Debug, Clone, Default)]
pub struct Shutdown {
    /// No new connections; requests under way are answered.
    pub drain: CancellationToken,
    /// Requests under way are given up.
    pub abort: CancellationToken,
}

impl Shutdown {
    /// Follows the process signals: the first SIGTERM or SIGINT drains, the second one aborts.
    ///
    /// # Errors
    /// When the signals cannot be listened to.
    pub fn on_signals() -> std::io::Result<Self> {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminate = signal(SignalKind::terminate())?;
        let mut interrupt = signal(SignalKind::interrupt())?;
        let shutdown = Self::default();
        let (drain, abort) = (shutdown.drain.clone(), shutdown.abort.clone());
        tokio::spawn(async move {
            for step in [drain, abort] {
                tokio::select! {
                    _ = terminate.recv() => (),
                    _ = interrupt.recv() => (),
                }
                step.cancel();
            }
        });
        Ok(shutdown)
    }
}
