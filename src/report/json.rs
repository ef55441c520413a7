//! A report for programs.

use serde::Serialize;

use super::{KernelRow, Machine, Measured, Pipeline, Report, Spread, Timing};
use crate::diagnosis::{Hint, Summary};
use crate::difference::Difference;

/// The whole of it. What cannot be said as a number, an infinite error or what was not measured, is
/// `null`.
#[derive(Serialize)]
struct Json<'a> {
    version: u32,
    machine: JsonMachine<'a>,
    rows: Vec<JsonRow<'a>>,
    renderers: Vec<JsonRenderer<'a>>,
    crowds: Vec<JsonScaling>,
    pipeline: Vec<JsonPipeline<'a>>,
}

#[derive(Serialize)]
struct JsonMachine<'a> {
    #[serde(flatten)]
    machine: &'a Machine,
    threads: usize,
    simd: Option<&'static str>,
}

#[derive(Serialize)]
struct JsonRow<'a> {
    scene: &'a str,
    stage: u8,
    size: u32,
    frames: u64,
    kernel: &'static str,
    threads: usize,
    simd: Option<&'static str>,
    /// Why nothing was measured.
    refused: Option<&'a str>,
    samples: Option<usize>,
    ms: Option<Spread>,
    mpixel_per_s: Option<f64>,
    fill_ms: Option<Spread>,
    fill_gb_per_s: Option<f64>,
    fill_ratio: Option<Spread>,
    retained_fill_ratio: Option<Spread>,
    wrong_pixels: Option<u64>,
    wrong_by_kind: Option<Wrong>,
    misrounded: Option<u64>,
    nans: Option<u64>,
    max_ulp: Option<u32>,
    mean_ulp: Option<f64>,
    max_abs: Option<f64>,
    mean_abs: Option<f64>,
    eight_bit_differences: Option<u64>,
    pixels_in_doubt: Option<u64>,
    in_doubt_by_rung: Option<Doubt>,
    edges_a_row: Option<f64>,
    spans_a_row: Option<f64>,
}

#[derive(Serialize)]
struct Wrong {
    solid: u64,
    face: u64,
    shadow: u64,
    mirror: u64,
}

#[derive(Serialize)]
struct Doubt {
    double_double: u64,
    arbitrary: u64,
}

/// A renderer that is no kernel.
#[derive(Serialize)]
struct JsonRenderer<'a> {
    scene: &'a str,
    stage: u8,
    size: u32,
    frames: u64,
    renderer: &'a str,
    /// Why a picture is missing.
    failed: Option<&'a str>,
    tolerance: f32,
    ms: Option<Spread>,
    fill_ms: Option<Spread>,
    fill_ratio: Option<Spread>,
    wrong_pixels: Option<u64>,
    wrong_by_kind: Option<WrongOfRenderer>,
    rounded_pixels: Option<u64>,
    right_pixels: Option<u64>,
    misrounded: Option<u64>,
    nans: Option<u64>,
    max_ulp: Option<u32>,
    max_abs: Option<f64>,
    mean_abs: Option<f64>,
    eight_bit_differences: Option<u64>,
    hints: Vec<String>,
}

#[derive(Serialize)]
struct WrongOfRenderer {
    solid: u64,
    face: u64,
    shadow: u64,
    mirror: u64,
    several: u64,
    another_color: u64,
    not_a_number: u64,
}

/// A kernel on a crowd, or on the built-in scene.
#[derive(Serialize)]
struct JsonScaling {
    scene: &'static str,
    spheres: usize,
    stage: u8,
    size: u32,
    frames: u64,
    kernel: &'static str,
    threads: usize,
    samples: usize,
    ms: Spread,
    /// The median time by that of the built-in scene.
    ratio: f64,
}

#[derive(Serialize)]
struct JsonPipeline<'a> {
    context: &'static str,
    path: &'static str,
    missing: Option<&'a str>,
    kernel: &'static str,
    trace_ms: Option<f64>,
    upload_ms: Option<f64>,
    draw_ms: Option<f64>,
    readback_ms: Option<f64>,
}

impl Report {
    /// The report as one JSON object, with a line break at its end.
    pub fn json(&self) -> String {
        let rows = self.rows.iter().flat_map(|row| self.json_rows(row));
        let first = self.rows.iter().find_map(|row| row.measured.as_ref().ok());
        let json = Json {
            version: 1,
            machine: JsonMachine {
                machine: &self.machine,
                threads: self.threads,
                simd: first.and_then(|row| Some(row.timings.first()?.simd)),
            },
            rows: rows.collect(),
            renderers: self.json_renderers(),
            crowds: self.json_scalings(),
            pipeline: self.pipelines.iter().map(json_pipeline).collect(),
        };
        // Writing text and numbers to a string cannot fail.
        serde_json::to_string_pretty(&json).map_or_else(|_| String::new(), |text| text + "\n")
    }

    fn json_renderers(&self) -> Vec<JsonRenderer<'_>> {
        let rows = self.renderers.iter().map(|row| {
            let measured = row.measured.as_ref();
            let summary = measured.ok().map(|measured| &measured.summary);
            let difference = measured.ok().map(|measured| &measured.difference);
            JsonRenderer {
                scene: &row.scene,
                stage: row.stage.number(),
                size: self.size,
                frames: self.frame_count(),
                renderer: &row.renderer,
                failed: measured.err().map(String::as_str),
                tolerance: self.tolerance,
                ms: measured.ok().map(|measured| measured.ms),
                fill_ms: measured.ok().map(|measured| measured.fill_ms),
                fill_ratio: measured.ok().map(|measured| measured.fill_ratio),
                wrong_pixels: summary.map(Summary::wrong),
                wrong_by_kind: summary.map(|summary| WrongOfRenderer {
                    solid: summary.wrong_decisions.solid,
                    face: summary.wrong_decisions.face,
                    shadow: summary.wrong_decisions.shadow,
                    mirror: summary.wrong_decisions.mirror,
                    several: summary.several,
                    another_color: summary.another_color,
                    not_a_number: summary.not_a_number,
                }),
                rounded_pixels: summary.map(|summary| summary.rounding),
                right_pixels: summary.map(|summary| summary.right),
                misrounded: difference.map(|difference| difference.wrong),
                nans: difference.map(|difference| difference.nans[0]),
                max_ulp: difference.map(|difference| difference.max_steps),
                max_abs: difference.map(|difference| difference.max_abs),
                mean_abs: difference.map(Difference::mean_abs),
                eight_bit_differences: difference.map(|difference| difference.eight_bit),
                hints: measured.map_or_else(
                    |_| Vec::new(),
                    |measured| measured.hints.iter().map(Hint::to_string).collect(),
                ),
            }
        });
        rows.collect()
    }

    fn json_scalings(&self) -> Vec<JsonScaling> {
        let rows = self.scalings.iter().flat_map(|scaling| {
            scaling.timings.iter().map(|timing| JsonScaling {
                scene: scaling.scene(),
                spheres: scaling.spheres,
                stage: scaling.stage.number(),
                size: self.size,
                frames: self.frame_count(),
                kernel: scaling.kernel.name(),
                threads: timing.threads,
                samples: timing.samples,
                ms: timing.ms,
                ratio: timing.ratio,
            })
        });
        rows.collect()
    }

    fn json_rows<'a>(&self, row: &'a KernelRow) -> Vec<JsonRow<'a>> {
        match &row.measured {
            Err(refusal) => vec![JsonRow {
                refused: Some(refusal),
                ..self.json_row(row, None, None)
            }],
            Ok(measured) => measured
                .timings
                .iter()
                .map(|timing| self.json_row(row, Some(measured), Some(timing)))
                .collect(),
        }
    }

    fn json_row<'a>(
        &self,
        row: &'a KernelRow,
        measured: Option<&Measured>,
        timing: Option<&Timing>,
    ) -> JsonRow<'a> {
        let errors = measured.map(|measured| &measured.errors);
        let wrong = errors.map(|errors| errors.wrong_pixels);
        let tally = errors.map(|errors| errors.tally);
        JsonRow {
            scene: &row.scene,
            stage: row.stage.number(),
            size: self.size,
            frames: self.frame_count(),
            kernel: row.kernel.name(),
            threads: timing.map_or(self.threads, |timing| timing.threads),
            simd: timing.map(|timing| timing.simd),
            refused: None,
            samples: timing.map(|timing| timing.samples),
            ms: timing.map(|timing| timing.ms),
            mpixel_per_s: timing.map(|timing| self.mpixel_per_s(timing.ms)),
            fill_ms: timing.map(|timing| timing.fill_ms),
            fill_gb_per_s: timing.map(|timing| self.gb_per_s(timing.fill_ms)),
            fill_ratio: timing.map(|timing| timing.fill_ratio),
            retained_fill_ratio: timing.map(|timing| timing.retained_fill_ratio),
            wrong_pixels: wrong.map(|wrong| wrong.total()),
            wrong_by_kind: wrong.map(|wrong| Wrong {
                solid: wrong.solid,
                face: wrong.face,
                shadow: wrong.shadow,
                mirror: wrong.mirror,
            }),
            misrounded: errors.map(|errors| errors.all.wrong),
            nans: errors.map(|errors| errors.all.nans[0]),
            max_ulp: errors.map(|errors| errors.decided_rightly.max_steps),
            mean_ulp: errors.map(|errors| errors.decided_rightly.mean_steps()),
            max_abs: errors.map(|errors| errors.all.max_abs),
            mean_abs: errors.map(|errors| errors.all.mean_abs()),
            eight_bit_differences: errors.map(|errors| errors.all.eight_bit),
            pixels_in_doubt: tally.map(|tally| tally.double_double + tally.arbitrary),
            in_doubt_by_rung: tally.map(|tally| Doubt {
                double_double: tally.double_double,
                arbitrary: tally.arbitrary,
            }),
            edges_a_row: tally.map(|tally| self.per_row(tally.edges)),
            spans_a_row: tally.map(|tally| self.per_row(tally.spans)),
        }
    }
}

fn json_pipeline(pipeline: &Pipeline) -> JsonPipeline<'_> {
    let costs = pipeline.costs.as_ref();
    let median = |spread: Spread| spread.median;
    JsonPipeline {
        context: pipeline.backend.name(),
        path: pipeline.method.name(),
        missing: costs.err().map(String::as_str),
        kernel: pipeline.kernel.name(),
        trace_ms: costs.ok().map(|costs| median(costs.trace_ms)),
        upload_ms: costs.ok().map(|costs| median(costs.upload_ms)),
        draw_ms: costs.ok().map(|costs| median(costs.draw_ms)),
        readback_ms: costs.ok().map(|costs| median(costs.read_back_ms)),
    }
}
