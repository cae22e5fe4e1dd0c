//! Mutants kept by hand: what must not survive, and what cargo-mutants does not make (assembler,
//! and registers that only the ELF has).

/// Where a mutant's tests run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bench {
    /// The logic in process.
    Logic,
    /// The ELF in simavr.
    Elf,
}

/// A change of one place that tests must notice.
#[derive(Debug)]
pub struct ListedMutant {
    /// What it does.
    pub name: &'static str,
    /// The file, from the repository's root.
    pub file: &'static str,
    /// What is replaced; it occurs once.
    pub old: &'static str,
    /// What replaces it.
    pub new: &'static str,
    /// Where it has to be noticed.
    pub bench: Bench,
}

const fn logic(
    name: &'static str,
    file: &'static str,
    old: &'static str,
    new: &'static str,
) -> ListedMutant {
    ListedMutant {
        name,
        file,
        old,
        new,
        bench: Bench::Logic,
    }
}

const fn elf(
    name: &'static str,
    file: &'static str,
    old: &'static str,
    new: &'static str,
) -> ListedMutant {
    ListedMutant {
        name,
        file,
        old,
        new,
        bench: Bench::Elf,
    }
}

/// All of them.
pub const LISTED: &[ListedMutant] = &[
    logic(
        "low-supply stop removed",
        "firmware/src/app/soft_stop.rs",
        "} else if armed.low.is_some_and(|low| low.us() >= LOW_SUPPLY_US) {",
        "} else if false {",
    ),
    logic(
        "disarm keeps its token",
        "firmware/src/app/soft_stop.rs",
        "        self.tokens.set(Token::None);\n        if let",
        "        if let",
    ),
    logic(
        "check of a plan's slot ignored",
        "firmware/src/plan_store.rs",
        "            == u32::from_le_bytes(check);\n    is_sound.then_some",
        "            != 0;\n    is_sound.then_some",
    ),
    logic(
        "check of PlanStore ignored",
        "firmware/src/plan_store.rs",
        "if body_check(board, slot, length) != check {",
        "if false {",
    ),
    logic(
        "pose not checked",
        "firmware/src/app/arming.rs",
        "if !self.balance.is_posed(&readings) {",
        "if false {",
    ),
    logic(
        "a fault stops repeating torque off",
        "firmware/src/app/modes.rs",
        "if self.ticks & 7 == 0 {",
        "if false {",
    ),
    logic(
        "sign of the gyro reversed",
        "firmware/src/balance/attitude.rs",
        "code.wrapping_mul(i32::from(self.plan.gyro.scale))",
        "code.wrapping_neg().wrapping_mul(i32::from(self.plan.gyro.scale))",
    ),
    logic(
        "PlanChunk taken while armed",
        "firmware/src/app/command.rs",
        "Command::PlanChunk { offset, bytes } => {\n                if self.is_armed() {",
        "Command::PlanChunk { offset, bytes } => {\n                if false {",
    ),
    logic(
        "another start value of CRC-16",
        "shared/src/crc.rs",
        "pub const START_16: u16 = 0xffff;",
        "pub const START_16: u16 = 0x0000;",
    ),
    logic(
        "watchdog fed in every turn of the loop",
        "firmware/src/app.rs",
        "        self.pass(board.clock());\n        if board.tick_due() {",
        "        self.pass(board.clock());\n        board.feed_watchdog();\n        \
         if board.tick_due() {",
    ),
    logic(
        "fault not logged",
        "firmware/src/app/soft_stop.rs",
        "        self.log_fault(cause);\n        if self.servos.tripped",
        "        if self.servos.tripped",
    ),
    logic(
        "check of the fault log ignored",
        "firmware/src/fault_log.rs",
        "(crc32(content).to_le_bytes() == *check).then_some(cell)",
        "(!check.is_empty()).then_some(cell)",
    ),
    elf(
        "charger left on",
        "firmware/src/atmega128/mod.rs",
        "        port::charger_off(&registers);\n",
        "",
    ),
    elf(
        "reset cause not cleared",
        "firmware/src/atmega128/watchdog.rs",
        "    unsafe { r.CPU.mcucsr().write(|w| w.bits(flags & 0x80)) };\n",
        "",
    ),
    elf(
        "both receivers of the line on",
        "firmware/src/atmega128/port.rs",
        "FromZigbee::new(PinState::Low);",
        "FromZigbee::new(PinState::High);",
    ),
    elf(
        "r1 not cleared by the law",
        "shared/src/law/avr.rs",
        "            \"clr r1\",\n            \"mov r0, {kept}\",\n            forget!(\"power\"",
        "            \"mov r0, {kept}\",\n            forget!(\"power\"",
    ),
];

#[cfg(test)]
mod tests {
    use super::LISTED;
    use handstand_xtask::root;

    #[test]
    fn every_listed_mutant_has_its_place() {
        for mutant in LISTED {
            let text = std::fs::read_to_string(root().join(mutant.file)).unwrap();
            assert_eq!(text.matches(mutant.old).count(), 1, "{}", mutant.name);
            assert_ne!(mutant.old, mutant.new, "{}", mutant.name);
        }
    }
}
