//! What is seen in a column, once it is known which borders hold it.

use super::Rows;
use super::column::Column;
use super::floor::Floor;
use super::plan::{Plan, Seen, Show};
use super::solids::{Body, Facet, Pair, Solids};
use crate::scene::Side;
use crate::tracer::ladder::Lines;

impl<P: Lines> Rows<'_, P> {
    /// What is seen in a column, and in its neighbours up to the next crossing.
    pub(super) fn seen(&self, column: &Column, plan: &mut Plan) -> Seen {
        let Some(met) = column.direct.known() else {
            return Seen::UNKNOWN;
        };
        // What is above the surface hides it.
        let hides = |&solid: &usize| self.direct.solids[solid].side == Side::Above;
        let on_floor = if met.iter().any(hides) {
            Some(false)
        } else {
            column.surface()
        };
        let floor = match on_floor {
            Some(on_floor) => self.floor.as_ref().filter(|_| on_floor),
            None => return Seen::UNKNOWN,
        };
        match (met, floor) {
            ([], None) => Seen::Only(Show::Paint(self.background)),
            ([], Some(floor)) => self.seen_of_surface(floor, column, plan),
            (_, floor) => {
                if floor.is_none()
                    && let Some(solid) = self.direct.order.first(met)
                {
                    return Seen::Only(solid_in(&self.direct, solid, column));
                }
                let rest = match floor {
                    Some(floor) => self.seen_of_surface(floor, column, plan),
                    None => Seen::Only(Show::Paint(self.background)),
                };
                let shows = met
                    .iter()
                    .map(|&solid| (solid, solid_in(&self.direct, solid, column)));
                plan.contest(false, shows, floor.is_some(), rest)
            }
        }
    }

    /// The same where the surface is met, and no solid in front of it.
    fn seen_of_surface(&self, floor: &Floor<'_>, column: &Column, plan: &mut Plan) -> Seen {
        let itself = Seen::Only(Show::Paint(floor.paint));
        let mirrored = match (column.surface_in_shadow(), &floor.mirrored) {
            (Some(true), _) => return Seen::Only(Show::Paint(floor.in_shadow)),
            (None, _) => return Seen::UNKNOWN,
            (Some(false), None) => return itself,
            (Some(false), Some(mirrored)) => mirrored,
        };
        let Some(met) = column.mirrored.known() else {
            return Seen::UNKNOWN;
        };
        // A solid that goes through the surface may be met below it, where nothing is mirrored.
        let goes_through = |&solid: &usize| mirrored.solids[solid].side != Side::Above;
        if met.is_empty() {
            return itself;
        }
        if met.iter().any(goes_through) {
            return Seen::UNKNOWN;
        }
        if let Some(solid) = mirrored.order.first(met) {
            return Seen::Only(solid_in(mirrored, solid, column));
        }
        let shows = met
            .iter()
            .map(|&solid| (solid, solid_in(mirrored, solid, column)));
        plan.contest(true, shows, false, itself)
    }
}

/// What a column shows where it sees a solid.
fn solid_in(view: &Solids<'_>, solid: usize, column: &Column) -> Show {
    match &view.solids[solid].body {
        Body::Flat(paint) => Show::Paint(*paint),
        Body::Ball(_) => Show::Ball {
            mirrored: view.mirrored,
            solid: solid as u32,
        },
        Body::Facets(facets, pairs) => match last_entered(pairs, column) {
            Some(last) => facet_in(&facets[last], column),
            None => Show::Unknown,
        },
        Body::Unknown => Show::Unknown,
    }
}

/// What it shows where it sees a face.
fn facet_in(facet: &Facet, column: &Column) -> Show {
    if facet.turned_away {
        return Show::Paint(facet.in_shadow);
    }
    let mut all_known = true;
    for shadow in facet.shadows.clone() {
        match column.holds(shadow) {
            Some(true) => return Show::Paint(facet.in_shadow),
            Some(false) => {}
            None => all_known = false,
        }
    }
    if all_known {
        Show::Paint(facet.lit)
    } else {
        Show::Unknown
    }
}

/// The facet that eye rays enter last.
fn last_entered(pairs: &[Pair], column: &Column) -> Option<usize> {
    let mut last = 0;
    for pair in pairs {
        if pair.facets.0 == last && !column.holds(pair.first)? {
            last = pair.facets.1;
        }
    }
    Some(last)
}
