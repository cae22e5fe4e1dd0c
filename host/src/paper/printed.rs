//! What the paper prints, digit by digit, and what was recomputed from its Table 1 by other means.

/// Which number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
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
    pub quantity: Quantity,
    /// As it stands there; its last digit says how exact it is.
    pub text: &'static str,
    /// Whether the paper prints it; else it was recomputed from Table 1 with SciPy.
    pub in_paper: bool,
}

const fn paper(place: &'static str, quantity: Quantity, text: &'static str) -> Printed {
    Printed {
        place,
        quantity,
        text,
        in_paper: true,
    }
}

const fn recomputed(quantity: Quantity, text: &'static str) -> Printed {
    Printed {
        place: "recomputed",
        quantity,
        text,
        in_paper: false,
    }
}

const TABLE: &str = "Table 1";
const PLANT: &str = "eq. (5)";
const GAIN: &str = "after eq. (9)";
const SERVO: &str = "eq. (2)";

use Quantity::{A, B, Dlqr, Link, Lqr, Pole, Servo};

/// Every number that can be computed. Gains are without the minus sign of `u = -k x`.
pub const PRINTED: &[Printed] = &[
    paper(TABLE, Link(0, 0), "143.6"),
    paper(TABLE, Link(0, 1), "68.7"),
    paper(TABLE, Link(0, 2), "367.6"),
    paper(TABLE, Link(0, 3), "7890.7"),
    paper(TABLE, Link(1, 0), "115.8"),
    paper(TABLE, Link(1, 1), "57.5"),
    paper(TABLE, Link(1, 2), "981.5"),
    paper(TABLE, Link(1, 3), "32898.6"),
    paper(TABLE, Link(2, 0), "184.0"),
    paper(TABLE, Link(2, 1), "116.3"),
    paper(TABLE, Link(2, 2), "576.4"),
    paper(TABLE, Link(2, 3), "11328.0"),
    paper(PLANT, A(3, 0), "74.2389"),
    paper(PLANT, A(3, 1), "-117.8764"),
    paper(PLANT, A(3, 2), "0.0028"),
    paper(PLANT, A(4, 0), "-81.5857"),
    paper(PLANT, A(4, 1), "348.7777"),
    paper(PLANT, A(4, 2), "-76.0776"),
    paper(PLANT, A(5, 0), "-7.3471"),
    paper(PLANT, A(5, 1), "-230.9113"),
    paper(PLANT, A(5, 2), "215.8591"),
    paper(PLANT, B(3, 0), "-176.2065"),
    paper(PLANT, B(3, 1), "97.5517"),
    paper(PLANT, B(4, 0), "527.7831"),
    paper(PLANT, B(4, 1), "-467.2635"),
    paper(PLANT, B(5, 0), "-467.2635"),
    paper(PLANT, B(5, 1), "697.9566"),
    recomputed(Pole(0), "21.2157"),
    recomputed(Pole(1), "12.5086"),
    recomputed(Pole(2), "5.6837"),
    recomputed(Pole(3), "-5.6837"),
    recomputed(Pole(4), "-12.5086"),
    recomputed(Pole(5), "-21.2157"),
    paper(GAIN, Lqr(0, 0), "-114.7206"),
    paper(GAIN, Lqr(0, 1), "-63.3382"),
    paper(GAIN, Lqr(0, 2), "-23.2078"),
    paper(GAIN, Lqr(0, 3), "-25.2863"),
    paper(GAIN, Lqr(0, 4), "11.8534"),
    paper(GAIN, Lqr(0, 5), "-5.0644"),
    paper(GAIN, Lqr(1, 0), "92.6369"),
    paper(GAIN, Lqr(1, 1), "-41.0629"),
    paper(GAIN, Lqr(1, 2), "-13.3245"),
    paper(GAIN, Lqr(1, 3), "-15.8651"),
    paper(GAIN, Lqr(1, 4), "8.1298"),
    paper(GAIN, Lqr(1, 5), "-2.2096"),
    recomputed(Dlqr(0, 0), "-75.758443"),
    recomputed(Dlqr(0, 1), "-32.187228"),
    recomputed(Dlqr(0, 2), "-11.454290"),
    recomputed(Dlqr(0, 3), "-13.004784"),
    recomputed(Dlqr(0, 4), "-6.2134254"),
    recomputed(Dlqr(0, 5), "-2.3441985"),
    recomputed(Dlqr(1, 0), "-62.056988"),
    recomputed(Dlqr(1, 1), "-26.928273"),
    recomputed(Dlqr(1, 2), "-9.0350845"),
    recomputed(Dlqr(1, 3), "-10.653945"),
    recomputed(Dlqr(1, 4), "-5.1619377"),
    recomputed(Dlqr(1, 5), "-1.8225471"),
    paper(SERVO, Servo("b1"), "0.06217"),
    paper(SERVO, Servo("f1"), "-1.469"),
    paper(SERVO, Servo("f2"), "0.5544"),
];

impl Quantity {
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
