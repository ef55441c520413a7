//! What the panels are drawn with: text, and a colour and a shape for each kernel.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::Kernel;

/// An image, or a part of one.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);

pub(super) fn font(size: u32, horizontal: HPos) -> TextStyle<'static> {
    ("sans-serif", size)
        .into_font()
        .color(&INK)
        .pos(Pos::new(horizontal, VPos::Top))
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
