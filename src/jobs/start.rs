//! The start of a service: its parts are put together, what an earlier one left is taken over, and its tasks begin.

use std::sync::Arc;

use tokio::sync::Notify;
use tokio_util::sync::CancellationToken;
use tokio_util::task::TaskTracker;

use super::arrivals::Arrivals;
use super::capacity::Capacity;
use super::child::TrialError;
use super::disk::on_disk;
use super::executor::{Engine, Executor};
use super::handle::Jobs;
use super::live::LiveJobs;
use super::pace::Pace;
use super::service::Service;
use super::settings::JobsSettings;
use super::shares::Incoming;
use super::slot::{self, SlotKind};
use super::spool::{SpaceLimits, Spool};
use super::store::JobStore;
use super::stores::{Stores, StoresError};
use super::webhook::{Sender, Vault};
use super::{load, neighbours, retention};

/// A service that cannot start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The stores in the data directory cannot be used.
    #[error(transparent)]
    Stores(#[from] StoresError),
    /// Jobs cannot run as the settings ask.
    #[error(transparent)]
    Isolation(#[from] TrialError),
    /// Webhooks cannot be sent.
    #[error("webhooks cannot be sent: {why}")]
    Webhooks {
        /// Why.
        why: String,
    },
    /// What an earlier service left in the stores cannot be taken over.
    #[error("the jobs of an earlier start cannot be taken over: {why}")]
    TakeOver {
        /// Why.
        why: String,
    },
}

/// The file of the key of secrets, when the operator names no other.
const KEY_FILE: &str = "store.key";

/// What seals secrets, and what sends webhooks.
type WebhookSending = (Arc<Vault>, Arc<Sender>);

/// What webhooks need; `None`: none are sent.
fn webhooks(settings: &JobsSettings, store: &Arc<dyn JobStore>) -> Result<Option<WebhookSending>, String> {
    let Some(webhooks) = settings.webhooks.clone() else { return Ok(None) };
    if settings.shared.is_some() && settings.store_key_file.is_none() {
        // Each server would seal with a key of its own, which the others do not have.
        return Err("servers that share their stores need one store_key_file, the same on each".to_owned());
    }
    let path = settings.store_key_file.clone().unwrap_or_else(|| settings.data_dir.join(KEY_FILE));
    let vault = Arc::new(Vault::open(&path).map_err(|error| error.to_string())?);
    let sender = Sender::new(webhooks, Arc::clone(&vault), Arc::clone(store));
    Ok(Some((vault, Arc::new(sender.map_err(|error| error.to_string())?))))
}

impl Jobs {
    /// Starts a service on the stores in its data directory: jobs of an earlier run go on. To be called inside a tokio
    /// runtime.
    ///
    /// # Errors
    /// The data directory cannot be used, another server uses it, or jobs cannot run as the settings ask.
    pub async fn start(settings: JobsSettings) -> Result<Self, StartError> {
        let stores = Stores::open(&settings).await?;
        Self::start_on(stores, settings, None).await
    }

    /// As [`start`](Self::start) with another engine, which runs in threads of this process.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub async fn start_with(settings: JobsSettings, engine: Engine) -> Result<Self, StartError> {
        let stores = Stores::open(&settings).await?;
        Self::start_on(stores, settings, Some(engine)).await
    }

    /// Starts a service on these stores; with an `engine` of its own, that one runs in threads of this process.
    ///
    /// # Errors
    /// The stores do not answer, or jobs cannot run as the settings ask.
    pub async fn start_on(
        stores: Stores,
        settings: JobsSettings,
        engine: Option<Engine>,
    ) -> Result<Self, StartError> {
        let Stores { rows: store, blobs, worker, lock } = stores;
        let settings = Arc::new(settings);
        let space = SpaceLimits {
            bytes_max: settings.data_bytes_max,
            free_bytes_min: settings.disk_free_bytes_min,
            is_shared: store.is_shared(),
        };
        let spool = on_disk(move || Spool::of(blobs, space)).await;
        let spool = spool.map_err(|problem| StartError::TakeOver { why: problem.detail })?;
        let executor = Executor::new(&settings, &spool, engine).await?;
        let (vault, sender) =
            webhooks(&settings, &store).map_err(|why| StartError::Webhooks { why })?.unzip();
        let pace = Arc::new(Pace::of(&settings));
        let service = Arc::new(Service {
            capacity: Capacity::of(&settings),
            executor,
            worker,
            live: LiveJobs::default(),
            arrivals: Arrivals::new(Arc::clone(&store), Arc::clone(&settings)),
            incoming: Incoming::new(Arc::clone(&store), Arc::clone(&spool), Arc::clone(&pace)),
            pace,
            vault,
            work: Notify::new(),
            load_changed: Notify::new(),
            draining: CancellationToken::new(),
            stopping: CancellationToken::new(),
            slots: TaskTracker::new(),
            settings,
            store,
            spool,
            _lock: lock,
        });
        service.take_over().await.map_err(|problem| StartError::TakeOver { why: problem.detail })?;
        begin_tasks(&service);
        if let Some(sender) = sender {
            tokio::spawn(sender.send_forever(service.stopping.clone()));
        }
        Ok(Self(service))
    }
}

/// Begins what goes on until the service drains: slots, the sweep, and who tells the load.
fn begin_tasks(service: &Arc<Service>) {
    let general = std::iter::repeat_n(SlotKind::General, service.settings.slots);
    let interactive = std::iter::repeat_n(SlotKind::Interactive, service.settings.interactive_slots);
    for kind in general.chain(interactive) {
        service.slots.spawn(slot::serve(Arc::clone(service), kind));
    }
    service.slots.spawn(retention::sweep_forever(Arc::clone(service)));
    service.slots.spawn(load::tell_forever(Arc::clone(service)));
    if service.store.is_shared() {
        // Who waits for a job that another server runs does so until this one stops.
        tokio::spawn(neighbours::follow_forever(Arc::clone(service)));
    }
    service.slots.close();
}
