//! Vectors, 3×3 matrices and quaternions of the zoo's own: nothing of the crate's, whose bugs it would share.
//!
//! Quaternions are (x, y, z, w), body to world.

pub type V = [f64; 3];
pub type M = [[f64; 3]; 3];
pub type Q = [f64; 4];

pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scaled(a: V, s: f64) -> V {
    a.map(|x| x * s)
}

pub fn sub(a: V, b: V) -> V {
    add(a, scaled(b, -1.0))
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn norm(a: V) -> f64 {
    dot(a, a).sqrt()
}

pub fn apply(m: &M, v: V) -> V {
    [dot(m[0], v), dot(m[1], v), dot(m[2], v)]
}

pub fn transposed(m: &M) -> M {
    let [a, b, c] = *m;
    [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]]
}

pub fn product(a: &M, b: &M) -> M {
    let b = transposed(b);
    a.map(|row| b.map(|column| dot(row, column)))
}

pub fn diagonal(d: V) -> M {
    [[d[0], 0.0, 0.0], [0.0, d[1], 0.0], [0.0, 0.0, d[2]]]
}

/// By cofactors.
pub fn inverse(m: &M) -> M {
    let columns = transposed(m);
    let volume = dot(columns[0], cross(columns[1], columns[2]));
    [
        scaled(cross(columns[1], columns[2]), 1.0 / volume),
        scaled(cross(columns[2], columns[0]), 1.0 / volume),
        scaled(cross(columns[0], columns[1]), 1.0 / volume),
    ]
}

/// `R m Rᵀ`.
pub fn carried(r: &M, m: &M) -> M {
    product(&product(r, m), &transposed(r))
}

pub fn times(a: Q, b: Q) -> Q {
    let (u, v) = ([a[0], a[1], a[2]], [b[0], b[1], b[2]]);
    let w = add(add(cross(u, v), scaled(v, a[3])), scaled(u, b[3]));
    [w[0], w[1], w[2], a[3] * b[3] - dot(u, v)]
}

pub fn length(q: Q) -> f64 {
    q.iter().map(|x| x * x).sum::<f64>().sqrt()
}

pub fn unit(q: Q) -> Q {
    let l = length(q);
    q.map(|x| x / l)
}

pub fn conjugate(q: Q) -> Q {
    [-q[0], -q[1], -q[2], q[3]]
}

/// The turn by a rotation vector.
pub fn turn(v: V) -> Q {
    let angle = norm(v);
    let (sin, cos) = libm::sincos(0.5 * angle);
    let s = if angle > 1e-12 { sin / angle } else { 0.5 };
    [v[0] * s, v[1] * s, v[2] * s, cos]
}

pub fn matrix(q: Q) -> M {
    let [x, y, z, w] = unit(q);
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

/// Numbers as good as random: a 64-bit linear congruence (Knuth's MMIX constants), its upper bits stirred.
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        let mut draw = Self(seed ^ 0x5851_f42d_4c95_7f2d);
        for _ in 0..4 {
            draw.unit();
        }
        draw
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let x = self.0 ^ (self.0 >> 29);
        (x.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.unit() * choices.len() as f64) as usize]
    }

    /// By Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.unit())
    }

    pub fn normals(&mut self) -> V {
        [self.normal(), self.normal(), self.normal()]
    }

    pub fn direction(&mut self) -> V {
        let v = self.normals();
        scaled(v, 1.0 / norm(v))
    }

    pub fn attitude(&mut self) -> Q {
        let [x, y, z] = self.normals();
        unit([x, y, z, self.normal()])
    }
}
