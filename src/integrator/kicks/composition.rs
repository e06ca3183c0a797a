//! Compositions of free motion A and kicks B: their coefficients.
//!
//! All are palindromes whose sums are 1; the tables give the first half without its last entry,
//! which closes the sum.

#![expect(clippy::excessive_precision, reason = "digits as published")]

use crate::integrator::{Accepts, Cost, Damping, Kind, MethodInfo, Models};

/// `A(a1 h) B(b1 h) A(a2 h) …`, or with B first.
#[derive(Debug)]
pub struct Composition {
    pub info: MethodInfo,
    pub first: First,
    /// Lengths of the drifts, in steps.
    pub a: &'static [f64],
    /// Weights of the kicks.
    pub b: &'static [f64],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum First {
    Drift,
    Kick,
}

/// The palindrome of N numbers with sum 1 that begins so: its middle, one number or two, closes the sum.
const fn closed<const N: usize>(beginning: &[f64]) -> [f64; N] {
    let mut all = [0.0; N];
    let mut sum = 0.0;
    let mut k = 0;
    while k < beginning.len() {
        all[k] = beginning[k];
        all[N - 1 - k] = beginning[k];
        sum += beginning[k];
        k += 1;
    }
    let middle = if N % 2 == 1 {
        1.0 - 2.0 * sum
    } else {
        0.5 - sum
    };
    all[k] = middle;
    all[N - 1 - k] = middle;
    all
}

/// Weights γ of Strang's steps as drifts: `γ1/2, (γ1 + γ2)/2, …, γ15/2`.
const fn between<const N: usize, const M: usize>(gamma: &[f64; N]) -> [f64; M] {
    let mut all = [0.0; M];
    let mut k = 0;
    while k < N {
        all[k] += 0.5 * gamma[k];
        all[k + 1] += 0.5 * gamma[k];
        k += 1;
    }
    all
}

const fn info(
    name: &'static str,
    order: u32,
    evaluations: u32,
    weight: f64,
    citation: &'static str,
) -> MethodInfo {
    MethodInfo {
        name,
        engines: &[],
        kind: Kind::Fixed,
        order,
        weak_orders: None,
        accepts: Accepts::Place,
        models: Models::Both,
        damping: Damping::Exact("exact, as part of the free motion"),
        reversible: true,
        keeps_momentum: true,
        exact_free: true,
        preserves: "free motion exactly; symplectic: energy under forces of place stays within bounds",
        cost: Cost {
            evaluations: Some(evaluations),
            weight,
        },
        citation,
    }
}

pub const STRANG: Composition = Composition {
    info: info(
        "strang",
        2,
        1,
        0.69,
        "Strang, SIAM J. Numer. Anal. 5 (1968) 506; Touma & Wisdom, Astron. J. 107 (1994) 1189",
    ),
    // Half the error of the one with kicks outside, on the tests' top.
    first: First::Drift,
    a: &[0.5, 0.5],
    b: &[1.0],
};

pub const RKN4: Composition = Composition {
    info: info(
        "rkn4",
        4,
        6,
        3.9,
        "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, SRKN b6",
    ),
    first: First::Kick,
    a: &closed::<6>(&[0.245298957184271, 0.604872665711080]),
    b: &closed::<7>(&[0.0829844064174052, 0.396309801498368, -0.0390563049223486]),
};

pub const RKN6: Composition = Composition {
    info: info(
        "rkn6",
        6,
        14,
        8.5,
        "Blanes & Moan, J. Comput. Appl. Math. 142 (2002) 313, SRKN a14",
    ),
    first: First::Drift,
    a: &closed::<15>(&[
        0.0378593198406116,
        0.102635633102435,
        -0.0258678882665587,
        0.314241403071447,
        -0.130144459517415,
        0.106417700369543,
        -0.00879424312851058,
    ]),
    b: &closed::<14>(&[
        0.09171915262446165,
        0.183983170005006,
        -0.05653436583288827,
        0.004914688774712854,
        0.143761127168358,
        0.328567693746804,
    ]),
};

/// Suzuki and Umeno's weights of 15 steps of order 2 that make one of order 8.
const S15: [f64; 15] = closed(&[
    0.741670364350612953448,
    -0.409100825800031593997,
    0.190754710296238379954,
    -0.573862471116082266656,
    0.299064181303655923844,
    0.334624918245298183785,
    0.315293092396766596632,
]);

pub const ORDER8: Composition = Composition {
    info: info(
        "s15",
        8,
        15,
        9.2,
        "Suzuki & Umeno 1993; McLachlan, SIAM J. Sci. Comput. 16 (1995) 151; Hairer, Lubich & Wanner, Geometric Numerical Integration, V.3.2",
    ),
    first: First::Drift,
    a: &between::<15, 16>(&S15),
    b: &S15,
};

pub const ABA864: Composition = Composition {
    info: MethodInfo {
        weak_orders: Some([8, 6, 4]),
        ..info(
            "aba864",
            4,
            7,
            4.4,
            "Blanes, Casas, Farrés, Laskar, Makazaga & Murua, Appl. Numer. Math. 68 (2013) 58, ABA(8,6,4)",
        )
    },
    first: First::Drift,
    a: &closed::<8>(&[
        0.0711334264982231177779,
        0.241153427956640098736,
        0.521411761772814789212,
    ]),
    b: &closed::<7>(&[
        0.183083687472197221962,
        0.310782859898574869508,
        -0.0265646185119588006972,
    ]),
};

pub const ABA1064: Composition = Composition {
    info: MethodInfo {
        weak_orders: Some([10, 6, 4]),
        ..info(
            "aba1064",
            4,
            8,
            5.1,
            "Blanes, Casas, Farrés, Laskar, Makazaga & Murua, Appl. Numer. Math. 68 (2013) 58, ABA(10,6,4)",
        )
    },
    first: First::Drift,
    a: &closed::<9>(&[
        0.0380944974224121954570,
        0.145298716116913749294,
        0.207627695725541250716,
        0.435909703651526159223,
    ]),
    b: &closed::<8>(&[
        0.0958588808370752106108,
        0.204446153142998780681,
        0.217070347978991101714,
    ]),
};
