use super::*;
use crate::sysid::generate::noise;

fn measured(edge: f64, slope: f64, limit: f64, deviation: f64, seed: u64) -> Vec<BlockMean> {
    let noise = noise(201, deviation, seed);
    (0..201)
        .map(|k| {
            let input = (k as f64 - 100.0) / 100.0;
            let size = (slope * (input.abs() - edge).max(0.0)).min(limit);
            BlockMean {
                input,
                output: size.copysign(input) + noise[k],
                supply_v: f64::NAN,
            }
        })
        .collect()
}

#[test]
fn intervals_hold_the_truth() {
    let mut held = [0; 3];
    for seed in 0..100 {
        let map = DeadZoneMap::fit(&measured(0.085, 3.0, 2.0, 0.05, seed)).unwrap();
        held[0] += usize::from(map.up.edge.holds(0.085));
        held[1] += usize::from(map.up.slope.holds(3.0));
        held[2] += usize::from(map.up.limit.is_some_and(|limit| limit.holds(2.0)));
    }
    assert!(held.iter().all(|count| *count >= 90), "{held:?}");
}

#[test]
fn no_limit_is_seen_where_there_is_none() {
    let map = DeadZoneMap::fit(&measured(0.1, 2.0, f64::INFINITY, 0.02, 1)).unwrap();
    assert_eq!((map.up.limit, map.down.limit), (None, None));
    assert!((map.down.edge.value - 0.1).abs() < 0.02);
}

#[test]
fn the_inverse_undoes_the_map() {
    let map = DeadZoneMap::fit(&measured(0.085, 3.0, 2.0, 0.01, 4)).unwrap();
    let inverse = map.inverse();
    for output in [-1.9, -0.3, 0.2, 1.5] {
        assert!((map.output(inverse.input(output)) - output).abs() < 1e-9);
    }
    assert_eq!(inverse.input(0.0), 0.0);
    assert_eq!(inverse.input(9.0), inverse.input(inverse.limit.unwrap()));
}

#[test]
fn what_never_moves_is_no_map() {
    let still: Vec<BlockMean> = measured(2.0, 1.0, 1.0, 0.0, 1);
    let refused = |blocks: &[BlockMean]| DeadZoneMap::fit(blocks).unwrap_err().to_string();
    assert_eq!(
        refused(&still),
        "the output does not grow with positive inputs"
    );
    let one_sided: Vec<BlockMean> = measured(0.1, 1.0, 1.0, 0.01, 1)
        .into_iter()
        .filter(|block| block.input > 0.0)
        .collect();
    assert_eq!(
        refused(&one_sided),
        "0 blocks of negative inputs where 4 are the least"
    );
}
