//! `gains deploy --flash` all the way: built by the AVR's own toolchain, through a boot loader of
//! ours, run in simavr.

#[path = "../../../host/tests/it/common/boot_loader.rs"]
#[allow(dead_code)] // its troubles are other tests'
mod boot_loader;

use boot_loader::{Trouble, start_then};
use handstand_measure::bench::serve;
use handstand_measure::firmware::find_built;
use handstand_simavr::ElfCm5;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::time::{Duration, Instant};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// The image that was flashed, on a chip with an erased EEPROM; at the port until nobody can be
/// there any more.
fn run_image(pty: &handstand::link::Pty, elf: &Path, image: &[u8]) {
    let mut rig = ElfCm5::new(elf).unwrap();
    let flash = rig.core.flash();
    flash.fill(0xff);
    flash[..image.len()].copy_from_slice(image);
    let began = Instant::now();
    serve(&mut rig, pty, || began.elapsed() < Duration::from_secs(60)).unwrap();
}

#[test]
fn a_plan_goes_through_toolchain_and_boot_loader_and_is_read_back_from_the_chip() {
    let built = find_built().unwrap_or_else(|why| panic!("{why}"));
    let folder = tempfile::tempdir().unwrap();
    // `cargo xtask` is the one beside this test, which built the ELF, without cargo's looking for
    // changes.
    let beside = std::env::current_exe().unwrap();
    let beside = beside.ancestors().nth(2).unwrap();
    let cargo = folder.path().join("cargo");
    let xtask = beside.join("xtask");
    let script = format!("#!/bin/sh\nshift\nexec {} \"$@\"\n", xtask.display());
    std::fs::write(&cargo, script).unwrap();
    std::fs::set_permissions(&cargo, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", folder.path().display());
    let loader = start_then(Trouble::None, move |pty, image| {
        run_image(pty, &built.elf, image)
    });
    let ran = assert_cmd::Command::new(beside.join("handstand"))
        .args([
            "gains",
            "deploy",
            "host/models/handstand.toml",
            "--flash",
            "--json",
        ])
        .args(["--wait", "60", "--states", "1000", "--port", &loader.port])
        .current_dir(ROOT)
        .env("PATH", path)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(0), "{said}");
    let data: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(
        (&data["way"], &data["law"]),
        (&"flash".into(), &"observer".into())
    );
    assert_eq!(loader.did.recv().unwrap().0, "sys");
    let (_, image) = loader.did.recv().unwrap();
    assert!(image.len() > 50_000, "{} bytes", image.len());
    for step in ["built", "flashed", "read back", "replayed"] {
        assert!(said.contains(step), "{step}: {said}");
    }
}
