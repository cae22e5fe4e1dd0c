//! Python packages that some tests need, in environments of their own under `target`.

use handstand_xtask::program::{self, found};
use handstand_xtask::root;
use std::path::PathBuf;
use std::process::Command;

/// Packages of PyPI that are installed together.
struct Environment {
    /// What they are called.
    names: &'static str,
    /// Which tests need them.
    wanted_for: &'static str,
    /// The environment's folder, in the project.
    folder: &'static str,
    /// What is imported to see whether they are there.
    imports: &'static str,
    /// What pip installs.
    packages: &'static [&'static str],
}

/// ROBOTIS's SDK drives simulated servos, MCAP's own reader reads recordings; MuJoCo and Pinocchio
/// move imported and exported robots.
const ENVIRONMENTS: [Environment; 2] = [
    Environment {
        names: "dynamixel-sdk and mcap",
        wanted_for: "the tests that drive simulated servos by ROBOTIS's own SDK and read \
                     recordings by MCAP's",
        folder: "target/sdk/venv",
        imports: "dynamixel_sdk, mcap",
        packages: &["dynamixel-sdk==4.1.0", "mcap==1.6.0"],
    },
    Environment {
        names: "MuJoCo and Pinocchio",
        wanted_for: "the tests that move imported and exported robots by them",
        folder: "target/peers/venv",
        imports: "mujoco, numpy, pinocchio",
        packages: &["--requirement", "tests/peers/requirements-tests.txt"],
    },
];

/// Installs what is not there yet; what cannot be is said, and its tests skipped.
pub fn all() {
    ENVIRONMENTS.iter().for_each(Environment::install);
}

impl Environment {
    fn python(&self) -> PathBuf {
        root().join(self.folder).join("bin/python")
    }

    fn is_there(&self) -> bool {
        let imports = format!("import {}", self.imports);
        let mut python = Command::new(self.python());
        let tried = python.args(["-c", &imports]).output();
        tried.is_ok_and(|output| output.status.success())
    }

    fn install(&self) {
        let Environment {
            names,
            wanted_for,
            folder,
            packages,
            ..
        } = self;
        if self.is_there() {
            println!("{names}, for {wanted_for}: here already.");
            return;
        }
        println!("{names} (PyPI), for {wanted_for}: installing into {folder}.");
        let mut make = Command::new("python3");
        let mut pip = Command::new(self.python());
        pip.args(["-m", "pip", "install", "--quiet"])
            .args(*packages);
        let well = found(&["python3"])
            && program::run(make.args(["-m", "venv", folder]).current_dir(root()))
            && program::run(pip.current_dir(root()));
        if !well {
            println!("They could not be installed; these tests are skipped.");
        }
    }
}
