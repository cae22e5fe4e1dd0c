//! Moments of inertia as files write them: rounding below zero, and such as no body has.

use super::xml::Element;
use crate::error::Result;
use nalgebra::Matrix3;

/// Moments this small beside the mass are the noise of who computed them, m^2.
const NOISE_M2: f64 = 1e-12;
/// Two principal moments may fall short of the third by such a share of it: files round.
const ROUNDED: f64 = 1e-3;

/// Moments whose noise is taken away, and what is impossible about them.
///
/// # Errors
/// A mass, or a moment about an axis, that is below zero by more than noise.
pub(super) fn checked(
    element: Element,
    mass_kg: f64,
    moments: Matrix3<f64>,
) -> Result<(Matrix3<f64>, Option<String>)> {
    let noise = NOISE_M2 * mass_kg.abs();
    let mut checked = moments;
    for axis in 0..3 {
        let moment = &mut checked[(axis, axis)];
        if mass_kg < 0.0 || *moment < -noise {
            return Err(element.wrong("a mass or a moment of inertia is below 0", "mend its sign"));
        }
        *moment = moment.max(0.0);
    }
    Ok((checked, impossible(&checked, noise)))
}

/// What no body's moments can be, in words.
fn impossible(moments: &Matrix3<f64>, noise: f64) -> Option<String> {
    let mut principal: Vec<f64> = moments.symmetric_eigenvalues().iter().copied().collect();
    principal.sort_by(f64::total_cmp);
    let [least, middle, most] = principal[..] else {
        return None;
    };
    let rounding = noise + ROUNDED * most;
    let what = if least < -rounding {
        "are not all above 0"
    } else if most - middle - least > rounding {
        "break the triangle inequality: two together are never less than the third"
    } else {
        return None;
    };
    Some(format!(
        "its principal moments {least:.3e}, {middle:.3e} and {most:.3e} kg m^2 {what}; no body has \
         such, they are taken as written: see in the CAD that they are about the centre of mass, \
         and which sign its products have"
    ))
}
