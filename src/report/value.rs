//! Numbers and texts out of JSON that may hold anything.

use serde_json::Value;

/// The first of some keys that holds a number.
pub fn number(value: &Value, keys: &[&str]) -> Option<f64> {
    keys.iter().find_map(|key| value.get(key)?.as_f64())
}

/// Memory of a pixel that a row tells of \[bits\]: infinite where it grows with the scene, which rows say by null; none
/// where nothing is said.
pub fn bits(row: &Value) -> Option<f64> {
    match row.get("bits_per_pixel")? {
        Value::Null => Some(f64::INFINITY),
        bits => bits.as_f64(),
    }
}

/// The first of some keys that holds a text.
pub fn text<'a>(value: &'a Value, keys: &[&str]) -> Option<&'a str> {
    keys.iter().find_map(|key| value.get(key)?.as_str())
}

/// The list under a key; empty where there is none.
pub fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// All finite numbers of the list under the first of some keys that holds a list.
pub fn numbers(value: &Value, keys: &[&str]) -> Vec<f64> {
    let found = keys.iter().find_map(|key| value.get(key)?.as_array());
    found.map_or(Vec::new(), |list| list.iter().filter_map(Value::as_f64).collect())
}

/// A number that may have been NaN: null stands for it where `nonfinite` values are counted beside it, and for nothing
/// where none are.
pub fn number_or_nan(value: &Value, key: &str, nonfinite: bool) -> Option<f64> {
    match value.get(key) {
        Some(Value::Null) if nonfinite => Some(f64::NAN),
        found => found.and_then(Value::as_f64),
    }
}

/// A value that is neither a list nor an object, as a person reads it.
pub fn scalar(value: &Value) -> Option<String> {
    match value {
        Value::Null => Some("–".to_owned()),
        Value::Bool(b) => Some(if *b { "yes" } else { "no" }.to_owned()),
        Value::Number(n) => match (n.as_u64(), n.as_f64()) {
            (Some(n), _) => Some(i64::try_from(n).map_or_else(|_| n.to_string(), super::html::thousands)),
            (None, x) => Some(super::html::number(x.unwrap_or(f64::NAN))),
        },
        Value::String(s) => Some(s.clone()),
        Value::Array(_) | Value::Object(_) => None,
    }
}

/// A key as words: "seconds_accumulate" is "seconds accumulate".
pub fn words(key: &str) -> String {
    key.replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn whatever_the_types() {
        let value =
            json!({ "a": 1, "b": "x", "c": null, "d": [1, "y", null, 2.5], "e": { "a": 2 }, "f": -3, "g": u64::MAX });
        assert_eq!(
            (
                number(&value, &["b", "a"]),
                number(&value, &["c"]),
                number(&value, &["z"])
            ),
            (Some(1.0), None, None)
        );
        assert_eq!((text(&value, &["a", "b"]), text(&value, &["d"])), (Some("x"), None));
        assert_eq!(
            (
                list(&value, "d").len(),
                list(&value, "e").len(),
                numbers(&value, &["a", "d"])
            ),
            (4, 0, vec![1.0, 2.5])
        );
        assert!(number_or_nan(&value, "c", true).unwrap().is_nan());
        assert_eq!(
            (
                number_or_nan(&value, "c", false),
                number_or_nan(&value, "a", true),
                number_or_nan(&value, "z", true)
            ),
            (None, Some(1.0), None)
        );
        assert_eq!(
            ["a", "b", "c", "f", "g"].map(|k| scalar(&value[k]).unwrap()),
            ["1", "x", "–", "-3", "18446744073709551615"]
        );
        assert!(scalar(&value["d"]).is_none());
        // Not an object at all.
        assert_eq!((number(&json!([1]), &["a"]), list(&json!("x"), "a").len()), (None, 0));
    }
}
