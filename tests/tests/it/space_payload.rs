//! A mass bolted onto a robot in space, as its logs say.

use crate::space::{CRANE, import_crane, run, swung_tree};
use handstand::Model;
use nalgebra::Vector3;

const PAYLOAD_KG: f64 = 0.25;
const AT_M: [f64; 3] = [0.02, -0.01, -0.12];

#[test]
fn a_log_with_a_payload_is_followed_where_the_log_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    import_crane(at, CRANE);
    let file = at.join("crane.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let payload = format!(
        "[log]\npayload = {{ column = \"tool_kg\", unit = \"kg\", link = \"head\", \
         at_m = {AT_M:?} }}"
    );
    let friction = "[[effect]]\nkind = \"viscous\"\njoint = 2\ncoefficient_nm_s_rad = 0.06\n\n";
    let text = text.replace("[log]", &[friction, &payload].concat());
    std::fs::write(&file, text).unwrap();
    let tree = Model::load(&file).unwrap().tree().unwrap();
    let mut loaded = tree.clone();
    loaded.bolt_on(2, PAYLOAD_KG, Vector3::from(AT_M));
    for (name, tree, said_kg) in [
        ("empty.csv", &tree, 0.0),
        ("loaded.csv", &loaded, PAYLOAD_KG),
        ("untold.csv", &loaded, 0.0),
    ] {
        let log = format!("# tool_kg = {said_kg}\n{}", swung_tree(tree, 1));
        std::fs::write(at.join(name), log).unwrap();
    }
    let rms_rad = |log: &str| {
        let (data, _) = run(
            at,
            &["compare", "crane.toml", log, "--json", "--horizon", "1"],
        );
        let signals = data["comparisons"][0]["signals"].as_array().unwrap().iter();
        let rms = signals.map(|signal| signal["rms_rad"].as_f64().unwrap());
        rms.fold(0.0, f64::max)
    };
    let [empty, told, untold] = ["empty.csv", "loaded.csv", "untold.csv"].map(rms_rad);
    assert!(empty < 2e-3 && told < 2e-3, "{empty} {told}");
    assert!(untold > 20.0 * told, "{told} {untold}");
    // What only a known mass tells, the next experiment asks for.
    let next = [
        "next",
        "crane.toml",
        "empty.csv",
        "--value",
        "link3.mass_kg",
        "--seconds",
        "6",
        "--mass",
        "0.25",
        "--json",
    ];
    let (data, _) = run(at, &next);
    let simulated = data["proposal"]["simulated"].as_u64().unwrap();
    let unloaded = [&next[..8], &["0", "--json"]].concat();
    let (data, _) = run(at, &unloaded);
    assert_eq!(
        data["proposal"]["simulated"].as_u64().unwrap() * 2,
        simulated
    );
}
