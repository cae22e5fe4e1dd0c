//! Other programs: whether they are there, and running them aloud.

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

/// Whether one of these files can be found: on the path, or where an absolute name says.
pub fn found(names: &[&str]) -> bool {
    let Some(path) = std::env::var_os("PATH") else {
        return false;
    };
    let folders: Vec<_> = std::env::split_paths(&path).collect();
    names
        .iter()
        .any(|name| folders.iter().any(|folder| folder.join(name).is_file()))
}

/// Whether the programs are run with all rights.
pub fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output();
    id.is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Says the command and runs it; whether it succeeded.
pub fn run(command: &mut Command) -> bool {
    announce(command);
    match command.status() {
        Ok(status) => status.success(),
        Err(error) => {
            println!("cannot run it: {error}");
            false
        }
    }
}

/// As [`run`], handing every line of stdout to `hear` on its way to the terminal.
pub fn overheard(command: &mut Command, mut hear: impl FnMut(&str)) -> bool {
    announce(command);
    let mut child = match command.stdout(Stdio::piped()).spawn() {
        Ok(child) => child,
        Err(error) => {
            println!("cannot run it: {error}");
            return false;
        }
    };
    let lines = child.stdout.take().into_iter();
    let lines = lines.flat_map(|stdout| BufReader::new(stdout).split(b'\n'));
    for line in lines.map_while(Result::ok) {
        let line = String::from_utf8_lossy(&line).into_owned();
        println!("{line}");
        hear(&line);
    }
    child.wait().is_ok_and(|status| status.success())
}

fn announce(command: &Command) {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words: Vec<_> = std::iter::once(name)
        .chain(command.get_args())
        .map(|word| word.to_string_lossy())
        .collect();
    println!("\n$ {}", words.join(" "));
}
