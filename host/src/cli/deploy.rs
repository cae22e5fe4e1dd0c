//! `handstand deploy MODEL`: gains from a model onto the CM-5, without building or flashing.
//!
//! Designs as `handstand gains` does, with its options (`--rust`, `--c` write the files too); uploads the fixed-point
//! table, which the CM-5 keeps in EEPROM beside the one before; reads it back; compares bytes and fingerprint; and runs the
//! law the CM-5 has, on the table it has, over random states beside the host's wide integers: not a bit may differ.
//!
//! ```console
//! $ handstand deploy handstand.toml --q 100 --r 1 --port /dev/ttyUSB0
//! ```
//!
//! Torque stays off. Gains compiled in instead: `handstand gains --rust`, `cargo xtask firmware`, `handstand flash`.
//! `--json` prints `fingerprint`, `bytes`, `uploaded`, `states_replayed`.

use super::port::{AnyLink, Port};
use super::talk::Talk;
use super::{Outcome, gains};
use handstand::link::Session;
use handstand::synth::FixedLaw;
use handstand::{Error, Result};
use handstand_shared::crc::crc32;
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use handstand_shared::message::{Command, GAIN_CHUNK, Report};
use rand::{Rng as _, SeedableRng as _};
use serde_json::json;

/// Bring gains onto the CM-5.
#[derive(Debug, clap::Args)]
#[group(id = "deploy")]
pub struct Args {
    #[command(flatten)]
    gains: gains::Args,
    #[command(flatten)]
    port: Port,
    /// Random states to compare the laws over
    #[arg(long, default_value_t = 1_000_000)]
    states: u64,
    /// Seed of these states
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Design and replay, but upload nothing
    #[arg(long)]
    dry_run: bool,
}

/// States and inputs of the firmware's law: angles and speeds of three joints, two of them driven.
const STATES: usize = 6;
const INPUTS: usize = 2;

/// Designs, uploads, reads back, replays.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let (design, made) = gains::designed(&args.gains, talk)?;
    let fixed = design.fixed.as_ref().ok_or_else(|| {
        Error::usage(
            "gains for continuous time have no table",
            "leave --continuous out",
        )
    })?;
    gains::write(&args.gains, &design, &made, talk)?;
    let bytes = fixed.law.bytes();
    table_of(&bytes)?;
    let back = if args.dry_run {
        bytes.clone()
    } else {
        let mut session = Session::open(args.port.open()?)?;
        upload(&mut session, &bytes, talk)?;
        let back = read_back(&mut session)?;
        same(&bytes, &back)?;
        back
    };
    let table = table_of(&back)?;
    replay(&table, &fixed.law, args, talk)?;
    let fingerprint = format!("{:08X}", table.fingerprint());
    if talk.json {
        talk.data(&json!({
            "fingerprint": fingerprint,
            "bytes": bytes.len(),
            "uploaded": !args.dry_run,
            "states_replayed": args.states,
        }))?;
    } else {
        talk.print(&format!("fingerprint {fingerprint}, {} bytes", bytes.len()))?;
    }
    let kept = if args.dry_run {
        "nothing was uploaded"
    } else {
        "the CM-5 keeps these gains"
    };
    talk.say(&format!(
        "{kept}; its law equals the host's bit for bit over {} states",
        args.states
    ));
    Ok(Outcome::Done)
}

/// A table as the firmware takes it.
fn table_of(bytes: &[u8]) -> Result<GainTable<INPUTS, STATES>> {
    let table = GainTable::<INPUTS, STATES>::from_bytes(bytes).ok_or_else(|| {
        Error::design(
            format!(
                "the firmware's law has {INPUTS} inputs and {STATES} states; this table has others"
            ),
            "give a model of three joints, two of them driven",
        )
    })?;
    match table.is_safe() {
        true => Ok(table),
        false => Err(Error::design(
            "the table could overflow",
            "weigh the inputs more: a larger --r",
        )),
    }
}

fn upload(session: &mut Session<AnyLink>, bytes: &[u8], talk: &Talk) -> Result<()> {
    let bar = talk.bar();
    bar.set_length(bytes.len() as u64);
    for (place, piece) in bytes.chunks(GAIN_CHUNK).enumerate() {
        let mut chunk = [0; GAIN_CHUNK];
        chunk[..piece.len()].copy_from_slice(piece);
        let offset = (place * GAIN_CHUNK) as u16;
        session.obey(
            &Command::GainChunk {
                offset,
                bytes: chunk,
            },
            "take gains",
        )?;
        bar.inc(piece.len() as u64);
    }
    bar.finish_and_clear();
    let store = Command::GainStore {
        length: bytes.len() as u16,
        check: crc32(bytes),
    };
    session.obey(&store, "keep the gains")
}

fn read_back(session: &mut Session<AnyLink>) -> Result<Vec<u8>> {
    let mut back = Vec::new();
    loop {
        let wanted = back.len() as u16;
        let (length, bytes) =
            session.fetch(
                &Command::GainRead { offset: wanted },
                |report| match *report {
                    Report::GainChunk {
                        offset,
                        length,
                        bytes,
                    } if offset == wanted => Some((usize::from(length), bytes)),
                    _ => None,
                },
            )?;
        let left = length.saturating_sub(back.len());
        back.extend(bytes.iter().take(left));
        if back.len() >= length {
            return Ok(back);
        }
    }
}

fn same(ours: &[u8], theirs: &[u8]) -> Result<()> {
    match ours == theirs {
        true => Ok(()),
        false => Err(Error::device(
            format!(
                "{} bytes were sent, {} others came back",
                ours.len(),
                theirs.len()
            ),
            "try again; if it stays so, the CM-5's EEPROM is worn",
        )),
    }
}

/// The law as the firmware computes it, beside the host's.
fn replay(
    table: &GainTable<INPUTS, STATES>,
    law: &FixedLaw,
    args: &Args,
    talk: &Talk,
) -> Result<()> {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(args.seed);
    let bar = talk.bar();
    bar.set_length(args.states);
    for count in 0..args.states {
        let x: [i16; STATES] = random.random();
        let wide = law.raw(&x.map(i64::from));
        if control(table, &x).map(i64::from)[..] != wide[..] {
            return Err(Error::device(
                format!(
                    "the laws differ at the states {x:?}: {:?}, the host's {wide:?}",
                    control(table, &x)
                ),
                "this is a bug; please report it with the model",
            ));
        }
        if count % 4096 == 0 {
            bar.set_position(count);
        }
    }
    bar.finish_and_clear();
    Ok(())
}
