//! The verification of a design in words.

use crate::model::{JointNames, Model};
use crate::study::{LimitedFigure, NEAR_RAD, STABILISED_SHARE, Verification, VerifiedLaw, Without};

/// Whether the simulated loop is stabilised, from how far, and what limits it.
///
/// Where joints of `model` slide, a spread in rad is as much in m.
pub fn verification_text(verified: &Verification, model: &Model) -> String {
    let (slides, names) = (model.slides(), &JointNames::of(model));
    let also_mm = |rad: f64| {
        if slides {
            format!(" and {:.1} mm", 1e3 * rad)
        } else {
            String::new()
        }
    };
    // Where the search ends, the region may be larger.
    let reach = |rad: f64, open: bool| {
        let from = if open { "at least" } else { "within" };
        format!("{from} {:.2} deg{}", rad.to_degrees(), also_mm(rad))
    };
    let near = &verified.near;
    let mut lines = vec![
        format!("\n{}", law(verified)),
        format!(
            "Simulated with every effect of the model, 5 s from {} random starts within {} deg{}{}: \
             {}.",
            near.runs,
            (10.0 * verified.near_rad.to_degrees()).round() / 10.0,
            also_mm(verified.near_rad),
            if verified.near_rad > NEAR_RAD {
                ", for nearer friction holds it by itself"
            } else {
                ""
            },
            verdict(verified)
        ),
    ];
    lines.extend(uncontrolled(verified));
    lines.push(lasting(verified));
    lines.extend(swing(verified, slides));
    lines.push(if verified.region_rad > 0.0 {
        format!(
            "Largest cube of starts of which 95 % are stabilised: {}.",
            reach(verified.region_rad, verified.region_open)
        )
    } else {
        "There is no cube of starts of which 95 % are stabilised.".to_string()
    });
    lines.extend(ellipsoid(verified, slides, names));
    if !verified.without.is_empty() {
        lines.push(format!(
            "Without the effects that the design leaves out: {}.",
            reach(
                verified.region_as_designed_rad,
                verified.region_as_designed_open
            )
        ));
        lines.push(limits(verified, names, &reach));
    }
    lines.join("\n")
}

/// Which law ran, on which measurements.
fn law(verified: &Verification) -> String {
    let angles = match verified.position_step_rad {
        0.0 => "exact angles".to_string(),
        step => format!("angles in steps of {:.3} deg", step.to_degrees()),
    };
    let speeds = if verified.differences {
        "their differences as speeds"
    } else {
        "exact speeds"
    };
    match verified.law {
        VerifiedLaw::FixedPoint => format!(
            "The law that is exported, bit for bit: the fixed-point table, given {angles} and \
             {speeds}."
        ),
        VerifiedLaw::GainsAndFilter => format!(
            "The law of gains and filter, in floating point, given {angles} and the gyro. It is in \
             --state-space alone: --rust, --c and --csv hold K, without the filter."
        ),
        VerifiedLaw::Continuous => format!(
            "The law in continuous time, in floating point, given {angles} and {speeds}; no table \
             is exported."
        ),
    }
}

fn verdict(verified: &Verification) -> String {
    let near = &verified.near;
    if near.stabilised_share < STABILISED_SHARE {
        return format!(
            "NOT stabilised: {} of them, {:.0} % fall",
            near.stabilised,
            100.0 * near.fallen_share
        );
    }
    if verified.held {
        return "NOT stabilised: it stays, but without control it stays, too".to_string();
    }
    if !verified.lasting.is_stable() {
        return "NOT stabilised: it stays for so long, and then no more".to_string();
    }
    if verified.stays_uncontrolled {
        return "it stays, but without control it stays, too".to_string();
    }
    "stabilised".to_string()
}

/// How it stands in the long run.
fn lasting(verified: &Verification) -> String {
    let lasting = &verified.lasting;
    let how = match lasting.manner {
        Some(manner) => format!(", {}", manner.words()),
        None => String::new(),
    };
    format!(
        "After {:.0} s {} of {} stand{how}.",
        lasting.seconds, lasting.stabilised, lasting.runs
    )
}

/// Limit cycle and torque.
fn swing(verified: &Verification, slides: bool) -> Option<String> {
    let near = &verified.near;
    let (cycle, torque) = (near.limit_cycle_rad?, near.rms_torque_nm?);
    let of = if near.stabilised_share >= STABILISED_SHARE {
        "medians".to_string()
    } else {
        format!("medians of the {} that stay alone", near.stabilised)
    };
    Some(format!(
        "Limit cycle {:.2} deg{} peak to peak, {torque:.3} N m{} RMS ({of}).",
        cycle.to_degrees(),
        if slides {
            format!(" or {:.2} mm", 1e3 * cycle)
        } else {
            String::new()
        },
        if slides { " or N" } else { "" }
    ))
}

/// Which effect limits what, taken out alone.
fn limits(
    verified: &Verification,
    names: &JointNames,
    reach: &dyn Fn(f64, bool) -> String,
) -> String {
    let place = |without: &Without| match without.joint {
        Some(joint) => format!("{} at joint {}", without.effect, names.label(joint - 1)),
        None => without.effect.to_string(),
    };
    let region = verified.limiting(LimitedFigure::Region).map(|without| {
        format!(
            "region by {}: without it {}",
            place(without),
            reach(without.region_rad, without.region_open)
        )
    });
    let swing = verified.limiting(LimitedFigure::Swing).and_then(|without| {
        let cycle = without.limit_cycle_rad?.to_degrees();
        Some(format!(
            "limit cycle by {}: without it {cycle:.2} deg",
            place(without)
        ))
    });
    let torque = verified.limiting(LimitedFigure::Torque);
    let torque = torque.and_then(|without| {
        let torque = without.rms_torque_nm?;
        Some(format!(
            "torque by {}: without it {torque:.3} N m",
            place(without)
        ))
    });
    let limited: Vec<String> = [region, swing, torque].into_iter().flatten().collect();
    if limited.is_empty() {
        return "With these gains none of them alone limits region, limit cycle or torque."
            .to_string();
    }
    format!("Limited, with these gains, {}.", limited.join("; "))
}

/// The region's shape: how far along each of its axes, and where it is weak.
fn ellipsoid(verified: &Verification, slides: bool, names: &JointNames) -> Option<String> {
    let ellipsoid = verified.ellipsoid.as_ref()?;
    let axes = ellipsoid.half_axes_rad.iter();
    let axes: Vec<String> = axes.map(|rad| format!("{:.2}", rad.to_degrees())).collect();
    let weak = ellipsoid.directions.first()?.iter().enumerate();
    let weak: Vec<String> = weak
        .map(|(joint, share)| match names.joint(joint + 1) {
            Some(name) => format!("{name} {share:+.2}"),
            None => format!("{share:+.2}"),
        })
        .collect();
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
    let verdict = if verified.near.stabilised_share >= STABILISED_SHARE {
        "these runs prove nothing of the gains"
    } else {
        "the gains drive it away"
    };
    verified.stays_uncontrolled.then(|| {
        format!(
            "With all gains at zero it stays from {} of the same {} starts: friction or the drives \
             themselves hold it, and {verdict}.",
            without.stabilised, without.runs
        )
    })
}
