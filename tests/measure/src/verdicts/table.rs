//! The exported table of gains, in arithmetic written for this check: wide integers, and a division
//! with a floor where the law shifts.

use serde_json::Value;

/// u = sat(floor((bias - sum k (x - x0)) / 2^shift)).
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    k: Vec<Vec<i64>>,
    bias: Vec<i64>,
    shift: Vec<i64>,
    limits: Vec<[i64; 2]>,
    x0: Vec<i64>,
    state_step: Vec<f64>,
    input_step: Vec<f64>,
}

impl Table {
    /// Of `fixed` in what `handstand gains --json` prints.
    pub fn read(fixed: &Value) -> Option<Table> {
        fn of<T: serde::de::DeserializeOwned>(fixed: &Value, key: &str) -> Option<T> {
            serde_json::from_value(fixed.get(key)?.clone()).ok()
        }
        Some(Table {
            k: of(fixed, "k")?,
            bias: of(fixed, "bias")?,
            shift: of(fixed, "shift")?,
            limits: of(fixed, "limits")?,
            x0: of(fixed, "x0")?,
            state_step: of(fixed, "state_step")?,
            input_step: of(fixed, "input_step")?,
        })
    }

    /// Past inputs among the states.
    pub fn past(&self) -> usize {
        self.x0.len() - 6
    }

    /// Inputs in SI for states in SI.
    pub fn inputs(&self, x: &[f64]) -> Vec<f64> {
        let word = |value: i64| value.clamp(-32_768, 32_767);
        let states: Vec<i64> = x
            .iter()
            .zip(&self.state_step)
            .map(|(x, step)| word((x / step).round() as i64))
            .collect();
        let input = |row: usize| {
            let products = self.k[row].iter().enumerate();
            let sum: i64 = products
                .map(|(j, k)| k * word(states[j] - self.x0[j]))
                .sum();
            let raw = (self.bias[row] - sum).div_euclid(1 << self.shift[row]);
            let [low, high] = self.limits[row];
            raw.clamp(low, high) as f64 * self.input_step[row]
        };
        (0..self.k.len()).map(input).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: x = (3, -2) steps, u = floor((1 + 8 - (5 * 3 + 7 * -2)) / 2) = 4 steps.
    #[test]
    fn a_table_is_read_and_computed() {
        let mut k = vec![0; 6];
        (k[0], k[1]) = (5, 7);
        let fixed = serde_json::json!({
            "k": [k], "bias": [9], "shift": [1], "limits": [[-4, 4]], "x0": [0, 0, 0, 0, 0, 0],
            "state_step": [0.5, 0.5, 1.0, 1.0, 1.0, 1.0], "input_step": [0.25],
        });
        let table = Table::read(&fixed).unwrap();
        assert_eq!(table.past(), 0);
        assert_eq!(table.inputs(&[1.5, -1.0, 0.0, 0.0, 0.0, 0.0]), [1.0]);
        // (9 - 10) / 2 is floored to -1, not cut to 0.
        assert_eq!(table.inputs(&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [-0.25]);
        assert_eq!(table.inputs(&[5.0, 0.0, 0.0, 0.0, 0.0, 0.0]), [-1.0]);
    }
}
