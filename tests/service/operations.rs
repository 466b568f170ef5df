//! A mesh in, its report or its repair out.

use crate::meshes::{BROKEN, CROSSING, LINE, MOEBIUS, OPEN, SOLID};
use crate::server::{Server, header, link, problem};
use reqwest::blocking::{Response, multipart};
use serde_json::{Value, json};
use std::io::Read as _;

#[test]
fn a_valid_mesh_comes_back_as_the_very_bytes() {
    let server = Server::start();
    let response = server.post("/v1/repair").body(SOLID).send().unwrap();
    assert_eq!(response.status(), 200);
    assert_eq!(header(&response, "content-type"), "text/off");
    assert_eq!(header(&response, "meshmend-outcome"), "identical");
    assert!(header(&response, "content-disposition").starts_with("attachment; filename="));
    let report = header(&response, "link").strip_prefix('<').unwrap().split('>').next().unwrap().to_owned();
    assert!(header(&response, "link").ends_with("; rel=\"describedby\""));
    assert!(header(&response, "server-timing").contains("certify;dur="));
    assert_eq!(response.text().unwrap(), SOLID);
    let report: Value = server.get(&report).send().unwrap().json().unwrap();
    assert_eq!(report["verdict"]["outcome"], "identical");
}

#[test]
fn an_open_mesh_is_closed_and_certified() {
    let server = Server::start();
    let response = server.post("/v1/repair?output_format=stl").body(OPEN).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "meshmend-outcome")), (200, "repaired"));
    assert_eq!(header(&response, "content-type"), "model/stl");
    let repaired = response.bytes().unwrap().to_vec();
    assert_eq!(repaired.len(), 84 + 4 * 50);
    let verified: Value = server.post("/v1/verify").body(repaired).send().unwrap().json().unwrap();
    assert_eq!(verified["verdict"]["printable"], true);
}

#[test]
fn analyze_and_verify_answer_for_any_readable_mesh() {
    let server = Server::start();
    for mesh in [SOLID, OPEN, CROSSING] {
        for path in ["/v1/analyze", "/v1/verify"] {
            let response = server.post(path).body(mesh).send().unwrap();
            assert_eq!(
                (response.status().as_u16(), header(&response, "content-type")),
                (200, "application/json")
            );
            let report: Value = response.json().unwrap();
            assert_eq!(report["verdict"]["printable"], mesh == SOLID, "{path}");
        }
    }
}

#[test]
fn convert_writes_another_format() {
    let server = Server::start();
    let response = server.post("/v1/convert?output_format=obj").body(OPEN).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "content-type")), (200, "model/obj"));
    let text = response.text().unwrap();
    assert_eq!(text.lines().filter(|line| line.starts_with("f ")).count(), 3, "{text}");
}

#[test]
fn what_curl_sends_by_default_is_understood() {
    let server = Server::start();
    for content_type in ["application/x-www-form-urlencoded", "application/octet-stream", "text/off"] {
        let request = server.post("/v1/verify").header("content-type", content_type).body(SOLID);
        assert_eq!(request.send().unwrap().status(), 200, "{content_type}");
    }
}

#[test]
fn a_mesh_of_another_format_than_named_is_refused_unless_format_says_otherwise() {
    let server = Server::start();
    let named = |path| server.post(path).header("content-type", "application/x-ply").body(SOLID);
    let (status, code, _) = problem(named("/v1/verify").send().unwrap());
    assert_eq!((status, code.as_str()), (422, "mesh-unparseable"));
    assert_eq!(named("/v1/verify?format=off").send().unwrap().status(), 200);
}

#[test]
fn a_3mf_is_converted_to_repaired_as_itself_and_back() {
    let server = Server::start();
    let made = server.post("/v1/convert?output_format=3mf").body(SOLID).send().unwrap();
    assert_eq!(made.headers()["content-type"], "model/3mf");
    let project = made.bytes().unwrap();
    assert!(project.starts_with(b"PK"));
    let repair = |accept: &str| {
        let request = server.post("/v1/repair").header("content-type", "model/3mf").header("accept", accept);
        request.body(project.clone()).send().unwrap()
    };
    assert_eq!(repair("*/*").bytes().unwrap(), project, "a valid project comes back byte for byte");
    let report: Value = repair("application/json").json().unwrap();
    assert_eq!(report["verdict"]["outcome"], "identical");
    assert_eq!(
        (&report["certificate"]["parts"], &report["parts"][0]["path"]),
        (&1.into(), &"/3D/3dmodel.model".into())
    );
    let back =
        server.post("/v1/convert?output_format=off&parts=together").body(project.clone()).send().unwrap();
    assert_eq!(back.headers()["content-type"], "text/off");
    let (status, code, problem) =
        problem(server.post("/v1/repair?output_units=in").body(project).send().unwrap());
    assert_eq!((status, code.as_str()), (400, "invalid-parameter"));
    assert_eq!(problem["parameter"], "output_units");
}

#[test]
fn an_unreadable_mesh_is_a_problem_with_its_place() {
    let server = Server::start();
    for path in ["/v1/analyze", "/v1/repair", "/v1/convert", "/v1/verify"] {
        let (status, code, problem) = problem(server.post(path).body(BROKEN).send().unwrap());
        assert_eq!((status, code.as_str()), (422, "mesh-unparseable"), "{path}");
        assert_eq!(problem["line"], 3, "{problem}");
    }
}

#[test]
fn a_refused_repair_says_why_with_its_report() {
    let server = Server::start();
    for accept in ["*/*", "application/json", "application/zip", "multipart/mixed", "text/off"] {
        let request = server.post("/v1/repair").header("accept", accept).body(LINE);
        let (status, code, problem) = problem(request.send().unwrap());
        assert_eq!((status, code.as_str()), (422, "not-repairable"), "{accept}");
        assert_eq!(problem["report"]["verdict"]["outcome"], "refused", "{accept}");
        let job: Value = server.get(problem["instance"].as_str().unwrap()).send().unwrap().json().unwrap();
        assert_eq!(job["state"], "failed");
    }
    let job = server.ended(&server.job("repair", LINE));
    let report = server.get(link(&job, "report")).send().unwrap();
    assert_eq!(report.status(), 200);
    let (status, code, _) = problem(server.get(&format!("{}/result", link(&job, "self"))).send().unwrap());
    assert_eq!((status, code.as_str()), (422, "not-repairable"));
}

#[test]
fn what_is_mended_or_rebuilt_is_told() {
    let server = Server::start();
    for (require, outcome) in [("none", "partial"), ("best_effort", "rebuilt"), ("printable", "rebuilt")] {
        let path = format!("/v1/repair?wrap_cells=24&require={require}");
        let response = server.post(&path).body(MOEBIUS).send().unwrap();
        assert_eq!((response.status().as_u16(), header(&response, "meshmend-outcome")), (200, outcome));
    }
}

/// What of an answer shows which representation it is.
fn kind(response: Response) -> String {
    let status = response.status().as_u16();
    if status != 200 {
        return format!("{status} {}", problem(response).1);
    }
    header(&response, "content-type").split(';').next().unwrap().to_owned()
}

#[test]
fn accept_chooses_the_mesh_the_report_or_both() {
    let server = Server::start();
    let table = [
        (None, "", "text/off"),
        (Some("*/*"), "", "text/off"),
        (Some("model/*"), "", "text/off"),
        (Some("*/*"), "?output_format=ply", "application/x-ply"),
        (Some("model/stl"), "", "model/stl"),
        (Some("model/obj, application/json;q=0.9"), "", "model/obj"),
        (Some("model/stl"), "?output_format=obj", "406 not-acceptable"),
        (Some("model/stl, application/json;q=0.1"), "?output_format=obj", "application/json"),
        (Some("application/octet-stream"), "", "application/octet-stream"),
        (Some("application/json"), "", "application/json"),
        (Some("application/json, */*;q=0.1"), "", "application/json"),
        (Some("multipart/mixed"), "", "multipart/mixed"),
        (Some("application/zip"), "", "application/zip"),
        (Some("text/html"), "", "406 not-acceptable"),
    ];
    for path in ["/v1/repair", "/v1/convert"] {
        for (accept, query, expected) in table {
            let request = server.post(&format!("{path}{query}")).body(SOLID);
            let request = match accept {
                Some(accept) => request.header("accept", accept),
                None => request,
            };
            assert_eq!(kind(request.send().unwrap()), expected, "{path}{query} {accept:?}");
        }
    }
    for path in ["/v1/analyze", "/v1/verify"] {
        let request = server.post(path).header("accept", "model/stl").body(SOLID);
        assert_eq!(kind(request.send().unwrap()), "406 not-acceptable");
    }
}

#[test]
fn both_parts_of_an_answer_are_whole() {
    let server = Server::start();
    let both = |accept| server.post("/v1/repair").header("accept", accept).body(SOLID).send().unwrap();
    let response = both("multipart/mixed");
    let boundary = header(&response, "content-type").split_once("boundary=").unwrap().1.to_owned();
    let text = response.text().unwrap();
    let parts: Vec<_> = text.split(&format!("--{boundary}")).collect();
    let [before, report, mesh, after] = parts[..] else { panic!("two parts: {text}") };
    assert_eq!((before, after), ("", "--\r\n"));
    let report: Value = serde_json::from_str(report.split_once("\r\n\r\n").unwrap().1).unwrap();
    assert_eq!(report["verdict"]["outcome"], "identical");
    assert_eq!(mesh.split_once("\r\n\r\n").unwrap().1.strip_suffix("\r\n").unwrap(), SOLID);

    let archive = both("application/zip").bytes().unwrap();
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(archive)).unwrap();
    let mut file = |at| {
        let mut text = String::new();
        archive.by_index(at).unwrap().read_to_string(&mut text).unwrap();
        text
    };
    assert_eq!(serde_json::from_str::<Value>(&file(0)).unwrap()["verdict"]["outcome"], "identical");
    assert_eq!(file(1), SOLID);
}

#[test]
fn cutting_and_stitching_parts_what_only_touches_and_says_what_ran() {
    // Two tetrahedra that share one vertex.
    let touching = "OFF\n7 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n\
        3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 0 4 5\n3 0 6 4\n3 0 5 6\n3 4 6 5\n";
    let server = Server::start();
    let response = server.post("/v1/cut-stitch?cut=local&stitch=pinch").body(touching).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "meshmend-outcome")), (200, "cut-stitched"));
    assert!(header(&response, "content-disposition").contains("-cut-stitched.off"));
    let report = header(&response, "link").strip_prefix('<').unwrap().split('>').next().unwrap().to_owned();
    assert!(response.text().unwrap().starts_with("OFF\n8 8 0\n"));
    let report: Value = server.get(&report).send().unwrap().json().unwrap();
    let actions = report["actions"].as_array().unwrap();
    let cut = actions.iter().find(|action| action["step"] == "cut").unwrap();
    assert!(cut["reason"].as_str().unwrap().starts_with("cut locally, as asked: 1 of 7 vertices"));
    assert_eq!(report["certificate"]["printable"], false, "a reader that welds joins the two again");
    let wrong = server.post("/v1/cut-stitch?cut_edges=[[1,1]]").body(touching).send().unwrap();
    let (status, code, body) = problem(wrong);
    assert_eq!((status, &code[..], &body["parameter"]), (400, "invalid-parameter", &"cut_edges".into()));
    let unknown = server.post("/v1/cut-stitch?cut_edges=[[0,7]]").body(touching).send().unwrap();
    let (status, code, body) = problem(unknown);
    assert_eq!((status, &code[..], &body["parameter"]), (400, "invalid-parameter", &"cut_edges".into()));
    assert!(body["detail"].as_str().unwrap().contains("vertex 7"), "{body}");
}

#[test]
fn holes_are_listed_chosen_and_filled_and_each_is_told_of() {
    let server = Server::start();
    let listed: Value = server.post("/v1/analyze").body(OPEN).send().unwrap().json().unwrap();
    let witness = &listed["before"]["defects"][0]["witnesses"][0];
    assert_eq!(
        (&witness["hole"], &listed["before"]["holes"]["missing_face"]),
        (&"missing-face".into(), &1.into())
    );
    let response = server.post("/v1/fill-holes?holes=[0]&method=minimal").body(OPEN).send().unwrap();
    assert_eq!((response.status().as_u16(), header(&response, "meshmend-outcome")), (200, "filled"));
    assert!(header(&response, "content-disposition").contains("-filled.off"));
    let report = header(&response, "link").strip_prefix('<').unwrap().split('>').next().unwrap().to_owned();
    assert!(response.text().unwrap().starts_with("OFF\n4 4 0\n"));
    let report: Value = server.get(&report).send().unwrap().json().unwrap();
    let hole = &report["holes"][0];
    assert_eq!((&hole["loops"], &hole["class"]), (&json!([0]), &"missing-face".into()));
    assert_eq!((&hole["fate"], &hole["asked"]), (&"filled".into(), &"minimal".into()));
    assert_eq!((&hole["triangles"], &hole["vertices"]), (&1.into(), &0.into()));
    let share = report["deviation"]["interpolated_area_share"].as_f64().unwrap();
    assert!(share > 0.3 && share < 0.4, "{share}");
    assert_eq!(report["certificate"]["printable"], true);
    let solid = server.post("/v1/fill-holes").body(SOLID).send().unwrap();
    assert_eq!(header(&solid, "meshmend-outcome"), "identical");
    assert_eq!(solid.text().unwrap(), SOLID);
    for (query, parameter, told) in [
        ("holes=[1]", "holes", "numbers from 0 to 0"),
        ("holes=[]", "holes", "`all`"),
        ("method=rbff", "method", "auto, flat"),
        ("band_rings=9", "band_rings", "from 0 to 8"),
    ] {
        let wrong = server.post(&format!("/v1/fill-holes?{query}")).body(OPEN).send().unwrap();
        let (status, code, body) = problem(wrong);
        assert_eq!((status, &code[..], &body["parameter"]), (400, "invalid-parameter", &parameter.into()));
        assert!(body["expected"].as_str().unwrap().contains(told), "{body}");
    }
}

#[test]
fn a_polyhedron_is_measured_edited_certified_and_taken_back() {
    let server = Server::start();
    let post = |params: Value| {
        let form = multipart::Form::new()
            .part("mesh", multipart::Part::bytes(SOLID.as_bytes().to_vec()).file_name("part.off"))
            .text("params", params.to_string());
        server.post("/v1/modeller").multipart(form).send().unwrap()
    };
    let report_of = |response: &Response| -> Value {
        let path = header(response, "link").strip_prefix('<').unwrap().split('>').next().unwrap().to_owned();
        server.get(&path).send().unwrap().json().unwrap()
    };
    let asked = post(json!({"operators": [], "ranges": [{"normal": [0, 0, -1], "at": [0, 0, 0]}]}));
    assert_eq!((asked.status().as_u16(), header(&asked, "meshmend-outcome")), (200, "identical"));
    let report = report_of(&asked);
    assert_eq!(asked.text().unwrap(), SOLID);
    let range = &report["modeller"]["ranges"][0];
    assert_eq!(range["outward"]["limit_mm"], Value::Null, "the floor of a tip may go down for ever");
    let limit = range["inward"]["limit_mm"].as_f64().unwrap();
    assert!((limit + 1.0).abs() < 1e-12 && range["inward"]["blocking"][0]["kind"] == "edge-vanishes");
    let face = range["faces"][0]["face"].clone();

    let shift = json!({"shift": {"faces": [{"face": face, "by_mm": -0.5}]}});
    let edited = post(json!({"operators": [shift], "output_format": "stl"}));
    assert_eq!((edited.status().as_u16(), header(&edited, "meshmend-outcome")), (200, "modelled"));
    assert!(header(&edited, "content-disposition").contains("part-modelled.stl"));
    let report = report_of(&edited);
    assert_eq!(
        (&report["certificate"]["printable"], &report["operation"]),
        (&true.into(), &"modeller".into())
    );
    let step = &report["modeller"]["steps"][0];
    assert_eq!((&step["operator"], &step["validity"]["is_valid"]), (&"shift".into(), &true.into()));
    assert_eq!(step["validity"]["vertices"], 4);

    let back = post(json!({"operators": [shift, step["undo"]]}));
    assert_eq!(header(&back, "meshmend-outcome"), "identical");
    assert_eq!(back.text().unwrap(), SOLID);

    let too_far = json!({"shift": {"faces": [{"face": face, "by_mm": -1}]}});
    let (status, code, body) = problem(post(json!({"operators": [too_far]})));
    assert_eq!((status, &code[..]), (422, "not-repairable"));
    let refused = &body["report"]["modeller"]["refused"];
    assert_eq!((&refused["operator"], &refused["reason"]), (&0.into(), &"limit".into()));
    assert_eq!(body["report"]["verdict"]["reasons"][0]["code"], "operator-refused");
    assert!(body["detail"].as_str().unwrap().contains("would lose its length"), "{body}");

    let wrong = server.post("/v1/modeller?operators=[{\"turn\":{}}]").body(SOLID).send().unwrap();
    let (status, code, body) = problem(wrong);
    assert_eq!((status, &code[..], &body["parameter"]), (400, "invalid-parameter", &"operators".into()));
    let (status, code, body) = problem(server.post("/v1/modeller").body(OPEN).send().unwrap());
    assert_eq!((status, &code[..]), (422, "not-repairable"));
    assert_eq!(body["report"]["verdict"]["reasons"][0]["code"], "not-a-polyhedron");
}

#[test]
fn a_plan_is_asked_for_edited_and_given_back_and_the_steps_of_a_repair_run_again() {
    let server = Server::start();
    let report: Value = server.post("/v1/plan").body(OPEN).send().unwrap().json().unwrap();
    let mut plan = report["plan"].clone();
    assert_eq!((&plan["findings"][0]["code"], &plan["steps"]), (&"boundary-loop".into(), &Value::Null));
    let repair = |mesh: &str, plan: &Value, require: &str| {
        let form = multipart::Form::new()
            .part("mesh", multipart::Part::bytes(mesh.as_bytes().to_vec()).file_name("mesh.off"))
            .text("params", serde_json::json!({"plan": plan, "require": require}).to_string());
        server.post("/v1/repair").multipart(form).send().unwrap()
    };
    let filled = repair(OPEN, &plan, "printable");
    assert_eq!((filled.status().as_u16(), header(&filled, "meshmend-outcome")), (200, "repaired"));
    let made = header(&filled, "link").strip_prefix('<').unwrap().split('>').next().unwrap().to_owned();
    let filled = filled.text().unwrap();
    plan["findings"][0]["elements"][0]["remedy"] = "keep".into();
    let kept = repair(OPEN, &plan, "best_effort");
    assert_eq!((kept.status().as_u16(), header(&kept, "meshmend-outcome")), (200, "partial"));
    let (status, code, _) = problem(repair(OPEN, &plan, "printable"));
    assert_eq!((status, &code[..]), (422, "not-repairable"));
    let (status, code, body) = problem(repair(CROSSING, &plan, "printable"));
    assert_eq!((status, &code[..], &body["parameter"]), (409, "plan-mismatch", &"plan".into()));

    let report: Value = server.get(&made).send().unwrap().json().unwrap();
    assert!(report["plan"]["steps"].as_array().unwrap().iter().any(|step| step["step"] == "fill-holes"));
    assert_eq!(repair(OPEN, &report["plan"], "printable").text().unwrap(), filled);
}

#[test]
fn how_true_a_result_is_stands_in_the_header_the_job_and_the_report() {
    let server = Server::start();
    let repaired = server.post("/v1/repair").body(OPEN).send().unwrap();
    assert_eq!(repaired.headers()["meshmend-fidelity"], "changed");
    let same = server.post("/v1/repair").body(SOLID).send().unwrap();
    assert_eq!(same.headers()["meshmend-fidelity"], "exact");
    let report: Value = server
        .post("/v1/repair")
        .header("accept", "application/json")
        .body(OPEN)
        .send()
        .unwrap()
        .json()
        .unwrap();
    assert_eq!(report["verdict"]["fidelity"], "changed");
    let reasons: Vec<_> =
        report["verdict"]["changes"].as_array().unwrap().iter().map(|c| &c["reason"]).collect();
    assert!(reasons.contains(&&"invented".into()), "{reasons:?}");
    let (status, code, problem) =
        crate::server::problem(server.post("/v1/repair?require=faithful").body(OPEN).send().unwrap());
    assert_eq!((status, &*code), (422, "not-repairable"));
    assert!(problem["detail"].as_str().unwrap().contains("is not faithful to the file"), "{problem}");
}

#[test]
fn an_option_that_the_operation_does_not_take_is_refused_wherever_it_stands() {
    let server = Server::start();
    for request in [
        server.post("/v1/verify?wall_mm=1").body(SOLID),
        server.post("/v1/jobs?operation=verify&wall_mm=1").body(SOLID),
        server.post("/v1/verify").multipart(
            reqwest::blocking::multipart::Form::new().text("mesh", SOLID).text("params", r#"{"wall_mm":1}"#),
        ),
    ] {
        let (status, code, problem) = crate::server::problem(request.send().unwrap());
        assert_eq!((status, &*code, &problem["parameter"]), (400, "unknown-parameter", &"wall_mm".into()));
        assert!(problem["detail"].as_str().unwrap().contains("it is an option of repair"), "{problem}");
    }
}
