//! The length 1.

use glam::DVec3;

pub(super) fn get_unit(v: DVec3) -> DVec3 {
    v / v.length()
}
