//! Uploads as `multipart/form-data`: parts `mesh`, of which some operations take several, `params` and `material`.

use super::body::IncomingBody;
use super::entrance::{Entrance, Intake, finish_if_any};
use super::multipart::{Multipart, PartHead};
use super::sizes::{JSON_BYTES_MAX, MATERIAL_BYTES_MAX};
use crate::jobs::{Upload, Uploaded};
use crate::wire::{Operation, Problem, ProblemCode, format_of_media_type};

const PARTS: &[&str] = &["mesh", "params", "material"];
/// `/v1/jobs` also takes the request as `job`, which names the operation.
const PARTS_WITH_JOB: &[&str] = &["mesh", "params", "job", "material"];

/// Receives the parts in any order, the mesh streamed to disk.
pub(super) async fn receive(
    entrance: &Entrance<'_>,
    body: IncomingBody,
    boundary: &str,
    operation: Option<Operation>,
) -> Result<Intake, Problem> {
    let parts = if operation.is_some() { PARTS } else { PARTS_WITH_JOB };
    let mut mesh = entrance.upload(None).await?;
    let meshes_max = Operation::ALL.iter().filter(|&&one| operation.is_none_or(|named| named == one));
    let meshes_max = meshes_max.map(|one| one.meshes_max()).max().unwrap_or(1);
    let mut form = Multipart::new(body, boundary);
    let mut intake = Intake::default();
    let mut seen = Vec::new();
    while let Some(head) = form.next_part().await? {
        // What many clients call the one file of a form.
        let name = if head.name == "file" { "mesh" } else { &*head.name };
        let Some(&part) = parts.iter().find(|part| **part == name) else {
            return Err(unknown(&head.name, parts));
        };
        let count = seen.iter().filter(|&&other| other == part).count();
        let count_max = if part == "mesh" { meshes_max } else { 1 };
        if count == count_max {
            let times = if count == 1 { "twice".to_owned() } else { format!("more than {count_max} times") };
            return Err(about(part, format!("the part `{part}` is there {times}")));
        }
        seen.push(part);
        match part {
            "mesh" => receive_mesh(&mut mesh, &mut form, head, &mut intake, count == 0).await?,
            "material" => intake.material = receive_material(entrance, &mut form).await?,
            _ => {
                let text = receive_small(&mut form, JSON_BYTES_MAX, "json_bytes_max").await?;
                intake.take_json(&text, operation)?;
            }
        }
    }
    intake.upload = finish_if_any(mesh).await?;
    Ok(intake)
}

impl Intake {
    /// Of several meshes the first gives its name, and a format counts that all name.
    fn take_names(&mut self, head: PartHead, is_first: bool) {
        // Browsers make up media types for file extensions, so one that is not a mesh's says nothing.
        let named = head.media_type.and_then(|media| format_of_media_type(&media));
        self.named = named.filter(|_| is_first || self.named == named);
        if is_first {
            self.file_name = head.file_name.filter(|name| !name.is_empty());
        }
    }
}

/// A part with neither a byte nor a name is none: browsers send one for a file input that was left empty.
async fn receive_mesh(
    upload: &mut Upload,
    form: &mut Multipart,
    head: PartHead,
    intake: &mut Intake,
    is_first: bool,
) -> Result<(), Problem> {
    let begin = upload.bytes();
    while let Some(piece) = form.next_piece().await? {
        upload.write(&piece).await?;
    }
    if upload.bytes() > begin || head.file_name.as_ref().is_some_and(|name| !name.is_empty()) {
        upload.end_file();
        intake.take_names(head, is_first);
    }
    Ok(())
}

/// `None` when the part has no byte.
async fn receive_material(
    entrance: &Entrance<'_>,
    form: &mut Multipart,
) -> Result<Option<Uploaded>, Problem> {
    let bytes = receive_small(form, MATERIAL_BYTES_MAX, "material_bytes_max").await?;
    let mut upload = entrance.jobs.upload_beside(entrance.tenant.clone()).await?;
    upload.write(&bytes).await?;
    finish_if_any(upload).await
}

async fn receive_small(form: &mut Multipart, bytes_max: u64, name: &'static str) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    while let Some(piece) = form.next_piece().await? {
        bytes.extend_from_slice(&piece);
        if bytes.len() as u64 > bytes_max {
            let detail = format!("a part is over the limit of {bytes_max} bytes");
            return Err(Problem::new(ProblemCode::BodyTooLarge, detail).with_limit(name, bytes_max, None));
        }
    }
    Ok(bytes)
}

fn unknown(name: &str, parts: &[&str]) -> Problem {
    let detail = format!(
        "there is no part `{name}`; the parts are {}, options belong into `params`",
        parts.join(", ")
    );
    Problem { parameter: Some(name.to_owned()), ..Problem::new(ProblemCode::UnknownParameter, detail) }
}

fn about(part: &str, detail: String) -> Problem {
    Problem { parameter: Some(part.to_owned()), ..Problem::new(ProblemCode::InvalidParameter, detail) }
}
