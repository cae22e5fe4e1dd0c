//! Where the search for a model's coefficients begins: linear least squares, refined.

use super::model::TransferModel;
use super::polynomial::{filter, multiply, stabilised};
use super::record::Record;
use super::structure::{Family, Structure};
use nalgebra::{DMatrix, DVector};

/// Largest root a start may have.
const MOST_ROOT: f64 = 0.98;
/// Order of the long ARX model whose errors stand for the noise.
const LONG: usize = 20;
/// Steiglitz-McBride rounds.
const ROUNDS: usize = 8;

/// Models to start from, stable ones; the search goes on from each.
pub(super) fn starts(structure: &Structure, records: &[Record]) -> Vec<TransferModel> {
    match structure.family {
        Family::Arx => {
            let orders = [structure.na, structure.nb, structure.nk];
            arx(orders, records, None, None).into_iter().collect()
        }
        Family::Armax => armax(structure, records).into_iter().collect(),
        Family::Oe | Family::Bj => {
            let orders = [structure.nf, structure.nb, structure.nk];
            let plain = arx(orders, records, None, None);
            let plants = [
                plain.clone(),
                instrumented(orders, records),
                plain.and_then(|plain| steiglitz_mcbride(orders, records, plain)),
            ];
            let with_noise = |plant: TransferModel| noise_model(structure, records, plant);
            plants.into_iter().flatten().map(with_noise).collect()
        }
    }
}

/// One column of a regression: a signal of each record, and its delay.
struct Regressor<'a> {
    signal: &'a [Vec<f64>],
    delay: usize,
}

/// Weights of `columns` whose error from `target` over the scored samples is orthogonal to
/// `instruments`, one per column (Ljung 1999, eq. 7.118): the least squares where these are the
/// columns themselves.
fn regress(
    records: &[Record],
    target: &[Vec<f64>],
    columns: &[Regressor],
    instruments: &[Regressor],
) -> Option<DVector<f64>> {
    let count = columns.len();
    let mut normal = DMatrix::<f64>::zeros(count, count);
    let mut right = DVector::zeros(count);
    let at = |column: &Regressor, r: usize, t: usize| match t.checked_sub(column.delay) {
        Some(t) => column.signal[r][t],
        None => 0.0,
    };
    let (mut row, mut test) = (vec![0.0; count], vec![0.0; count]);
    for (r, record) in records.iter().enumerate() {
        for t in record.scored.clone() {
            for k in 0..count {
                row[k] = at(&columns[k], r, t);
                test[k] = at(&instruments[k], r, t);
            }
            for (i, test) in test.iter().enumerate() {
                right[i] += test * target[r][t];
                for (k, value) in row.iter().enumerate() {
                    normal[(i, k)] += test * value;
                }
            }
        }
    }
    // Columns of one size, so that the threshold below is one of directions.
    let scale: Vec<f64> = (0..count)
        .map(|k| normal[(k, k)].abs().sqrt())
        .map(|size| if size > 0.0 { size } else { 1.0 })
        .collect();
    for i in 0..count {
        right[i] /= scale[i];
        for k in 0..count {
            normal[(i, k)] /= scale[i] * scale[k];
        }
    }
    // An instrument that grows without bound: no decomposition ends on numbers that are none.
    if !normal.iter().chain(right.iter()).all(|v| v.is_finite()) {
        return None;
    }
    let mut weights = normal.svd(true, true).solve(&right, 1e-12).ok()?;
    for (weight, scale) in weights.iter_mut().zip(&scale) {
        *weight /= scale;
    }
    weights.iter().all(|w| w.is_finite()).then_some(weights)
}

fn signals(records: &[Record], of: impl Fn(&Record) -> Vec<f64>) -> Vec<Vec<f64>> {
    records.iter().map(of).collect()
}

fn delayed<'a>(
    signal: &'a [Vec<f64>],
    delays: std::ops::Range<usize>,
) -> impl Iterator<Item = Regressor<'a>> {
    delays.map(move |delay| Regressor { signal, delay })
}

/// Least squares on `y = -a y(past) + b u`; filtered by `1/prefilter` first, where there is one.
/// With an `instrument`, what that model makes of the input stands for the past outputs' own noise.
fn arx(
    [na, nb, nk]: [usize; 3],
    records: &[Record],
    prefilter: Option<&[f64]>,
    instrument: Option<&TransferModel>,
) -> Option<TransferModel> {
    let through = |signal: &[f64]| match prefilter {
        Some(denominator) => filter(&[1.0], denominator, signal),
        None => signal.to_vec(),
    };
    let output = signals(records, |r| through(&r.output));
    let input = signals(records, |r| through(&r.input));
    let clean = instrument.map(|model| signals(records, |r| model.simulated(&r.input)));
    let past = |output| -> Vec<Regressor> {
        let output = delayed(output, 1..na + 1);
        output.chain(delayed(&input, nk..nk + nb)).collect()
    };
    let (columns, instruments) = (past(&output), past(clean.as_ref().unwrap_or(&output)));
    let mut weights = regress(records, &output, &columns, &instruments)?;
    weights.rows_mut(0, na).neg_mut();
    let structure = Structure::arx([na, nb, nk]);
    Some(TransferModel::of(&structure, weights.as_slice()))
}

/// Order of the long ARX model that the records can carry.
fn long_order(records: &[Record]) -> usize {
    let samples: usize = records.iter().map(Record::count).sum();
    LONG.min(samples / 10).max(1)
}

/// A long ARX model: its errors come near the noise's own innovations.
fn long_arx(nk: usize, records: &[Record]) -> Option<TransferModel> {
    let order = long_order(records);
    arx([order, order, nk], records, None, None)
}

/// Extended least squares: past errors of a long ARX model stand for the noise.
fn armax(structure: &Structure, records: &[Record]) -> Option<TransferModel> {
    let long = long_arx(structure.nk, records)?;
    let (na, nb, nc, nk) = (structure.na, structure.nb, structure.nc, structure.nk);
    let output = signals(records, |r| r.output.clone());
    let input = signals(records, |r| r.input.clone());
    let errors = signals(records, |r| long.errors(r));
    let columns: Vec<Regressor> = delayed(&output, 1..na + 1)
        .chain(delayed(&input, nk..nk + nb))
        .chain(delayed(&errors, 1..nc + 1))
        .collect();
    let mut weights = regress(records, &output, &columns, &columns)?;
    weights.rows_mut(0, na).neg_mut();
    let mut model = TransferModel::of(structure, weights.as_slice());
    model.c = stabilised(&model.c, MOST_ROOT);
    Some(model)
}

/// B/F by instrumental variables: the long ARX model's noise-free output as the instrument.
fn instrumented(orders: [usize; 3], records: &[Record]) -> Option<TransferModel> {
    let mut long = long_arx(orders[2], records)?;
    long.a = stabilised(&long.a, MOST_ROOT);
    arx(orders, records, None, Some(&long))
}

/// B/F by least squares on signals filtered by the denominator found before (Steiglitz & McBride,
/// IEEE Trans. Automatic Control 10, 1965, 461-464).
fn steiglitz_mcbride(
    orders: [usize; 3],
    records: &[Record],
    plain: TransferModel,
) -> Option<TransferModel> {
    let mut model = plain;
    for _ in 0..ROUNDS {
        let denominator = stabilised(&model.a, MOST_ROOT);
        model = arx(orders, records, Some(&denominator), None)?;
    }
    Some(model)
}

/// An ARX model's A becomes F, and C/D is fitted to what B/F leaves (Hannan & Rissanen, Biometrika
/// 69, 1982, 81-94).
fn noise_model(structure: &Structure, records: &[Record], plant: TransferModel) -> TransferModel {
    let mut model = TransferModel {
        a: vec![1.0],
        f: stabilised(&plant.a, MOST_ROOT),
        b: plant.b,
        c: vec![0.0; structure.nc + 1],
        d: vec![0.0; structure.nd + 1],
    };
    (model.c[0], model.d[0]) = (1.0, 1.0);
    if structure.nc + structure.nd == 0 {
        return model;
    }
    let left = signals(records, |r| {
        let simulated = model.simulated(&r.input);
        r.output.iter().zip(simulated).map(|(y, w)| y - w).collect()
    });
    let past: Vec<Regressor> = delayed(&left, 1..long_order(records) + 1).collect();
    let Some(weights) = regress(records, &left, &past, &past) else {
        return model;
    };
    let whitening: Vec<f64> = std::iter::once(1.0)
        .chain(weights.iter().map(|w| -w))
        .collect();
    let errors = left.iter().map(|left| filter(&whitening, &[1.0], left));
    let errors: Vec<Vec<f64>> = errors.collect();
    let columns: Vec<Regressor> = delayed(&errors, 1..structure.nc + 1)
        .chain(delayed(&left, 1..structure.nd + 1))
        .collect();
    if let Some(weights) = regress(records, &left, &columns, &columns) {
        let (c, d) = weights.as_slice().split_at(structure.nc);
        model.c[1..].copy_from_slice(c);
        for (own, weight) in model.d[1..].iter_mut().zip(d) {
            *own = -weight;
        }
        model.c = stabilised(&model.c, MOST_ROOT);
        model.d = stabilised(&model.d, MOST_ROOT);
    }
    model
}

/// Whether the predictor and the noise model are stable: C and F, and D, have their roots inside
/// the circle.
pub(super) fn is_usable(model: &TransferModel) -> bool {
    super::polynomial::is_stable(&multiply(&multiply(&model.c, &model.f), &model.d))
}
