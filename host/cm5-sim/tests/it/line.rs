//! The line from the PC: frames and servo packets on it, and what becomes of broken ones.

use super::rig::*;
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::board::Board as _;
use handstand_firmware::design::{COMMAND_US, TICK_US};
use handstand_firmware::link::Link;
use handstand_shared::control_table::RETURN_DELAY;
use handstand_shared::frame::MAX_FRAME;
use handstand_shared::message::*;

/// A PING of servo 1, and its answer.
const PING: [u8; 6] = [0xff, 0xff, 1, 2, 1, 0xfb];
const PONG: [u8; 6] = [0xff, 0xff, 1, 2, 0, 0xfc];

/// An adapter past its start.
fn adapter() -> VirtualCm5 {
    let mut cm5 = VirtualCm5::new();
    cm5.run_ms(250.0);
    cm5
}

/// Whether a PING reaches the servo, and what is read is its answer alone.
fn pings(cm5: &mut VirtualCm5) -> bool {
    cm5.clear();
    cm5.send_bytes(&PING);
    cm5.run_ms(20.0);
    let is_pong = cm5.raw() == PONG;
    // What is no frame must not spoil the next one at the PC.
    let now_ms = cm5.now_ms();
    cm5.pc_mut().receive(now_ms, 0);
    is_pong
}

/// Statistics of an adapter: a zero tells a frame from a servo packet.
fn counted(cm5: &mut VirtualCm5) -> Statistics {
    cm5.send_bytes(&[0]);
    statistics(cm5)
}

#[test]
fn an_adapter_s_line_carries_frames_between_packets() {
    let mut cm5 = adapter();
    for _ in 0..3 {
        assert!(pings(&mut cm5));
        greet(&mut cm5);
        assert!(pings(&mut cm5), "after a frame");
    }
}

/// Of what was begun and not continued for 50 ms nothing is left: neither in the filter nor in the
/// frames' decoder.
#[test]
fn what_was_begun_is_given_up() {
    let mut cm5 = adapter();
    greet(&mut cm5);
    let bad = counted(&mut cm5).bad_frames;
    let (frame, _) = cm5.pc_mut().frame(&Command::Hello { version: VERSION });
    cm5.send_bytes(&frame[..3]);
    cm5.run_ms(100.0);
    assert!(pings(&mut cm5));
    greet(&mut cm5);
    // The servo, too, waits for the rest of a packet: it takes the next one's first bytes.
    cm5.send_bytes(&PING[..4]);
    cm5.run_ms(100.0);
    pings(&mut cm5);
    greet(&mut cm5);
    assert!(pings(&mut cm5));
    assert_eq!(
        counted(&mut cm5).bad_frames,
        bad,
        "no half frame was taken for one"
    );
}

#[test]
fn lost_frames_are_counted_from_the_greeting_on() {
    let mut cm5 = adapter();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    let before = statistics(&mut cm5);
    // Three that never arrive, and one that arrives broken.
    for _ in 0..3 {
        let _ = cm5.pc_mut().frame(&Command::KeepAlive);
    }
    let (mut frame, _) = cm5.pc_mut().frame(&Command::KeepAlive);
    frame[2] ^= 1;
    cm5.send_bytes(&frame);
    cm5.run_ms(20.0);
    cm5.send(&Command::KeepAlive);
    cm5.run_ms(20.0);
    let after = statistics(&mut cm5);
    assert_eq!(after.lost_frames - before.lost_frames, 4);
    assert_eq!(after.bad_frames - before.bad_frames, 1);
    assert_eq!(after.frames - before.frames, 2);
    greet(&mut cm5);
    assert_eq!(statistics(&mut cm5).lost_frames, 0);
}

/// A report goes out whole or not at all.
#[test]
fn a_report_takes_all_the_room_it_needs() {
    let report = Report::Statistics(Statistics::default());
    let length = {
        let mut frame = [0; MAX_FRAME];
        encode(0, &report, &mut frame).expect("it fits")
    };
    for (missing, is_sent) in [(0, true), (1, false)] {
        let mut board = HostBoard::new(Bus::new([]));
        let filler = vec![1; board.link_room() - length + missing];
        board.link_send(&filler);
        assert_eq!(board.link_room(), length - missing);
        assert_eq!(Link::default().send(&mut board, &report), is_sent);
        let left = if is_sent { 0 } else { length - missing };
        assert_eq!(board.link_room(), left);
    }
}

/// What the queue to the PC has no room for is lost, and counted: no tool sees it otherwise.
#[test]
fn what_is_cut_of_long_answers_is_counted() {
    let mut cm5 = adapter();
    greet(&mut cm5);
    assert_eq!(counted(&mut cm5).cut, 0);
    // Pings right behind each other: a servo answers them at 1 Mbps, the line passes on 57600.
    let mut heard = 0;
    for count in [30, 60] {
        cm5.clear();
        cm5.run_ms(100.0);
        // As if they had come at once.
        for _ in 0..count {
            let now_ns = cm5.board.now_ns();
            for (place, byte) in (1u64..).zip(PING) {
                cm5.board.bus.receive(now_ns + place * 10_000, byte);
            }
            cm5.run_ms(0.2);
        }
        cm5.run_ms(100.0);
        heard += cm5.raw().len() as u16;
        let now_ms = cm5.now_ms();
        cm5.pc_mut().receive(now_ms, 0);
        let cut = counted(&mut cm5).cut;
        assert_eq!(cut > 0, count == 60, "{count} answers: {cut}");
        if cut > 0 {
            assert_eq!(heard + cut, 90 * 6, "every byte is passed on or counted");
        }
    }
}

/// The LEDs say whether the PC was heard in the last 80 ms, and whether all servos answer.
#[test]
fn leds_tell_of_both_lines() {
    use handstand_firmware::panel::led;
    let lit = |cm5: &VirtualCm5, led: u8| cm5.board.leds & led != 0;
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    cm5.run_ms(200.0);
    assert!(!lit(&cm5, led::TXD) && lit(&cm5, led::RXD));
    say(&mut cm5, &Command::KeepAlive, 50);
    assert!(lit(&cm5, led::TXD));
    cm5.run_ms(60.0);
    assert!(lit(&cm5, led::TXD));
    cm5.run_ms(40.0);
    assert!(!lit(&cm5, led::TXD));
    cm5.bus().servo(9).unwrap().faults.dead = true;
    cm5.run_ms(30.0);
    assert!(!lit(&cm5, led::RXD));
    assert!(lit(&cm5, led::POWER));
}

/// Held down it would have to be let go and pressed again to stop the robot.
#[test]
fn nothing_is_armed_under_a_button_that_is_held_down() {
    use handstand_firmware::panel::button;
    let mut cm5 = VirtualCm5::new();
    let token = greet(&mut cm5).token;
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    cm5.board.buttons = button::DOWN;
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Button)));
    cm5.board.buttons = 0;
    say(&mut cm5, &Command::KeepAlive, 50);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
}

/// Ticks may last from less than their period to more, those that end just before the next one
/// among them.
#[test]
fn a_word_counts_however_long_ticks_are() {
    let mut lengths_us = Vec::new();
    let answer_after = |cm5: &mut VirtualCm5, delay: u16| {
        for id in 1..=18 {
            cm5.bus().servo(id).unwrap().set(RETURN_DELAY, delay);
        }
    };
    for delay in 130..170 {
        let mut cm5 = VirtualCm5::new();
        // Where ticks are longer it is not armed.
        answer_after(&mut cm5, 130);
        arm(&mut cm5);
        answer_after(&mut cm5, delay);
        say(&mut cm5, &Command::KeepAlive, 100);
        cm5.send(&Command::Disarm);
        cm5.run_ms(40.0);
        assert!(!cm5.app.is_armed(), "delay {delay}");
        lengths_us.push(telemetry(&mut cm5).longest_tick_us);
    }
    let near = |length: &&u16| (TICK_US - COMMAND_US..TICK_US).contains(length);
    assert!(lengths_us.iter().filter(near).count() > 2, "{lengths_us:?}");
}
