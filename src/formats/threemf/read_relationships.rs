//! What the parts of a package are for: the relationships of the package.

use super::package::{Package, resolve, shortened};
use super::xml::{Document, Scanner, XmlEvent, value};
use crate::budget::Budget;
use crate::formats::{Place, ReadError};

/// The part with the relationships of the package.
const PACKAGE_RELATIONSHIPS: &str = "/_rels/.rels";
/// Ends of the types of relationships.
const MODEL: &str = "/3dmodel";
const PRINT_TICKET: &str = "/printticket";

/// Where the model of a package begins.
pub(super) struct RootModel {
    /// Name of the model part.
    pub(super) part: String,
    /// Rules that the package breaks, as sentences.
    pub(super) remarks: Vec<String>,
}

struct Relationship {
    kind: String,
    target: String,
    is_external: bool,
}

/// Finds the model part of `package`: the one that its relationships name, or where these are missing the only one that there
/// is.
///
/// # Errors
/// No model part, more than one, one that is elsewhere, or a package that is signed or encrypted.
pub(super) fn read_start(package: &mut Package<'_>, budget: &Budget) -> Result<RootModel, ReadError> {
    let mut remarks = Vec::new();
    let Some(number) = package.find(PACKAGE_RELATIONSHIPS) else {
        let part = only_model(package)?;
        remarks.push(
            "The file breaks a rule of 3MF: the package has no relationships (_rels/.rels).".to_owned(),
        );
        return Ok(RootModel { part, remarks });
    };
    let (bytes, _charge) = package.inflate(number, budget)?;
    let document = Document::of(PACKAGE_RELATIONSHIPS, &bytes)?;
    let all = relationships(&document, budget)?;
    let whole = |found: String, expected: &str| ReadError::unparseable(Place::Whole, found, expected);
    let is_of =
        |relationship: &&Relationship, end: &str| relationship.kind.to_ascii_lowercase().ends_with(end);
    for relationship in &all {
        let kind = relationship.kind.to_ascii_lowercase();
        if kind.contains("/digital-signature/") {
            return Err(ReadError::foreign(
                "a signed 3MF, which no longer is what was signed once it is changed",
            ));
        }
        if kind.ends_with("/keystore") || kind.contains("securecontent") {
            return Err(ReadError::foreign("an encrypted 3MF"));
        }
    }
    let models: Vec<&Relationship> = all.iter().filter(|r| is_of(r, MODEL)).collect();
    let model = match models[..] {
        [model] => model,
        [] => {
            let part = only_model(package)?;
            remarks.push(
                "The file breaks a rule of 3MF: no relationship of the package names the model.".to_owned(),
            );
            return Ok(RootModel { part, remarks });
        }
        _ => return Err(whole(format!("{} models in the package", models.len()), "one")),
    };
    if model.is_external {
        let found = format!("a model outside of the package: {}", shortened(&model.target));
        return Err(whole(found, "a model part in it"));
    }
    let part = resolve("/", &model.target).filter(|part| package.find(part).is_some());
    let Some(part) = part else {
        let found = format!("a package without the model part {} that it names", shortened(&model.target));
        return Err(whole(found, "the part"));
    };
    let beside = part
        .rsplit_once('/')
        .map_or_else(String::new, |(folder, name)| format!("{folder}/_rels/{name}.rels"));
    let of_model = match package.find(&beside) {
        Some(number) => {
            let (bytes, _charge) = package.inflate(number, budget)?;
            relationships(&Document::of(&beside, &bytes)?, budget)?
        }
        None => Vec::new(),
    };
    for (source, of_source) in [("/", &all), (part.as_str(), &of_model)] {
        let owner = if source == "/" { "the package" } else { source };
        let is_there = |r: &&Relationship| {
            resolve(source, &r.target).is_some_and(|named| package.find(&named).is_some())
        };
        let missing: Vec<_> = of_source.iter().filter(|r| !r.is_external && !is_there(r)).collect();
        if let [first, ..] = missing[..] {
            let others = match missing.len() {
                1 => String::new(),
                count => format!(" and {} more", count - 1),
            };
            remarks.push(format!(
                "The file breaks a rule of 3MF: {owner} names the part {}{others}, {} not there.",
                shortened(&first.target),
                if missing.len() == 1 { "which is" } else { "which are" }
            ));
        }
    }
    let tickets = all.iter().chain(&of_model).filter(|r| is_of(r, PRINT_TICKET)).count();
    if tickets > 1 {
        remarks.push(format!("The file breaks a rule of 3MF: there are {tickets} print tickets."));
    }
    Ok(RootModel { part, remarks })
}

/// The only part that can be the model, where nothing names it.
fn only_model(package: &Package<'_>) -> Result<String, ReadError> {
    const USUAL: &str = "/3D/3dmodel.model";
    if package.find(USUAL).is_some() {
        return Ok(USUAL.to_owned());
    }
    let is_model = |name: &&String| {
        let name = name.to_ascii_lowercase();
        name.starts_with("/3d/") && name.ends_with(".model") && name.matches('/').count() == 2
    };
    let mut models = package.names().iter().filter(is_model);
    match (models.next(), models.next()) {
        (Some(only), None) => Ok(only.clone()),
        _ if package.names().iter().any(|name| name.to_ascii_lowercase().ends_with(".model")) => {
            let found = "a package that does not say which part is its model";
            Err(ReadError::unparseable(Place::Whole, found, "a relationship of the package that names it"))
        }
        _ => Err(ReadError::foreign("a zip archive without a 3MF model")),
    }
}

fn relationships(document: &Document<'_>, budget: &Budget) -> Result<Vec<Relationship>, ReadError> {
    let mut scanner = Scanner::new(document, budget);
    let mut all = Vec::new();
    loop {
        match scanner.next()? {
            XmlEvent::Open(element) if element.local == "Relationship" => {
                let attributes = scanner.attributes(&element)?;
                let of = |name| value(&attributes, name).unwrap_or_default().to_owned();
                let is_external = of("TargetMode").eq_ignore_ascii_case("external");
                all.push(Relationship { kind: of("Type"), target: of("Target"), is_external });
            }
            XmlEvent::Open(_) | XmlEvent::Close => {}
            XmlEvent::End => return Ok(all),
        }
    }
}
