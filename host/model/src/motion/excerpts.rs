//! Excerpts of long logs, so that a check or a rough estimate takes seconds however long they are.

use super::Motion;

/// Samples of an excerpt.
const LENGTH: usize = 400;

/// Pieces of the motions, evenly spread, of some `most` samples in all; the motions themselves
/// where they have no more.
pub fn excerpts(motions: &[Motion], most: usize) -> Vec<Motion> {
    let samples: usize = motions.iter().map(Motion::len).sum();
    if samples <= most {
        return motions.to_vec();
    }
    let share = most as f64 / samples as f64;
    motions
        .iter()
        .flat_map(|motion| of(motion, share))
        .collect()
}

/// Pieces of one motion that hold about this share of its samples.
fn of(motion: &Motion, share: f64) -> Vec<Motion> {
    let count = (share * motion.len() as f64 / LENGTH as f64)
        .ceil()
        .max(1.0) as usize;
    let length = LENGTH.min(motion.len());
    let room = motion.len() - length;
    let begin = |piece: usize| match count {
        1 => 0,
        _ => piece * room / (count - 1),
    };
    let mut pieces = Vec::new();
    let mut from = 0;
    for piece in 0..count {
        let begin = begin(piece).max(from);
        let end = (begin + length).min(motion.len());
        if end > begin + LENGTH / 4 || pieces.is_empty() {
            pieces.push(motion.part(begin..end));
        }
        from = end;
    }
    pieces
}
