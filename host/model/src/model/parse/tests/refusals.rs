//! Model files that are wrong in one place.

use super::{GOOD, parse};

/// Replace this by that in the good file; the complaint's place, message and remedy must hold
/// these.
#[rustfmt::skip]
const REFUSED: &[(&str, &str, &str, &str, &str)] = &[
    // Keys.
    ("mass_kg = 0.2", "mas_kg = 0.2", "12:1", "unknown key `mas_kg` in [[link]] 1",
     "did you mean `mass_kg`? known here: length_m"),
    ("length_m = 0.15", "length_mm = 150", "10:1", "key `length_mm` ends in `_mm`",
     "write `length_m`, in m"),
    ("com_m = 0.10", "com = 0.10", "11:1", "key `com` does not say its unit",
     "write `com_m`, in m"),
    ("step_s = 0.001", "step_ms = 1", "7:1", "`step_ms`", "write `step_s`, in s"),
    ("gain_per_rad = 8", "gain = 8", "25:1", "does not say its unit", "`gain_per_rad`, in 1/rad"),
    ("[fit]", "[fti]", "43:2", "unknown key `fti` in the file", "did you mean `fit`?"),
    ("[rig]", "[Rig]", "2:2", "unknown key `Rig`", "did you mean `rig`?"),
    ("free = [", "fre = [", "44:1", "unknown key `fre` in [fit]", "`free`"),
    ("segment = \"segment\"", "segmnt = \"segment\"", "48:1", "unknown key `segmnt` in [log]",
     "`segment`"),
    ("torque_nm = 0.02", "torque = 0.02", "33:1", "does not say its unit", "`torque_nm`, in N m"),
    ("offset_rad = 0.1", "offset_deg = 6", "56:70", "`offset_deg` ends in `_deg`",
     "`offset_rad`, in rad"),
    ("unit = \"ms\"", "unit = \"ms\", reversed = true", "47:40", "unknown key `reversed`",
     "known here: column"),
    ("drive = \"passive\"", "drive = \"passive\"\nstall_torque_nm = 1", "22:1",
     "unknown key `stall_torque_nm`", "known here: drive"),
    // Missing.
    ("name = \"everything\"\n", "", "2:1", "[rig] lacks `name`", "add `name`"),
    ("angle_zero = \"upright\"", "", "2:1", "[rig] lacks `angle_zero`", "add"),
    ("mass_kg = 0.2\n", "", "9:1", "[[link]] 1 lacks `mass_kg`", "add `mass_kg = ...`, in kg"),
    ("length_m = 0.15\n", "", "9:1", "[[link]] 1 lacks `length_m`", "in m"),
    ("stall_torque_nm = 1.5\n", "", "23:1", "[[joint]] 2 lacks `stall_torque_nm`", "in N m"),
    ("gain_per_rad = 8\n", "", "23:1", "[[joint]] 2 lacks `gain_per_rad`", "in 1/rad"),
    ("drive = \"passive\"", "", "20:1", "[[joint]] 1 lacks `drive`", "add"),
    ("torque_nm = 0.02 # felt by hand", "", "30:1", "[[effect]] 1 lacks `torque_nm`", "in N m"),
    ("kind = \"coulomb\"", "", "30:1", "lacks `kind`", "add"),
    ("kind = \"coulomb\"\njoint = 1", "kind = \"coulomb\"", "30:1", "lacks `joint`", "add"),
    ("time = { column = \"t_ms\", unit = \"ms\" }\n", "", "46:1", "[log] lacks `time`", "add"),
    ("ticks_per_turn = 4096, ", "", "56:12", "lacks `ticks_per_turn`", "add"),
    ("column = \"pos2\", ", "", "60:12", "lacks `column`", "add"),
    (", at_m = 0.12", "", "51:11", "lacks `at_m`", "in m"),
    // Types and values.
    ("mass_kg = 0.2", "mass_kg = \"0.2\"", "12:11", "`mass_kg` is a string", "it must be a number"),
    ("mass_kg = 0.2", "mass_kg = nan", "12:11", "`mass_kg` is NaN", "above 0"),
    ("mass_kg = 0.2", "mass_kg = inf", "12:11", "`mass_kg` is inf", "above 0"),
    ("mass_kg = 0.2", "mass_kg = 0", "12:11", "`mass_kg` = 0 is impossible", "above 0"),
    ("mass_kg = 0.2", "mass_kg = -1", "12:11", "`mass_kg` = -1 is impossible", "above 0"),
    ("inertia_kg_m2 = 1.2e-4", "inertia_kg_m2 = -1e-4", "13:17", "impossible", "from 0"),
    ("length_m = 0.15", "length_m = -0.15", "10:12", "impossible", "from 0"),
    ("gravity_m_s2 = 9.80665", "gravity_m_s2 = 981", "6:16", "impossible", "from 0 to 100"),
    ("step_s = 0.001", "step_s = 0", "7:10", "impossible", "from 0.00001 to 0.1"),
    ("step_s = 0.001", "step_s = 0.2", "7:10", "impossible", "from 0.00001 to 0.1"),
    ("stall_torque_nm = 1.5", "stall_torque_nm = 0", "26:19", "impossible", "above 0"),
    ("name = \"everything\"", "name = \"\"", "3:8", "`name` is empty", "name"),
    ("name = \"everything\"", "name = 7", "3:8", "`name` is an integer", "text in quotes"),
    ("angle_zero = \"upright\"", "angle_zero = \"uprigth\"", "4:14",
     "`angle_zero` cannot be `uprigth`",
     "did you mean `upright`? known here: hanging, upright, horizontal"),
    ("drive = \"position\"", "drive = \"positon\"", "24:9", "cannot be `positon`",
     "did you mean `position`?"),
    ("[rig]", "rig = 3\n[log.x]", "2:7", "`rig` is an integer", "it must be a table"),
    ("reversed = true", "reversed = 1", "56:99", "`reversed` is an integer", "true or false"),
    ("split_at_gap_s = 0.5", "split_at_gap_s = 0", "53:18", "impossible", "above 0"),
    // Joints and links.
    ("[[joint]]\ndrive = \"passive\"", "", "1:1", "has 2 link(s) but 1 joint(s)",
     "add a `[[joint]]`"),
    ("[[joint]]\ndrive = \"passive\"",
     "[[joint]]\ndrive = \"passive\"\n[[joint]]\ndrive = \"passive\"", "25:1",
     "[[joint]] 3 is one joint too many", "remove the joint"),
    // Effects.
    ("kind = \"coulomb\"", "kind = \"colomb\"", "31:8", "`kind` cannot be `colomb`",
     "did you mean `coulomb`?"),
    ("torque_nm = 0.02", "torque_nm = 11", "33:13", "`torque_nm` = 11 is impossible",
     "from 0 to 10"),
    ("joint = 1", "joint = 3", "32:9", "there is no joint 3", "count from 1 to 2"),
    ("joint = 1", "joint = 0", "32:9", "there is no joint 0", "count from 1 to 2"),
    ("joint = 1", "joint = 1.0", "32:9", "`joint` is a float", "a whole number"),
    ("joint = 2\ndelay", "joint = 1\ndelay", "37:9",
     "`delay` acts on driven joints only, and joint 1 is `passive`", "driven joint"),
    ("kind = \"delay\"\njoint = 2\ndelay_s", "kind = \"coulomb\"\njoint = 1\ntorque_nm", "36:8",
     "`coulomb` is there twice", "keep one"),
    ("[effect.fitted]\nby = \"an earlier run\"", "fitted = 3", "40:10", "`fitted` is an integer",
     "a table"),
    // Fit.
    ("\"link1.inertia_kg_m2\"", "\"link1.inertia\"", "44:9", "unknown name `inertia`",
     "did you mean `inertia_kg_m2`?"),
    ("\"link1.inertia_kg_m2\"", "\"link7.mass_kg\"", "44:9",
     "`link7.mass_kg` is not in this model", "remove it"),
    ("\"link1.inertia_kg_m2\"", "\"coulomb@1.torque_nm\"", "44:55", "named twice", "remove one"),
    ("\"link1.inertia_kg_m2\"", "3", "44:9", "`free` holds an integer", "quotes"),
    // Log.
    ("unit = \"ms\"", "unit = \"deg\"", "47:34",
     "unit `deg` measures an angle, and `time` is a time", "write one of: s, ms, us, ns"),
    ("unit = \"ms\"", "unit = \"msec\"", "47:34", "unknown unit `msec`",
     "write one of: s, ms, us, ns"),
    ("unit = \"V\"", "unit = \"kg\"", "49:40", "measures a mass, and `supply` is a voltage",
     "V, mV"),
    ("column = \"goal2\", unit = \"deg\"", "column = \"goal2\", unit = \"rpm\"", "61:36",
     "and `input` is an angle", "rad, deg"),
    ("input = { column = \"goal2\", unit = \"deg\" }", "", "59:1", "[[log.joint]] 2 lacks `input`",
     "unit = \"rad\""),
    ("velocity = {", "input = { column = \"u\", unit = \"1\" }\nvelocity = {", "57:1",
     "a passive joint has no input", "remove `input`"),
    ("velocity = {", "gyro = { column = \"g\", unit = \"deg\" }\nvelocity = {", "57:31",
     "and `gyro` is an angular speed", "rad/s, deg/s"),
    ("velocity = {", "gyro = { column = \"g\", unit = \"rpm\" }\n\
      tachometer = { column = \"w\", unit = \"rpm\" }\nvelocity = {", "58:1",
     "a joint has one rate sensor", "keep the one"),
    ("ticks_per_turn = 4096", "ticks_per_turn = 0", "56:64", "impossible", "from 1"),
    ("unit = \"ticks\"", "unit = \"rad\"", "56:45", "unknown key `ticks_per_turn`", "known here"),
    ("[[log.joint]]\nposition = { column = \"pos2\"", "[rig.x]\nposition = { column = \"pos2\"",
     "59:6", "unknown key `x` in [rig]", "angle_zero"),
    // Syntax.
    ("mass_kg = 0.2", "mass_kg 0.2", "12:", "not TOML", "key = value"),
    ("[[link]]", "[[link]", "9:", "not TOML", "key = value"),
    ("name = \"everything\"", "name = \"everything", "3:", "not TOML", "quotes"),
    ("name = \"everything\"", "name = \"a\"\nname = \"b\"", "4:", "not TOML", "key = value"),
];

#[test]
fn wrong_files_are_refused_at_the_place_with_a_remedy() {
    let mut wrong = String::new();
    for (this, that, place, what, remedy) in REFUSED {
        assert!(GOOD.contains(this), "the good file holds {this}");
        let error = parse(&GOOD.replacen(this, that, 1)).expect_err(that);
        assert_eq!(error.exit_code(), 3);
        let message = error.to_string();
        let found = error.remedy().unwrap();
        let right = message.starts_with(&format!("rig.toml:{place}"))
            && message.contains(what)
            && found.contains(remedy);
        if !right {
            wrong += &format!("\n{that}\n  {message}; {found}\n  not {place}: {what}; {remedy}");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
