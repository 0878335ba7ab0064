//! `nmt methods`

use super::Verdict;
use super::ui::{Ui, table};
use crate::oit::{all_names, parse, source};
use clap::Args;
use serde_json::{Value, json};

#[derive(Args)]
pub struct Methods {
    /// Print the table as Markdown.
    #[arg(long)]
    markdown: bool,
}

/// What stands over the columns.
const HEAD: [&str; 7] = ["method", "bits/pixel", "colour", "passes", "needs", "order", "source"];

impl Methods {
    pub fn execute(self, ui: &Ui) -> anyhow::Result<Verdict> {
        if ui.json() {
            ui.print_json("methods", json_rows()?)?;
            return Ok(Verdict::Fine);
        }
        let rows = rows()?;
        if self.markdown {
            let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
            let head = line(&HEAD.map(str::to_owned)) + &"|---".repeat(HEAD.len()) + "|\n";
            let named = |row: &Vec<String>| {
                let mut row = row.clone();
                row[0] = format!("`{}`", row[0]);
                line(&row)
            };
            ui.print(&(head + &rows.iter().map(named).collect::<String>()))?;
        } else {
            let mut all = vec![HEAD.map(str::to_owned).to_vec()];
            all.extend(rows);
            ui.print(&table(&all))?;
        }
        Ok(Verdict::Fine)
    }
}

fn rows() -> anyhow::Result<Vec<Vec<String>>> {
    let row = |name: String| {
        let capabilities = parse(&name)?.capabilities();
        Ok(vec![
            capabilities.bits_text(),
            capabilities.colour_bits_per_pixel.to_string(),
            capabilities.geometry_passes.to_string(),
            capabilities.needs.list(),
            if capabilities.order_dependent { "counts" } else { "-" }.to_owned(),
            source(&name).unwrap_or("-").to_owned(),
        ])
        .map(|mut cells| {
            cells.insert(0, name);
            cells
        })
    };
    all_names().into_iter().map(row).collect()
}

fn json_rows() -> anyhow::Result<Vec<Value>> {
    let row = |name: String| {
        let mut value = json!(parse(&name)?.capabilities());
        value["method"] = name.as_str().into();
        value["source"] = source(&name).into();
        Ok(value)
    };
    all_names().into_iter().map(row).collect()
}
