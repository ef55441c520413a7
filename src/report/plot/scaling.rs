//! A panel with time against the number of spheres: a line for each kernel over the crowds, and
//! beside it the kernel's mark for the built-in scene. Both scales are logarithmic.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::super::Spread;
use super::super::scaling::Scaling;
use super::axis::LogAxis;
use super::drawing::{Area, Drawn, TIME_AXIS, chart, color, font, shape};
use crate::Kernel;

/// The scalings of a report, on one thread.
pub(super) struct ScalingPanel {
    marks: Vec<Mark>,
}

/// A kernel on a scene.
#[derive(Clone, Copy)]
struct Mark {
    kernel: Kernel,
    is_crowd: bool,
    spheres: f64,
    ms: Spread,
}

impl ScalingPanel {
    /// The panel; `None` where no crowd was measured.
    pub(super) fn new(scalings: &[Scaling]) -> Option<ScalingPanel> {
        let marks: Vec<Mark> = scalings
            .iter()
            .filter_map(|scaling| {
                Some(Mark {
                    kernel: scaling.kernel,
                    is_crowd: scaling.is_crowd,
                    spheres: scaling.spheres as f64,
                    ms: scaling.timings.first()?.ms,
                })
            })
            .collect();
        (!marks.is_empty()).then_some(ScalingPanel { marks })
    }

    /// Draws the panel in `place` of the plot.
    pub(super) fn draw(&self, plot: &Area<'_>, place: &Area<'_>) -> Drawn {
        let marks = &self.marks;
        let spheres = LogAxis::over(marks.iter().map(|mark| mark.spheres));
        let times = LogAxis::over(marks.iter().flat_map(|mark| [mark.ms.min, mark.ms.max]));
        let title = "Time against the number of spheres";
        let chart = chart(place, title, (spheres, "spheres"), (times, TIME_AXIS))?;
        let pixel = |mark: &Mark, ms: f64| chart.backend_coord(&(mark.spheres, ms));

        for kernel in Kernel::ALL {
            let of_kernel = marks.iter().filter(|mark| mark.kernel == kernel);
            let crowds = of_kernel.filter(|mark| mark.is_crowd);
            let line: Vec<_> = crowds.map(|mark| pixel(mark, mark.ms.median)).collect();
            if line.len() > 1 {
                plot.draw(&PathElement::new(line, color(kernel).stroke_width(2)))?;
            }
        }
        for mark in marks {
            let line = color(mark.kernel).stroke_width(2);
            let (x, y) = pixel(mark, mark.ms.median);
            let (top, bottom) = (pixel(mark, mark.ms.max).1, pixel(mark, mark.ms.min).1);
            plot.draw(&PathElement::new(vec![(x, top), (x, bottom)], line))?;
            for end in [top, bottom] {
                plot.draw(&PathElement::new(vec![(x - 4, end), (x + 4, end)], line))?;
            }
            shape(plot, mark.kernel, (x, y), 2, line)?;
        }
        let builtin = marks.iter().filter(|mark| !mark.is_crowd);
        if let Some(highest) = builtin.max_by(|a, b| a.ms.max.total_cmp(&b.ms.max)) {
            let (x, y) = pixel(highest, highest.ms.max);
            let label = font(13, HPos::Left);
            plot.draw(&Text::new("built-in scene", (x - 8, y - 24), label))?;
        }
        Ok(())
    }
}
