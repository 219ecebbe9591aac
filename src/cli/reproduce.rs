//! `valet reproduce`: the thesis' tables and figures beside the thesis' own numbers.
//!
//! Runs experiments and writes what they found: lines or JSON rows on stdout, and with `--out` one CSV file a table, each
//! figure as SVG and PNG, and one HTML page.

use super::exit::Failure;
use super::output::Output;
use crate::experiments::{EXPERIMENTS, Experiment, Findings, Row};
use crate::report::page::Page;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The thesis' tables and figures beside the thesis' own numbers.
#[derive(Debug, Default, clap::Args)]
pub(super) struct Arguments {
    /// What to run: one of the names of the list, or `all`.
    #[arg(value_parser = names(), required = true)]
    what: String,
    /// Folder for CSV files, plots (SVG and PNG) and the page; made where it does not exist.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object a row on stdout.
    #[arg(long)]
    json: bool,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn names() -> clap::builder::PossibleValuesParser {
    EXPERIMENTS.iter().map(|experiment| experiment.name).chain(["all"]).collect::<Vec<_>>().into()
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut output = Output::new(arguments.json);
    let chosen: Vec<&Experiment> =
        EXPERIMENTS.iter().filter(|experiment| arguments.what == "all" || experiment.name == arguments.what).collect();
    let progress = progress_bar(chosen.len());
    let mut page = Page::new(
        format!("valet reproduce {}", arguments.what),
        &format!("Seed {}, valet {}.", arguments.seed, env!("CARGO_PKG_VERSION")),
    );
    let file = arguments.out.as_ref().map(|folder| folder.join(format!("{}.html", arguments.what)));
    for experiment in chosen {
        progress.set_message(experiment.name);
        let findings = (experiment.run)(arguments.seed).map_err(Failure::fault)?;
        progress.suspend(|| print(&mut output, &findings))?;
        if let Some(folder) = &arguments.out {
            write_files(folder, &findings)?;
        }
        write_section(&mut page, experiment, &findings)?;
        if let Some(file) = &file {
            // Whoever ends a long run has the page of what is done.
            page.save(file).map_err(Failure::fault)?;
        }
        progress.inc(1);
    }
    progress.finish_and_clear();
    file.map_or(Ok(()), |file| output.line(format!("Written: {}", file.display())))
}

fn progress_bar(steps: usize) -> ProgressBar {
    let bar = ProgressBar::new(steps as u64);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} [{bar:30}] {pos}/{len} {elapsed}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn print(output: &mut Output, findings: &Findings) -> Result<(), Failure> {
    for row in &findings.rows {
        output.event(row)?;
    }
    for table in tables(findings) {
        output.line(format!("Table {table}"))?;
        for row in findings.rows.iter().filter(|row| row.table() == table) {
            let cells = row.cells().filter(|(name, _)| !matches!(*name, "event" | "table"));
            let words: Vec<String> = cells.map(|(name, value)| format!("{name} {}", words(value))).collect();
            output.line(format!("  {}", words.join(", ")))?;
        }
    }
    Ok(())
}

/// The tables of the findings, each once, in order.
fn tables(findings: &Findings) -> Vec<&str> {
    let mut tables: Vec<&str> = findings.rows.iter().map(Row::table).collect();
    tables.dedup();
    tables
}

/// A value for people: four significant digits are more than any of these numbers deserves.
fn words(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            if number != 0.0 && number.abs() < 1e-3 { format!("{number:.2e}") } else { format!("{number:.3}") }
        }
        other => other.to_string(),
    }
}

fn head(rows: &[&Row]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (name, _) in rows.iter().flat_map(|row| row.cells()) {
        if !matches!(name, "event" | "table") && !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

fn write_files(folder: &Path, findings: &Findings) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::Configuration(format!("cannot make folder {}: {error}", folder.display())))?;
    for table in tables(findings) {
        let rows: Vec<&Row> = findings.rows.iter().filter(|row| row.table() == table).collect();
        let stem = if table.starts_with(|letter: char| letter.is_ascii_digit()) { "table-" } else { "" };
        let file = folder.join(format!("{stem}{table}.csv"));
        write_csv(&file, &rows).map_err(|error| Failure::Fault(format!("cannot write {}: {error}", file.display())))?;
    }
    for drawing in &findings.drawings {
        drawing.figure.save(folder, &drawing.stem).map_err(Failure::fault)?;
    }
    Ok(())
}

fn write_csv(file: &Path, rows: &[&Row]) -> Result<(), csv::Error> {
    let names = head(rows);
    let mut writer = csv::Writer::from_path(file)?;
    writer.write_record(&names)?;
    for row in rows {
        let exact = |value: &Value| value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
        writer.write_record(names.iter().map(|name| row.value(name).map(exact).unwrap_or_default()))?;
    }
    writer.flush()?;
    Ok(())
}

fn write_section(page: &mut Page, experiment: &Experiment, findings: &Findings) -> Result<(), Failure> {
    page.section(experiment.title);
    for remark in &findings.remarks {
        page.paragraph(remark);
    }
    for drawing in &findings.drawings {
        page.figure(&drawing.figure, &drawing.caption).map_err(Failure::fault)?;
    }
    for table in tables(findings) {
        let rows: Vec<&Row> = findings.rows.iter().filter(|row| row.table() == table).collect();
        let names = head(&rows);
        let cells = |row: &&Row| names.iter().map(|name| row.value(name).map(words).unwrap_or_default()).collect();
        let body: Vec<Vec<String>> = rows.iter().map(cells).collect();
        let head: Vec<&str> = names.iter().map(String::as_str).collect();
        page.table(&format!("Table {table}"), &head, &body);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_written_with_every_name_once() {
        let rows = [
            Row::of("x").with("method", "adam").with("error", 1.5),
            Row::of("x").with("method", "sgd").with("more", 2),
        ];
        assert_eq!(head(&rows.iter().collect::<Vec<_>>()), ["method", "error", "more"]);
        let folder = tempfile::tempdir().unwrap();
        let findings = Findings { rows: rows.to_vec(), ..Findings::default() };
        write_files(folder.path(), &findings).unwrap();
        let text = std::fs::read_to_string(folder.path().join("x.csv")).unwrap();
        assert_eq!(text, "method,error,more\nadam,1.5,\nsgd,,2\n");
    }
}
