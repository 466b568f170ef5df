//! The page of a few reports.

use super::*;
use crate::wire::{Report, TimingMs, sample};
use serde_json::json;

fn page_of(answer: &crate::pipeline::Answer) -> String {
    report_page(&serde_json::to_value(Report::new(&answer.report, TimingMs::default())).unwrap(), None)
}

#[test]
fn a_repair_is_told_from_verdict_to_certificate() {
    let page = page_of(&sample::repaired());
    let wanted = [
        "<strong>A valid solid, but not what your file shows</strong>",
        "The file was mended in a few places.",
        "50 % of the surface is invented (faithful: at most 1 %).",
        "No unit is stated: ",
        "The surface has holes or open rims: it is not watertight.",
        "line 17",
        "Holes were closed.",
        "faces added: 1",
        "How far the result is from your file",
        "of the returned file",
    ];
    let mut from = 0;
    for part in wanted {
        let at = page[from..].find(part).unwrap_or_else(|| panic!("{part} after {from} in {page}"));
        from += at;
    }
    assert!(!page.contains("Printing by"), "no policy was asked for");
}

#[test]
fn a_refusal_says_why() {
    let page = page_of(&sample::refused());
    assert!(page.contains("Not a valid solid") && page.contains("No result is returned."), "{page}");
    assert!(!page.contains("How far the result"), "there is none");
}

#[test]
fn text_of_a_report_cannot_become_markup_and_nothing_is_loaded() {
    let mut report =
        serde_json::to_value(Report::new(&sample::repaired().report, TimingMs::default())).unwrap();
    let evil = "<script src=//x>\"'&";
    report["verdict"]["reasons"] = json!([{"message": evil}]);
    report["actions"][0]["step"] = json!(evil);
    report["actions"][0]["reason"] = json!(evil);
    report["input"]["units"]["unit"] = json!(evil);
    report["engine"]["name"] = json!(evil);
    report["certificate"]["sha256"] = json!(evil);
    report["printing"] = json!({"policy": evil, "checks": [{"message": evil, "code": evil}]});
    let page = report_page(&report, None);
    assert!(!page.to_lowercase().contains("<script"), "{page}");
    assert_eq!(page.matches('<').count(), page.matches('>').count());
    for word in ["src=", "href=", "url(", "@import", "http:", "https:"] {
        let outside = page.replace("src=//x", "");
        assert!(!outside.contains(word), "{word}");
    }
}

#[test]
fn text_cannot_become_markup() {
    assert_eq!(Escaped("<a href=\"x\">&").to_string(), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

#[test]
fn whatever_json_it_is_given_there_is_a_page() {
    for report in [json!(null), json!({}), json!([1]), json!({"before": 5, "printing": {"quote": []}})] {
        assert!(report_page(&report, None).ends_with("</html>\n"));
    }
}

#[test]
fn a_picture_stands_in_the_page_itself_and_its_words_say_what_it_shows() {
    let report = serde_json::to_value(Report::new(&sample::repaired().report, TimingMs::default())).unwrap();
    let page = report_page(&report, Some(b"picture"));
    assert!(page.contains("src=\"data:image/png;base64,cGljdHVyZQ==\""), "{page}");
    assert!(page.contains("Left your file, right the result"));
    let refused = serde_json::to_value(Report::new(&sample::refused().report, TimingMs::default())).unwrap();
    assert!(!report_page(&refused, Some(b"picture")).contains("the result, from the same side"));
    assert!(REPORT_PAGE_CSP.contains("img-src data:;"));
    assert!(!report_page(&report, None).contains("<img"));
}

#[test]
fn the_worst_defects_stand_first_and_places_have_no_noise() {
    let defect = |severity: &str, code: &str, x: f64| {
        let witness = json!({"faces": [{"index": 3}], "position": [x, 0.5, 2.0]});
        json!({"severity": severity, "code": code, "count": 1, "witnesses": [witness]})
    };
    let report = json!({
        "input": {"units": {"unit": "mm"}},
        "before": {"defects": [defect("info", "needle", 8.6e-42), defect("error", "overlap", 1e-3)],
                   "unit_hypothesis": {"question": "Is the side 1 mm? Say so with `units`."}}
    });
    let page = report_page(&report, None);
    assert!(page.find("error</span>").unwrap() < page.find("note</span>").unwrap(), "{page}");
    assert!(page.contains("at 0, 0.5, 2") && page.contains("at 0.001, 0.5, 2"), "{page}");
    assert!(
        page.contains("Is the side 1 mm? The file was taken in mm.") && !page.contains("units`"),
        "{page}"
    );
}

#[test]
fn small_numbers_are_told_without_powers_of_ten_and_nothing_is_below_zero() {
    let told = [2.1e-14, 3.2e-8, 4.5e-5, -1e-14, 0.0, 12.345, 1234.5].map(figure);
    assert_eq!(told, ["0", "0.000000032", "0.000045", "0", "0", "12.35", "1234"]);
    assert_eq!(measured(&json!(2.1e-14), " mm"), "less than 0.000000001 mm");
    assert_eq!(measured(&json!(0.0), " mm"), "0 mm");
}

#[test]
fn holes_are_counted_from_one_and_a_cause_is_told_once() {
    let hole = json!({"hole": "crack", "faces": [{"index": 7}], "position": null});
    let defect = json!({"severity": "error", "code": "boundary-loop", "count": 1, "witnesses": [hole]});
    let action =
        json!({"step": "fill-holes", "causes": ["needle", "cap"], "changes": [{"name": "n", "count": 2}]});
    let filled = json!({"loops": [0, 2], "fate": "filled", "class": "crack", "triangles": 4});
    let report = json!({"before": {"defects": [defect]}, "actions": [action], "holes": [filled]});
    let page = report_page(&report, None);
    assert!(
        page.contains("<td class=number>1</td><td>A crack") && page.contains("<td class=number>1, 3</td>"),
        "{page}"
    );
    assert!(page.contains("face 7 of the file, counted from 0"), "{page}");
    assert!(page.contains("<td>faces as thin as a line</td>"), "{page}");
}
