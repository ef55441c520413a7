//! Error against time, as an SVG.
//!
//! A panel for each group of scenes, a mark for each kernel: its time on one thread horizontally;
//! vertically the mean error of its samples in f32 steps, wrong pixels included, with a line from
//! there to the largest: the scenes differ in brightness by many orders of magnitude, and steps do
//! not know of it. Both scales are logarithmic, and 0 has a place of its own. Kernels differ in
//! shape, so that the plot reads in grey, and in colours that the colour-blind can tell apart
//! (Okabe and Ito). Where crowds were measured, a last panel has their times.

mod axis;
mod drawing;
mod scaling;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{Group, KernelRow, Measured, Report, Spread};
use crate::Kernel;
use axis::{ErrorAxis, LogAxis};
use drawing::{Area, Drawn, INK, TIME_AXIS, chart, color, font, shape};
use scaling::ScalingPanel;

/// A plot that cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

const PANEL: (u32, u32) = (680, 420);
const TITLE: u32 = 58;
const LEGEND: u32 = 64;

/// A kernel in a panel.
struct Mark {
    kernel: Kernel,
    ms: Spread,
    mean: f64,
    largest: f64,
    /// Time and mean error of each scene and stage, where they are more than one.
    each: Vec<(f64, f64)>,
}

struct Panel {
    title: String,
    marks: Vec<Mark>,
    fill_ms: f64,
}

impl Report {
    /// The plot as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError`] where it cannot be drawn.
    pub fn plot(&self) -> Result<String, PlotError> {
        let panels: Vec<Panel> = [Group::Builtin, Group::File, Group::Hard]
            .into_iter()
            .filter_map(|group| self.panel(group))
            .collect();
        let mut text = String::new();
        self.draw(&panels, &mut text)
            .map_err(|error| PlotError(error.to_string()))?;
        Ok(text)
    }

    fn draw(&self, panels: &[Panel], text: &mut String) -> Drawn {
        let scaling = ScalingPanel::new(&self.scalings);
        let count = (panels.len() + usize::from(scaling.is_some())).max(1);
        let (width, height) = (PANEL.0 * count as u32, TITLE + PANEL.1 + LEGEND);
        let area = SVGBackend::with_string(text, (width, height)).into_drawing_area();
        area.fill(&WHITE)?;
        let middle = width as i32 / 2;
        let on = format!(
            "one thread of {}; {} × {} pixels, frames {}..{}",
            self.machine.cpu,
            self.size,
            self.size,
            self.frames.start(),
            self.frames.end()
        );
        area.draw(&Text::new(
            "Error against time",
            (middle, 10),
            font(20, HPos::Center),
        ))?;
        area.draw(&Text::new(on, (middle, 36), font(13, HPos::Center)))?;
        let axes = axes(panels);
        let places = area.split_vertically(TITLE).1.split_vertically(PANEL.1).0;
        let places = places.split_evenly((1, count));
        for (panel, place) in panels.iter().zip(&places) {
            draw_panel(panel, &area, place, axes)?;
        }
        if let (Some(scaling), Some(place)) = (&scaling, places.last()) {
            scaling.draw(&area, place)?;
        }
        let top = (TITLE + PANEL.1) as i32;
        draw_legend(panels, scaling.is_some(), &area, (middle, top))?;
        area.present()
    }

    /// What is known about a group of scenes; `None` if nothing.
    fn panel(&self, group: Group) -> Option<Panel> {
        let rows: Vec<(&KernelRow, &Measured)> = self
            .rows
            .iter()
            .filter(|row| row.group == group)
            .filter_map(|row| Some((row, row.measured.as_ref().ok()?)))
            .collect();
        let marks: Vec<Mark> = Kernel::ALL
            .into_iter()
            .filter_map(|kernel| {
                let of_kernel = rows.iter().filter(|(row, _)| row.kernel == kernel);
                mark(kernel, of_kernel.map(|&(_, measured)| measured))
            })
            .collect();
        let fills = rows
            .iter()
            .filter_map(|(_, measured)| measured.timings.first());
        let fill_ms = Spread::of(fills.map(|timing| timing.fill_ms.median).collect())?.median;
        let mut scenes: Vec<&str> = rows.iter().map(|(row, _)| &row.scene[..]).collect();
        scenes.dedup();
        let title = match (group, &scenes[..]) {
            (Group::Builtin, _) => "Built-in scene".to_owned(),
            (Group::File, [scene]) => (*scene).to_owned(),
            (Group::File, _) => format!("{} scene files", scenes.len()),
            (Group::Hard, _) => format!("{} hard scenes", scenes.len()),
        };
        Some(Panel {
            title,
            marks,
            fill_ms,
        })
    }
}

/// One kernel on all scenes of a group: the median time and how far it spreads, the mean of the
/// mean errors, the largest of the largest.
fn mark<'a>(kernel: Kernel, measured: impl Iterator<Item = &'a Measured>) -> Option<Mark> {
    let (mut each, mut largest, mut spread) = (Vec::new(), 0.0_f64, None);
    for Measured { timings, errors } in measured {
        let timing = timings.first()?;
        each.push((timing.ms.median, errors.all.mean_steps()));
        largest = largest.max(f64::from(errors.all.max_steps));
        spread = Some(timing.ms);
    }
    let mean = each.iter().map(|(_, mean)| mean).sum::<f64>() / each.len() as f64;
    if each.len() > 1 {
        spread = Spread::of(each.iter().map(|&(ms, _)| ms).collect());
    } else {
        each.clear();
    }
    Some(Mark {
        kernel,
        ms: spread?,
        mean,
        largest,
        each,
    })
}

/// Axes that all panels share, so that they can be compared.
fn axes(panels: &[Panel]) -> (LogAxis, ErrorAxis) {
    let marks = || panels.iter().flat_map(|panel| &panel.marks);
    let times = marks().flat_map(|mark| [mark.ms.min, mark.ms.max]);
    let errors = marks().flat_map(|mark| {
        let each = mark.each.iter().map(|&(_, mean)| mean);
        each.chain([mark.mean, mark.largest])
    });
    (
        LogAxis::over(times.chain(panels.iter().map(|panel| panel.fill_ms))),
        ErrorAxis::over(errors),
    )
}

fn draw_panel(
    panel: &Panel,
    whole: &Area<'_>,
    place: &Area<'_>,
    (times, errors): (LogAxis, ErrorAxis),
) -> Drawn {
    let chart = chart(
        place,
        &panel.title,
        (times, TIME_AXIS),
        (errors, "error of a sample, f32 steps"),
    )?;
    let pixel = |time: f64, error: f64| chart.backend_coord(&(time, error));

    let high = errors.upper_end();
    let (x, top) = pixel(panel.fill_ms, high);
    let (_, pixels) = chart.plotting_area().get_pixel_range();
    dashes(whole, x, (top, pixels.end))?;
    // Below and behind, what the marks sum up.
    for mark in &panel.marks {
        let pale = color(mark.kernel).mix(0.5);
        for &(time, error) in &mark.each {
            shape(
                whole,
                mark.kernel,
                pixel(time, error),
                1,
                pale.stroke_width(1),
            )?;
        }
    }
    for Mark {
        kernel,
        ms,
        mean,
        largest,
        ..
    } in &panel.marks
    {
        let line = color(*kernel).stroke_width(2);
        let (x, y) = pixel(ms.median, *mean);
        let (left, right) = (pixel(ms.min, *mean).0, pixel(ms.max, *mean).0);
        let top = pixel(ms.median, largest.min(high)).1;
        whole.draw(&PathElement::new(vec![(left, y), (right, y)], line))?;
        for end in [left, right] {
            whole.draw(&PathElement::new(vec![(end, y - 4), (end, y + 4)], line))?;
        }
        if top < y {
            whole.draw(&PathElement::new(vec![(x, y), (x, top)], line))?;
            whole.draw(&PathElement::new(vec![(x - 5, top), (x + 5, top)], line))?;
        }
        shape(whole, *kernel, (x, y), 2, line)?;
    }
    Ok(())
}

/// The line of fill.
fn dashes(area: &Area<'_>, x: i32, (top, bottom): (i32, i32)) -> Drawn {
    for y in (top..bottom).step_by(10) {
        let dash = vec![(x, y), (x, (y + 6).min(bottom))];
        area.draw(&PathElement::new(dash, INK.stroke_width(2)))?;
    }
    Ok(())
}

/// Shapes and what they stand for, in the middle below the panels.
fn draw_legend(
    panels: &[Panel],
    with_scaling: bool,
    area: &Area<'_>,
    (middle, top): (i32, i32),
) -> Drawn {
    const ENTRY: i32 = 108;
    const LAST: i32 = 150;
    let is_there = |kernel: &Kernel| {
        let mut marks = panels.iter().flat_map(|panel| &panel.marks);
        marks.any(|mark| mark.kernel == *kernel)
    };
    let kernels: Vec<Kernel> = Kernel::ALL.into_iter().filter(is_there).collect();
    let (mut x, y) = (middle - (ENTRY * kernels.len() as i32 + LAST) / 2, top + 14);
    for kernel in kernels {
        shape(area, kernel, (x, y), 2, color(kernel).stroke_width(2))?;
        area.draw(&Text::new(
            kernel.name(),
            (x + 14, y - 7),
            font(14, HPos::Left),
        ))?;
        x += ENTRY;
    }
    dashes(area, x, (y - 10, y + 10))?;
    area.draw(&Text::new(
        "fill with one colour",
        (x + 14, y - 7),
        font(14, HPos::Left),
    ))?;
    let mut marks = panels.iter().flat_map(|panel| &panel.marks);
    let small = match marks.any(|mark| !mark.each.is_empty()) {
        true => "; small: a single scene",
        false => "",
    };
    let last = match with_scaling {
        true => "; last panel, up and down: least and most time",
        false => "",
    };
    let text = format!(
        "mark: median time and mean error; across: least and most time; up: to the largest error{small}{last}"
    );
    area.draw(&Text::new(text, (middle, top + 36), font(13, HPos::Center)))
}
