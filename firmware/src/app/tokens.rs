//! What arming must bring, so that no old frame arms.

/// Tokens of this start.
#[derive(Debug)]
pub(super) struct Tokens {
    now: Token,
    /// Number of this start, and of the greetings in it from a number of chance on: what tokens are
    /// made of.
    start: u8,
    greetings: Option<u8>,
}

/// What the last greeting gave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Token {
    /// Nothing: there was none of this version, or torque went off since.
    None,
    /// One that may arm.
    Fresh(u16),
    /// One that has armed: it does so once.
    Used(u16),
}

impl Tokens {
    /// Before a greeting, in the start of this number.
    pub fn of_start(start: u8) -> Self {
        Tokens {
            now: Token::None,
            start,
            greetings: None,
        }
    }

    /// Number of this start.
    pub fn start(&self) -> u8 {
        self.start
    }

    pub fn now(&self) -> Token {
        self.now
    }

    pub fn set(&mut self, token: Token) {
        self.now = token;
    }

    /// Its last token arms no more.
    pub fn uses_up(&mut self) {
        if let Token::Fresh(token) = self.now {
            self.now = Token::Used(token);
        }
    }

    /// What it should have armed for came to nothing: it may arm again.
    pub fn gives_back(&mut self) {
        if let Token::Used(token) = self.now {
            self.now = Token::Fresh(token);
        }
    }

    /// Another one than in the last 255 greetings and the last 255 starts. The first of a start is
    /// chance, for when a host greets is: should the EEPROM be erased, an old frame still fits with
    /// 1 in 256 only.
    pub fn greet(&mut self, clock: u16) -> u16 {
        let before = self.greetings.unwrap_or(clock as u8);
        let greeting = before.wrapping_add(1);
        self.greetings = Some(greeting);
        u16::from_le_bytes([greeting, self.start])
    }
}
