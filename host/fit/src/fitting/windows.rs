//! How long the windows of each motion are, for people and programs.

use crate::output::number::given;
use serde::Serialize;

/// How long the windows of a motion are.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionWindow {
    /// The motion.
    pub motion: String,
    /// Seconds of a window; absent where the model runs over the whole motion.
    pub window_s: Option<f64>,
}

/// How long a model runs uncorrected, as a clause.
pub fn in_windows(windows: &[MotionWindow]) -> String {
    let seconds = windows.iter().filter_map(|window| window.window_s);
    let whole = windows.iter().any(|window| window.window_s.is_none());
    let shortest = seconds.clone().reduce(f64::min);
    let longest = seconds.reduce(f64::max);
    match (shortest, longest) {
        (Some(short), Some(_)) if whole => {
            format!("in windows from {} s to whole motions", given(short))
        }
        (Some(short), Some(long)) if given(short) != given(long) => {
            format!("in windows of {} to {} s", given(short), given(long))
        }
        (Some(short), _) => format!("in windows of {} s", given(short)),
        _ => "over whole motions".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_of_different_motions_are_said_in_one_clause() {
        let said = |seconds: &[Option<f64>]| {
            let windows = seconds.iter().map(|window_s| MotionWindow {
                motion: String::new(),
                window_s: *window_s,
            });
            in_windows(&windows.collect::<Vec<_>>())
        };
        assert_eq!(said(&[]), "over whole motions");
        assert_eq!(said(&[None, None]), "over whole motions");
        assert_eq!(said(&[Some(0.5), Some(0.5)]), "in windows of 0.5 s");
        assert_eq!(
            said(&[Some(0.5), Some(0.16)]),
            "in windows of 0.16 to 0.5 s"
        );
        assert_eq!(
            said(&[None, Some(0.16)]),
            "in windows from 0.16 s to whole motions"
        );
    }
}
