//! Files: lines as JSON, whole or not there.

use std::path::Path;

use hooke_harness::output::safe;
use serde::Serialize;

/// Writes a list as JSON, a line per item.
pub(crate) fn json(path: &Path, rows: &[impl Serialize]) -> Result<(), String> {
    let lines: Result<Vec<String>, _> = rows.iter().map(serde_json::to_string).collect();
    let text = format!("[\n{}\n]\n", lines.map_err(|error| error.to_string())?.join(",\n"));
    safe::write_file(path, |out| out.write_all(text.as_bytes())).map_err(|error| error.to_string())
}
