//! Commands on their way from the controller to the drives.

/// Rings of commands, each with the time it is due: one ring for all drives of the same delay.
#[derive(Debug, Clone)]
pub(super) struct Pending {
    rings: Vec<Ring>,
}

#[derive(Debug, Clone)]
struct Ring {
    delay_s: f64,
    /// Which drives obey so late.
    drives: Vec<usize>,
    due_s: Vec<f64>,
    commands: Vec<f64>,
    first: usize,
    count: usize,
}

impl Pending {
    /// Room for what the delays of the drives keep on its way.
    pub(super) fn new(delays_s: impl Iterator<Item = f64>, period_s: f64) -> Self {
        let mut rings: Vec<Ring> = Vec::new();
        for (drive, delay_s) in delays_s.enumerate() {
            match rings.iter_mut().find(|ring| ring.delay_s == delay_s) {
                Some(ring) => ring.drives.push(drive),
                None => rings.push(Ring {
                    delay_s,
                    drives: vec![drive],
                    due_s: Vec::new(),
                    commands: Vec::new(),
                    first: 0,
                    count: 0,
                }),
            }
        }
        for ring in &mut rings {
            // A jittering sample can come almost half a period early, so one more may be on its
            // way.
            let places = (ring.delay_s / period_s).max(0.0).ceil() as usize + 3;
            ring.due_s = vec![0.0; places];
            ring.commands = vec![0.0; places * ring.drives.len()];
        }
        Pending { rings }
    }

    /// Sends a command to every drive at `now_s`.
    #[inline]
    pub(super) fn push(&mut self, now_s: f64, command: &[f64]) {
        for ring in &mut self.rings {
            let place = (ring.first + ring.count) % ring.due_s.len();
            ring.due_s[place] = now_s + ring.delay_s;
            ring.count += 1;
            let to = &mut ring.commands[place * ring.drives.len()..];
            for (to, &drive) in to.iter_mut().zip(&ring.drives) {
                *to = command[drive];
            }
        }
    }

    /// When the next command is due, s.
    #[inline]
    pub(super) fn due_s(&self) -> f64 {
        let due = self.rings.iter().map(|ring| match ring.count {
            0 => f64::INFINITY,
            _ => ring.due_s[ring.first],
        });
        due.fold(f64::INFINITY, f64::min)
    }

    /// Takes off every command due at `until_s`: `obey(drive, command)`.
    #[inline]
    pub(super) fn pop(&mut self, until_s: f64, mut obey: impl FnMut(usize, f64)) {
        for ring in &mut self.rings {
            while ring.count > 0 && ring.due_s[ring.first] <= until_s {
                let commands = &ring.commands[ring.first * ring.drives.len()..];
                for (&drive, &command) in ring.drives.iter().zip(commands) {
                    obey(drive, command);
                }
                ring.first = (ring.first + 1) % ring.due_s.len();
                ring.count -= 1;
            }
        }
    }
}
