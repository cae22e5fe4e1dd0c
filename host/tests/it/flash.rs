//! `flash` against a boot loader on a pseudo terminal.

use crate::common::boot_loader::{Loader, Trouble, start};
use crate::common::{Bench, Ran};
use handstand_shared::image::{MARK, mark};

fn program(length: usize) -> Vec<u8> {
    let mut bytes = vec![0x0c, 0x94, 0x46, 0x00];
    bytes.extend((4..length - MARK).map(|at| (at * 7 % 251) as u8));
    bytes.extend(mark(&bytes));
    bytes
}

fn flash(trouble: Trouble, more: &str) -> (Ran, Loader) {
    let bench = Bench::new();
    bench.put("image.bin", program(2000));
    let loader = start(trouble);
    let ran = bench.run(&format!(
        "flash image.bin --port {} --wait 2 {more}",
        loader.port
    ));
    (ran, loader)
}

#[test]
fn a_program_is_written_verified_and_made_to_start() {
    let (ran, loader) = flash(Trouble::None, "--go --json");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    assert_eq!(ran.json()["written"], true);
    // Its words are shown as they are, not believed.
    assert_eq!(ran.json()["verify_said"], "2000 bytes O.K.");
    assert_eq!(loader.did.recv().unwrap().0, "sys");
    assert_eq!(
        loader.did.recv().unwrap(),
        ("flash".to_string(), program(2000))
    );
    assert_eq!(loader.did.recv().unwrap().0, "app");
    assert_eq!(loader.did.recv().unwrap().0, "go");
}

#[test]
fn a_slow_line_is_paced() {
    let begin = std::time::Instant::now();
    let (ran, loader) = flash(Trouble::None, "--pace-us 300 --no-app");
    assert_eq!(ran.code, Some(0), "{ran:?}");
    // 2000 bytes of 174 us each, and 300 us after each.
    assert!(begin.elapsed().as_secs_f64() > 0.94);
    assert_eq!(loader.did.recv().unwrap().0, "sys");
    assert_eq!(loader.did.recv().unwrap().1, program(2000));
    assert!(
        loader.did.try_recv().is_err(),
        "without --no-app it would have said so"
    );
}

#[test]
fn every_trouble_is_a_device_error_that_names_the_remedy() {
    for (trouble, said) in [
        (Trouble::Silence, "does not answer"),
        (Trouble::SilentAfterReady, "does not answer to the image"),
        (Trouble::LosesBytes, "the boot loader received"),
        (Trouble::WrongByte, "the checksum is wrong"),
        (Trouble::BadFlash, "verify failed"),
    ] {
        let (ran, loader) = flash(trouble, "");
        assert_eq!(ran.code, Some(4), "{trouble:?}: {ran:?}");
        assert!(
            ran.stderr.contains(said) && ran.stderr.contains("help:"),
            "{trouble:?}: {ran:?}"
        );
        let did: Vec<String> = loader.did.try_iter().map(|(what, _)| what).collect();
        assert!(!did.contains(&"app".to_string()), "{trouble:?}: {did:?}");
        // Nothing starts what was half written.
        if trouble != Trouble::Silence {
            assert_eq!(did[0], "sys", "{trouble:?}");
        }
    }
}

#[test]
fn wrong_files_are_refused_before_anything_is_sent() {
    let bench = Bench::new();
    bench.put("large.bin", program(122_881));
    bench.put("image.hex", ":100000000C9446000C945E000C945E000C945E00E4\n");
    bench.put("image.elf", b"\x7fELF\x01\x01\x01");
    bench.put("empty.bin", "");
    bench.put("foreign.bin", &program(500)[..400]);
    bench.put(
        "damaged.bin",
        [&program(500)[..99], &program(500)[100..]].concat(),
    );
    for (file, said) in [
        ("large.bin", "122881 bytes"),
        ("image.hex", "Intel HEX"),
        ("image.elf", "ELF"),
        ("empty.bin", "empty"),
        ("absent.bin", "cannot read"),
        ("foreign.bin", "--any-program"),
        ("damaged.bin", "damaged"),
    ] {
        let ran = bench.run(&format!("flash {file} --port /dev/absent"));
        assert_eq!(ran.code, Some(3), "{file}: {ran:?}");
        assert!(ran.stderr.contains(said), "{file}: {ran:?}");
    }
    let wanted = bench.run("flash foreign.bin --any-program --dry-run");
    assert_eq!(wanted.code, Some(0), "{wanted:?}");
}

#[test]
fn a_dry_run_and_isp_without_consent_do_nothing() {
    let bench = Bench::new();
    bench.put("image.bin", program(100));
    let dry = bench.run("flash image.bin --dry-run --json");
    assert_eq!(
        (dry.code, dry.json()["bytes"].as_u64()),
        (Some(0), Some(100)),
        "{dry:?}"
    );
    let isp = bench.run("flash image.bin --isp usbasp");
    assert_eq!(isp.code, Some(2), "{isp:?}");
    assert!(
        isp.stderr.contains("boot loader included") && isp.stderr.contains("--yes"),
        "{isp:?}"
    );
    let shown = bench
        .run("flash image.bin --isp usbasp --dry-run --json")
        .json();
    assert_eq!(
        shown["command"],
        "avrdude -p m128 -c usbasp -U flash:w:image.bin:r"
    );
}
