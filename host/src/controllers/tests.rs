use super::*;
use crate::Model;
use crate::synth::{dlqr, lost_share, upright, zoh};
use nalgebra::DMatrix;
use std::path::Path;

fn model() -> Model {
    let text = include_str!("../../models/handstand.toml");
    Model::parse(text, Path::new("handstand.toml")).unwrap()
}

/// Tries a controller on 100 robots that start within 2 deg.
fn tried(id: &str, under: &str) -> Tried {
    let model = model();
    let pose = upright(&model);
    let robots = Robots {
        model: &model,
        pose_rad: &pose,
        period_s: 0.01,
        count: 100,
        spread_rad: 2f64.to_radians(),
        seconds: 5.0,
        seed: 7,
    };
    let condition = condition(under).unwrap();
    let known = condition.tell(&DesignModel::ideal(&model, &pose, 0.01).unwrap());
    try_out(&robots, design(id).unwrap(), condition, &known, &|| ()).unwrap()
}

#[test]
fn under_everything_at_once_the_paper_s_regulator_fails_and_the_best_holds() {
    let best = tried("best", "all");
    assert!(best.held >= 0.94, "{best:?}");
    for paper in ["dlqr", "dlqr-compensated"] {
        let paper = tried(paper, "all");
        assert!(paper.held < 0.05, "{paper:?}");
    }
}

#[test]
fn the_paper_s_findings_hold() {
    // Figure 13: the sampled regulator holds, with 10-bit angles too.
    assert!(tried("dlqr", "ideal").held >= 0.95);
    assert!(tried("dlqr", "positions").held >= 0.95);
    // Figure 12: eccentric masses need the compensation.
    let (plain, told) = (
        tried("dlqr", "eccentric"),
        tried("dlqr-compensated", "eccentric"),
    );
    assert!(plain.held < 0.7 && told.held >= 0.95, "{plain:?} {told:?}");
    // Figure 14: the gyro is survived by most, the dead zone by none.
    assert!(tried("dlqr", "gyro").held >= 0.7);
    assert!(tried("dlqr", "dead-zone").held < 0.05);
    // Equation 1 is no way to tell speeds to this regulator.
    assert!(tried("dlqr-differences", "ideal").held < 0.05);
}

#[test]
fn each_remedy_mends_what_it_is_made_for() {
    for (id, under) in [
        ("dead-zone-inverse", "dead-zone"),
        ("offset-observer", "eccentric"),
        ("lqg", "delay"),
        ("lqg", "gyro"),
        ("servo-model", "servo"),
        ("sliding", "delay"),
        ("robust", "masses"),
    ] {
        let tried = tried(id, under);
        assert!(tried.held >= 0.9, "{id} under {under}: {tried:?}");
    }
    assert!(tried("dlqr", "servo").held < 0.05);
    assert!(tried("dlqr", "delay").held < 0.05);
}

#[test]
fn names_are_told_once_and_found() {
    for (index, one) in DESIGNS.iter().enumerate() {
        let card = one.info();
        assert_eq!(design(card.id).unwrap().info().title, card.title);
        assert!(
            DESIGNS[..index]
                .iter()
                .all(|other| other.info().id != card.id)
        );
        assert!(!card.law.is_empty() && !card.reference.is_empty());
    }
    assert!(design("pid").is_none() && condition("rain").is_none());
}

#[test]
fn wrong_masses_fell_the_paper_s_gain_and_not_the_multi_model_one() {
    let model = model();
    let pose = upright(&model);
    let uncertain = |mass: f64, with_inertia: bool| Uncertain {
        mass,
        with_inertia,
        period_s: 0.01,
        delay_s: 0.0,
    };
    let nominal = uncertain(0.0, false)
        .plant(&model, &pose, &[0.0; 3])
        .unwrap();
    let (q, r) = (DMatrix::identity(6, 6), DMatrix::identity(2, 2));
    let robust = robust_gain(&model, &pose, &uncertain(SHARE, false), &(&q * WEIGHTS)).unwrap();
    for with_inertia in [false, true] {
        let robots = uncertain(0.1, with_inertia)
            .draw(&model, &pose, 600, 5)
            .unwrap();
        let lost = |q: DMatrix<f64>| lost_share(&robots, &dlqr(&nominal, &q, &r).unwrap().k);
        let (hundred, one) = (lost(100.0 * &q), lost(q.clone()));
        assert!((0.19..0.29).contains(&hundred), "{hundred}");
        assert!((0.12..0.22).contains(&one), "{one}");
        assert!(lost_share(&robots, &robust) <= 0.02);
    }
}

#[test]
fn the_longest_delay_is_the_one_of_the_eigenvalues() {
    let model = model();
    let pose = upright(&model);
    let known = DesignModel::ideal(&model, &pose, 0.01).unwrap();
    let longest = |id: &str, told: Option<f64>| {
        longest_linear(design(id).unwrap(), &known, told, 1e-3, 0.03).unwrap()
    };
    let dlqr_longest = longest("dlqr", Some(0.0));
    let (q, r) = known.weights();
    let k = dlqr(&zoh(&known.plant, 0.01, 0.0).unwrap(), &q, &r)
        .unwrap()
        .k;
    // By eigenvalues of the loop with the late inputs as states.
    let stable = |delay_s: f64| {
        let plant = zoh(&known.plant, 0.01, delay_s).unwrap();
        let k = k.clone().resize(2, plant.a.nrows(), 0.0);
        let closed = &plant.a - &plant.b * k;
        closed
            .complex_eigenvalues()
            .iter()
            .all(|pole| pole.norm() < 1.0)
    };
    let most = dlqr_longest.delay_s.unwrap();
    assert!(stable(most) && !stable(most + 1e-3), "{most}");
    assert!(
        most < 0.01,
        "one sample of delay is too much for the paper's regulator"
    );
    let told = longest("best", None);
    assert!(told.open, "{told:?}");
    let one = longest("best", Some(0.01));
    assert!(one.survives(0.01) && !one.survives(0.0), "{one:?}");
}

#[test]
fn figures_are_the_same_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| tried("best", "all-masses"))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn other_drives_are_refused() {
    let text = include_str!("../../models/handstand.toml").replacen(
        "drive = \"torque\"",
        "drive = \"duty\"\nstall_torque_nm = 1.5\nnominal_supply_v = 9.8",
        1,
    );
    let text = text.replacen(
        "\"torque2_nm\", unit = \"N m\"",
        "\"duty2\", unit = \"1\"",
        1,
    );
    let model = Model::parse(&text, Path::new("handstand.toml")).unwrap();
    let refused = DesignModel::ideal(&model, &upright(&model), 0.01).unwrap_err();
    assert!(refused.to_string().contains("joint 2"), "{refused}");
}
