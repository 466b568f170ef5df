//! Each call in curl, Python and TypeScript, by what their standard libraries bring. A test runs them.

/// Languages of examples: their word in the page, and their name.
pub(super) const LANGUAGES: [(&str, &str); 3] =
    [("curl", "curl"), ("python", "Python"), ("typescript", "TypeScript")];

/// What is done with an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ResponseUse {
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
    /// Files of meshes that it sends: one as the body, several as a form.
    meshes: &'static [&'static str],
    accept: Option<&'static str>,
    answer: ResponseUse,
}

impl Call {
    /// The call of `path` by `method`.
    pub(super) fn of(path: &str, method: &'static str) -> Self {
        let (query, answer) = match (method, path) {
            ("POST", "/v1/convert") => ("?output_format=obj", ResponseUse::Saved("part.obj")),
            ("POST", "/v1/simplify") => ("?ratio=0.5", ResponseUse::Saved("small.stl")),
            ("POST", "/v1/cut-stitch") => ("?output_format=off", ResponseUse::Saved("sheets.off")),
            ("POST", "/v1/fill-holes") => ("?method=auto", ResponseUse::Saved("closed.stl")),
            ("POST", "/v1/modeller") => ("?list_faces=true", ResponseUse::Told),
            ("POST", "/v1/boolean") => ("?set_operation=union", ResponseUse::Saved("both.stl")),
            ("POST", "/v1/render") => ("?views=four", ResponseUse::Saved("part.png")),
            ("POST", "/v1/jobs") => ("?operation=repair&thumbnail=true", ResponseUse::Told),
            ("GET", "/v1/jobs") => ("?limit=20", ResponseUse::Told),
            ("GET", "/v1/jobs/{id}") => ("?wait=60", ResponseUse::Told),
            ("POST", "/v1/repair") | ("GET", "/v1/jobs/{id}/result") => {
                ("", ResponseUse::Saved("repaired.stl"))
            }
            ("GET", "/v1/jobs/{id}/thumbnail.png") => ("", ResponseUse::Saved("part.png")),
            ("GET", "/v1/jobs/{id}/thumbnail.glb") => ("", ResponseUse::Saved("part.glb")),
            ("GET", "/openapi.yaml") => ("", ResponseUse::Saved("openapi.yaml")),
            ("GET", "/openapi.json") => ("", ResponseUse::Saved("openapi.json")),
            ("DELETE", _) => ("", ResponseUse::None),
            _ => ("", ResponseUse::Told),
        };
        let accept = match path {
            "/v1/modeller" => Some("application/json"),
            "/v1/jobs/{id}/events" => Some("text/event-stream"),
            _ => None,
        };
        let operation = path.strip_prefix("/v1/").filter(|rest| !rest.contains('/')).unwrap_or_default();
        let meshes: &[_] = match operation {
            _ if method != "POST" || operation.is_empty() => &[],
            "boolean" => &["part.stl", "other.stl"],
            _ => &["part.stl"],
        };
        let path = path.replace("/v1/jobs/{id}", "{job}").replace("{delivery}", "DELIVERY");
        Self { method, path, query, meshes, accept, answer }
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
        match (self.method, self.meshes) {
            ("GET", []) => {}
            (method, []) => line.push_str(&format!(" -X {method}")),
            (_, [file]) => line.push_str(&format!(" --data-binary @{file}")),
            (_, files) => files.iter().for_each(|file| line.push_str(&format!(" -F mesh=@{file}"))),
        }
        line.push_str(&format!(" \"$url{}{}\"", self.path.replace("{job}", "$job"), self.query));
        if let Some(accept) = self.accept {
            line.push_str(&format!(" -H 'Accept: {accept}'"));
        }
        if let ResponseUse::Saved(file) = self.answer {
            line.push_str(&format!(" -o {file}"));
        }
        line
    }

    fn python(&self) -> String {
        let uses_path = !self.meshes.is_empty() || matches!(self.answer, ResponseUse::Saved(_));
        let mut lines = Vec::new();
        if uses_path {
            lines.push("from pathlib import Path".to_owned());
        }
        lines.push("from urllib.request import Request, urlopen\n".to_owned());
        let mut arguments = vec![format!("f\"{{url}}{}{}\"", self.path, self.query)];
        let mut headers = Vec::new();
        match self.meshes {
            [] if self.method == "GET" => {}
            [] => arguments.push(format!("method=\"{}\"", self.method)),
            [file] => {
                arguments.push(format!("data=Path(\"{file}\").read_bytes()"));
                headers.push("\"Content-Type\": \"application/octet-stream\"".to_owned());
            }
            files => {
                lines.push("boundary = \"between-the-meshes\"".to_owned());
                lines.push("form = b\"\"".to_owned());
                lines.push(format!("for name in {files:?}:"));
                lines.push(
                    "    head = f'--{boundary}\\r\\nContent-Disposition: form-data; name=\"mesh\"; filename=\"{name}\"\\r\\n\\r\\n'"
                        .to_owned(),
                );
                lines.push("    form += head.encode() + Path(name).read_bytes() + b\"\\r\\n\"".to_owned());
                arguments.push("data=form + f\"--{boundary}--\\r\\n\".encode()".to_owned());
                headers.push("\"Content-Type\": f\"multipart/form-data; boundary={boundary}\"".to_owned());
            }
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
            ResponseUse::None => lines.push("urlopen(request).close()".to_owned()),
            ResponseUse::Told => {
                lines.push("with urlopen(request) as answer:\n    print(answer.read().decode())".to_owned());
            }
            ResponseUse::Saved(file) => lines.push(format!(
                "with urlopen(request) as answer:\n    Path(\"{file}\").write_bytes(answer.read())"
            )),
        }
        lines.join("\n")
    }

    fn typescript(&self) -> String {
        let saves = matches!(self.answer, ResponseUse::Saved(_));
        let names: Vec<_> = [("readFile", !self.meshes.is_empty()), ("writeFile", saves)]
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
        match self.meshes {
            [] => {}
            [file] => choices.push(format!("body: await readFile(\"{file}\")")),
            files => {
                lines.push("const body = new FormData();".to_owned());
                lines.push(format!("for (const name of {files:?}) {{"));
                lines.push("  body.append(\"mesh\", new Blob([await readFile(name)]), name);\n}".to_owned());
                choices.push("body".to_owned());
            }
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
            ResponseUse::None => {}
            ResponseUse::Told => lines.push("console.log(await answer.text());".to_owned()),
            ResponseUse::Saved(file) => {
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
    fn several_meshes_are_sent_as_a_form() {
        let call = Call::of("/v1/boolean", "POST");
        assert_eq!(
            call.example("curl"),
            "curl -f -F mesh=@part.stl -F mesh=@other.stl \"$url/v1/boolean?set_operation=union\" -o both.stl"
        );
        assert!(call.example("python").contains("for name in [\"part.stl\", \"other.stl\"]:"));
        assert!(call.example("typescript").contains("body.append(\"mesh\", "));
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
