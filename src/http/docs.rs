//! The contract as a page for people, rendered once when the service starts.

use std::fmt::Write as _;

use axum::http::header;
use axum::response::{IntoResponse as _, Response};
use serde_json::Value;
use utoipa::openapi::OpenApi;

use super::state::State;
use crate::wire::Escaped;

/// `/docs`.
pub(super) async fn show(state: State) -> Response {
    ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], state.docs.clone()).into_response()
}

/// The page.
pub(super) fn render(document: &OpenApi) -> String {
    // The document is made of types that all have a form in JSON.
    let document = serde_json::to_value(document).unwrap_or_default();
    let mut page = Page(String::new());
    page.add(format_args!(
        "<!doctype html><html lang=en><head><meta charset=utf-8><meta name=viewport content=\"width=device-width\">\
         <title>Meshmend API</title><link rel=stylesheet href=/style.css></head><body><main><h1>Meshmend API</h1>\
         <p>{}</p><p>The contract for programs: <a href=/openapi.yaml>openapi.yaml</a> or \
         <a href=/openapi.json>openapi.json</a>. \
         <a href=/>Try it with a file</a>.</p>",
        Escaped(text(&document["info"]["description"]))
    ));
    page.contents(&document);
    for (path, method, operation) in operations(&document) {
        page.operation(path, method, operation);
    }
    page.add(format_args!("<h2 id=schemas>Schemas</h2>"));
    for (name, schema) in members(&document["components"]["schemas"]) {
        page.schema(name, schema);
    }
    page.add(format_args!("</main></body></html>"));
    page.0
}

struct Page(String);

impl Page {
    fn add(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.0.write_fmt(arguments);
    }

    fn contents(&mut self, document: &Value) {
        self.add(format_args!("<nav><ul>"));
        for (path, method, operation) in operations(document) {
            let (id, summary) = (text(&operation["operationId"]), text(&operation["summary"]));
            self.add(format_args!(
                "<li><a href=#{}><code>{method} {}</code></a> {}</li>",
                Escaped(id),
                Escaped(path),
                Escaped(summary)
            ));
        }
        self.add(format_args!("</ul></nav>"));
    }

    fn operation(&mut self, path: &str, method: &str, operation: &Value) {
        let id = text(&operation["operationId"]);
        self.add(format_args!("<h2 id={}><code>{method} {}</code></h2>", Escaped(id), Escaped(path)));
        self.add(format_args!("<p><strong>{}</strong></p>", Escaped(text(&operation["summary"]))));
        self.add(format_args!("<p>{}</p>", Escaped(text(&operation["description"]))));
        let parameters = operation["parameters"].as_array().map_or(&[][..], Vec::as_slice);
        if !parameters.is_empty() {
            self.add(format_args!("<h3>Parameters</h3><dl>"));
            for parameter in parameters {
                self.add(format_args!(
                    "<dt><code>{}</code> <small>{}, {}</small></dt><dd>{}</dd>",
                    Escaped(text(&parameter["name"])),
                    Escaped(text(&parameter["in"])),
                    Type(&parameter["schema"]),
                    Escaped(text(&parameter["description"]))
                ));
            }
            self.add(format_args!("</dl>"));
        }
        if let Some(body) = operation.get("requestBody") {
            self.add(format_args!("<h3>Body</h3><p>{}</p>", Escaped(text(&body["description"]))));
            self.contents_of(&body["content"]);
        }
        self.add(format_args!("<h3>Answers</h3><dl>"));
        for (status, answer) in members(&operation["responses"]) {
            self.add(format_args!("<dt><code>{}</code></dt><dd>", Escaped(status)));
            for line in text(&answer["description"]).lines() {
                self.add(format_args!("<p>{}</p>", Escaped(line)));
            }
            self.contents_of(&answer["content"]);
            self.add(format_args!("</dd>"));
        }
        self.add(format_args!("</dl>"));
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

    fn schema(&mut self, name: &str, schema: &Value) {
        self.add(format_args!("<h3 id=schema-{0}>{0}</h3>", Escaped(name)));
        self.add(format_args!("<p>{}</p>", Escaped(text(&schema["description"]))));
        let words = schema["enum"].as_array().map_or(&[][..], Vec::as_slice);
        if !words.is_empty() {
            let words: Vec<_> = words.iter().map(text).collect();
            self.add(format_args!("<p><code>{}</code></p>", Escaped(&words.join(" | "))));
        }
        self.add(format_args!("<dl>"));
        for (member, schema) in members(&schema["properties"]) {
            self.add(format_args!(
                "<dt><code>{}</code> <small>{}</small></dt><dd>{}</dd>",
                Escaped(member),
                Type(schema),
                Escaped(text(&schema["description"]))
            ));
        }
        self.add(format_args!("</dl>"));
    }
}

/// Paths, methods and operations, in the order of the document.
fn operations(document: &Value) -> impl Iterator<Item = (&str, &'static str, &Value)> {
    members(&document["paths"]).flat_map(|(path, item)| {
        [("get", "GET"), ("post", "POST"), ("delete", "DELETE")]
            .into_iter()
            .filter_map(move |(key, method)| Some((path, method, item.get(key)?)))
    })
}

fn members(object: &Value) -> impl Iterator<Item = (&str, &Value)> {
    object.as_object().into_iter().flatten().map(|(name, value)| (name.as_str(), value))
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

/// A schema in a few words, with a link where it has a name.
struct Type<'s>(&'s Value);

impl std::fmt::Display for Type<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let schema = self.0;
        if let Some(name) = text(&schema["$ref"]).rsplit('/').next().filter(|name| !name.is_empty()) {
            return write!(f, "<a href=#schema-{0}>{0}</a>", Escaped(name));
        }
        for key in ["oneOf", "allOf", "anyOf"] {
            if let Some(choices) = schema[key].as_array() {
                for (at, choice) in choices.iter().enumerate() {
                    write!(f, "{}{}", if at == 0 { "" } else { " or " }, Type(choice))?;
                }
                return Ok(());
            }
        }
        if let Some(words) = schema["enum"].as_array() {
            let words: Vec<_> = words.iter().map(text).collect();
            return f.write_str(&words.join(" | "));
        }
        let names = match &schema["type"] {
            Value::Array(names) => names.iter().map(text).collect::<Vec<_>>().join(" or "),
            name => text(name).to_owned(),
        };
        write!(f, "{}", Escaped(&names))?;
        match text(&schema["type"]) {
            "array" => write!(f, " of {}", Type(&schema["items"])),
            _ if text(&schema["format"]) == "binary" => f.write_str(" of bytes"),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_names_every_path_and_loads_nothing_from_elsewhere() {
        let document = crate::http::router::openapi();
        let page = render(&document);
        for path in document.paths.paths.keys() {
            assert!(page.contains(path.as_str()), "{path}");
        }
        assert!(!page.contains("src=") && !page.contains("//"), "no outside host");
    }
}
