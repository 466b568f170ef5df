//! A schema in a few words, with a link where it has a name.

use std::fmt::{Display, Formatter, Result};

use serde_json::Value;

use super::{list, text};
use crate::wire::Escaped;

pub(super) struct Type<'s>(pub(super) &'s Value);

impl Display for Type<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
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
        if schema["enum"].is_array() {
            let words: Vec<_> = list(&schema["enum"]).iter().map(text).collect();
            return write!(f, "{}", Escaped(&words.join(" | ")));
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
