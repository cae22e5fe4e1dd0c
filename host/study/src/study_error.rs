//! Why a study is refused: the data, its sentence, and the remedy.

use super::quantities::QUANTITIES;
use crate::error::Reason;
use crate::model::suggest::suggest;
use std::borrow::Cow;
use std::path::PathBuf;

/// What is wrong with a study's file, its journals, or what is asked of it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum StudyError {
    #[error("nothing called `{0}` can be uncertain")]
    NotUncertain(String),
    #[error("`{0}` belongs to the whole robot")]
    WholeRobot(String),
    #[error("{0} is drawn twice")]
    DrawnTwice(String),
    #[error("{sweep}: there is no level {level}")]
    NoLevel {
        sweep: &'static str,
        level: f64,
        bounds: (f64, f64),
        unit: &'static str,
    },
    #[error("`{0}` is no square matrix")]
    NotSquare(&'static str),
    #[error("`{0}` is no shard: write `2/5` for the second of five")]
    NoShard(String),

    #[error("this is no journal of a study")]
    NoJournal,
    #[error("{}: another program is writing it", .0.display())]
    Locked(PathBuf),
    #[error("this is the journal of another study, or of another version of the program")]
    OtherStudy,
    #[error("writing has stopped")]
    WritingStopped,

    #[error("there is no journal to merge")]
    NothingToMerge,
    #[error("this is another study than {}", .0.display())]
    StudiesDiffer(PathBuf),
    #[error("chunk {chunk} differs from that in {}", other.display())]
    ChunkDiffers { chunk: usize, other: PathBuf },
    #[error("chunk {chunk} of a study of {chunks} chunks")]
    ChunkBeyond {
        chunk: usize,
        chunks: usize,
        other: PathBuf,
    },
    #[error("this row does not fit the columns")]
    WrongRow,
}

impl Reason for StudyError {
    fn remedy(&self) -> Cow<'_, str> {
        match self {
            StudyError::NotUncertain(what) => {
                let uncertain = QUANTITIES
                    .iter()
                    .filter(|quantity| quantity.spread.is_some());
                let known: Vec<&str> = uncertain.map(|quantity| quantity.id).collect();
                suggest(what, &known).into()
            }
            StudyError::WholeRobot(_) => "leave `link` out".into(),
            StudyError::DrawnTwice(_) => "say it once".into(),
            StudyError::NoLevel {
                bounds: (low, high),
                unit,
                ..
            } => {
                let remedy = format!("give levels from {low} to {high} {unit}");
                remedy.trim_end().to_string().into()
            }
            StudyError::NotSquare(_) => {
                "give a number, a diagonal such as [100, 100, 1, 1], or as many rows as columns"
                    .into()
            }
            StudyError::NoShard(_) => "the first of five is `1/5`, the last `5/5`".into(),
            StudyError::NoJournal => {
                "name a .journal file that `handstand study monte-carlo` wrote, or its folder"
                    .into()
            }
            StudyError::Locked(_) => "wait for it, or give this one another folder".into(),
            StudyError::OtherStudy => {
                "give this study another folder, or delete the journal".into()
            }
            StudyError::WritingStopped => "see the error before".into(),
            StudyError::NothingToMerge => "name .journal files, or folders with such files".into(),
            StudyError::StudiesDiffer(_) => {
                "merge shards of one study, all by the same version of the program".into()
            }
            StudyError::ChunkDiffers { .. } => {
                "the same run must give the same row: one of the two was changed, or computed on \
                 a machine whose arithmetic differs"
                    .into()
            }
            StudyError::ChunkBeyond { other, .. } => {
                format!("compare the file with {}", other.display()).into()
            }
            StudyError::WrongRow => "run the shard again".into(),
        }
    }
}
