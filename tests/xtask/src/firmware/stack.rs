//! A bound of the stack's depth from the code itself: what each function pushes and takes for its
//! frame, along the deepest path of calls, and the deepest interrupt on top of it.

use super::build::Built;
use super::toolchain::output;
use std::collections::{HashMap, HashSet};
use std::process::Command;

/// A return address.
const RETURN: usize = 2;

/// Stack of the program, bytes.
///
/// # Errors
/// `avr-objdump` failed, a function calls itself, or the code has a form this does not know.
pub fn bound(built: &Built) -> Result<usize, String> {
    let code = output(
        Command::new("avr-objdump")
            .args(["-d", "--no-show-raw-insn"])
            .arg(&built.elf),
    );
    depth(&code.ok_or("avr-objdump (Debian: binutils-avr) failed")?)
}

/// What a function takes, and whom it calls.
#[derive(Debug, Default)]
struct Function {
    own: usize,
    calls: HashSet<String>,
    calls_indirectly: bool,
}

/// The bound for the listing of a program.
fn depth(listing: &str) -> Result<usize, String> {
    let functions = functions(listing)?;
    let mut known = HashMap::new();
    let main = deepest(&functions, "main", &mut Vec::new(), &mut known)?;
    let mut interrupt = 0;
    for name in functions
        .keys()
        .filter(|name| name.starts_with("__vector_"))
    {
        interrupt = interrupt.max(deepest(&functions, name, &mut Vec::new(), &mut known)?);
    }
    // The first function was jumped to; an interrupt pushes its return address.
    Ok(main + RETURN + interrupt)
}

fn functions(listing: &str) -> Result<HashMap<String, Function>, String> {
    let mut functions: HashMap<String, Function> = HashMap::new();
    let mut name = String::new();
    // The low byte of a frame's size, and whether the stack pointer was just read.
    let (mut low, mut since_pointer) = (None, usize::MAX);
    for line in listing.lines() {
        if let Some(label) = line
            .strip_suffix(">:")
            .and_then(|line| line.split_once('<'))
        {
            name = label.1.to_string();
            (low, since_pointer) = (None, usize::MAX);
            continue;
        }
        let Some((_, text)) = line.split_once(":\t") else {
            continue;
        };
        let function = functions.entry(name.clone()).or_default();
        let (what, operands) = text.split_once('\t').unwrap_or((text.trim(), ""));
        let target = line
            .split_once('<')
            .map(|(_, rest)| rest.trim_end_matches('>'));
        since_pointer = since_pointer.saturating_add(1);
        match what {
            "push" => function.own += 1,
            "in" if operands.starts_with("r29, 0x3e") => since_pointer = 0,
            "sbiw" if operands.starts_with("r28,") && since_pointer <= 2 => {
                function.own += number(operands)?;
            }
            "subi" if operands.starts_with("r28,") && since_pointer <= 2 => {
                low = Some(number(operands)?);
            }
            "sbci" if operands.starts_with("r29,") => {
                let size = low
                    .take()
                    .map_or(Ok(0), |low| number(operands).map(|high| high << 8 | low))?;
                function.own += if size < 0x8000 { size } else { 0 };
            }
            "icall" | "eicall" => function.calls_indirectly = true,
            "call" | "rcall" | "jmp" | "rjmp" | "breq" | "brne" => {
                let called = target.filter(|target| !target.contains('+') && *target != name);
                function.calls.extend(called.map(str::to_string));
            }
            _ => {}
        }
    }
    Ok(functions)
}

/// The number behind the comma: `r28, 0x48`.
fn number(operands: &str) -> Result<usize, String> {
    let text = operands.split([',', ';']).nth(1).unwrap_or("").trim();
    let parsed = match text.strip_prefix("0x") {
        Some(digits) => usize::from_str_radix(digits, 16),
        None => text.parse(),
    };
    parsed.map_err(|_| format!("avr-objdump says `{operands}`, which is no frame"))
}

/// A function's own stack and that of the deepest it calls. Behind a pointer every function is
/// taken for possible that is small enough to be behind one: none that calls another.
fn deepest(
    functions: &HashMap<String, Function>,
    name: &str,
    path: &mut Vec<String>,
    known: &mut HashMap<String, usize>,
) -> Result<usize, String> {
    if let Some(depth) = known.get(name) {
        return Ok(*depth);
    }
    if path.iter().any(|caller| caller == name) {
        return Err(format!("{name} calls itself: its stack has no bound"));
    }
    let Some(function) = functions.get(name) else {
        return Ok(0);
    };
    path.push(name.to_string());
    let mut below = 0;
    if function.calls_indirectly {
        let leaves = functions.values().filter(|other| other.calls.is_empty());
        below = RETURN + leaves.map(|other| other.own).max().unwrap_or(0);
    }
    for called in &function.calls {
        below = below.max(RETURN + deepest(functions, called, path, known)?);
    }
    path.pop();
    known.insert(name.to_string(), function.own + below);
    Ok(function.own + below)
}

#[cfg(test)]
mod tests {
    use super::depth;

    const LISTING: &str = "
000000ca <main>:
      ca:\tcall\t0xd2\t; 0xd2 <outer>
000000d2 <outer>:
      d2:\tpush\tr28
      d4:\tin\tr28, 0x3d\t; 61
      d6:\tin\tr29, 0x3e\t; 62
      d8:\tsubi\tr28, 0x48\t; 72
      da:\tsbci\tr29, 0x01\t; 1
      dc:\tcall\t0xf0\t; 0xf0 <inner>
      de:\tsubi\tr28, 0xB8\t; 184
      e0:\tsbci\tr29, 0xFE\t; 254
000000f0 <inner>:
      f0:\tpush\tr16
      f2:\tin\tr28, 0x3d\t; 61
      f4:\tin\tr29, 0x3e\t; 62
      f6:\tsbiw\tr28, 0x08\t; 8
      f8:\tbrne\t.-4\t; 0xf6 <inner+0x6>
000000fa <__vector_1>:
      fa:\tpush\tr0
      fc:\tpush\tr1
";

    #[test]
    fn the_deepest_path_and_the_deepest_interrupt_count() {
        // main's call, outer's push and frame of 0x148, its call, inner's; the interrupt's address
        // and pushes.
        let expected = (2 + 1 + 0x148) + (2 + 1 + 8) + (2 + 2);
        assert_eq!(depth(LISTING), Ok(expected));
    }

    #[test]
    fn recursion_has_no_bound() {
        let recursive = LISTING.replace(
            "brne\t.-4\t; 0xf6 <inner+0x6>",
            "call\t0xd2\t; 0xd2 <outer>",
        );
        assert!(depth(&recursive).unwrap_err().contains("calls itself"));
    }
}
