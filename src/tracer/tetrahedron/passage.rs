//! How lines of one direction pass through a tetrahedron, as far as the signs of its faces tell: a
//! table, since no processor can predict these signs in a crowd.

use std::cmp::Ordering;

use super::FaceSigns;
use crate::scene::EDGES;

/// The border of a half-space that tells where lines of one direction meet a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::tracer) enum Wall {
    /// The plane of a face. The half-space is where f ≤ 0, or f < 0 if it is not `closed`.
    Face { face: u8, closed: bool },
    /// The plane in which lines meet `EDGES[edge]`, with faces i < j. The half-space is where the
    /// edge function is not negative or, if it is the `opposite` one, not positive. If lines enter i
    /// and leave j, the function is not negative where t_i ≤ t_j; if they enter both, where t_i ≥
    /// t_j.
    Edge { edge: u8, opposite: bool },
}

impl Wall {
    /// Whether it belongs to the half-space.
    pub(in crate::tracer) fn is_closed(self) -> bool {
        match self {
            Wall::Face { closed, .. } => closed,
            Wall::Edge { .. } => true,
        }
    }
}

/// Vectors hold so many walls.
pub(in crate::tracer) const WALLS_AT_ONCE: usize = 4;

/// There are at most 6 walls for lines of one direction.
const MOST: usize = 2 * WALLS_AT_ONCE;

/// Some of the walls for lines of one direction, first those of faces.
#[derive(Clone, Copy)]
pub(in crate::tracer) struct Walls {
    /// The walls; after them, the last of them again.
    all: [Wall; MOST],
    count: u8,
}

impl Walls {
    const fn none() -> Self {
        let (edge, opposite) = (0, false);
        Walls {
            all: [Wall::Edge { edge, opposite }; MOST],
            count: 0,
        }
    }

    const fn add(mut self, wall: Wall) -> Self {
        let mut index = self.count as usize;
        while index < MOST {
            self.all[index] = wall;
            index += 1;
        }
        self.count += 1;
        self
    }

    pub(in crate::tracer) fn count(&self) -> usize {
        usize::from(self.count)
    }

    pub(in crate::tracer) fn iter(&self) -> impl Iterator<Item = Wall> + Clone + use<> {
        self.all.into_iter().take(self.count())
    }

    /// Whether any of them is a face's.
    pub(in crate::tracer) fn any_face(&self) -> bool {
        matches!(self.all[0], Wall::Face { .. })
    }

    /// The walls, as many at once as vectors hold, and how many of these are walls.
    pub(in crate::tracer) fn vectors(
        &self,
    ) -> impl Iterator<Item = (&[Wall; WALLS_AT_ONCE], usize)> {
        let (vectors, _) = self.all.as_chunks();
        let begins = (0..self.count()).step_by(WALLS_AT_ONCE);
        let counts = begins.map(|begin| (self.count() - begin).min(WALLS_AT_ONCE));
        vectors.iter().zip(counts)
    }
}

/// How lines of one direction pass through a tetrahedron.
#[derive(Clone, Copy)]
pub(in crate::tracer) struct Passage {
    entered: [u8; 4],
    entered_count: u8,
    pairs: [[u8; 2]; EDGES.len()],
    /// For each pair of faces that lines enter, the wall of the half-space in which they enter the
    /// first one last.
    pub(in crate::tracer) creases: Walls,
    /// The walls of half-spaces that hold a line exactly if the line meets the solid: it leaves no
    /// face before it enters another, and lies outside of no face that it is parallel to.
    pub(in crate::tracer) met: Walls,
    /// The walls of half-spaces that hold a ray's origin exactly if the ray meets the solid at some
    /// t > 0: its line meets the solid, and every face that it leaves lies ahead.
    pub(in crate::tracer) ahead: Walls,
}

impl Passage {
    /// That of lines whose n·d has these signs.
    #[inline]
    pub(in crate::tracer) fn of(face_signs: FaceSigns) -> &'static Passage {
        let index = face_signs.map(|sign| (sign as i8 + 1) as usize);
        let index = index.into_iter().rev().fold(0, |sum, sign| 3 * sum + sign);
        &ALL[index]
    }

    /// The faces that lines enter, in the order of their numbers.
    pub(in crate::tracer) fn entered(&self) -> impl Iterator<Item = usize> + Clone + use<> {
        let count = usize::from(self.entered_count);
        self.entered.into_iter().take(count).map(usize::from)
    }

    /// All pairs of faces that lines enter, in increasing order, as indices of
    /// [`Passage::entered`]; the lower one first.
    pub(in crate::tracer) fn pairs(&self) -> &[[u8; 2]] {
        &self.pairs[..self.creases.count()]
    }

    const fn with_signs(signs: FaceSigns) -> Passage {
        let mut passage = Passage {
            entered: [0; 4],
            entered_count: 0,
            pairs: [[0; 2]; EDGES.len()],
            creases: Walls::none(),
            met: Walls::none(),
            ahead: Walls::none(),
        };
        // The index of each face among those that are entered.
        let mut indices = [0; 4];
        let mut face = 0;
        while face < 4 {
            match signs[face as usize] {
                Ordering::Less => {
                    indices[face as usize] = passage.entered_count;
                    passage.entered[passage.entered_count as usize] = face;
                    passage.entered_count += 1;
                }
                Ordering::Equal => {
                    let closed = true;
                    passage.met = passage.met.add(Wall::Face { face, closed });
                }
                Ordering::Greater => {
                    let closed = false;
                    passage.ahead = passage.ahead.add(Wall::Face { face, closed });
                }
            }
            face += 1;
        }
        let mut edge = 0;
        while edge < EDGES.len() {
            let (i, j, _) = EDGES[edge];
            let (sign, other) = (signs[i], signs[j]);
            let opposite = sign.is_gt();
            let wall = Wall::Edge {
                edge: edge as u8,
                opposite,
            };
            if sign.is_lt() && other.is_lt() {
                passage.pairs[passage.creases.count as usize] = [indices[i], indices[j]];
                passage.creases = passage.creases.add(wall);
            }
            if sign.is_ne() && sign as i8 == -(other as i8) {
                passage.met = passage.met.add(wall);
            }
            edge += 1;
        }
        let mut wall = 0;
        while wall < passage.met.count as usize {
            passage.ahead = passage.ahead.add(passage.met.all[wall]);
            wall += 1;
        }
        passage
    }
}

const SIGNS: [Ordering; 3] = [Ordering::Less, Ordering::Equal, Ordering::Greater];

/// By the signs of the faces, as digits.
static ALL: [Passage; 81] = {
    let mut all = [Passage::with_signs([Ordering::Less; 4]); 81];
    let mut index = 0;
    while index < all.len() {
        let digits = [index % 3, index / 3 % 3, index / 9 % 3, index / 27];
        let [a, b, c, d] = digits;
        all[index] = Passage::with_signs([SIGNS[a], SIGNS[b], SIGNS[c], SIGNS[d]]);
        index += 1;
    }
    all
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_signs_have_the_faces_and_walls_of_their_definitions() {
        for number in 0..81 {
            let signs = [1, 3, 9, 27].map(|power| SIGNS[number / power % 3]);
            let passage = Passage::of(signs);
            let faces = |sign| (0..4).filter(move |face| signs[usize::from(*face)] == sign);
            let entered: Vec<u8> = faces(Ordering::Less).collect();
            assert!(
                passage
                    .entered()
                    .eq(entered.iter().copied().map(usize::from))
            );
            let edge_of = |[one, other]: [u8; 2]| {
                let pair = [one, other].map(|index| usize::from(entered[usize::from(index)]));
                EDGES.iter().position(|(i, j, _)| [*i, *j] == pair)
            };
            let pairs: Vec<_> = passage.pairs().iter().copied().map(edge_of).collect();
            let walls = |is_wall: fn(Ordering, Ordering) -> bool| {
                let edges = EDGES.iter().enumerate();
                let edges = edges.filter(move |(_, (i, j, _))| is_wall(signs[*i], signs[*j]));
                edges.map(move |(edge, (i, ..))| Wall::Edge {
                    edge: edge as u8,
                    opposite: signs[*i] == Ordering::Greater,
                })
            };
            let creases: Vec<Wall> = walls(|i, j| i.is_lt() && j.is_lt()).collect();
            assert_eq!(passage.creases.iter().collect::<Vec<_>>(), creases);
            let edge = |wall: &Wall| match wall {
                Wall::Edge { edge, .. } => Some(usize::from(*edge)),
                Wall::Face { .. } => None,
            };
            assert_eq!(pairs, creases.iter().map(edge).collect::<Vec<_>>());
            let face = |closed| move |face| Wall::Face { face, closed };
            let beside = faces(Ordering::Equal).map(face(true));
            let met = beside.chain(walls(|i, j| i.is_ne() && i == j.reverse()));
            let met: Vec<Wall> = met.collect();
            assert_eq!(passage.met.iter().collect::<Vec<_>>(), met);
            let left = faces(Ordering::Greater).map(face(false));
            let ahead: Vec<Wall> = left.chain(met).collect();
            assert_eq!(passage.ahead.iter().collect::<Vec<_>>(), ahead);
            for walls in [&passage.creases, &passage.met, &passage.ahead] {
                let all: Vec<Wall> = walls.iter().collect();
                let vectors = walls.vectors().flat_map(|(four, count)| &four[..count]);
                assert!(vectors.eq(&all));
                let last = walls.vectors().last().map(|(four, _)| four[3]);
                assert_eq!(last, all.last().copied());
                let is_face = |wall: &Wall| matches!(wall, Wall::Face { .. });
                assert_eq!(walls.any_face(), all.iter().any(is_face));
            }
        }
    }
}
