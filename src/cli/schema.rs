//! The schemas in `configs/schema`, and the reference in `docs/configuration.md`, are made from the types that read the
//! files.
//!
//! `NMT_WRITE=1 cargo test --release schema` writes them anew.

use super::config::Config;
use super::shell::{CONFIG_SCHEMA, SCENE_SCHEMA};
use crate::scene::SceneFile;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// The part of a reference page that is made here.
const MARKS: [&str; 2] = ["<!-- made from the types: begin -->", "<!-- end -->"];

/// Plain text of a documentation comment: no links between items, no escaped brackets.
fn plain(text: &str) -> String {
    let mut out = text
        .replace("[`", "`")
        .replace("`]", "`")
        .replace("Self::", "")
        .replace("\\[", "[")
        .replace("\\]", "]");
    if let Some(at) = out.find("\n\n# ") {
        out.truncate(at);
    }
    out.split("\n\n")
        .map(|p| p.replace('\n', " "))
        .collect::<Vec<_>>()
        .join("\n\n")
}

/// Rewrites every description of a schema as [`plain`] text, and takes out what only Rust knows.
fn tidy(value: &mut Value) {
    match value {
        Value::Object(object) => {
            for (key, value) in object.iter_mut() {
                match value {
                    Value::String(text) if key == "description" => *text = plain(text),
                    other => tidy(other),
                }
            }
            if object.get("format").is_some_and(|f| f != "uri") {
                object.remove("format");
            }
        }
        Value::Array(list) => list.iter_mut().for_each(tidy),
        _ => {}
    }
}

/// Prose in lines of at most 120 letters, the first behind a mark and the others as far in.
fn wrapped(mark: &str, text: &str) -> String {
    let indent = " ".repeat(mark.chars().count());
    let mut lines = vec![mark.to_owned()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("one line or more");
        let fresh = line.trim().is_empty() || *line == mark;
        if !fresh && line.chars().count() + 1 + word.chars().count() > 120 {
            lines.push(format!("{indent}{word}"));
        } else {
            *line += if fresh { "" } else { " " };
            *line += word;
        }
    }
    lines.join("\n")
}

fn scene_schema() -> Value {
    let mut schema = schemars::schema_for!(SceneFile).to_value();
    tidy(&mut schema);
    schema["title"] = json!("nmt scene file");
    schema
}

/// A configuration may extend another one; only one that does not must say everything.
fn config_schema() -> Value {
    let mut schema = schemars::schema_for!(Config).to_value();
    tidy(&mut schema);
    schema["title"] = json!("nmt configuration");
    let mut tables = Map::new();
    for (key, name) in [
        ("synth", "SynthConfig"),
        ("dataset", "DatasetConfig"),
        ("train", "TrainConfig"),
    ] {
        if let Some(required) = schema["$defs"][name]
            .as_object_mut()
            .and_then(|def| def.remove("required"))
        {
            tables.insert(key.to_owned(), json!({ "required": required }));
        }
    }
    let object = schema.as_object_mut().unwrap();
    let required = object.remove("required").unwrap();
    object["properties"]["extends"] = json!({
        "type": "string",
        "description": "A file in the same folder, whose every value holds that this one does not give."
    });
    object.insert("if".to_owned(), json!({ "required": ["extends"] }));
    object.insert("then".to_owned(), json!({}));
    object.insert("else".to_owned(), json!({ "required": required, "properties": tables }));
    schema
}

/// The name of the definition that a property refers to.
fn reference_of(property: &Value) -> Option<&str> {
    let direct = property["$ref"].as_str();
    let among = |key: &str| property[key].as_array()?.iter().find_map(|p| p["$ref"].as_str());
    direct
        .or_else(|| among("anyOf"))
        .or_else(|| among("allOf"))
        .or_else(|| property["items"]["$ref"].as_str())
        .or_else(|| property["additionalProperties"]["$ref"].as_str())
        .map(|path| path.trim_start_matches("#/$defs/"))
}

/// The type of a property in words.
fn kind(property: &Value) -> String {
    let simple = |name: &str| {
        match name {
            "integer" => "whole number",
            "array" => "list",
            "object" => "table",
            other => other,
        }
        .to_owned()
    };
    if let Some(name) = reference_of(property) {
        let list = if property["type"] == "array" { "list of " } else { "" };
        return format!("{list}[{name}](#{})", name.to_lowercase());
    }
    match &property["type"] {
        Value::String(name) if name == "array" => match property["items"]["type"].as_str() {
            Some(item) => format!("list of {}s", simple(item)),
            None => "list".to_owned(),
        },
        Value::String(name) => simple(name),
        Value::Array(names) => {
            let names = names.iter().filter_map(Value::as_str).filter(|name| *name != "null");
            names.map(simple).collect::<Vec<_>>().join(" or ")
        }
        _ => "value".to_owned(),
    }
}

/// A table of fields.
fn fields(object: &Value) -> String {
    let Some(properties) = object["properties"].as_object() else {
        return String::new();
    };
    let mut out = "| field | type | default | |\n|---|---|---|---|\n".to_owned();
    let required: Vec<&str> = object["required"]
        .as_array()
        .map(|list| list.iter().filter_map(Value::as_str).collect())
        .unwrap_or_default();
    for (name, property) in properties.iter().filter(|(_, p)| p.get("const").is_none()) {
        let default = match property.get("default") {
            Some(Value::Null) | None if required.contains(&name.as_str()) => "required".to_owned(),
            Some(Value::Null) | None => "–".to_owned(),
            Some(Value::Object(_)) => "see there".to_owned(),
            Some(value) => format!("`{value}`"),
        };
        let text = property["description"].as_str().unwrap_or("").replace("\n\n", " ");
        out += &format!(
            "| `{name}` | {} | {default} | {} |\n",
            kind(property),
            text.replace('|', "\\|")
        );
    }
    out + "\n"
}

/// One definition: its fields, or its values.
fn definition(name: &str, def: &Value) -> String {
    let mut out = format!("### {name}\n\n");
    if let Some(text) = def["description"].as_str() {
        let paragraphs: Vec<String> = text.split("\n\n").map(|p| wrapped("", p)).collect();
        out += &format!("{}\n\n", paragraphs.join("\n\n"));
    }
    for variant in def["oneOf"].as_array().into_iter().flatten() {
        let text = variant["description"].as_str().unwrap_or("").replace("\n\n", " ");
        let tag = variant["properties"]["law"]["const"].as_str();
        let value = variant["const"]
            .as_str()
            .or(tag)
            .or(variant["title"].as_str())
            .unwrap_or("");
        match tag {
            // A law has fields of its own.
            Some(_) => {
                out += &format!("{}\n\n", wrapped("", &format!("`law = \"{value}\"`: {text}")));
                let own = variant["properties"].as_object().is_some_and(|p| p.len() > 1);
                out += &if own { fields(variant) } else { String::new() };
            }
            None => out += &format!("{}\n", wrapped("- ", &format!("`\"{value}\"`: {text}"))),
        }
    }
    for value in def["enum"].as_array().into_iter().flatten() {
        out += &format!("- `{value}`\n");
    }
    out += &fields(def);
    out.trim_end().to_owned() + "\n\n"
}

fn reference(schema: &Value, title: &str, required: &Value) -> String {
    let mut top = schema.clone();
    top["required"] = required.clone();
    let mut out = format!("## {title}\n\n{}", fields(&top));
    for (name, def) in schema["$defs"].as_object().into_iter().flatten() {
        let mut def = def.clone();
        // What a table must say where nothing is extended.
        let key = match name.as_str() {
            "SynthConfig" => "synth",
            "DatasetConfig" => "dataset",
            "TrainConfig" => "train",
            _ => "",
        };
        if let Some(required) = schema["else"]["properties"][key].get("required") {
            def["required"] = required.clone();
        }
        out += &definition(name, &def);
    }
    out
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Whether files are to be written rather than compared.
fn write() -> bool {
    std::env::var_os("NMT_WRITE").is_some()
}

#[test]
fn schemas_are_those_of_the_types() {
    for (name, schema, stands) in [
        ("config", config_schema(), CONFIG_SCHEMA),
        ("scene", scene_schema(), SCENE_SCHEMA),
    ] {
        let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        if write() {
            std::fs::write(path(&format!("configs/schema/{name}.schema.json")), &text).unwrap();
        } else {
            assert!(
                text == stands,
                "configs/schema/{name}.schema.json is stale: NMT_WRITE=1 writes it"
            );
        }
    }
}

/// The page holds the reference. Control: a page without it does not.
#[test]
fn the_reference_page_is_that_of_the_schemas() {
    let (config, scene) = (config_schema(), scene_schema());
    let made = reference(&config, "Configurations", &config["else"]["required"])
        + &reference(&scene, "Scene files", &json!([]));
    let page = path("docs/configuration.md");
    let text = std::fs::read_to_string(&page).unwrap();
    let (before, rest) = text
        .split_once(MARKS[0])
        .expect("the page has a place for the reference");
    let (stands, after) = rest.split_once(MARKS[1]).expect("the place has an end");
    if write() {
        let whole = format!("{before}{}\n\n{}\n\n{}{after}", MARKS[0], made.trim_end(), MARKS[1]);
        std::fs::write(&page, whole).unwrap();
    } else {
        assert!(
            stands.trim() == made.trim_end(),
            "docs/configuration.md is stale: NMT_WRITE=1 writes it"
        );
        assert!(before.trim() != made.trim_end() && made.contains("learning_rate") && made.contains("look_at"));
    }
}

/// Every shipped file names its schema in the first line, for editors that know JSON Schema.
#[test]
fn shipped_files_name_their_schema() {
    let mut count = 0;
    for (folder, line) in [
        ("configs", "#:schema schema/config.schema.json\n"),
        ("configs/scenes", "#:schema ../schema/scene.schema.json\n"),
    ] {
        for entry in std::fs::read_dir(path(folder)).unwrap() {
            let file = entry.unwrap().path();
            if file.extension().is_some_and(|e| e == "toml") {
                assert!(
                    std::fs::read_to_string(&file).unwrap().starts_with(line),
                    "{}",
                    file.display()
                );
                count += 1;
            }
        }
    }
    assert!(count >= 8);
}
