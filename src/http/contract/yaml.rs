//! The document as YAML that every reader takes for the same.

use utoipa::openapi::OpenApi;

/// Words that readers of YAML 1.1 take for booleans, which the writer of YAML 1.2 leaves bare.
const BOOLEANS: &[&str] = &["y", "n", "yes", "no", "on", "off"];

/// `document` as YAML, in which `off` and `no` are texts to readers of YAML 1.1 too, and bytes stand first among what a
/// request may hold: generators of clients take the first.
pub(in crate::http) fn yaml(document: &OpenApi) -> String {
    // The document is made of types that all have a form in YAML.
    meshes_first(&quoted(&document.to_yaml().unwrap_or_default()))
}

/// `yaml` with the content `application/json` of each request body behind its other contents.
fn meshes_first(yaml: &str) -> String {
    let mut out = String::with_capacity(yaml.len());
    let mut held = String::new();
    // How far the request body, and the list of its contents, are indented.
    let (mut body, mut contents, mut is_held) = (None::<usize>, None::<usize>, false);
    for line in yaml.lines() {
        let content = line.trim_start();
        let indent = line.len() - content.len();
        if !content.is_empty() {
            if contents.is_some_and(|contents| indent <= contents) {
                out.push_str(&std::mem::take(&mut held));
                (contents, is_held) = (None, false);
            }
            if body.is_some_and(|body| indent <= body) {
                body = None;
            }
            match (body, contents) {
                (_, Some(contents)) if indent == contents + 2 => is_held = content == "application/json:",
                (Some(body), None) if indent == body + 2 && content == "content:" => contents = Some(indent),
                (None, _) if content == "requestBody:" => body = Some(indent),
                _ => {}
            }
        }
        let to = if is_held { &mut held } else { &mut out };
        to.push_str(line);
        to.push('\n');
    }
    out.push_str(&held);
    out
}

/// `yaml` with every bare word of [`BOOLEANS`] in quotes, as an item, a value or a key.
fn quoted(yaml: &str) -> String {
    let mut out = String::with_capacity(yaml.len() + 1024);
    // Text blocks are at least that much indented; what stands in them is no item, value or key.
    let mut block = None;
    for line in yaml.lines() {
        let indent = line.len() - line.trim_start().len();
        if !line.is_empty() && block.is_some_and(|least| indent < least) {
            block = None;
        }
        if block.is_none() {
            let is_block = [": |", ": |-", ": |+", ": >", ": >-"].iter().any(|end| line.ends_with(end));
            block = is_block.then_some(indent + 1);
            out.push_str(&quoted_line(line));
        } else {
            out.push_str(line);
        }
        out.push('\n');
    }
    out
}

fn quoted_line(line: &str) -> String {
    let content = line.trim_start_matches([' ', '-']);
    let (head, content) = line.split_at(line.len() - content.len());
    let (key, value) = match content.split_once(": ") {
        Some((key, value)) => (key, Some(value)),
        None => (content.strip_suffix(':').unwrap_or(content), None),
    };
    let word = |word: &str| {
        let is_boolean = BOOLEANS.contains(&word.to_ascii_lowercase().as_str());
        if is_boolean { format!("'{word}'") } else { power_of_ten(word).unwrap_or_else(|| word.to_owned()) }
    };
    match value {
        Some(value) => format!("{head}{}: {}", word(key), word(value)),
        None => format!("{head}{}{}", word(key), &content[key.len()..]),
    }
}

/// A number such as `1e30` or `-1e-30` with the point and the sign that YAML 1.1 asks for; without them it is a text there.
fn power_of_ten(word: &str) -> Option<String> {
    let (digits, power) = word.split_once('e')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let (sign, power) = power.strip_prefix('-').map_or(("+", power), |power| ("-", power));
    let is_float = is_number(digits.strip_prefix('-').unwrap_or(digits)) && is_number(power);
    is_float.then(|| format!("{digits}.0e{sign}{power}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_yaml_1_1_takes_for_booleans_is_quoted() {
        let bare = "enum:\n- obj\n- off\n- 'yes'\nno:\n  default: No\n  y: office\n- n: on\n";
        let safe = "enum:\n- obj\n- 'off'\n- 'yes'\n'no':\n  default: 'No'\n  'y': office\n- 'n': 'on'\n";
        assert_eq!(quoted(bare), safe);
        for (bare, safe) in [("1e30", "1.0e+30"), ("-1e30", "-1.0e+30"), ("1e-30", "1.0e-30"), ("1e", "1e")] {
            assert_eq!(quoted(&format!("maximum: {bare}\n")), format!("maximum: {safe}\n"));
        }
    }

    #[test]
    fn bytes_stand_before_json_in_requests_and_nothing_else_moves() {
        let json = "        application/json:\n          schema: a\n";
        let bytes = "        model/stl:\n          schema: b\n";
        let with = |contents: [&str; 2]| {
            let [first, second] = contents;
            let answer = format!("      content:\n{json}{bytes}");
            format!(
                "post:\n    requestBody:\n      content:\n{first}{second}      required: true\n    other:\n{answer}"
            )
        };
        assert_eq!(meshes_first(&with([json, bytes])), with([bytes, json]));
        assert_eq!(meshes_first(&with([bytes, json])), with([bytes, json]));
        let last = format!("    requestBody:\n      content:\n{json}{bytes}");
        assert_eq!(meshes_first(&last), format!("    requestBody:\n      content:\n{bytes}{json}"));
    }

    #[test]
    fn text_blocks_stay_as_they_are() {
        let yaml = "a:\n  description: |-\n    - off\n\n    no: yes\n  b: off\n";
        assert_eq!(quoted(yaml), yaml.replace("b: off", "b: 'off'"));
    }
}
