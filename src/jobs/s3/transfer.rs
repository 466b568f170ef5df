//! Bytes between this machine and the bucket, a piece at a time.

use std::fs::File;
use std::io::{self, Read as _};
use std::os::unix::fs::FileExt as _;
use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use bytes::Bytes;
use futures_util::TryStreamExt as _;
use object_store::path::Path;
use object_store::{MultipartUpload, ObjectStoreExt as _, PutMode, PutOptions};
use tokio::io::AsyncWriteExt as _;
use tokio::task::JoinSet;

use super::SharedBucket;

/// Files up to this size are sent in one request.
const ONE_REQUEST_BYTES_MAX: u64 = 16 << 20;
/// Bytes of a part of a larger one: S3 takes 10,000 parts at most, which is 160 GB.
const PART_BYTES: u64 = 16 << 20;
/// Most parts on their way at one time, which is the memory that a file takes.
const PARTS_AT_ONCE: usize = 3;

impl SharedBucket {
    /// Brings a complete file into the bucket, where there must be none of that name. Blocks.
    pub(super) fn upload(self: &Arc<Self>, file: &FilePath, key: &str) -> io::Result<()> {
        let mut content = File::open(file)?;
        let bytes = content.metadata()?.len();
        let place = self.place(key);
        if bytes <= ONE_REQUEST_BYTES_MAX {
            let mut all = Vec::with_capacity(usize::try_from(bytes).unwrap_or_default());
            content.read_to_end(&mut all)?;
            let once = PutOptions::from(PutMode::Create);
            return self.run(|parts| async move {
                parts.bucket.put_opts(&place, Bytes::from(all).into(), once).await.map(drop)
            });
        }
        // A name is given once, so nothing comes in between.
        let is_there = self.run({
            let place = place.clone();
            |parts| async move { parts.bucket.head(&place).await.map(drop) }
        });
        match is_there {
            Ok(()) => return Err(io::ErrorKind::AlreadyExists.into()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        let content = Arc::new(content);
        let uploaded = self.run(move |parts| async move {
            let mut upload = parts.bucket.put_multipart(&place).await?;
            let sent = send_parts(&mut *upload, &content, bytes).await;
            match sent {
                Ok(()) => upload.complete().await.map(drop),
                Err(error) => {
                    // What stays goes by a rule of the bucket: it is no file yet.
                    if let Err(error) = upload.abort().await {
                        tracing::warn!(%error, "the parts of an upload stay in the bucket");
                    }
                    Err(error)
                }
            }
        });
        uploaded.map_err(in_vain)
    }

    /// Brings a file here. Blocks.
    pub(super) fn download(self: &Arc<Self>, key: &str) -> io::Result<PathBuf> {
        let (path, file) = self.cache.begin()?;
        let place = self.place(key);
        let brought = self.run(move |parts| async move {
            bring(&*parts.bucket, &place, tokio::fs::File::from_std(file)).await
        });
        match brought {
            Ok(()) => {
                self.cache.keep(&path, key)?;
                self.cache.find(key).ok_or_else(|| io::ErrorKind::NotFound.into())
            }
            Err(error) => {
                // What stays goes with the next start.
                let _ = std::fs::remove_file(&path);
                Err(error)
            }
        }
    }
}

/// Why a file was not brought into the bucket. When the answer to the end of an upload is lost, the client asks for the end again, and is
/// told that there is no such upload: then it may have become a file, which is removed.
fn in_vain(error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::NotFound {
        return io::Error::new(io::ErrorKind::HostUnreachable, error);
    }
    error
}

/// Sends the parts of a file, a few at a time.
async fn send_parts(
    upload: &mut dyn MultipartUpload,
    content: &Arc<File>,
    bytes: u64,
) -> object_store::Result<()> {
    let mut on_their_way = JoinSet::new();
    let mut begin = 0;
    while begin < bytes {
        if on_their_way.len() >= PARTS_AT_ONCE {
            joined(on_their_way.join_next().await)?;
        }
        let (content, length) = (Arc::clone(content), PART_BYTES.min(bytes - begin));
        let read = tokio::task::spawn_blocking(move || {
            let mut part = vec![0; usize::try_from(length).unwrap_or_default()];
            content.read_exact_at(&mut part, begin).map(|()| part)
        });
        let part = read.await.map_err(generic)?.map_err(generic)?;
        on_their_way.spawn(upload.put_part(Bytes::from(part).into()));
        begin += length;
    }
    while !on_their_way.is_empty() {
        joined(on_their_way.join_next().await)?;
    }
    Ok(())
}

fn joined(
    part: Option<Result<object_store::Result<()>, tokio::task::JoinError>>,
) -> object_store::Result<()> {
    part.map_or(Ok(()), |part| part.map_err(generic)?)
}

async fn bring(
    bucket: &dyn object_store::ObjectStore,
    place: &Path,
    mut file: tokio::fs::File,
) -> object_store::Result<()> {
    let mut content = bucket.get(place).await?.into_stream();
    while let Some(piece) = content.try_next().await? {
        file.write_all(&piece).await.map_err(generic)?;
    }
    file.flush().await.map_err(generic)
}

fn generic(source: impl std::error::Error + Send + Sync + 'static) -> object_store::Error {
    object_store::Error::Generic { store: "this machine", source: Box::new(source) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_upload_whose_end_was_not_answered_is_no_file_that_is_missing() {
        let of = |kind: io::ErrorKind| in_vain(kind.into()).kind();
        assert_eq!(of(io::ErrorKind::NotFound), io::ErrorKind::HostUnreachable);
        assert_eq!(of(io::ErrorKind::AlreadyExists), io::ErrorKind::AlreadyExists);
    }
}
