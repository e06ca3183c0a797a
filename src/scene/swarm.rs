//! `[[swarm]]`: many bodies alike by one table, and how they are spread.
//!
//! Body k of the swarm `box` is called `box_k`. Its place is the table's `position` and the offsets of
//! the spread; what is random of it depends on the seed and on k alone.

use super::body::Body;
use super::problem::Problems;
use super::table::{Node, Table};
use crate::math::draw;
use nalgebra::Vector3;

/// Bodies that a scene with swarms has at most: more than a viewer shows.
pub(super) const MOST: u64 = 100_000;

/// How the bodies of a swarm differ.
pub(super) struct Spread {
    grid: Option<Grid>,
    random: Option<Random>,
}

/// In rows along x, rows beside each other along z, layers of them upwards along y.
struct Grid {
    /// m.
    spacing: Vector3<f64>,
    /// Bodies along x, y and z.
    counts: [u64; 3],
}

struct Random {
    seed: u64,
    /// Half widths of the box around the place that the body would have otherwise, m.
    within: Vector3<f64>,
    /// The largest angular velocity that is added, rad/s.
    spin: f64,
    /// Whether the attitude is any.
    orientation: bool,
}

/// How many bodies the table makes, of so many that there is room for.
pub(super) fn count(table: &Table<'_>, room: u64, problems: &mut Problems) -> Option<u64> {
    let node = table.require("count", "how many bodies, such as 100", problems)?;
    let count = node.whole(1, MOST, problems)?;
    if count > room {
        node.problem(
            format!("makes more than {MOST} bodies in this scene; take fewer"),
            problems,
        );
        return None;
    }
    Some(count)
}

impl Spread {
    pub fn read(table: &Table<'_>, count: Option<u64>, problems: &mut Problems) -> Option<Self> {
        let grid = table
            .get("grid")
            .map(|node| Grid::read(node, count, problems));
        let random = table.get("random").map(|node| Random::read(node, problems));
        if grid.is_none() && random.is_none() {
            let message = format!(
                "{} puts all its bodies into one place; add grid = {{ spacing = 2.0 }} or random = {{ within = [5, 5, 5] }} (m)",
                table.name()
            );
            problems.add(table.span(), message);
            return None;
        }
        Some(Self {
            grid: optional(grid)?,
            random: optional(random)?,
        })
    }

    /// Body `k`, from one that is right but for its name, its label and where it is.
    pub fn body(&self, like: &Body, k: u64) -> Body {
        let mut body = like.clone();
        if let Some(grid) = &self.grid {
            body.position_w += grid.offset(k);
        }
        if let Some(random) = &self.random {
            random.apply(&mut body, k);
        }
        body.follow_pivot();
        body
    }
}

/// `None` for what is there and wrong.
fn optional<T>(read: Option<Option<T>>) -> Option<Option<T>> {
    match read {
        None => Some(None),
        Some(read) => read.map(Some),
    }
}

impl Grid {
    fn read(node: Node<'_>, count: Option<u64>, problems: &mut Problems) -> Option<Self> {
        let table = node.table("grid = {…}".to_owned(), problems)?;
        let spacing = table
            .require("spacing", "the distance of neighbours, in metres", problems)
            .and_then(|node| match node.is_number() {
                true => node.number("m", problems).map(Vector3::repeat),
                false => node.vector("m", problems),
            });
        let counts = match table.get("counts") {
            None => count.map(near_cube),
            Some(node) => counts(&node, count, problems),
        };
        table.check_keys(problems);
        Some(Self {
            spacing: spacing?,
            counts: counts?,
        })
    }

    /// From the middle of the grid, m.
    fn offset(&self, k: u64) -> Vector3<f64> {
        let [along_x, _, along_z] = self.counts;
        let place = [k % along_x, k / along_x / along_z, k / along_x % along_z];
        let from_middle = |axis: usize| place[axis] as f64 - 0.5 * (self.counts[axis] - 1) as f64;
        Vector3::from_fn(|axis, _| from_middle(axis) * self.spacing[axis])
    }
}

/// The smallest cube that holds so many, without its empty layers.
fn near_cube(count: u64) -> [u64; 3] {
    let side = (1..).find(|side| side * side * side >= count).unwrap_or(1);
    [side, count.div_ceil(side * side), side]
}

fn counts(node: &Node<'_>, count: Option<u64>, problems: &mut Problems) -> Option<[u64; 3]> {
    let numbers = node.numbers::<3>("bodies along x, y, z", problems)?;
    let whole = |x: &f64| x.fract() == 0.0 && (1.0..=MOST as f64).contains(x);
    if !numbers.iter().all(whole) {
        node.problem(
            format!("are not three whole numbers from 1 to {MOST}"),
            problems,
        );
        return None;
    }
    let places: f64 = numbers.iter().product();
    if let Some(count) = count
        && places < count as f64
    {
        node.problem(
            format!("has {places} places for {count} bodies; take larger numbers or fewer bodies"),
            problems,
        );
        return None;
    }
    Some(numbers.map(|x| x as u64))
}

impl Random {
    /// Numbers set aside for a body, more than it takes, so that what comes later changes nothing.
    const NUMBERS: u64 = 16;

    fn read(node: Node<'_>, problems: &mut Problems) -> Option<Self> {
        let table = node.table("random = {…}".to_owned(), problems)?;
        let seed = match table.get("seed") {
            None => Some(0),
            Some(node) => node.whole(0, 1 << 53, problems),
        };
        let within = match table.get("within") {
            None => Some(Vector3::zeros()),
            Some(node) => node.vector("m", problems),
        };
        let spin = match table.get("spin") {
            None => Some(0.0),
            Some(node) => node.number("rad/s", problems).filter(|&spin| {
                let right = spin >= 0.0;
                if !right {
                    let why = "is below zero; it is the largest speed there may be (rad/s)";
                    node.problem(why, problems);
                }
                right
            }),
        };
        let orientation = match table.get("orientation") {
            None => Some(false),
            Some(node) => node.boolean(problems),
        };
        table.check_keys(problems);
        Some(Self {
            seed: seed?,
            within: within?,
            spin: spin?,
            orientation: orientation?,
        })
    }

    fn apply(&self, body: &mut Body, k: u64) {
        let three = |from: u64| {
            let number = |j: usize| draw::unit(self.seed, Self::NUMBERS * k + from + j as u64);
            std::array::from_fn(number)
        };
        body.position_w += draw::in_cube(three(0)).component_mul(&self.within);
        if self.orientation {
            body.q_wb = draw::attitude(three(3)) * body.q_wb;
        }
        if self.spin != 0.0 {
            body.omega_w += draw::in_ball(three(6)) * self.spin;
        }
    }
}
