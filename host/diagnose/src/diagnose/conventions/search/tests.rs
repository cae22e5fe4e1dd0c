use super::*;

#[test]
fn units_of_one_input_do_not_crowd_out_other_corrections() {
    let tried = |correction| Trial {
        correction,
        before: 1.0,
        after: 0.5,
        before_rad: 1.0,
        after_rad: 0.5,
        better: 1.0,
    };
    let unit = Unit::named("N m", None).unwrap();
    let input = |joint| tried(Correction::Unit(vec![(LogColumn::Input(joint), unit)]));
    let reversed = tried(Correction::Reverse(vec![LogColumn::Input(0)]));
    let mut sorted: Vec<Trial> = (0..JUDGED).map(|_| input(0)).collect();
    sorted.extend([input(1), reversed.clone()]);
    let kept = most_promising(sorted);
    assert_eq!(kept, [input(0), input(0), input(1), reversed]);
}
