//! Which polynomials a model has, and of which order.
//!
//! All are cases of `A(q) y = B(q)/F(q) u + C(q)/D(q) e` (Ljung, System Identification, 2nd ed.
//! 1999, eq. 4.33).

use crate::error::{Error, Result};
use serde::Serialize;
use std::fmt;

/// Most coefficients of one polynomial.
const MOST: usize = 20;
/// Most structures of one grid.
const MOST_STRUCTURES: usize = 2000;

/// A family of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// `A y = B u + e`.
    Arx,
    /// `A y = B u + C e`.
    Armax,
    /// `y = B/F u + e`: output error.
    Oe,
    /// `y = B/F u + C/D e`: Box-Jenkins.
    Bj,
}

/// The families, their keys and the names of their orders, in the order of MATLAB's functions of
/// the same names.
pub const FAMILIES: [(&str, Family, &[&str]); 4] = [
    ("arx", Family::Arx, &["na", "nb", "nk"]),
    ("armax", Family::Armax, &["na", "nb", "nc", "nk"]),
    ("oe", Family::Oe, &["nb", "nf", "nk"]),
    ("bj", Family::Bj, &["nb", "nc", "nd", "nf", "nk"]),
];

/// A family with its orders; those a family lacks are 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Structure {
    /// Which family.
    pub family: Family,
    /// Order of A.
    pub na: usize,
    /// Coefficients of B.
    pub nb: usize,
    /// Order of C.
    pub nc: usize,
    /// Order of D.
    pub nd: usize,
    /// Order of F.
    pub nf: usize,
    /// Samples from input to output; 1 is the least a sampled system with a held input has.
    pub nk: usize,
}

impl Structure {
    /// Box-Jenkins, orders as MATLAB's `bj` has them.
    pub fn bj([nb, nc, nd, nf, nk]: [usize; 5]) -> Self {
        Structure {
            family: Family::Bj,
            na: 0,
            nb,
            nc,
            nd,
            nf,
            nk,
        }
    }

    /// Output error, orders as MATLAB's `oe` has them.
    pub fn oe([nb, nf, nk]: [usize; 3]) -> Self {
        Structure {
            family: Family::Oe,
            ..Structure::bj([nb, 0, 0, nf, nk])
        }
    }

    /// ARX, orders as MATLAB's `arx` has them.
    pub fn arx([na, nb, nk]: [usize; 3]) -> Self {
        Structure {
            family: Family::Arx,
            na,
            ..Structure::bj([nb, 0, 0, 0, nk])
        }
    }

    /// ARMAX, orders as MATLAB's `armax` has them.
    pub fn armax([na, nb, nc, nk]: [usize; 4]) -> Self {
        Structure {
            family: Family::Armax,
            na,
            ..Structure::bj([nb, nc, 0, 0, nk])
        }
    }

    fn of(family: Family, orders: &[usize]) -> Option<Self> {
        Some(match (family, orders) {
            (Family::Arx, &[na, nb, nk]) => Structure::arx([na, nb, nk]),
            (Family::Armax, &[na, nb, nc, nk]) => Structure::armax([na, nb, nc, nk]),
            (Family::Oe, &[nb, nf, nk]) => Structure::oe([nb, nf, nk]),
            (Family::Bj, &[nb, nc, nd, nf, nk]) => Structure::bj([nb, nc, nd, nf, nk]),
            _ => return None,
        })
    }

    /// Coefficients to be found.
    pub fn count(&self) -> usize {
        self.na + self.nb + self.nc + self.nd + self.nf
    }

    /// Names of the coefficients in the order of a parameter vector; the number is the delay in
    /// samples.
    pub fn names(&self) -> Vec<String> {
        let from_one =
            |letter: char, order: usize| (1..=order).map(move |k| format!("{letter}{k}"));
        let b = (0..self.nb).map(|k| format!("b{}", self.nk + k));
        from_one('a', self.na)
            .chain(b)
            .chain(from_one('c', self.nc))
            .chain(from_one('d', self.nd))
            .chain(from_one('f', self.nf))
            .collect()
    }
}

impl fmt::Display for Structure {
    /// As on the command line: `bj:1,2,1,2,1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (na, nb, nc, nd, nf, nk) = (self.na, self.nb, self.nc, self.nd, self.nf, self.nk);
        match self.family {
            Family::Arx => write!(f, "arx:{na},{nb},{nk}"),
            Family::Armax => write!(f, "armax:{na},{nb},{nc},{nk}"),
            Family::Oe => write!(f, "oe:{nb},{nf},{nk}"),
            Family::Bj => write!(f, "bj:{nb},{nc},{nd},{nf},{nk}"),
        }
    }
}

/// The structures that `text` asks for: `bj:1,2,1,2,1`, or with ranges `bj:1-2,1-2,1,1-3,1`.
///
/// # Errors
/// A family that is not known, the wrong number of orders, orders beyond 20, B
/// without a coefficient.
pub fn structures(text: &str) -> Result<Vec<Structure>> {
    let wrong = |fault: String| {
        let forms = FAMILIES.map(|(key, _, orders)| format!("{key}:{}", orders.join(",")));
        let remedy = format!(
            "write one of {}, such as bj:1,2,1,2,1, with ranges such as bj:1-2,1,1,1-3,1 to try \
             several",
            forms.join(" ")
        );
        Error::usage(format!("'{text}': {fault}"), remedy)
    };
    let (key, orders) = text
        .split_once(':')
        .ok_or_else(|| wrong("no colon between family and orders".into()))?;
    let (key, family, names) = FAMILIES
        .into_iter()
        .find(|(known, ..)| *known == key)
        .ok_or_else(|| wrong(format!("'{key}' is no family of models")))?;
    let fields: Vec<&str> = orders.split(',').collect();
    if fields.len() != names.len() {
        return Err(wrong(format!(
            "{} orders, and {key} has {}: {}",
            fields.len(),
            names.len(),
            names.join(", ")
        )));
    }
    let mut grid: Vec<Vec<usize>> = vec![Vec::new()];
    for (field, &name) in fields.iter().zip(names) {
        let range = order_range(field)
            .filter(|range| range.clone().count() * grid.len() <= MOST_STRUCTURES);
        let range = range.ok_or_else(|| {
            wrong(format!(
                "'{field}' is no order {name} from 0 to {MOST}, or makes more than \
                 {MOST_STRUCTURES} structures"
            ))
        })?;
        if name == "nb" && *range.start() == 0 {
            return Err(wrong("B needs a coefficient: nb is 1 or more".into()));
        }
        grid = grid
            .iter()
            .flat_map(|head| {
                let with = |order| head.iter().copied().chain([order]).collect();
                range.clone().map(with).collect::<Vec<Vec<usize>>>()
            })
            .collect();
    }
    Ok(grid
        .iter()
        .filter_map(|orders| Structure::of(family, orders))
        .collect())
}

fn order_range(field: &str) -> Option<std::ops::RangeInclusive<usize>> {
    let (low, high) = field.split_once('-').unwrap_or((field, field));
    let (low, high) = (low.trim().parse().ok()?, high.trim().parse().ok()?);
    (low <= high && high <= MOST).then_some(low..=high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_span_a_grid() {
        assert_eq!(
            structures("bj:1,2,1,2,1").unwrap(),
            [Structure::bj([1, 2, 1, 2, 1])]
        );
        let grid = structures("oe:1-2,1-3,1").unwrap();
        assert_eq!(grid.len(), 6);
        assert_eq!(grid[5].to_string(), "oe:2,3,1");
        assert_eq!(
            Structure::bj([2, 1, 0, 2, 1]).names(),
            ["b1", "b2", "c1", "f1", "f2"]
        );
    }

    #[test]
    fn what_is_no_structure_is_refused() {
        for text in [
            "bj",
            "bj:1,2",
            "hj:1,2,1",
            "oe:0,1,1",
            "oe:1,99,1",
            "oe:2-1,1,1",
            "oe:1,x,1",
            "bj:1-20,0-20,0-20,0-20,1",
        ] {
            let error = structures(text).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{text}");
        }
    }
}
