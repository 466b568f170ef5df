//! Each call in curl, Python and TypeScript, by what their standard libraries bring. A test runs them.

/// Languages of examples: their word in the page, and their name.
pub(super) const LANGUAGES: [(&str, &str); 3] =
    [("curl", "curl"), ("python", "Python"), ("typescript", "TypeScript")];

/// What is done with an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Answer {
    /// Written to this file.
    Saved(&'static str),
    /// Shown.
    Told,
    /// There is none.
    None,
}

/// One call as an example.
pub(super) struct Call {
    method: &'static str,
    /// The path, with `{job}` for that of a job.
    path: String,
    query: &'static str,
    sends_mesh: bool,
    accept: Option<&'static str>,
    answer: Answer,
}

impl Call {
    /// The call of `path` by `method`.
    pub(super) fn of(path: &str, method: &'static str) -> Self {
        let (query, answer) = match (method, path) {
            ("POST", "/v1/repair") => ("", Answer::Saved("repaired.stl")),
            ("POST", "/v1/convert") => ("?output_format=obj", Answer::Saved("part.obj")),
            ("POST", "/v1/simplify") => ("?ratio=0.5", Answer::Saved("small.stl")),
            ("POST", "/v1/cut-stitch") => ("?output_format=off", Answer::Saved("sheets.off")),
            ("POST", "/v1/fill-holes") => ("?method=auto", Answer::Saved("closed.stl")),
            ("POST", "/v1/modeller") => ("?list_faces=true", Answer::Told),
            ("POST", "/v1/render") => ("?views=four", Answer::Saved("part.png")),
            ("POST", "/v1/jobs") => ("?operation=repair&thumbnail=true", Answer::Told),
            ("GET", "/v1/jobs") => ("?limit=20", Answer::Told),
            ("GET", "/v1/jobs/{id}") => ("?wait=60", Answer::Told),
            ("GET", "/v1/jobs/{id}/result") => ("", Answer::Saved("repaired.stl")),
            ("GET", "/v1/jobs/{id}/thumbnail.png") => ("", Answer::Saved("part.png")),
            ("GET", "/openapi.yaml") => ("", Answer::Saved("openapi.yaml")),
            ("GET", "/openapi.json") => ("", Answer::Saved("openapi.json")),
            ("DELETE", _) => ("", Answer::None),
            _ => ("", Answer::Told),
        };
        let accept = match path {
            "/v1/modeller" => Some("application/json"),
            "/v1/jobs/{id}/events" => Some("text/event-stream"),
            _ => None,
        };
        let operation = path.strip_prefix("/v1/").filter(|rest| !rest.contains('/')).unwrap_or_default();
        let sends_mesh = method == "POST" && !operation.is_empty();
        let path = path.replace("/v1/jobs/{id}", "{job}").replace("{delivery}", "DELIVERY");
        Self { method, path, query, sends_mesh, accept, answer }
    }

    /// The example in one of [`LANGUAGES`].
    pub(super) fn example(&self, language: &str) -> String {
        match language {
            "python" => self.python(),
            "typescript" => self.typescript(),
            _ => self.curl(),
        }
    }

    fn curl(&self) -> String {
        let mut line = "curl -f".to_owned();
        match (self.method, self.sends_mesh) {
            (_, true) => line.push_str(" --data-binary @part.stl"),
            ("GET", _) => {}
            (method, _) => line.push_str(&format!(" -X {method}")),
        }
        line.push_str(&format!(" \"$url{}{}\"", self.path.replace("{job}", "$job"), self.query));
        if let Some(accept) = self.accept {
            line.push_str(&format!(" -H 'Accept: {accept}'"));
        }
        if let Answer::Saved(file) = self.answer {
            line.push_str(&format!(" -o {file}"));
        }
        line
    }

    fn python(&self) -> String {
        let uses_path = self.sends_mesh || matches!(self.answer, Answer::Saved(_));
        let mut lines = Vec::new();
        if uses_path {
            lines.push("from pathlib import Path".to_owned());
        }
        lines.push("from urllib.request import Request, urlopen\n".to_owned());
        let mut arguments = vec![format!("f\"{{url}}{}{}\"", self.path, self.query)];
        let mut headers = Vec::new();
        if self.sends_mesh {
            arguments.push("data=Path(\"part.stl\").read_bytes()".to_owned());
            headers.push("\"Content-Type\": \"application/octet-stream\"".to_owned());
        } else if self.method != "GET" {
            arguments.push(format!("method=\"{}\"", self.method));
        }
        headers.extend(self.accept.map(|accept| format!("\"Accept\": \"{accept}\"")));
        if !headers.is_empty() {
            arguments.push(format!("headers={{{}}}", headers.join(", ")));
        }
        lines.push(match arguments.as_slice() {
            [only] => format!("request = Request({only})"),
            all => format!("request = Request(\n    {},\n)", all.join(",\n    ")),
        });
        match self.answer {
            Answer::None => lines.push("urlopen(request).close()".to_owned()),
            Answer::Told => {
                lines.push("with urlopen(request) as answer:\n    print(answer.read().decode())".to_owned());
            }
            Answer::Saved(file) => lines.push(format!(
                "with urlopen(request) as answer:\n    Path(\"{file}\").write_bytes(answer.read())"
            )),
        }
        lines.join("\n")
    }

    fn typescript(&self) -> String {
        let saves = matches!(self.answer, Answer::Saved(_));
        let names: Vec<_> = [("readFile", self.sends_mesh), ("writeFile", saves)]
            .into_iter()
            .filter_map(|(name, is_used)| is_used.then_some(name))
            .collect();
        let mut lines = Vec::new();
        if !names.is_empty() {
            lines.push(format!("import {{ {} }} from \"node:fs/promises\";\n", names.join(", ")));
        }
        let mut choices = Vec::new();
        if self.method != "GET" {
            choices.push(format!("method: \"{}\"", self.method));
        }
        if self.sends_mesh {
            choices.push("body: await readFile(\"part.stl\")".to_owned());
        }
        choices.extend(self.accept.map(|accept| format!("headers: {{ Accept: \"{accept}\" }}")));
        let address = format!("`${{url}}{}{}`", self.path.replace("{job}", "${job}"), self.query);
        lines.push(match choices.as_slice() {
            [] => format!("const answer = await fetch({address});"),
            [one] => format!("const answer = await fetch({address}, {{ {one} }});"),
            all => format!("const answer = await fetch({address}, {{\n  {},\n}});", all.join(",\n  ")),
        });
        lines.push("if (!answer.ok) throw new Error((await answer.json()).detail);".to_owned());
        match self.answer {
            Answer::None => {}
            Answer::Told => lines.push("console.log(await answer.text());".to_owned()),
            Answer::Saved(file) => {
                lines.push(format!("await writeFile(\"{file}\", Buffer.from(await answer.arrayBuffer()));"));
            }
        }
        lines.join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_is_sent_and_its_result_saved() {
        let call = Call::of("/v1/repair", "POST");
        assert_eq!(
            call.example("curl"),
            "curl -f --data-binary @part.stl \"$url/v1/repair\" -o repaired.stl"
        );
        assert!(call.example("python").contains("f\"{url}/v1/repair\",\n    data=Path(\"part.stl\")"));
        assert!(call.example("typescript").contains("fetch(`${url}/v1/repair`, {\n  method: \"POST\","));
    }

    #[test]
    fn a_job_is_named_by_its_path() {
        let call = Call::of("/v1/jobs/{id}/report", "GET");
        assert_eq!(call.example("curl"), "curl -f \"$url$job/report\"");
        assert!(call.example("python").contains("f\"{url}{job}/report\""));
        assert!(call.example("typescript").contains("`${url}${job}/report`"));
        assert_eq!(Call::of("/v1/jobs/{id}", "DELETE").example("curl"), "curl -f -X DELETE \"$url$job\"");
    }
}
