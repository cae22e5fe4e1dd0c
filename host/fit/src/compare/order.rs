//! Where a value stands among all.

/// Value below which this share of the magnitudes lies; not a number without values or where it is
/// zero.
pub(super) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sizes: Vec<f64> = values
        .iter()
        .map(|v| v.abs())
        .filter(|v| v.is_finite())
        .collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let at = (share * sizes.len() as f64) as usize;
    sizes
        .get(at.min(sizes.len().saturating_sub(1)))
        .copied()
        .filter(|v| *v > 0.0)
        .unwrap_or(f64::NAN)
}

/// Each value's place in the order of all, 0 to 1, equals sharing the middle; not a number where
/// all are equal.
pub(super) fn ranks(values: &[f64], magnitude: bool) -> Vec<f64> {
    let key = |i: &usize| {
        if magnitude {
            values[*i].abs()
        } else {
            values[*i]
        }
    };
    let mut order: Vec<usize> = (0..values.len())
        .filter(|i| values[*i].is_finite())
        .collect();
    order.sort_unstable_by(|a, b| key(a).total_cmp(&key(b)));
    let count = order.len();
    let mut ranks = vec![f64::NAN; values.len()];
    for equal in order.chunk_by(|a, b| key(a) == key(b)) {
        if equal.len() == count {
            break;
        }
        let below = order.partition_point(|i| key(i) < key(&equal[0]));
        for i in equal {
            ranks[*i] = (below as f64 + 0.5 * equal.len() as f64) / count as f64;
        }
    }
    ranks
}
