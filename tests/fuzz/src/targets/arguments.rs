//! Arguments of the command line that are more than one word or number.

use super::text;
use handstand::link::virtual_cm5::BusSpec;
use handstand::log::LogRequest;
use handstand::model::ParameterPath;
use handstand::study::Shard;
use handstand::sysid::structures;

/// Logs with rows, parameters, shards, black-box structures, the words of a simulated bus.
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
    let _ = structures(text);
    if let Ok(words) = text.parse::<BusSpec>() {
        let _ = words.bus();
    }
}
