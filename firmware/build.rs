//! Hands the plan that `HANDSTAND_PLAN` names, a file as `handstand gains deploy --header` writes
//! it, to the firmware; none without it.

use std::path::Path;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-env-changed=HANDSTAND_PLAN");
    let plan = match env::var("HANDSTAND_PLAN") {
        Ok(file) => {
            println!("cargo::rerun-if-changed={file}");
            fs::read_to_string(&file)
                .unwrap_or_else(|error| panic!("HANDSTAND_PLAN={file}: {error}"))
        }
        Err(_) => "[]".into(),
    };
    let out = env::var("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&out).join("plan.rs"), plan).expect("its own folder can be written");
}
