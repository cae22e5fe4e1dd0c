//! Commands on their way from the controller to the drives.

/// A ring of commands, each with the time it is due.
#[derive(Debug, Clone)]
pub(super) struct Pending {
    due_s: Vec<f64>,
    command_nm: Vec<f64>,
    drives: usize,
    first: usize,
    count: usize,
}

impl Pending {
    /// Room for what a delay keeps on its way.
    pub(super) fn new(drives: usize, delay_periods: f64) -> Self {
        // A jittering sample can come almost half a period early, so one more may be on its way.
        let places = delay_periods.max(0.0).ceil() as usize + 3;
        Pending {
            due_s: vec![0.0; places],
            command_nm: vec![0.0; places * drives],
            drives,
            first: 0,
            count: 0,
        }
    }

    /// The place of a new command, due at `due_s`.
    #[inline]
    pub(super) fn push(&mut self, due_s: f64) -> &mut [f64] {
        let place = (self.first + self.count) % self.due_s.len();
        self.due_s[place] = due_s;
        self.count += 1;
        &mut self.command_nm[place * self.drives..][..self.drives]
    }

    /// When the next command is due, s.
    #[inline]
    pub(super) fn due_s(&self) -> f64 {
        match self.count {
            0 => f64::INFINITY,
            _ => self.due_s[self.first],
        }
    }

    /// Takes off the command that is due next.
    #[inline]
    pub(super) fn pop(&mut self) -> &[f64] {
        let place = self.first;
        self.first = (place + 1) % self.due_s.len();
        self.count -= 1;
        &self.command_nm[place * self.drives..][..self.drives]
    }

    /// Forgets the newest.
    #[inline]
    pub(super) fn lose(&mut self) {
        self.count -= 1;
    }
}
