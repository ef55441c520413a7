//! What the panels are drawn with: a grid, text, and a colour and a shape for each kernel.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::Kernel;

/// An image, or a part of one.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Drawn<T = ()> = Result<T, DrawingAreaErrorKind<std::io::Error>>;
/// A grid with its axes.
type Chart<'a, X, Y> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>;

pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);

pub(super) fn font(size: u32, horizontal: HPos) -> TextStyle<'static> {
    ("sans-serif", size)
        .into_font()
        .color(&INK)
        .pos(Pos::new(horizontal, VPos::Top))
}

/// What the axes of times measure.
pub(super) const TIME_AXIS: &str = "time a frame, ms";

/// A grid in `place` over the axes `x` and `y`, with what they measure.
pub(super) fn chart<'a, X, Y>(
    place: &Area<'a>,
    title: &str,
    (x, x_name): (X, &str),
    (y, y_name): (Y, &str),
) -> Drawn<Chart<'a, X, Y>>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(place)
        .caption(title, font(16, HPos::Center))
        .margin(8)
        .margin_right(20)
        .x_label_area_size(46)
        .y_label_area_size(68)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(INK)
        .label_style(("sans-serif", 13).into_font().color(&INK))
        .axis_desc_style(("sans-serif", 14).into_font().color(&INK))
        .x_desc(x_name)
        .y_desc(y_name)
        .draw()?;
    Ok(chart)
}

/// The colours of Okabe and Ito that are dark enough on white.
pub(super) fn color(kernel: Kernel) -> RGBColor {
    match kernel {
        Kernel::Exact => RGBColor(0x00, 0x72, 0xb2),
        Kernel::Fast => RGBColor(0xd5, 0x5e, 0x00),
        Kernel::Double => RGBColor(0x00, 0x9e, 0x73),
        Kernel::Listing => RGBColor(0xcc, 0x79, 0xa7),
        Kernel::Reference => RGBColor(0x00, 0x00, 0x00),
    }
}

/// The outline of a kernel's shape around (`x`, `y`), `parts` halves of its size. Of different
/// sizes, they can be told apart where they coincide.
pub(super) fn shape(
    area: &Area<'_>,
    kernel: Kernel,
    (x, y): (i32, i32),
    parts: i32,
    line: ShapeStyle,
) -> Drawn {
    let corners = match kernel {
        Kernel::Exact => return area.draw(&Circle::new((x, y), 4 * parts, line)),
        Kernel::Fast => [(0, -4), (4, 3), (-4, 3), (0, -4), (4, 3)],
        Kernel::Double => [(-2, -2), (2, -2), (2, 2), (-2, 2), (-2, -2)],
        Kernel::Listing => [(-3, -3), (3, 3), (0, 0), (3, -3), (-3, 3)],
        Kernel::Reference => [(0, -5), (5, 0), (0, 5), (-5, 0), (0, -5)],
    };
    let corners = corners.map(|(dx, dy)| (x + dx * parts, y + dy * parts));
    area.draw(&PathElement::new(corners, line))
}
