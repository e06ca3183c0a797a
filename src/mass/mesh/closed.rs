//! Whether faces bound a solid: every edge between two faces that run along it in opposite directions,
//! every shell looking out, or in where it bounds a cavity.

use super::super::solids::Triangles;
use super::crossing::Crossing;
use super::integrals::{mean, volume};
use super::{MOST_TRIANGLES, MeshError, Soup};
use nalgebra::Vector3;
use std::collections::HashMap;
use std::fmt;

/// Coordinates up to this, m: fifth powers of it, which a tensor is made of, stay finite.
const FARTHEST: f64 = 1e50;
/// Closed surfaces in one mesh; which lies inside which is asked of each pair.
const MOST_SHELLS: usize = 1_000;

/// An edge by its ends, in the file's own lengths, and the faces that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    /// As the file calls them, such as `line 12`.
    pub faces: Vec<String>,
    /// Other edges of the same kind.
    pub others: usize,
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |p: &Vector3<f64>| format!("({}, {}, {})", p.x, p.y, p.z);
        write!(f, "edge from {} to {}", place(&self.from), place(&self.to))
    }
}

impl Edge {
    fn faces(&self) -> String {
        /// As many as one looks up.
        const MOST: usize = 6;
        let mut shown = self.faces[..self.faces.len().min(MOST)].join(", ");
        if self.faces.len() > MOST {
            shown += ", …";
        }
        shown
    }

    fn others(&self) -> String {
        match self.others {
            0 => String::new(),
            n => format!(" (and so do {n} edges more)"),
        }
    }
}

/// Why faces enclose nothing that has a mass.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Flaw {
    #[error(
        "the mesh is open: the {0} belongs to one face only, {faces}{others}; close the hole there, an open surface has no inside",
        faces = .0.faces(),
        others = .0.others()
    )]
    Open(Edge),
    #[error(
        "the {0} belongs to {count} faces, {faces}{others}; on a solid it belongs to two: take away the faces inside, or part the pieces that touch along it",
        count = .0.faces.len(),
        faces = .0.faces(),
        others = .0.others()
    )]
    Crowded(Edge),
    #[error(
        "faces look different ways: the {0} is run along in one direction by both {faces}{others}; turn one of them over, so that all look out",
        faces = .0.faces(),
        others = .0.others()
    )]
    Against(Edge),
    #[error(
        "the mesh is inside-out: the faces at its {0} ({faces}) look inwards, and their shell lies in no other; turn all its faces over (corners run counter-clockwise seen from outside)",
        faces = .0.faces()
    )]
    InsideOut(Edge),
    #[error(
        "the shell with the {0} ({faces}) lies inside another, and both look outwards: what it encloses would count twice; take it away, or turn its faces over to make it a cavity",
        faces = .0.faces()
    )]
    Nested(Edge),
    #[error("it encloses no volume: flat, or of no size; give it some thickness")]
    Flat,
    #[error("it has no faces")]
    Empty,
    #[error(
        "it has {0} closed shells, more than the {most} that are compared with each other; split it",
        most = MOST_SHELLS
    )]
    TooManyShells(usize),
}

/// What was found to be closed.
pub(super) struct Closed {
    pub triangles: Triangles,
    pub shells: usize,
    /// Triangles with two corners at one place.
    pub dropped: usize,
}

pub(super) fn check(soup: &Soup, scale: f64) -> Result<Closed, MeshError> {
    if soup.triangles.len() > MOST_TRIANGLES {
        return Err(MeshError::TooMany(soup.triangles.len()));
    }
    let welded = Welded::new(soup, scale)?;
    if welded.corners.is_empty() {
        return Err(Flaw::Empty.into());
    }
    let uses = welded.edges();
    edges(&welded, &uses)?;
    let shells = shells(welded.corners.len(), &uses);
    if shells.len() > MOST_SHELLS {
        return Err(Flaw::TooManyShells(shells.len()).into());
    }
    let triangles = welded.triangles(scale);
    look_outwards(&welded, &uses, &triangles, &shells)?;
    Ok(Closed {
        shells: shells.len(),
        dropped: soup.triangles.len() - welded.corners.len(),
        triangles,
    })
}

/// Corners at one place made one; triangles that have two there are no faces.
struct Welded<'a> {
    soup: &'a Soup,
    /// In the file's lengths.
    points: Vec<Vector3<f64>>,
    corners: Vec<[u32; 3]>,
    /// Indices into the soup's triangles.
    origin: Vec<usize>,
}

/// A face's use of an edge: its ends, the lower first, whether the face runs from the lower to the higher,
/// and the face.
type Use = (u32, u32, bool, usize);

impl<'a> Welded<'a> {
    fn new(soup: &'a Soup, scale: f64) -> Result<Self, MeshError> {
        let mut place: HashMap<[u64; 3], u32> = HashMap::new();
        let mut points = Vec::new();
        let mut index = Vec::with_capacity(soup.points.len());
        for (k, point) in soup.points.iter().enumerate() {
            if !point.iter().all(|x| (x * scale).abs() <= FARTHEST) {
                return Err(MeshError::OutOfRange {
                    vertex: k + 1,
                    at: *point,
                });
            }
            // A zero with a sign is at the same place.
            let key = [0, 1, 2].map(|i| (point[i] + 0.0).to_bits());
            index.push(*place.entry(key).or_insert_with(|| {
                points.push(*point);
                points.len() as u32 - 1
            }));
        }
        let (mut corners, mut origin) = (Vec::new(), Vec::new());
        for (k, triangle) in soup.triangles.iter().enumerate() {
            let mut welded = [0; 3];
            for (corner, &i) in welded.iter_mut().zip(triangle) {
                *corner = *index.get(i as usize).ok_or(MeshError::NoVertex {
                    face: name(soup, k),
                    vertex: i as usize + 1,
                })?;
            }
            let [a, b, c] = welded;
            if a != b && b != c && c != a {
                corners.push(welded);
                origin.push(k);
            }
        }
        Ok(Self {
            soup,
            points,
            corners,
            origin,
        })
    }

    /// Every face's use of its edges, sorted by edge.
    fn edges(&self) -> Vec<Use> {
        let mut uses = Vec::with_capacity(3 * self.corners.len());
        for (k, &[a, b, c]) in self.corners.iter().enumerate() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                uses.push((from.min(to), from.max(to), from < to, k));
            }
        }
        uses.sort_unstable();
        uses
    }

    /// As the first of its faces runs along it.
    fn edge(&self, uses: &[Use], others: usize) -> Edge {
        let mut uses = uses.to_vec();
        uses.sort_unstable_by_key(|u| u.3);
        let (low, high, forward, _) = uses[0];
        let ends = if forward { (low, high) } else { (high, low) };
        let faces = uses.iter().map(|&(.., k)| name(self.soup, self.origin[k]));
        Edge {
            from: self.points[ends.0 as usize],
            to: self.points[ends.1 as usize],
            faces: faces.collect(),
            others,
        }
    }

    fn triangles(&self, scale: f64) -> Triangles {
        let points: Vec<_> = self.points.iter().map(|p| p * scale).collect();
        Triangles::new(points, self.corners.clone())
    }
}

fn name(soup: &Soup, triangle: usize) -> String {
    let number = soup.faces.get(triangle).copied().unwrap_or_default();
    format!("{} {number}", soup.counted)
}

/// Every edge between two faces that run along it in opposite directions. Of the edges that are not, the
/// first in the order of the file is named.
fn edges(welded: &Welded<'_>, uses: &[Use]) -> Result<(), Flaw> {
    let kind = |group: &[Use]| match group {
        [_] => Some(0),
        [one, other] if one.2 != other.2 => None,
        [_, _] => Some(1),
        _ => Some(2),
    };
    let same = |a: &Use, b: &Use| (a.0, a.1) == (b.0, b.1);
    let wrong = uses.chunk_by(same).filter_map(|g| Some((kind(g)?, g)));
    let wrong: Vec<(usize, &[Use])> = wrong.collect();
    let first = wrong
        .iter()
        .min_by_key(|(_, group)| group.iter().map(|u| u.3).min());
    let Some(&(what, group)) = first else {
        return Ok(());
    };
    let alike = wrong.iter().filter(|(kind, _)| *kind == what).count();
    let edge = welded.edge(group, alike - 1);
    Err([Flaw::Open, Flaw::Against, Flaw::Crowded][what](edge))
}

/// The faces of each closed surface, joined along edges.
fn shells(faces: usize, uses: &[Use]) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..faces).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    for pair in uses.chunks_exact(2) {
        let (a, b) = (root(&mut parent, pair[0].3), root(&mut parent, pair[1].3));
        parent[a.max(b)] = a.min(b);
    }
    let mut shells: Vec<Vec<usize>> = Vec::new();
    let mut number = vec![usize::MAX; faces];
    for k in 0..faces {
        let r = root(&mut parent, k);
        if number[r] == usize::MAX {
            number[r] = shells.len();
            shells.push(Vec::new());
        }
        shells[number[r]].push(k);
    }
    shells
}

/// A shell that lies in an even number of others bounds matter and looks outwards; one in an odd number
/// bounds a cavity and looks inwards.
fn look_outwards(
    welded: &Welded<'_>,
    uses: &[Use],
    triangles: &Triangles,
    shells: &[Vec<usize>],
) -> Result<(), Flaw> {
    let o = mean(&triangles.points);
    let faces = |shell: &Vec<usize>| {
        let shell = shell.clone();
        shell.into_iter().map(|k| triangles.face(k))
    };
    let boxes: Vec<_> = shells.iter().map(|s| bounds(faces(s).flatten())).collect();
    for (k, shell) in shells.iter().enumerate() {
        let (volume, size) = volume(o, faces(shell));
        // What rounding leaves of nothing: each part is good to some roundings of its size.
        if volume.abs() <= 64.0 * f64::EPSILON * size {
            return Err(Flaw::Flat);
        }
        let depth = (0..shells.len())
            .filter(|&other| other != k && holds(boxes[other], boxes[k]))
            .filter(|&other| inside(triangles, shell, &shells[other]))
            .count();
        let cavity = depth % 2 == 1;
        let at = |uses: &[Use]| uses.iter().position(|u| u.3 == shell[0]);
        let edge = || {
            // Uses of one edge stand side by side, in pairs.
            let pair = at(uses).map_or(0, |i| i & !1);
            welded.edge(&uses[pair..pair + 2], 0)
        };
        match (volume > 0.0, cavity) {
            (true, false) | (false, true) => {}
            (false, false) => return Err(Flaw::InsideOut(edge())),
            (true, true) => return Err(Flaw::Nested(edge())),
        }
    }
    Ok(())
}

type Bounds = (Vector3<f64>, Vector3<f64>);

fn bounds(points: impl Iterator<Item = Vector3<f64>>) -> Bounds {
    let start = (
        Vector3::repeat(f64::INFINITY),
        Vector3::repeat(-f64::INFINITY),
    );
    points.fold(start, |(low, high), p| (low.inf(&p), high.sup(&p)))
}

fn holds(outer: Bounds, inner: Bounds) -> bool {
    (0..3).all(|i| outer.0[i] <= inner.0[i] && inner.1[i] <= outer.1[i])
}

/// Whether a shell lies in another, by the middles of three of its faces: rays cross the other's faces an
/// odd number of times. Three, because one may lie on the other's surface.
fn inside(triangles: &Triangles, shell: &[usize], other: &[usize]) -> bool {
    let samples = [0, shell.len() / 3, 2 * shell.len() / 3];
    let is_in = |&sample: &usize| {
        let [a, b, c] = triangles.face(shell[sample]);
        let p = (a + b + c) / 3.0;
        let crossings = other
            .iter()
            .filter_map(|&k| Crossing::of(triangles.face(k)).x_at(p.y, p.z))
            .filter(|&x| x > p.x);
        crossings.count() % 2 == 1
    };
    samples.iter().filter(|sample| is_in(sample)).count() >= 2
}
