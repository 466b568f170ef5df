//! What is wrong with a plan that cannot be taken, and where.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::certificate::digest_of_hex;
use super::fill_settings::{FillSettings, SingleHole};
use super::options::nearest;
use super::plan::{ChosenElement, ChosenFinding, ChosenShell, LIST_MAX, PlanStep};
use super::shortened::shortened;
use crate::pipeline::ELEMENTS_MAX;

/// What of a plan cannot be taken.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanFault {
    /// Where it stands and what would be taken there, in a sentence.
    pub told: String,
    /// The words that would be taken there; empty: something else would.
    pub allowed: Vec<String>,
    /// The one that was probably meant.
    pub suggestion: Option<String>,
}

impl PlanFault {
    fn new(told: String) -> Self {
        Self { told, ..Self::default() }
    }

    /// The fault of a member that should hold one of `allowed`, or be named so.
    fn of_word(told: &str, word: &str, allowed: Vec<String>) -> Self {
        let suggestion = nearest(word, allowed.iter().map(String::as_str)).map(str::to_owned);
        let meant = suggestion.as_ref().map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        let expected = if allowed.is_empty() { "none".to_owned() } else { allowed.join(", ") };
        Self { told: format!("{told}; expected {expected}{meant}"), allowed, suggestion }
    }

    /// The first one of the plan in `text`; `None`: it is a plan, or what is wrong is not known.
    pub(super) fn of(text: &str) -> Option<Self> {
        let plan: Value = match serde_json::from_str(text) {
            Ok(plan) => plan,
            Err(error) => return Some(Self::new(format!("`plan` is no JSON: {error}"))),
        };
        let Some(members) = plan.as_object() else {
            return Some(Self::new("`plan` is no object".to_owned()));
        };
        of_members(members)
            .or_else(|| first(items(&plan, "findings"), "`plan`, finding", of_finding))
            .or_else(|| first(items(&plan, "steps"), "`plan`, step", of_step))
    }
}

/// The first fault of items of a list, which are named by `kind` and their numbers from 1.
fn first(items: &[Value], kind: &str, fault: fn(&str, &Value) -> Option<PlanFault>) -> Option<PlanFault> {
    items.iter().zip(1..).find_map(|(item, number)| fault(&format!("{kind} {number}"), item))
}

fn items<'v>(of: &'v Value, name: &str) -> &'v [Value] {
    of[name].as_array().map_or(&[], Vec::as_slice)
}

fn of_members(members: &Map<String, Value>) -> Option<PlanFault> {
    let names = ["input_sha256", "findings", "steps"];
    if let Some(name) = members.keys().find(|name| !names.contains(&name.as_str())) {
        let told = format!("`plan` has no member `{}`", shortened(name));
        return Some(PlanFault::of_word(&told, name, names.map(str::to_owned).into()));
    }
    let value = |name: &str| members.get(name).filter(|value| !value.is_null());
    let is_digest = |value: &Value| value.as_str().is_some_and(|text| digest_of_hex(text).is_some());
    if value("input_sha256").is_some_and(|value| !is_digest(value)) {
        return Some(PlanFault::new("`plan`: `input_sha256` is not 64 hexadecimal digits".to_owned()));
    }
    ["findings", "steps"].into_iter().find_map(|name| of_list("`plan`", name, value(name)?, LIST_MAX))
}

fn of_list(place: &str, name: &str, list: &Value, items_max: usize) -> Option<PlanFault> {
    match list.as_array() {
        None => Some(PlanFault::new(format!("{place}: `{name}` is no list"))),
        Some(items) if items.len() > items_max => {
            Some(PlanFault::new(format!("{place}: `{name}` has more than {items_max} items")))
        }
        Some(_) => None,
    }
}

fn of_finding(place: &str, finding: &Value) -> Option<PlanFault> {
    let of_element: fn(&str, &Value) -> _ = |place, element| {
        of_object::<ChosenElement>(place, element)
            .or_else(|| of_contradiction(place, element, ChosenElement::contradiction))
    };
    first(items(finding, "elements"), &format!("{place}, element"), of_element)
        .or_else(|| of_object::<ChosenFinding>(place, finding))
        .or_else(|| of_list(place, "elements", finding.get("elements")?, ELEMENTS_MAX))
}

fn of_step(place: &str, step: &Value) -> Option<PlanFault> {
    let of_shell: fn(&str, &Value) -> _ = |place, shell| of_object::<ChosenShell>(place, shell);
    let of_hole: fn(&str, &Value) -> _ = |place, hole| {
        of_object::<SingleHole>(place, hole)
            .or_else(|| of_contradiction(place, hole, SingleHole::contradiction))
    };
    let how = step.get("how").filter(|how| !how.is_null());
    first(items(step, "chosen"), &format!("{place}, shell"), of_shell)
        .or_else(|| first(items(how?, "single"), &format!("{place}, hole"), of_hole))
        .or_else(|| of_object::<FillSettings>(&format!("{place}, `how`"), how?))
        .or_else(|| of_object::<PlanStep>(place, step))
        .or_else(|| {
            let read: PlanStep = serde_json::from_value(step.clone()).ok()?;
            let told =
                format!("{place}: a number is out of range, or a list has more than {ELEMENTS_MAX} items");
            (!read.is_small()).then(|| PlanFault::new(told))
        })
}

/// Why a `T` cannot be taken whose members are right each by itself.
fn of_contradiction<T: DeserializeOwned>(
    place: &str,
    value: &Value,
    contradiction: fn(&T) -> Option<&'static str>,
) -> Option<PlanFault> {
    let read: T = serde_json::from_value(value.clone()).ok()?;
    contradiction(&read).map(|why| PlanFault::new(format!("{place}: {why}")))
}

/// Why `value` is no `T`, which is an object.
fn of_object<T: DeserializeOwned>(place: &str, value: &Value) -> Option<PlanFault> {
    let Some(members) = value.as_object() else {
        return Some(PlanFault::new(format!("{place} is no object: `{}`", shortened(&value.to_string()))));
    };
    let error = error_of::<T>(members)?;
    let expected = error.rsplit_once(", expected ").map(|(_, expected)| expected);
    // Words stand in such signs.
    let words = || expected.unwrap_or_default().split('`').skip(1).step_by(2).map(str::to_owned).collect();
    if let Some(name) = error.strip_prefix("unknown field `").and_then(|rest| rest.split('`').next()) {
        let told = format!("{place} has no member `{}`", shortened(name));
        return Some(PlanFault::of_word(&told, name, words()));
    }
    let named = culprit::<T>(members, &error).and_then(|name| Some((name, members.get(name)?)));
    let Some((name, given)) = named else {
        // What is absent is named.
        let told = match error.strip_prefix("missing field ") {
            Some(name) => format!("{place} lacks the member {name}"),
            None => format!("{place}: {error}"),
        };
        return Some(PlanFault::new(told));
    };
    let given = given.as_str().map_or_else(|| given.to_string(), str::to_owned);
    let told = format!("{place}: `{name}` cannot be `{}`", shortened(&given));
    if error.starts_with("unknown variant") {
        return Some(PlanFault::of_word(&told, &given, words()));
    }
    Some(PlanFault::new(format!("{told}: {}", expected.map_or(error.clone(), plainly))))
}

fn error_of<T: DeserializeOwned>(members: &Map<String, Value>) -> Option<String> {
    serde_json::from_value::<T>(Value::Object(members.clone())).err().map(|error| error.to_string())
}

/// The member that `error` is about: without it, it is another one, or none. The word of a step says what members there are, so
/// that only what no other member explains is about it.
fn culprit<'m, T: DeserializeOwned>(members: &'m Map<String, Value>, error: &str) -> Option<&'m String> {
    let is_about = |name: &&String| {
        let mut others = members.clone();
        others.remove(name.as_str());
        error_of::<T>(&others).as_deref() != Some(error)
    };
    let is_word = |name: &&String| name.as_str() == "step";
    let of_others = members.keys().filter(|name| !is_word(name)).find(is_about);
    let is_missing = error.starts_with("missing field");
    of_others.or_else(|| members.keys().find(is_word)).filter(|_| !is_missing)
}

/// What a deserializer expects, for people.
fn plainly(expected: &str) -> String {
    let plain = match expected {
        "f64" | "f32" | "u32" | "u64" => "a number",
        "a sequence" => "a list",
        "a borrowed string" | "a string" => "a text",
        "a boolean" => "true or false",
        other => other,
    };
    format!("expected {plain}")
}
