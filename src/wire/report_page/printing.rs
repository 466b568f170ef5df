//! The part of the page about printing.

use super::markup::{HtmlPage, TableCell, Tone, figure, items, measured, text};
use super::{coordinates, plain};
use serde_json::Value;

/// Checks and the figures of a quote; nothing without a policy.
pub(super) fn add(page: &mut HtmlPage, printing: &Value) {
    if printing.is_null() {
        return;
    }
    let about = if printing["about"] == "result" { "the returned file" } else { "your file" };
    page.heading(&format!("Printing by {}", text(&printing["policy"]).to_uppercase()));
    page.paragraph(&format!(
        "Measured on {about}, with {} up, against version {} of the limits of this process.",
        text(&printing["build_direction"]).replace("minus_", "\u{2212}"),
        printing["policy_version"]
    ));
    let rows = items(&printing["checks"]).iter().map(check).collect();
    page.table(&["", "Check", "Result", "First places"], rows);
    quote(page, printing);
}

fn check(check: &Value) -> Vec<TableCell> {
    let (tone, word) = match text(&check["status"]) {
        "ok" => (Tone::Good, "ok"),
        "warning" => (Tone::Fair, "warning"),
        "error" => (Tone::Bad, "error"),
        _ => (Tone::Open, "not told"),
    };
    let places = items(&check["witnesses"]).iter().take(super::PLACES);
    let places = places.filter_map(|witness| Some(format!("at {}", coordinates(&witness["position"])?)));
    vec![
        TableCell::Mark(tone, word),
        TableCell::Text(plain::check(text(&check["code"])).to_owned()),
        TableCell::Text(text(&check["message"]).to_owned()),
        TableCell::Text(places.collect::<Vec<_>>().join("; ")),
    ]
}

fn quote(page: &mut HtmlPage, printing: &Value) {
    let quote = &printing["quote"];
    page.heading("Figures for a quote");
    let up = &printing["build_direction"];
    let placed = items(&printing["overhangs"]).iter().find(|overhang| overhang["direction"] == *up);
    let support = placed.map_or(&Value::Null, |overhang| &overhang["support_area"]);
    let (low, high) = (items(&quote["bounds"]["min"]), items(&quote["bounds"]["max"]));
    let bounds: Vec<f64> =
        high.iter().zip(low).filter_map(|(high, low)| Some(high.as_f64()? - low.as_f64()?)).collect();
    let turned: Vec<f64> = items(&quote["oriented_box"]["size"]).iter().filter_map(Value::as_f64).collect();
    let rows = [
        ("Volume of material", measured(&quote["volume"], " mm\u{b3}")),
        ("Surface", measured(&quote["area"], " mm\u{b2}")),
        ("Box along the axes", sides(&bounds)),
        ("Smallest box found, turned in any way", sides(&turned)),
        ("Area covered on the plate", measured(&quote["shadow_area"], " mm\u{b2}")),
        ("Area that needs support, seen from above", measured(support, " mm\u{b2}")),
    ];
    let row =
        |(name, value): (&str, String)| vec![TableCell::Text(name.to_owned()), TableCell::Number(value)];
    page.table(&[], rows.into_iter().map(row).collect());
    let safe =
        if quote["price_safe"] == true { "A price can rest on these figures" } else { "Not for a price" };
    page.paragraph(&format!("{safe}: {}.", text(&quote["reason"])));
}

fn sides(sides: &[f64]) -> String {
    if sides.len() != 3 {
        return "\u{2013}".to_owned();
    }
    format!("{} mm", sides.iter().map(|&side| figure(side)).collect::<Vec<_>>().join(" \u{d7} "))
}
