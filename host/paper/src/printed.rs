//! What the paper prints, digit by digit, and what was recomputed from its Table 1 by other means.

/// Which number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PrintedQuantity {
    /// A value of the model file: link from 0, and 0 length, 1 centre of mass, 2 mass, 3 inertia,
    /// in the print's units.
    Link(usize, usize),
    /// Entry of A, row and column from 0.
    A(usize, usize),
    /// Entry of B.
    B(usize, usize),
    /// Entry of the continuous gain.
    Lqr(usize, usize),
    /// Entry of the sampled gain.
    Dlqr(usize, usize),
    /// Open-loop pole of this rank, largest first, 1/s.
    Pole(usize),
    /// Coefficient of the servo's model, by name.
    Servo(&'static str),
}

/// A printed number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Printed {
    /// Where: "Table 1", "eq. (5)".
    pub place: &'static str,
    /// Which.
    pub quantity: PrintedQuantity,
    /// As it stands there; its last digit says how exact it is.
    pub text: &'static str,
    /// Whether the paper prints it; else it was recomputed from Table 1 with SciPy.
    pub in_paper: bool,
}

use PrintedQuantity::{A, B, Dlqr, Link, Lqr, Pole, Servo};

/// Every number that can be computed, as it stands in its rows. Gains are without the minus sign of
/// `u = -k x`.
pub fn printed() -> Vec<Printed> {
    type NumberAt = fn(usize, usize) -> PrintedQuantity;
    const SERVO: [&str; 3] = ["b1", "f1", "f2"];
    const RECOMPUTED: &str = "recomputed";
    let blocks: [(&'static str, &[&'static str], NumberAt); 7] = [
        (
            "Table 1",
            &[
                "143.6 68.7 367.6 7890.7",
                "115.8 57.5 981.5 32898.6",
                "184.0 116.3 576.4 11328.0",
            ],
            Link,
        ),
        (
            "eq. (5)",
            &[
                "74.2389 -117.8764 0.0028",
                "-81.5857 348.7777 -76.0776",
                "-7.3471 -230.9113 215.8591",
            ],
            |r, c| A(r + 3, c),
        ),
        (
            "eq. (5)",
            &[
                "-176.2065 97.5517",
                "527.7831 -467.2635",
                "-467.2635 697.9566",
            ],
            |r, c| B(r + 3, c),
        ),
        (
            RECOMPUTED,
            &["21.2157 12.5086 5.6837 -5.6837 -12.5086 -21.2157"],
            |_, k| Pole(k),
        ),
        (
            "after eq. (9)",
            &[
                "-114.7206 -63.3382 -23.2078 -25.2863 11.8534 -5.0644",
                "92.6369 -41.0629 -13.3245 -15.8651 8.1298 -2.2096",
            ],
            Lqr,
        ),
        (
            RECOMPUTED,
            &[
                "-75.758443 -32.187228 -11.454290 -13.004784 -6.2134254 -2.3441985",
                "-62.056988 -26.928273 -9.0350845 -10.653945 -5.1619377 -1.8225471",
            ],
            Dlqr,
        ),
        ("eq. (2)", &["0.06217 -1.469 0.5544"], |_, c| {
            Servo(SERVO[c])
        }),
    ];
    let mut all = Vec::new();
    for (place, rows, quantity) in blocks {
        for (r, row) in rows.iter().enumerate() {
            all.extend(row.split(' ').enumerate().map(|(c, text)| Printed {
                place,
                quantity: quantity(r, c),
                text,
                in_paper: place != RECOMPUTED,
            }));
        }
    }
    all
}

impl PrintedQuantity {
    /// Its name: `A[4,1]`, counted from 1 as on paper.
    pub fn name(self) -> String {
        const LINKS: [&str; 3] = ["arms", "torso", "legs"];
        const FIELDS: [&str; 4] = ["l", "lc", "m", "I"];
        match self {
            Link(link, field) => format!("{} {}", FIELDS[field], LINKS[link]),
            A(r, c) => format!("A[{},{}]", r + 1, c + 1),
            B(r, c) => format!("B[{},{}]", r + 1, c + 1),
            Lqr(r, c) => format!("k[{},{}]", r + 1, c + 1),
            Dlqr(r, c) => format!("kd[{},{}]", r + 1, c + 1),
            Pole(k) => format!("pole {}", k + 1),
            Servo(name) => format!("servo {name}"),
        }
    }

    /// Its unit as printed.
    pub fn unit(self) -> &'static str {
        match self {
            Link(_, 0 | 1) => "mm",
            Link(_, 2) => "g",
            Link(..) => "g cm^2",
            Pole(_) => "1/s",
            Lqr(_, 0..=2) | Dlqr(_, 0..=2) => "N m/rad",
            Lqr(..) | Dlqr(..) => "N m s/rad",
            A(..) => "1/s^2",
            B(..) => "1/(kg m^2)",
            Servo(_) => "",
        }
    }
}
