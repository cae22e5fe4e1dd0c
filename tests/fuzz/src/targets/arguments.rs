//! Arguments of the command line that are more than one word or number.

use super::text;
use handstand::link::{SimWords, ids};
use handstand::log::LogRequest;
use handstand::model::ParameterPath;
use handstand::study::Shard;

/// Logs with rows, parameters, shards, servo lists, the words of a simulated bus.
pub(crate) fn run(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    if let Ok(log) = text.parse::<LogRequest>() {
        let _ = (log.name(), log.is_json(), log.wants(usize::MAX));
    }
    if let Ok(path) = text.parse::<ParameterPath>() {
        let again = path.to_string().parse::<ParameterPath>();
        assert_eq!(again.ok(), Some(path), "{text}");
    }
    let _ = text.parse::<Shard>();
    let _ = ids(text);
    if let Ok(words) = text.parse::<SimWords>() {
        let _ = words.bus();
    }
}
