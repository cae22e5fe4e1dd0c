//! The verification of a design in words.

use crate::study::{Verification, Without};

/// Whether the simulated loop is stabilised, from how far, and what limits it.
///
/// Where joints slide, a spread in rad is as much in m.
pub fn verification_text(verified: &Verification, slides: bool) -> String {
    let also_mm = |rad: f64| match slides {
        true => format!(" and {:.1} mm", 1e3 * rad),
        false => String::new(),
    };
    // Where the search ends, the region may be larger.
    let reach = |rad: f64, open: bool| {
        let from = if open { "at least" } else { "within" };
        format!("{from} {:.1} deg{}", rad.to_degrees(), also_mm(rad))
    };
    let near = &verified.near;
    let mut lines = vec![format!(
        "\nSimulated with every effect of the model, 5 s from {} random starts within 0.5 deg{}: \
         {}.",
        near.runs,
        also_mm(0.5f64.to_radians()),
        match (verified.stabilised, verified.stays_uncontrolled) {
            (true, true) => "it stays, but without control it stays, too".to_string(),
            (true, false) => "stabilised".to_string(),
            (false, _) => format!(
                "NOT stabilised: {} of them, {:.0} % fall",
                near.stabilised,
                100.0 * near.fallen_share
            ),
        }
    )];
    lines.extend(uncontrolled(verified));
    if let (Some(cycle), Some(torque)) = (near.limit_cycle_rad, near.rms_torque_nm) {
        lines.push(format!(
            "Limit cycle {:.2} deg{} peak to peak, {torque:.3} N m{} RMS (medians).",
            cycle.to_degrees(),
            if slides {
                format!(" or {:.2} mm", 1e3 * cycle)
            } else {
                String::new()
            },
            if slides { " or N" } else { "" }
        ));
    }
    lines.push(match verified.region_rad > 0.0 {
        true => format!(
            "Largest cube of starts of which 95 % are stabilised: {}.",
            reach(verified.region_rad, verified.region_open)
        ),
        false => "There is no cube of starts of which 95 % are stabilised.".to_string(),
    });
    lines.extend(ellipsoid(verified, slides));
    if !verified.without.is_empty() {
        let place = |without: &Without| match without.joint {
            Some(joint) => format!("{} at joint {joint}", without.effect),
            None => without.effect.to_string(),
        };
        lines.push(format!(
            "Without the effects that the design leaves out: {}.",
            reach(
                verified.region_as_designed_rad,
                verified.region_as_designed_open
            )
        ));
        lines.push(match verified.limiting() {
            Some(limiting) => format!(
                "It is limited by {}: without it {}.",
                place(limiting),
                reach(limiting.region_rad, limiting.region_open)
            ),
            None => "None of them alone limits it.".to_string(),
        });
    }
    lines.join("\n")
}

/// The region's shape: how far along each of its axes, and where it is weak.
fn ellipsoid(verified: &Verification, slides: bool) -> Option<String> {
    let ellipsoid = verified.ellipsoid.as_ref()?;
    let axes = ellipsoid.half_axes_rad.iter();
    let axes: Vec<String> = axes.map(|rad| format!("{:.1}", rad.to_degrees())).collect();
    let weak = ellipsoid.directions.first()?.iter();
    let weak: Vec<String> = weak.map(|share| format!("{share:+.2}")).collect();
    Some(format!(
        "Ellipsoid of starts of which 95 % are stabilised: half-axes {}{} deg{}, weak along ({}); \
         {} of {} runs within it.",
        if ellipsoid.open { "at least " } else { "" },
        axes.join(", "),
        if slides { " (1 deg as 17.5 mm)" } else { "" },
        weak.join(", "),
        ellipsoid.stabilised,
        ellipsoid.runs
    ))
}

/// That the robot stays without control as well, if it does.
fn uncontrolled(verified: &Verification) -> Option<String> {
    let without = &verified.uncontrolled;
    let verdict = match verified.stabilised {
        true => "these runs prove nothing of the gains",
        false => "the gains drive it away",
    };
    verified.stays_uncontrolled.then(|| {
        format!(
            "With all gains at zero it stays from {} of the same {} starts: friction or the drives \
             themselves hold it, and {verdict}.",
            without.stabilised, without.runs
        )
    })
}
