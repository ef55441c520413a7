//! A report for people, at a terminal.

use std::fmt::Write as _;

use super::{KernelRow, Measured, Pipeline, Report, Spread, Timing};
use crate::Kernel;

impl Report {
    /// The kernels as tables, aligned for a terminal: what they were measured on, times and errors.
    pub fn table(&self) -> String {
        let mut text = self.head();
        let names = ["scene", "stage", "kernel"];
        let mut times = Table::new(vec![Columns::new("", &names)]);
        let mut errors = Table::new(vec![
            Columns::new("", &names),
            Columns::new("wrong pixels", &["solid", "face", "shadow", "mirror"]),
            Columns::new("samples", &["misrounded", "8-bit", "NaN"]),
            Columns::new("f32 steps", &["largest", "mean"]),
            Columns::new("absolute", &["largest", "mean"]),
            Columns::new("in doubt after", &["f64", "double-double"]),
            Columns::new("a row", &["edges", "spans"]),
        ]);
        let mut threads = vec![1];
        threads.extend((self.threads > 1).then_some(self.threads));
        for &count in &threads {
            times.groups.push(Columns::of_threads(
                count,
                &["ms", "min … max", "Mpixel/s", "× fill", "retained"],
            ));
        }
        let mut reason = String::new();
        for row in &self.rows {
            match &row.measured {
                Ok(measured) => {
                    times.rows.push(self.times(row, measured));
                    errors.rows.push(self.errors_of(row, measured));
                }
                Err(refusal) => {
                    times.rows.push(refused(row, 5 * threads.len()));
                    errors.rows.push(refused(row, 15));
                    // One reason is enough.
                    reason = format!("refused: {refusal}\n");
                }
            }
        }
        let _ = write!(
            text,
            "\ntime a frame\n{times}\nerrors against reference, over all frames\n{errors}{reason}{}{}",
            self.renderer_table(),
            self.scaling_table(&threads)
        );
        text
    }

    /// What it was measured on, and how the picture was filled.
    fn head(&self) -> String {
        let machine = &self.machine;
        let commit = machine.commit.as_deref().unwrap_or("unknown commit");
        let mut levels = Vec::new();
        for row in &self.rows {
            let level = row
                .measured
                .as_ref()
                .ok()
                .and_then(|measured| measured.timings.first());
            let level = level.map(|timing| format!("{} {}", row.kernel.name(), timing.simd));
            levels.extend(level.filter(|level| !levels.contains(level)));
        }
        let mut text = format!(
            "firsthit {} ({commit}){} on {}, {} cores, {} {}\nSIMD level: {}\n{} × {} pixels, frames {}..{}\n",
            machine.version,
            if machine.debug_build {
                ", a debug build: its times mean little,"
            } else {
                ""
            },
            machine.cpu,
            machine.cores,
            machine.os,
            machine.architecture,
            levels.join(", "),
            self.size,
            self.size,
            self.frames.start(),
            self.frames.end(),
        );
        let mut counts = vec![1];
        counts.extend((self.threads > 1).then_some(self.threads));
        for (&threads, how) in counts.iter().zip(&self.fills) {
            let fills = self.timings().filter(|timing| timing.threads == threads);
            let medians = fills.map(|timing| timing.fill_ms.median).collect();
            if let Some(fill) = Spread::of(medians) {
                let s = if threads == 1 { "" } else { "s" };
                let _ = writeln!(
                    text,
                    "fill with one colour, where {threads} thread{s} may: {} ms, {} GB/s ({how})",
                    digits(fill.median),
                    digits(self.gb_per_s(fill))
                );
            }
        }
        text
    }

    fn timings(&self) -> impl Iterator<Item = &Timing> {
        let measured = self
            .rows
            .iter()
            .filter_map(|row| row.measured.as_ref().ok());
        measured.flat_map(|measured| &measured.timings)
    }

    fn times(&self, row: &KernelRow, measured: &Measured) -> Vec<String> {
        let mut cells = names(row);
        for timing in &measured.timings {
            cells.extend(time(timing.ms));
            cells.extend([
                digits(self.mpixel_per_s(timing.ms)),
                digits(timing.fill_ratio.median),
                digits(timing.retained_fill_ratio.median),
            ]);
        }
        cells
    }

    fn errors_of(&self, row: &KernelRow, Measured { errors, .. }: &Measured) -> Vec<String> {
        let mut cells = names(row);
        let wrong = errors.wrong_pixels;
        let (all, rightly) = (&errors.all, &errors.decided_rightly);
        cells.extend([wrong.solid, wrong.face, wrong.shadow, wrong.mirror].map(|n| n.to_string()));
        cells.extend([all.wrong, all.eight_bit, all.nans[0]].map(|n| n.to_string()));
        cells.extend([rightly.max_steps.to_string(), digits(rightly.mean_steps())]);
        cells.extend([digits(all.max_abs), digits(all.mean_abs())]);
        // A rung leaves in doubt what the next ones settle.
        let tally = errors.tally;
        cells.push(match row.kernel {
            // f64 is not tried.
            Kernel::Reference => "–".to_owned(),
            _ => (tally.double_double + tally.arbitrary).to_string(),
        });
        cells.push(tally.arbitrary.to_string());
        cells.extend([tally.edges, tally.spans].map(|n| digits(self.per_row(n))));
        cells
    }

    /// The other renderers, as a table that follows those of the kernels; nothing without any.
    fn renderer_table(&self) -> String {
        if self.renderers.is_empty() {
            return String::new();
        }
        let names = ["scene", "stage", "renderer"];
        let wrong = [
            "solid", "face", "shadow", "mirror", "several", "other", "NaN",
        ];
        let mut table = Table::new(vec![
            Columns::new("", &names),
            Columns::new("time a frame", &["ms", "min … max", "× fill"]),
            Columns::new("wrong pixels", &wrong),
            Columns::new("other pixels", &["rounded", "right"]),
            Columns::new("samples", &["8-bit", "largest error"]),
        ]);
        let mut notes = String::new();
        for row in &self.renderers {
            let mut cells = vec![
                row.scene.clone(),
                row.stage.number().to_string(),
                row.renderer.clone(),
            ];
            match &row.measured {
                Ok(measured) => {
                    let (summary, difference) = (&measured.summary, &measured.difference);
                    let decisions = summary.wrong_decisions;
                    cells.extend(time(measured.ms));
                    cells.push(digits(measured.fill_ratio.median));
                    let counts = [
                        decisions.solid,
                        decisions.face,
                        decisions.shadow,
                        decisions.mirror,
                        summary.several,
                        summary.another_color,
                        summary.not_a_number,
                        summary.rounding,
                        summary.right,
                        difference.eight_bit,
                    ];
                    cells.extend(counts.map(|count| count.to_string()));
                    cells.push(digits(difference.max_abs));
                    for hint in &measured.hints {
                        let (name, stage) = (&row.renderer, row.stage.number());
                        let _ = writeln!(notes, "{name}, {}, stage {stage}: {hint}", row.scene);
                    }
                }
                Err(reason) => {
                    cells.push("failed".to_owned());
                    cells.extend(vec!["–".to_owned(); 13]);
                    let _ = writeln!(notes, "failed: {reason}");
                }
            }
            table.rows.push(cells);
        }
        format!(
            "\nother renderers, over all frames; a pixel is wrong where it shows another decision than the true one, or is more than {} off\n{table}{notes}",
            digits(self.tolerance.into())
        )
    }

    /// What spheres cost, as a table that follows the others; nothing without crowds.
    fn scaling_table(&self, threads: &[usize]) -> String {
        let Some(stage) = self.scalings.first().map(|scaling| scaling.stage) else {
            return String::new();
        };
        let mut table = Table::new(vec![Columns::new("", &["scene", "spheres", "kernel"])]);
        for &count in threads {
            let names = ["ms", "min … max", "× builtin"];
            table.groups.push(Columns::of_threads(count, &names));
        }
        for scaling in &self.scalings {
            let mut cells = vec![
                scaling.scene().to_owned(),
                scaling.spheres.to_string(),
                scaling.kernel.name().to_owned(),
            ];
            for timing in &scaling.timings {
                cells.extend(time(timing.ms));
                cells.push(digits(timing.ratio));
            }
            table.rows.push(cells);
        }
        format!(
            "\ntime a frame against the number of spheres, stage {}\n{table}",
            stage.number()
        )
    }

    /// What it costs to display a frame, as a table that follows the others.
    pub fn pipeline_table(&self) -> String {
        let mut table = Table::new(vec![
            Columns::new("", &["context", "path"]),
            Columns::new(
                "ms a frame",
                &["trace", "upload", "draw", "read back", "all"],
            ),
        ]);
        let mut missing = String::new();
        for Pipeline {
            backend,
            method,
            costs,
            ..
        } in &self.pipelines
        {
            let (backend, method) = (backend.name(), method.name());
            match costs {
                Ok(costs) => {
                    let steps = [
                        costs.trace_ms,
                        costs.upload_ms,
                        costs.draw_ms,
                        costs.read_back_ms,
                    ]
                    .map(|step| step.median);
                    let mut cells = vec![backend.to_owned(), method.to_owned()];
                    cells.extend(steps.map(digits));
                    cells.push(digits(steps.iter().sum()));
                    table.rows.push(cells);
                }
                Err(reason) => {
                    let _ = writeln!(missing, "{backend}, {method}: {reason}");
                }
            }
        }
        match self.pipelines.first() {
            Some(pipeline) => {
                let (kernel, rows) = (pipeline.kernel.name(), table.to_string());
                let rows = if table.rows.is_empty() { "" } else { &rows };
                format!("\na displayed frame, traced by {kernel} on all threads\n{rows}{missing}")
            }
            None => String::new(),
        }
    }
}

fn names(row: &KernelRow) -> Vec<String> {
    vec![
        row.scene.clone(),
        row.stage.number().to_string(),
        row.kernel.name().to_owned(),
    ]
}

/// The cells of a time: the median, and how far it spreads.
fn time(Spread { median, min, max }: Spread) -> [String; 2] {
    [digits(median), format!("{} … {}", digits(min), digits(max))]
}

/// A row without numbers, and why.
fn refused(row: &KernelRow, columns: usize) -> Vec<String> {
    let mut cells = names(row);
    cells.push("refused".to_owned());
    cells.extend(vec!["–".to_owned(); columns - 1]);
    cells
}

/// Three digits that count, or all those before the point.
fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        0.0 => return "0".to_owned(),
        size if !(9.995e-4..1e7).contains(&size) => return scientific(value),
        size if size >= 99.95 => 0,
        size if size >= 9.995 => 1,
        size if size >= 0.9995 => 2,
        size if size >= 0.09995 => 3,
        size if size >= 0.009995 => 4,
        _ => 5,
    };
    format!("{value:.decimals$}")
}

fn scientific(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else {
        format!("{value:.1e}")
    }
}

/// Columns under one title.
struct Columns {
    title: String,
    names: Vec<String>,
}

impl Columns {
    fn new(title: &str, names: &[&str]) -> Columns {
        Columns {
            title: title.to_owned(),
            names: names.iter().map(|&name| name.to_owned()).collect(),
        }
    }

    /// Columns for what so many threads do.
    fn of_threads(threads: usize, names: &[&str]) -> Columns {
        let s = if threads == 1 { "" } else { "s" };
        Columns::new(&format!("{threads} thread{s}"), names)
    }
}

/// Rows of cells under titled columns. The first group holds names, which begin where their column
/// does; numbers end where theirs does.
struct Table {
    groups: Vec<Columns>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn new(groups: Vec<Columns>) -> Table {
        let rows = Vec::new();
        Table { groups, rows }
    }

    /// The characters that each column needs, group by group.
    fn widths(&self) -> Vec<Vec<usize>> {
        let mut first = 0;
        let widths = self.groups.iter().map(|group| {
            let columns = first..first + group.names.len();
            first = columns.end;
            let mut widths: Vec<usize> = columns
                .zip(&group.names)
                .map(|(column, name)| {
                    let cells = self.rows.iter().filter_map(|row| row.get(column));
                    cells
                        .chain([name])
                        .map(|cell| count(cell))
                        .max()
                        .unwrap_or(0)
                })
                .collect();
            let sum = widths.iter().sum::<usize>() + GAP.len() * (widths.len() - 1);
            if let Some(last) = widths.last_mut() {
                *last += count(&group.title).saturating_sub(sum);
            }
            widths
        });
        widths.collect()
    }
}

/// Between columns, and between groups of them.
const GAP: &str = "  ";
const RULE: &str = " │ ";

fn count(text: &str) -> usize {
    text.chars().count()
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let widths = self.widths();
        let titles = self.groups.iter().zip(&widths).map(|(group, widths)| {
            let width = widths.iter().sum::<usize>() + GAP.len() * (widths.len() - 1);
            format!("{:<width$}", group.title)
        });
        let titles = titles.collect::<Vec<_>>().join(RULE);
        writeln!(f, "{}", titles.trim_end())?;
        let header: Vec<&String> = self.groups.iter().flat_map(|group| &group.names).collect();
        let rows = self.rows.iter().map(|row| row.iter().collect());
        for cells in std::iter::once(header).chain(rows) {
            let mut cells = cells.into_iter();
            let parts = widths.iter().enumerate().map(|(group, widths)| {
                let cells = widths.iter().zip(cells.by_ref());
                let cells = cells.map(|(&width, cell)| match group {
                    0 => format!("{cell:<width$}"),
                    _ => format!("{cell:>width$}"),
                });
                cells.collect::<Vec<_>>().join(GAP)
            });
            let line = parts.collect::<Vec<_>>().join(RULE);
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits() {
        let numbers = [0.0, 0.0001234, 0.01234, 0.09997, 1.234, 12.34, 99.96, 1.2e8];
        let texts = [
            "0", "1.2e-4", "0.0123", "0.100", "1.23", "12.3", "100", "1.2e8",
        ];
        assert_eq!(numbers.map(digits), texts);
        assert_eq!(scientific(f64::INFINITY), "inf");
    }

    #[test]
    fn columns_are_aligned_by_characters() {
        let table = Table {
            groups: vec![
                Columns::new("", &["name"]),
                Columns::new("a long title", &["×", "y"]),
            ],
            rows: vec![
                vec!["α".into(), "1".into(), "22".into()],
                vec!["longer".into(), "333".into(), "4".into()],
            ],
        };
        let expected = "       │ a long title
name   │   ×        y
α      │   1       22
longer │ 333        4
";
        assert_eq!(table.to_string(), expected);
    }
}
