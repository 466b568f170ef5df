//! Uploads that come before their job.

use std::collections::HashSet;

use super::*;
use crate::jobs::{NewUpload, UploadId, UploadRow};

fn upload(owner: &str, length: u64) -> NewUpload {
    NewUpload {
        id: UploadId::unique(),
        owner: Some(owner.to_owned()),
        tenant: Tenant::named(format!("key:{owner}")),
        file_name: Some("part \0 one.stl".to_owned()),
        metadata: Some("filename YQ==".to_owned()),
        length,
        keep_for: Duration::from_secs(60),
        presigned: None,
    }
}

fn piece(number: u32, bytes: u64) -> BlobRef {
    BlobRef { key: format!("pieces/{number}"), bytes, sha256: [7; 32], files: Vec::new() }
}

async fn made(store: &dyn JobStore, new: NewUpload) -> UploadRow {
    store.create_upload(new, 100).await.unwrap()
}

async fn append(store: &dyn JobStore, id: UploadId, at: u64, piece: BlobRef) -> Result<(), StoreError> {
    store.append_piece(id, at, piece, Duration::from_secs(60)).await.map(drop)
}

pub(super) async fn an_upload_is_read_back_as_it_was_made_and_outlasts_the_process<H: StoreHouse>() {
    let house = H::open().await;
    let new = upload("a", 20);
    let row = made(&*house.store(), new.clone()).await;
    assert_eq!((row.received, row.pieces, row.job, row.is_due), (0, 0, None, false));
    assert_eq!((row.owner, row.tenant, row.length), (new.owner, new.tenant, 20));
    assert_eq!((row.file_name, row.metadata), (new.file_name, new.metadata));
    append(&*house.store(), new.id, 0, piece(1, 5)).await.unwrap();
    append(&*house.store(), new.id, 5, piece(2, 6)).await.unwrap();
    let house = house.reopen().await;
    let store = house.store();
    let row = store.get_upload(new.id).await.unwrap();
    assert_eq!((row.received, row.pieces), (11, 2));
    assert_eq!(store.pieces(new.id).await.unwrap(), [piece(1, 5), piece(2, 6)]);
    let named = store.named(vec!["pieces/1".to_owned(), "pieces/3".to_owned()]).await.unwrap();
    assert_eq!(named, HashSet::from(["pieces/1".to_owned()]));
    assert_eq!(store.get_upload(UploadId::unique()).await, Err(StoreError::NotFound));
}

pub(super) async fn a_piece_goes_on_where_the_upload_stands_and_nowhere_else<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = made(&*store, upload("a", 20)).await.id;
    append(&*store, id, 0, piece(1, 5)).await.unwrap();
    for at in [0, 4, 6, 20] {
        let moved = Err(StoreError::UploadMoved { received: 5 });
        assert_eq!(append(&*store, id, at, piece(2, 5)).await, moved, "{at}");
    }
    let too_long = append(&*store, id, 5, piece(2, 16)).await;
    assert_eq!(too_long, Err(StoreError::UploadMoved { received: 5 }), "there is no room for it");
    append(&*store, id, 5, piece(2, 15)).await.unwrap();
    assert_eq!(append(&*store, UploadId::unique(), 0, piece(3, 1)).await, Err(StoreError::NotFound));
    assert_eq!(store.pieces(id).await.unwrap().len(), 2);
}

pub(super) async fn of_many_pieces_at_one_offset_one_is_appended<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = made(&*store, upload("a", 100)).await.id;
    let appending = (0..16).map(|number| {
        let store = Arc::clone(&store);
        tokio::spawn(async move { append(&*store, id, 0, piece(number, 5)).await.is_ok() })
    });
    let mut appended = 0;
    for one in appending.collect::<Vec<_>>() {
        appended += usize::from(one.await.unwrap());
    }
    let row = store.get_upload(id).await.unwrap();
    assert_eq!((appended, row.received, row.pieces), (1, 5, 1));
}

pub(super) async fn an_upload_is_due_a_while_after_its_last_piece<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let (going, left) = (made(&*store, upload("a", 20)).await.id, made(&*store, upload("a", 20)).await.id);
    append(&*store, left, 0, piece(1, 5)).await.unwrap();
    house.advance_ms(40_000).await;
    append(&*store, going, 0, piece(2, 5)).await.unwrap();
    house.advance_ms(19_999).await;
    assert!(store.due_uploads().await.unwrap().is_empty());
    house.advance_ms(1).await;
    assert_eq!(store.due_uploads().await.unwrap(), [left]);
    assert!(store.get_upload(left).await.unwrap().is_due);
    assert_eq!(store.drop_due_upload(going).await, Err(StoreError::NotFound), "more of it has come");
    assert_eq!(store.drop_due_upload(left).await.unwrap(), [piece(1, 5)]);
    assert_eq!(store.delete_upload(left).await, Err(StoreError::NotFound));
    assert!(store.named(vec!["pieces/1".to_owned()]).await.unwrap().is_empty());
    assert_eq!(append(&*store, left, 5, piece(3, 1)).await, Err(StoreError::NotFound));
}

pub(super) async fn a_job_takes_an_upload_once_and_takes_it_along_when_it_goes<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let id = made(&*store, upload("a", 5)).await.id;
    append(&*store, id, 0, piece(1, 5)).await.unwrap();
    let first = admit(&*store, NewJob { taken: Some(id), ..job() }).await;
    let row = store.get_upload(id).await.unwrap();
    assert_eq!((row.job, row.received), (Some(first.id), 5));
    assert!(store.pieces(id).await.unwrap().is_empty(), "the job has a file of its own");
    house.advance_ms(1_000_000).await;
    assert!(!store.get_upload(id).await.unwrap().is_due, "it stays as long as its job");
    assert!(store.due_uploads().await.unwrap().is_empty());
    assert_eq!(store.drop_due_upload(id).await, Err(StoreError::NotFound));
    let second = store.create(NewJob { taken: Some(id), ..job() }, 1000).await;
    assert_eq!(second.unwrap_err(), StoreError::NotFound);
    assert_eq!(store.counts().await.unwrap().all, 1, "nothing of it was made");
    store.delete(first.id).await.unwrap();
    assert_eq!(store.get_upload(id).await, Err(StoreError::NotFound));
}

pub(super) async fn uploads_are_as_many_as_may_be_and_count_for_their_tenant<H: StoreHouse>() {
    let house = H::open().await;
    let store = house.store();
    let holding = async |owner: &str| {
        let held = store.holding(Tenant::named(format!("key:{owner}"))).await.unwrap();
        (held.open_bytes, held.open_bytes_of_all, held.bytes)
    };
    let first = store.create_upload(upload("a", 9), 4).await.unwrap().id;
    store.create_upload(upload("a", 9), 4).await.unwrap();
    let full = StoreError::UploadsFull { open: 2, limit: 4 };
    assert_eq!(store.create_upload(upload("a", 9), 4).await.unwrap_err(), full, "half is left for others");
    append(&*store, first, 0, piece(1, 5)).await.unwrap();
    // Of one that goes past the servers nobody knows how much has come.
    let presigned = NewUpload { presigned: Some(piece(2, 7)), ..upload("b", 7) };
    let row = store.create_upload(presigned.clone(), 4).await.unwrap();
    assert_eq!((row.is_presigned, store.pieces(row.id).await.unwrap()), (true, vec![piece(2, 7)]));
    let refused = append(&*store, row.id, 0, piece(3, 1)).await;
    assert_eq!(refused, Err(StoreError::UploadMoved { received: 0 }));
    assert_eq!((holding("a").await, holding("b").await), ((5, 12, 5), (7, 12, 7)));
    let taken = NewJob { taken: Some(row.id), input: piece(2, 7), ..job() };
    let taker = admit(&*store, taken).await;
    assert_eq!((holding("a").await.0, holding("b").await), (5, (0, 12, 0)), "it is the job's now");
    assert_eq!(store.delete(taker.id).await.unwrap(), [piece(2, 7)]);
    store.delete_upload(first).await.unwrap();
    assert_eq!(holding("a").await, (0, 0, 0));
    store.create_upload(upload("a", 9), 4).await.unwrap();
}
