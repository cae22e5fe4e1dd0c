//! Simulated servos of Protocol 2.0, byte for byte and in time.

use super::*;
use handstand_shared::control_table::Item;
use handstand_shared::control_table::x::*;
use handstand_shared::dynamixel2::*;

fn bus(words: &str) -> Bus {
    words.parse::<BusSpec>().unwrap().bus()
}

/// The answers to these bytes, sent at `now_ns`, each byte with its end.
fn send(bus: &mut Bus, now_ns: u64, bytes: &[u8]) -> Vec<(u64, u8)> {
    bytes.iter().for_each(|byte| bus.receive(now_ns, *byte));
    std::iter::from_fn(|| bus.take(u64::MAX)).collect()
}

fn ask(bus: &mut Bus, now_ns: u64, id: u8, request: Request) -> Vec<(u8, ErrorByte, Vec<u8>)> {
    let mut out = [0; MAX_PACKET];
    let length = request.emit(id, &mut out).unwrap();
    let mut receiver = Receiver::<MAX_PACKET>::default();
    let mut found = Vec::new();
    for (_, byte) in send(bus, now_ns, &out[..length]) {
        if let Some(packet) = receiver.push(byte) {
            let (error, data) = packet.status().unwrap();
            found.push((packet.id(), error, data.collect()));
        }
    }
    found
}

fn write(item: Item, code: i32) -> ([u8; 4], Item) {
    (item.bytes(code), item)
}

fn set(bus: &mut Bus, now_ns: u64, id: u8, (bytes, item): ([u8; 4], Item)) -> u8 {
    let data = &bytes[..usize::from(item.size)];
    let address = item.address;
    let answers = ask(bus, now_ns, id, Request::Write { address, data });
    answers.first().map_or(0xff, |(_, error, _)| error.0)
}

#[test]
fn a_ping_is_answered_literally_and_in_time() {
    let mut bus = bus("model=XL330-M288,ids=1,delay=0,turnaround=0");
    let ping = [0xff, 0xff, 0xfd, 0, 1, 3, 0, 1, 0x19, 0x4e];
    let answer = send(&mut bus, 1_000_000, &ping);
    let bytes: Vec<u8> = answer.iter().map(|(_, byte)| *byte).collect();
    let said = [
        0xff, 0xff, 0xfd, 0, 1, 7, 0, 0x55, 0, 0xb0, 4, 0x34, 0xb2, 0xd4,
    ];
    assert_eq!(bytes, said);
    assert_eq!(answer[13].0, 1_000_000 + 14 * 10_000);
    // Protocol 1.0 it does not know.
    assert!(send(&mut bus, 2_000_000, &[0xff, 0xff, 1, 2, 1, 0xfb]).is_empty());
    // A pause within an instruction makes it drop the instruction.
    send(&mut bus, 3_000_000, &ping[..5]);
    assert!(send(&mut bus, 5_000_000, &ping[5..]).is_empty());
}

/// The line's limit of the manual: request and statuses without a gap.
#[test]
fn reads_of_18_servos_take_what_the_line_takes() {
    let ids: Vec<u8> = (1..=18).collect();
    for (baud, code) in [(1_000_000, 3), (2_000_000, 4), (4_000_000, 6)] {
        for (fast, bytes) in [(false, 410), (true, 292)] {
            let mut bus = bus(&format!(
                "model=XL330-M288,delay=0,turnaround=0,baud={code}"
            ));
            bus.line_baud = baud;
            let read = Request::SyncRead {
                fast,
                address: 126,
                count: 10,
                ids: &ids,
            };
            let mut out = [0; MAX_PACKET];
            let length = read.emit(BROADCAST, &mut out).unwrap();
            let byte_ns = 10_000_000_000 / u64::from(baud);
            let sent_ns = length as u64 * byte_ns;
            let answer = send(&mut bus, sent_ns, &out[..length]);
            assert_eq!(length + answer.len(), bytes);
            assert_eq!(answer.last().unwrap().0, bytes as u64 * byte_ns);
        }
    }
}

#[test]
fn sync_and_bulk_reads_end_at_a_missing_servo() {
    let mut bus = bus("model=XL430,ids=1-5,dead=4");
    let ids =
        |answers: Vec<(u8, ErrorByte, Vec<u8>)>| answers.iter().map(|a| a.0).collect::<Vec<_>>();
    let sync = Request::SyncRead {
        fast: false,
        address: 132,
        count: 4,
        ids: &[2, 1, 4, 5],
    };
    assert_eq!(ids(ask(&mut bus, 0, BROADCAST, sync)), [2, 1]);
    let items = &[1, 144, 0, 2, 0, 5, 146, 0, 1, 0];
    let bulk = ask(
        &mut bus,
        10_000_000,
        BROADCAST,
        Request::BulkRead { fast: false, items },
    );
    assert_eq!(bulk[0].2, [100, 0]);
    assert_eq!(bulk[1], (5, ErrorByte(0), vec![30]));
    let pinged = ask(&mut bus, 20_000_000, BROADCAST, Request::Ping);
    assert_eq!(ids(pinged), [1, 2, 3, 5]);
}

#[test]
fn eeprom_is_locked_while_torque_is_on_and_values_are_checked() {
    let mut bus = bus("model=XM430-W350,ids=1,level=2");
    assert_eq!(set(&mut bus, 0, 1, write(TORQUE_ENABLE, 1)), 0);
    assert_eq!(set(&mut bus, 1_000_000, 1, write(OPERATING_MODE, 4)), 7);
    assert_eq!(set(&mut bus, 2_000_000, 1, write(PRESENT_POSITION, 4)), 7);
    assert_eq!(set(&mut bus, 3_000_000, 1, write(LED, 2)), 4);
    assert_eq!(set(&mut bus, 4_000_000, 1, write(GOAL_POSITION, 5000)), 6);
    let short = Request::Write {
        address: 116,
        data: &[0],
    };
    assert_eq!(ask(&mut bus, 5_000_000, 1, short)[0].1, ErrorByte(5));
    let beyond = Request::Read {
        address: 700,
        count: 1,
    };
    assert_eq!(ask(&mut bus, 6_000_000, 1, beyond)[0].1, ErrorByte(7));
}

#[test]
fn the_bus_watchdog_stops_a_servo_until_it_is_cleared() {
    let mut bus = bus("model=XL330-M288,ids=1");
    set(&mut bus, 0, 1, write(GOAL_POSITION, 4000));
    set(&mut bus, 0, 1, write(BUS_WATCHDOG, 5));
    set(&mut bus, 0, 1, write(TORQUE_ENABLE, 1));
    // Within 100 ms it moves, behind them it stands, short of its goal.
    bus.advance(90_000_000);
    assert!(bus.x.servos[0].shaft.speed_rad_s > 1.0);
    bus.advance(600_000_000);
    let servo = &bus.x.servos[0];
    assert!(servo.watchdog_has_tripped() && servo.torque_is_on());
    assert!(servo.shaft.speed_rad_s.abs() < 0.01 && servo.get(PRESENT_POSITION) < 3000);
    assert_eq!(set(&mut bus, 600_000_000, 1, write(GOAL_POSITION, 2048)), 4);
    assert_eq!(set(&mut bus, 600_000_000, 1, write(BUS_WATCHDOG, 0)), 0);
    assert_eq!(set(&mut bus, 600_000_000, 1, write(GOAL_POSITION, 2048)), 0);
    bus.advance(2_000_000_000);
    assert!((bus.x.servos[0].get(PRESENT_POSITION) - 2048).abs() < 5);
}

#[test]
fn an_overloaded_servo_answers_with_an_alert_until_it_is_rebooted() {
    let mut bus = bus("model=XL330-M288,ids=1,overload=1");
    let read = Request::Read {
        address: 70,
        count: 1,
    };
    assert_eq!(ask(&mut bus, 0, 1, read)[0], (1, ErrorByte(0x80), vec![32]));
    set(&mut bus, 0, 1, write(TORQUE_ENABLE, 1));
    assert!(!bus.x.servos[0].torque_is_on());
    ask(&mut bus, 0, 1, Request::Reboot);
    bus.advance(200_000_000);
    assert_eq!(
        ask(&mut bus, 200_000_000, 1, read)[0],
        (1, ErrorByte(0), vec![0])
    );
}

#[test]
fn words_of_protocol_2_are_checked() {
    for (wrong, said) in [
        ("model=XL330", "XL330-M288"),
        ("turns=1", "name its model before"),
        ("model=xl430,robot=a.toml", "AX-12 servos only"),
        ("model=xl430,turns=x", "from -200 to 200"),
    ] {
        let error = wrong.parse::<BusSpec>().unwrap_err().to_string();
        assert!(error.contains(said), "{wrong}: {error}");
    }
}

/// The firmware as an adapter passes packets of Protocol 2.0 and their answers whole.
#[test]
fn a_cm5_passes_them_on() {
    let mut cm5 = VirtualCm5::start(HostBoard::new(bus("model=XL430,ids=1-3,delay=0")));
    cm5.run_ms(STARTED_MS);
    cm5.pc_mut().raw.clear();
    cm5.send_bytes(&[0xff, 0xff, 0xfd, 0, 1, 3, 0, 1, 0x19, 0x4e]);
    cm5.run_ms(10.0);
    let packet = Packet::new(&cm5.pc().raw).expect("a whole status");
    assert_eq!((packet.id(), packet.bytes().len()), (1, 14));
    cm5.pc_mut().raw.clear();
    // Goal position 512, with the zeros that begin a frame elsewhere; then a sync read.
    cm5.send_bytes(&[
        0xff, 0xff, 0xfd, 0, 1, 9, 0, 3, 0x74, 0, 0, 2, 0, 0, 0xca, 0x89,
    ]);
    cm5.run_ms(20.0);
    assert_eq!(cm5.pc().raw.len(), 11);
    assert_eq!(cm5.bus().x.servos[0].get(GOAL_POSITION), 512);
    cm5.pc_mut().raw.clear();
    let mut out = [0; 32];
    let read = Request::SyncRead {
        fast: false,
        address: 132,
        count: 4,
        ids: &[1, 2, 3],
    };
    let length = read.emit(BROADCAST, &mut out).unwrap();
    cm5.send_bytes(&out[..length]);
    cm5.run_ms(30.0);
    assert_eq!(cm5.pc().raw.len(), 3 * 15);
}
