//! A value of the file that explains all: nothing larger is looked for.

use super::tests::{all_but, arm, silent};
use super::*;
use crate::diagnose::DiagnoseOptions;
use crate::diagnose::evaluator::Reach;
use crate::diagnose::explanation::Explanation;

/// The file's centre of mass is off by a third, which no friction says.
#[test]
fn where_a_value_explains_all_no_set_of_two_is_tried() {
    let (mut model, training, held_out) = arm(1, &[]);
    let com = "link1.com_m".parse().unwrap();
    model.free.retain(|path| *path != com);
    let given_m = com.get(&model).unwrap();
    assert!(com.set(&mut model, 0.7 * given_m));
    let options = DiagnoseOptions {
        without: all_but(&["delay", "torque_offset", "air_drag"]),
        ..DiagnoseOptions::default()
    };
    let reach = Reach::Promising;
    let mut evaluator = Evaluator::new(&model, training, held_out, &options, reach, silent());
    let mut found = SearchResults::default();
    evaluator.search(&mut found);
    assert_eq!(found.sizes.len(), 1);
    let outcome = found.outcome();
    let explanation = outcome.explanation(&evaluator);
    assert!(evaluator.is_value_that_explains(explanation));
    // Friction is off, too, and free.
    assert!(matches!(explanation, Explanation::ValueAndRefit(_)));
    assert_eq!(explanation.hypothesis().values, [com]);
}
