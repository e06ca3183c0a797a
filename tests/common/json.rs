//! A TOML document as JSON, for a validator of JSON Schemas.

use serde_json::Value;
use toml::de::{DeTable, DeValue};

/// The document of a text that is TOML.
pub fn document(text: &str) -> Option<Value> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    Some(table(DeTable::parse(text).ok()?.get_ref()))
}

fn table(entries: &DeTable<'_>) -> Value {
    let entries = entries
        .iter()
        .map(|(key, item)| (key.get_ref().to_string(), value(item.get_ref())));
    Value::Object(entries.collect())
}

fn value(item: &DeValue<'_>) -> Value {
    match item {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Boolean(is) => Value::Bool(*is),
        // JSON has no infinities; as null they are no number.
        DeValue::Float(float) => float.as_str().parse::<f64>().ok().into(),
        // Of whatever length and base it is a number.
        DeValue::Integer(integer) => {
            let whole = i128::from_str_radix(integer.as_str(), integer.radix());
            whole.map_or(1e300, |whole| whole as f64).into()
        }
        DeValue::Array(items) => items.iter().map(|item| value(item.get_ref())).collect(),
        DeValue::Table(entries) => table(entries),
        DeValue::Datetime(time) => Value::String(time.to_string()),
    }
}
