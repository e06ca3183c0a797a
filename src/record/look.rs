//! Colours and line widths, chosen once by quantity, readable on dark and on light ground.
//!
//! Contrast against black and against white is at least 3 for each (WCAG's bound for graphics),
//! but for the amber line and the green area, which reach 2.7 on white.

/// RGBA, as Rerun packs it.
pub type Colour = u32;

pub const FORCE: Colour = 0xE0_31_31_FF;
pub const TORQUE: Colour = 0xBE_4B_DB_FF;
pub const ALPHA: Colour = 0xD9_7B_00_FF;
pub const OMEGA: Colour = 0x0C_92_A8_FF;
pub const MOMENTUM: Colour = 0x5C_7C_FA_FF;
pub const INERTIA: Colour = 0x37_B2_4D_FF;
pub const PIVOT: Colour = 0x86_8E_96_FF;
pub const NAME: Colour = 0x80_88_90_FF;

/// What turns a body, in the order of the scene: a torque's source has the same colour in every
/// picture and plot of a recording.
pub const SOURCES: [Colour; 8] = [
    0xE8_59_0C_FF,
    0x1C_7E_D6_FF,
    0x2B_8A_3E_FF,
    0xD6_33_6C_FF,
    0x0C_85_99_FF,
    0x91_67_E0_FF,
    0x9C_74_00_FF,
    0x75_84_94_FF,
];

/// Components of a vector in a plot of one body: x, y, z.
pub const COMPONENTS: [Colour; 3] = [0xE0_31_31_FF, 0x2B_8A_3E_FF, 0x33_7A_E0_FF];

/// Bodies, in the order of the scene, again from the start where there are more: hues that no
/// quantity has.
pub const BODIES: [Colour; 8] = [
    0x4A_8F_C7_FF,
    0xA9_74_4F_FF,
    0x75_84_94_FF,
    0x86_8B_3A_FF,
    0xC2_70_8F_FF,
    0x5E_7F_A8_FF,
    0x6B_8E_86_FF,
    0x9A_80_68_FF,
];

/// The ground grid. The background is the viewer's own, which follows its theme as labels do.
pub const GRID: Colour = 0x80_88_90_60;

/// Radii of lines, in points of the screen, so that nothing vanishes in the distance.
pub const BOLD: f32 = 2.6;
pub const MEDIUM: f32 = 2.0;
pub const THIN: f32 = 1.1;

/// The same colour with another opacity.
pub fn with_alpha(colour: Colour, alpha: u8) -> Colour {
    (colour & 0xFFFF_FF00) | u32::from(alpha)
}

/// The colour mixed with white by `part`.
pub fn lightened(colour: Colour, part: f32) -> Colour {
    let mut mixed = colour & 0xFF;
    for shift in [8, 16, 24] {
        let channel = ((colour >> shift) & 0xFF) as f32;
        let channel = (channel + (255.0 - channel) * part).round() as u32;
        mixed |= channel << shift;
    }
    mixed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance by WCAG 2.2.
    fn luminance(colour: Colour) -> f64 {
        let linear = |shift: u32| {
            let c = f64::from((colour >> shift) & 0xFF) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(24) + 0.7152 * linear(16) + 0.0722 * linear(8)
    }

    fn contrast(a: Colour, b: Colour) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_colour_reads_on_dark_and_on_light() {
        let quantities = [FORCE, TORQUE, ALPHA, OMEGA, MOMENTUM, INERTIA];
        let lines = SOURCES.iter().chain(&COMPONENTS).chain(&BODIES);
        let all = quantities.iter().chain(lines);
        for &colour in all {
            let on_white = match colour {
                ALPHA | INERTIA => 2.7,
                _ => 3.0,
            };
            assert!(contrast(colour, 0xFF) >= 3.0, "{colour:08X} on black");
            let seen = contrast(colour, 0xFFFF_FFFF);
            assert!(seen >= on_white, "{colour:08X} on white: {seen}");
        }
    }
}
