//! The contract as a page for people, rendered once when the service starts: every call with its options, answers and
//! examples, and a form to try it, which `web/docs.js` fills.

mod examples;
mod prose;
mod schema;

use std::fmt::{Arguments, Write as _};

use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use serde_json::Value;
use utoipa::openapi::OpenApi;

use self::examples::Call;
use self::prose::Prose;
use self::schema::Type;
use super::state::State;
use crate::wire::Escaped;

/// `/docs`.
pub(super) async fn show(state: State) -> Response {
    ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], state.docs.clone()).into_response()
}

/// Groups of calls, by their tags, with what is said of them.
const GROUPS: [(&str, &str, &str); 4] = [
    (
        "operations",
        "Operations",
        "A mesh comes in as the body of the request, and the answer is what became of it. An operation that takes longer \
         than 60 s (or `Prefer: wait=N`) is answered with 202 and goes on as a job.",
    ),
    (
        "jobs",
        "Jobs",
        "Every request is a job. It is kept with its report, mesh and picture until it expires or is deleted.",
    ),
    (
        "uploads",
        "Uploads",
        "A mesh may come before its job: over as many requests as it takes, by the protocol tus, or past this service into its \
         bucket. A job then names it in `input`.",
    ),
    ("service", "The service", "What the service reads, writes and allows, and its contract."),
];

/// The page.
pub(super) fn render(document: &OpenApi) -> String {
    // The document is made of types that all have a form in JSON.
    let document = serde_json::to_value(document).unwrap_or_default();
    let mut page = DocsPage { html: String::new(), document: &document };
    page.add(format_args!(
        "<!doctype html><html lang=en><head><meta charset=utf-8>\
         <meta name=viewport content=\"width=device-width, initial-scale=1\"><title>Meshmend API</title>\
         <link rel=icon href=/favicon.ico type=image/svg+xml><link rel=stylesheet href=/docs.css>\
         <script type=module src=/docs.js></script></head><body>\
         <a class=skip href=#content>Skip to the content</a>"
    ));
    page.header();
    page.contents();
    page.add(format_args!("<main id=content>"));
    page.introduction();
    for (tag, title, about) in GROUPS {
        page.add(format_args!("<section aria-labelledby=group-{tag}><h2 id=group-{tag}>{title}</h2>"));
        page.add(format_args!("{}", Prose(about)));
        for (path, method, operation) in operations(&document).filter(|(.., one)| tag_of(one) == tag) {
            page.operation(path, method, operation);
        }
        page.add(format_args!("</section>"));
    }
    page.schemas();
    page.add(format_args!("</main></body></html>"));
    page.html
}

struct DocsPage<'d> {
    html: String,
    document: &'d Value,
}

impl<'d> DocsPage<'d> {
    fn add(&mut self, arguments: Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.html.write_fmt(arguments);
    }

    /// The name of the service, and in which language examples are shown.
    fn header(&mut self) {
        self.add(format_args!(
            "<header><a class=home href=/>Meshmend</a><span>API reference, version {}</span>\
             <fieldset id=languages><legend>Examples</legend>",
            Escaped(text(&self.document["info"]["version"]))
        ));
        for (at, (language, name)) in examples::LANGUAGES.iter().enumerate() {
            let checked = if at == 0 { " checked" } else { "" };
            self.add(format_args!(
                "<label><input type=radio name=language value={language} id=in-{language}{checked}>{name}</label>"
            ));
        }
        self.add(format_args!("</fieldset></header>"));
    }

    fn contents(&mut self) {
        self.add(format_args!("<nav aria-label=Contents>"));
        for (tag, title, _) in GROUPS {
            self.add(format_args!("<a class=group href=#group-{tag}>{title}</a><ul>"));
            for (path, method, operation) in operations(self.document).filter(|(.., one)| tag_of(one) == tag)
            {
                let (id, summary) = (text(&operation["operationId"]), text(&operation["summary"]));
                self.add(format_args!(
                    "<li><a href=#{}><span class=\"method {1}\">{1}</span> {2}</a></li>",
                    Escaped(id),
                    method,
                    Escaped(if summary.is_empty() { path } else { summary.trim_end_matches('.') })
                ));
            }
            self.add(format_args!("</ul>"));
        }
        self.add(format_args!("<a class=group href=#schemas>Schemas</a></nav>"));
    }

    fn introduction(&mut self) {
        let about = text(&self.document["info"]["description"]);
        self.add(format_args!(
            "<h1>Meshmend API</h1>{}\
             <p>The contract for programs is <a href=/openapi.yaml>openapi.yaml</a> or \
             <a href=/openapi.json>openapi.json</a>; clients are generated from it. To see a mesh and its defects, \
             <a href=/>open the page</a>.</p>\
             <p>In the examples <code>url</code> is the address of this service, <code>part.stl</code> a mesh, <code>other.stl</code> another and \
             <code>job</code> the path of a job, such as <code>/v1/jobs/ID</code>, as <code>Location</code> tells it.</p>\
             <p>An error is a document of type <code>application/problem+json</code> with a stable <code>code</code>, a \
             <code>detail</code> in words and, where one was met, the limit and the value; <a href=#list_errors>all codes</a> \
             are listed by the service.</p>\
             <p>A service with keys takes one as <code>Authorization: Bearer KEY</code> or <code>X-API-Key: KEY</code>.</p>\
             <p id=key-field><label>Key for trying calls on this page: <input id=key type=password autocomplete=off \
             placeholder=\"none\"></label> <span class=quiet>It stays in this tab.</span></p>",
            Prose(about)
        ));
    }

    fn operation(&mut self, path: &str, method: &'static str, operation: &'d Value) {
        let id = Escaped(text(&operation["operationId"])).to_string();
        self.add(format_args!(
            "<article id={id} aria-labelledby=title-{id}><h3 id=title-{id}>\
             <span class=\"method {method}\">{method}</span> <code>{}</code></h3>\
             <p class=summary>{}</p>{}",
            Escaped(path),
            Escaped(text(&operation["summary"])),
            Prose(text(&operation["description"]))
        ));
        // Uploads go over several calls, which programs have clients for: one call by itself is no example.
        if tag_of(operation) != "uploads" {
            self.examples(&Call::of(path, method));
        }
        self.parameters(operation);
        self.body(&operation["requestBody"]);
        self.answers(operation);
        self.add(format_args!(
            "<details class=try data-path=\"{}\" data-method={}><summary>Try it</summary>\
             <p class=quiet>This form needs scripts.</p></details></article>",
            Escaped(path),
            method.to_lowercase()
        ));
    }

    fn examples(&mut self, call: &Call) {
        self.add(format_args!("<div class=examples>"));
        for (language, name) in examples::LANGUAGES {
            // Long lines scroll, also by keyboard.
            self.add(format_args!(
                "<pre class={language} tabindex=0 aria-label=\"Example in {name}\"><code>{}</code></pre>",
                Escaped(&call.example(language))
            ));
        }
        self.add(format_args!("</div>"));
    }

    fn parameters(&mut self, operation: &'d Value) {
        let parameters: Vec<&Value> =
            list(&operation["parameters"]).iter().map(|parameter| self.resolved(parameter)).collect();
        if parameters.is_empty() {
            return;
        }
        let open = if parameters.len() <= 4 { " open" } else { "" };
        self.add(format_args!(
            "<details class=parameters{open}><summary>Parameters ({})</summary><dl>",
            parameters.len()
        ));
        for parameter in parameters {
            let required = if parameter["required"] == true { ", required" } else { "" };
            self.add(format_args!(
                "<dt><code>{}</code> <span class=quiet>{}{required}, {}</span></dt><dd>{}</dd>",
                Escaped(text(&parameter["name"])),
                Escaped(text(&parameter["in"])),
                Type(&parameter["schema"]),
                Prose(text(&parameter["description"]))
            ));
        }
        self.add(format_args!("</dl></details>"));
    }

    fn body(&mut self, body: &Value) {
        if body.is_null() {
            return;
        }
        self.add(format_args!("<details><summary>Body</summary>{}", Prose(text(&body["description"]))));
        self.contents_of(&body["content"]);
        self.add(format_args!("</details>"));
    }

    fn answers(&mut self, operation: &Value) {
        self.add(format_args!("<details><summary>Answers</summary><dl>"));
        for (status, answer) in members(&operation["responses"]) {
            let kind = if status.starts_with('2') { "good" } else { "other" };
            self.add(format_args!(
                "<dt><code class={kind}>{}</code></dt><dd>{}",
                Escaped(status),
                Prose(text(&answer["description"]))
            ));
            self.contents_of(&answer["content"]);
            self.add(format_args!("</dd>"));
        }
        self.add(format_args!("</dl></details>"));
    }

    fn contents_of(&mut self, content: &Value) {
        for (media_type, content) in members(content) {
            self.add(format_args!(
                "<p class=type><code>{}</code> {}</p>",
                Escaped(media_type),
                Type(&content["schema"])
            ));
        }
    }

    fn schemas(&mut self) {
        self.add(format_args!("<section aria-labelledby=schemas><h2 id=schemas>Schemas</h2>"));
        for (name, schema) in members(&self.document["components"]["schemas"]) {
            self.add(format_args!("<article class=schema id=schema-{0}><h3>{0}</h3>", Escaped(name)));
            self.add(format_args!("{}", Prose(text(&schema["description"]))));
            let words: Vec<_> = list(&schema["enum"]).iter().map(text).collect();
            // The description lists them already where each has one.
            if !words.is_empty() && !text(&schema["description"]).contains("\n- ") {
                self.add(format_args!("<p><code>{}</code></p>", Escaped(&words.join(" | "))));
            }
            let mut properties = members(&schema["properties"]).peekable();
            if properties.peek().is_some() {
                self.add(format_args!("<dl>"));
                for (member, schema) in properties {
                    self.add(format_args!(
                        "<dt><code>{}</code> <span class=quiet>{}</span></dt><dd>{}</dd>",
                        Escaped(member),
                        Type(schema),
                        Prose(text(&schema["description"]))
                    ));
                }
                self.add(format_args!("</dl>"));
            }
            self.add(format_args!("</article>"));
        }
        self.add(format_args!("</section>"));
    }

    /// A part of the document, or that which it refers to.
    fn resolved(&self, part: &'d Value) -> &'d Value {
        let pointer = text(&part["$ref"]).trim_start_matches('#');
        if pointer.is_empty() { part } else { self.document.pointer(pointer).unwrap_or(part) }
    }
}

/// Paths, methods and operations, in the order of the document.
/// Methods, as the contract and as requests write them.
const METHODS: [(&str, &str); 6] = [
    ("get", "GET"),
    ("head", "HEAD"),
    ("post", "POST"),
    ("patch", "PATCH"),
    ("delete", "DELETE"),
    ("options", "OPTIONS"),
];

fn operations(document: &Value) -> impl Iterator<Item = (&str, &'static str, &Value)> {
    members(&document["paths"]).flat_map(|(path, item)| {
        METHODS.into_iter().filter_map(move |(key, method)| Some((path, method, item.get(key)?)))
    })
}

/// The group of an operation; the last one where it names none.
fn tag_of(operation: &Value) -> &str {
    let tag = text(&operation["tags"][0]);
    GROUPS.iter().map(|(known, ..)| *known).find(|known| *known == tag).unwrap_or("service")
}

fn members(object: &Value) -> impl Iterator<Item = (&str, &Value)> {
    object.as_object().into_iter().flatten().map(|(name, value)| (name.as_str(), value))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[][..], Vec::as_slice)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_every_path_and_option_and_loads_nothing_from_elsewhere() {
        let document = crate::http::router::openapi();
        let page = render(&document);
        for path in document.paths.paths.keys() {
            assert!(page.contains(&format!("<code>{path}</code>")), "{path}");
        }
        for spec in crate::wire::SPECS {
            assert!(page.contains(&format!("<dt><code>{}</code>", spec.name)), "{}", spec.name);
        }
        for loads in ["src=", "href="] {
            let loaded = page.split(loads).skip(1).map(|rest| rest.trim_start_matches('"'));
            for target in loaded {
                assert!(target.starts_with(['/', '#']) && !target.starts_with("//"), "{target:.40}");
            }
        }
        assert!(!page.contains("style=") && !page.contains("onclick"), "the policy allows no inline code");
    }

    #[test]
    fn every_link_inside_of_the_page_leads_somewhere() {
        let page = render(&crate::http::router::openapi());
        let targets: Vec<&str> =
            page.split("href=#").skip(1).filter_map(|rest| rest.split(['>', ' ']).next()).collect();
        assert!(targets.len() > 100, "{}", targets.len());
        for target in targets {
            assert!(
                page.contains(&format!(" id={target}>")) || page.contains(&format!(" id={target} ")),
                "{target}"
            );
        }
    }
}
