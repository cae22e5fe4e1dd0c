//! Servo models of Protocol 2.0 by model number. Source: ROBOTIS e-manual, page of each.
//!
//! Limits and gains are a factory-new servo's; firmware versions differ, so a program reads them
//! from the servo. The simulation starts with them.

use super::item::{Item, Presence};
pub use super::x::X_ITEMS;

/// Servos of one control table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// XL330 and XC330.
    X330,
    /// XL430 and XM430.
    X430,
    /// MX with firmware of Protocol 2.0.
    Mx,
}

/// A servo model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoModel {
    /// Its name.
    pub name: &'static str,
    /// Its model number, register 0.
    pub number: u16,
    /// Whose table it has.
    pub family: Family,
    /// One code of current, A; none where it infers a load instead. X330 measure it at the supply's
    /// input, the others in the motor's phase: only the latter is proportional to torque.
    pub current_lsb_a: Option<f64>,
    /// Current limit, code.
    pub current_limit: u16,
    /// Lowest and highest supply, codes of 0.1 V.
    pub supply: (u16, u16),
    /// Temperature limit, degrees Celsius.
    pub temperature_limit: u8,
    /// Velocity limit, code.
    pub velocity_limit: u16,
    /// Shutdown mask.
    pub shutdown: u8,
    /// Velocity I and P gain, position D, I and P gain, codes.
    pub gains: [u16; 5],
}

macro_rules! models {
    ($($name:literal $number:literal $family:ident $lsb_ma:literal $limit:literal $low:literal
        $high:literal $hot:literal $speed:literal $shutdown:literal $vi:literal $vp:literal
        $pd:literal $pi:literal $pp:literal)*) => {
        /// Every model that is known.
        pub const MODELS: &[ServoModel] = &[$(ServoModel {
            name: $name, number: $number, family: Family::$family,
            current_lsb_a: if $lsb_ma > 0.0 { Some($lsb_ma * 1e-3) } else { None },
            current_limit: $limit, supply: ($low, $high), temperature_limit: $hot,
            velocity_limit: $speed, shutdown: $shutdown, gains: [$vi, $vp, $pd, $pi, $pp],
        }),*];
    };
}

#[rustfmt::skip]
models! {
    // name      number family mA   limit  V low high degC speed shutdown vel I, P  pos D, I, P
    "XL330-M077"   1190 X330 1.0    1750      35   70   70  1620   53   400   40     0 400  400
    "XL330-M288"   1200 X330 1.0    1750      35   70   70   445   53  1600  180     0   0  400
    "XC330-T181"   1210 X330 1.0     910      55  140   70   510   52  1200   40     0   0  900
    "XC330-T288"   1220 X330 1.0     910      55  140   70   320   52  1200   40     0   0  900
    "XC330-M181"   1230 X330 1.0    2352      35   70   70   545   52  1400  100   500   0 1200
    "XC330-M288"   1240 X330 1.0    2352      35   70   70   350   52  1600   50   500   0 1100
    "XL430-W250"   1060 X430 0.0       0      60  140   72   265   52  1000  100  4000   0  640
    "XM430-W210"   1030 X430 2.69   1193      95  160   80   330   52  1920  100     0   0  800
    "XM430-W350"   1020 X430 2.69   1193      95  160   80   200   52  1920  100     0   0  800
    "MX-28(2.0)"     30 Mx   0.0       0      95  160   80   230   52  1920  100     0   0  850
    "MX-64(2.0)"    311 Mx   3.36   1941      95  160   80   435   52  1920  100     0   0  850
    "MX-106(2.0)"   321 Mx   3.36   2047      95  160   80   360   52  1920  100     0   0  850
}

impl ServoModel {
    /// The model of this number.
    pub fn of(number: u16) -> Option<&'static ServoModel> {
        MODELS.iter().find(|model| model.number == number)
    }

    /// The model of this name; capitals do not matter, and what follows a beginning that only one
    /// has may be left out: `xl330-m288`, `XL430`.
    pub fn named(name: &str) -> Option<&'static ServoModel> {
        let begins = |model: &&ServoModel| {
            let own = model.name.as_bytes().get(..name.len());
            own.is_some_and(|own| own.eq_ignore_ascii_case(name.as_bytes()))
        };
        let mut found = MODELS.iter().filter(begins);
        let first = found.next().filter(|_| !name.is_empty());
        first.filter(|model| model.name.len() == name.len() || found.next().is_none())
    }

    /// Whether it has this register.
    pub fn has(&self, item: &Item) -> bool {
        match item.presence {
            Presence::All => true,
            Presence::Current => self.current_lsb_a.is_some(),
            Presence::Load => self.current_lsb_a.is_none(),
            Presence::X330 => self.family == Family::X330,
            Presence::Mx => self.family == Family::Mx,
        }
    }

    /// Its registers, by address.
    pub fn items(&self) -> impl Iterator<Item = &'static Item> + '_ {
        X_ITEMS.iter().filter(|item| self.has(item))
    }

    /// Whether firmware of this version answers fast sync reads. The MX are not listed with it.
    pub fn has_fast_read(&self, firmware: u8) -> bool {
        match self.family {
            Family::X330 => firmware >= 46,
            Family::X430 => firmware >= 45,
            Family::Mx => false,
        }
    }

    /// Whether firmware of this version has the bus watchdog.
    pub fn has_watchdog(&self, firmware: u8) -> bool {
        self.family == Family::X330 || firmware >= 38
    }
}

#[cfg(test)]
mod tests {
    use super::super::x;
    use super::*;

    #[test]
    fn models_are_found_by_number_and_name() {
        for model in MODELS {
            assert_eq!(ServoModel::of(model.number), Some(model));
            assert_eq!(ServoModel::named(model.name), Some(model));
        }
        let name = |text| ServoModel::named(text).map(|model| model.number);
        assert_eq!(name("xl430"), Some(1060));
        assert_eq!(name("mx-28"), Some(30));
        assert_eq!(name("XL330"), None);
        assert_eq!(name("XL330-M288-T"), None);
        assert_eq!(ServoModel::of(1061), None);
        assert_eq!(name(""), None);
    }

    #[test]
    fn a_model_has_either_current_or_load() {
        for model in MODELS {
            let has = |item: Item| model.has(&item);
            assert!(
                has(x::PRESENT_CURRENT) != has(x::PRESENT_LOAD),
                "{}",
                model.name
            );
            assert_eq!(
                has(x::CURRENT_LIMIT),
                model.current_limit > 0,
                "{}",
                model.name
            );
        }
        let xl430 = ServoModel::named("xl430").unwrap();
        assert!(!xl430.has_fast_read(44) && xl430.has_fast_read(45));
        assert!(!xl430.has_watchdog(37) && xl430.has_watchdog(38));
    }

    #[test]
    fn each_family_has_its_own() {
        let [x330, mx] = ["xl330-m288", "mx-64"].map(|name| ServoModel::named(name).unwrap());
        assert!(!x330.has_fast_read(45) && x330.has_fast_read(46));
        assert!(x330.has_watchdog(0));
        assert!(!mx.has_fast_read(255));
        assert!(!mx.has_watchdog(37) && mx.has_watchdog(38));
        let has = |item: Item| [x330, mx].map(|model| model.has(&item));
        assert_eq!(has(x::PWM_SLOPE), [true, false]);
        assert_eq!(has(x::ACCELERATION_LIMIT), [false, true]);
        assert_eq!(has(x::GOAL_POSITION), [true, true]);
        let listed = |item: Item| [x330, mx].map(|model| model.items().any(|it| *it == item));
        assert_eq!(listed(x::PWM_SLOPE), [true, false]);
        assert_eq!(x330.current_lsb_a, Some(1e-3));
    }
}
