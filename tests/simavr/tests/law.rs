#![allow(missing_docs)]
#[cfg(simavr)]
#[test]
fn law() {
    use handstand_shared::{gains::GainTable, law::control};
    let elf = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/avr/avr-none/avr/law.elf");
    let mut law = handstand_simavr::Law::load(&elf).unwrap();
    let mut seed = 12345u64;
    let mut next = || { seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (seed >> 33) as i32 };
    let (mut min, mut max, mut wrong) = (u64::MAX, 0, 0);
    let t0 = std::time::Instant::now();
    let mut n = 0;
    for shift in [16u8, 8, 0, 13] {
        let k = [[0; 6]; 2].map(|row: [i32; 6]| row.map(|_| (next() % 10_000) as i16));
        let table = GainTable::new(k, [next() % (1 << 28), next() % (1 << 20)], [shift; 2], [[-1023, 1023], [i16::MIN, i16::MAX]], [0; 6].map(|_: i32| next() as i16));
        if !table.is_safe() { println!("unsafe"); continue; }
        law.set(&table);
        for i in 0..5000 {
            let x = [0; 6].map(|_: i32| if i % 3 == 0 { next() as i16 } else { (next() % 1000) as i16 });
            let (u, cycles) = law.control(&x);
            min = min.min(cycles); max = max.max(cycles); n += 1;
            if u != control(&table, &x) { wrong += 1; if wrong < 5 { println!("{x:?} {table:?} {u:?} {:?}", control(&table, &x)); } }
        }
        println!("shift {shift} cycles {min}..{max} wrong {wrong}");
    }
    println!("{n} states, wall {:?}", t0.elapsed());
    assert_eq!(wrong, 0);
}
