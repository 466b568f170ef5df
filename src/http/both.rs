//! Report and meshes in one answer: as `multipart/mixed`, or as a zip archive.

use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::vec::IntoIter;

use axum::body::Body;
use bytes::{Bytes, BytesMut};
use futures_util::StreamExt as _;
use tokio::io::{AsyncRead, AsyncReadExt as _};
use tokio_util::io::ReaderStream;
use zip::write::{SimpleFileOptions, StreamWriter};
use zip::{CompressionMethod, ZipWriter};

use super::mesh_file::disposition;

/// Bytes of a mesh handled at a time.
const PIECE_BYTES: usize = 64 << 10;
/// Name of the report in an archive.
const REPORT_NAME: &str = "report.json";

/// What goes into the answer.
pub(super) struct CombinedAnswer<R> {
    /// The report, as JSON.
    pub(super) report: Vec<u8>,
    /// The meshes: one, or one for each target of a simplification.
    pub(super) meshes: Vec<OutgoingMesh<R>>,
}

/// A mesh to be sent.
pub(super) struct OutgoingMesh<R> {
    /// Its bytes.
    pub(super) content: R,
    /// Their number.
    pub(super) len: u64,
    /// Media type.
    pub(super) media_type: &'static str,
    /// File name.
    pub(super) file_name: String,
}

impl<R> OutgoingMesh<R> {
    /// What stands before it in a `multipart/mixed` body.
    fn head(&self, boundary: &str) -> String {
        format!(
            "\r\n--{boundary}\r\nContent-Type: {}\r\nContent-Disposition: {}\r\n\r\n",
            self.media_type,
            disposition(&self.file_name)
        )
    }
}

impl<R: AsyncRead + Send + Unpin + 'static> CombinedAnswer<R> {
    /// The parts as `multipart/mixed` with this boundary, which must occur in none; and the whole length.
    pub(super) fn into_multipart(self, boundary: &str) -> (Body, u64) {
        let report_head = format!("--{boundary}\r\nContent-Type: application/json\r\n\r\n");
        let head = [report_head.as_bytes(), &self.report].concat();
        let tail = format!("\r\n--{boundary}--\r\n");
        let mut len = (head.len() + tail.len()) as u64;
        let once = |bytes: Vec<u8>| futures_util::stream::iter([Ok::<_, io::Error>(Bytes::from(bytes))]);
        let mut meshes = Vec::with_capacity(self.meshes.len());
        for mesh in self.meshes {
            let head = mesh.head(boundary);
            len += head.len() as u64 + mesh.len;
            let pieces = ReaderStream::with_capacity(mesh.content, PIECE_BYTES);
            meshes.push(once(head.into_bytes()).chain(pieces));
        }
        let meshes = futures_util::stream::iter(meshes).flatten();
        (Body::from_stream(once(head).chain(meshes).chain(once(tail.into_bytes()))), len)
    }

    /// All as a zip archive, packed while it is sent.
    pub(super) fn into_zip(self) -> io::Result<Body> {
        let spill = Spill::default();
        let mut packer = Packer {
            zip: ZipWriter::new_stream(spill.clone()),
            spill,
            mesh: None,
            waiting: self.meshes.into_iter(),
        };
        let begun = packer.begin(&self.report)?;
        let rest = futures_util::stream::try_unfold(Some(packer), Packer::step);
        Ok(Body::from_stream(futures_util::stream::iter([Ok(begun)]).chain(rest)))
    }
}

/// Takes what the archive writer writes until it is sent.
#[derive(Clone, Default)]
struct Spill(Arc<Mutex<BytesMut>>);

impl Spill {
    fn take(&self) -> Bytes {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).split().freeze()
    }
}

impl Write for Spill {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Packs an archive piece by piece, so that it is never in memory as a whole.
struct Packer<R> {
    zip: ZipWriter<StreamWriter<Spill>>,
    spill: Spill,
    /// The mesh that is being packed.
    mesh: Option<R>,
    waiting: IntoIter<OutgoingMesh<R>>,
}

impl<R: AsyncRead + Unpin> Packer<R> {
    /// Level 1: meshes shrink to a half already there, and the client waits.
    fn options(len: u64) -> SimpleFileOptions {
        SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .compression_level(Some(1))
            .large_file(len >= u64::from(u32::MAX))
    }

    /// The report.
    fn begin(&mut self, report: &[u8]) -> io::Result<Bytes> {
        self.zip.start_file(REPORT_NAME, Self::options(0))?;
        self.zip.write_all(report)?;
        Ok(self.spill.take())
    }

    /// The next piece of a mesh, packed; after the last mesh the archive's directory.
    async fn step(packer: Option<Self>) -> io::Result<Option<(Bytes, Option<Self>)>> {
        let Some(mut packer) = packer else { return Ok(None) };
        let mut piece = vec![0; PIECE_BYTES];
        let len = match &mut packer.mesh {
            Some(mesh) => mesh.read(&mut piece).await?,
            None => 0,
        };
        if len > 0 {
            packer.zip.write_all(&piece[..len])?;
        } else if let Some(next) = packer.waiting.next() {
            packer.zip.start_file(next.file_name, Self::options(next.len))?;
            packer.mesh = Some(next.content);
        } else {
            packer.zip.finish()?;
            return Ok(Some((packer.spill.take(), None)));
        }
        let packed = packer.spill.take();
        Ok(Some((packed, Some(packer))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use http_body_util::BodyExt as _;
    use std::io::Read as _;

    fn both(mesh: &[u8]) -> CombinedAnswer<io::Cursor<Vec<u8>>> {
        let mesh = |file_name: &str| OutgoingMesh {
            content: io::Cursor::new(mesh.to_vec()),
            len: mesh.len() as u64,
            media_type: "model/stl",
            file_name: file_name.to_owned(),
        };
        CombinedAnswer { report: b"{\"a\":1}".to_vec(), meshes: vec![mesh("one.stl"), mesh("two.stl")] }
    }

    async fn bytes_of(body: Body) -> Vec<u8> {
        body.collect().await.unwrap().to_bytes().to_vec()
    }

    #[tokio::test]
    async fn the_archive_holds_report_and_meshes() {
        let mesh: Vec<u8> = (0..200_000_u32).map(|i| i.to_le_bytes()[0]).collect();
        let packed = bytes_of(both(&mesh).into_zip().unwrap()).await;
        let mut archive = zip::ZipArchive::new(io::Cursor::new(packed)).unwrap();
        let mut content = |name: &str| {
            let mut bytes = Vec::new();
            archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
            bytes
        };
        assert_eq!(content("report.json"), b"{\"a\":1}");
        assert_eq!(content("one.stl"), mesh);
        assert_eq!(content("two.stl"), mesh);
    }

    #[tokio::test]
    async fn the_multipart_answer_has_the_length_that_it_announces() {
        let (body, len) = both(b"solid").into_multipart("cut");
        let text = String::from_utf8(bytes_of(body).await).unwrap();
        assert_eq!(text.len() as u64, len);
        assert_eq!(
            text,
            "--cut\r\nContent-Type: application/json\r\n\r\n{\"a\":1}\r\n--cut\r\nContent-Type: model/stl\r\n\
             Content-Disposition: attachment; filename=\"one.stl\"\r\n\r\nsolid\r\n--cut\r\nContent-Type: model/stl\r\n\
             Content-Disposition: attachment; filename=\"two.stl\"\r\n\r\nsolid\r\n--cut--\r\n"
        );
    }
}
