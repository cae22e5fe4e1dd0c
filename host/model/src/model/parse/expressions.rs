//! The `[[expression]]` tables: effects that the file defines itself.

use super::super::reader::Table;
use super::EITHER_SIGN;
use super::effects::effect_twice;
use crate::effects::Effect;
use crate::effects::expression::{DefinitionFault, LawDefinition, LawParameter, LawSite, effect};
use crate::error::Result;

pub(super) fn read(root: &Table) -> Result<Vec<Effect>> {
    let mut laws: Vec<Effect> = Vec::new();
    for table in root.tables("expression")? {
        let law = law(&table)?;
        let id = law.info().id;
        if laws.iter().any(|other| other.info().id == id) {
            return Err(effect_twice(&table, "name", id));
        }
        laws.push(law);
    }
    Ok(laws)
}

fn law(table: &Table) -> Result<Effect> {
    table.only(&["name", "torque", "friction", "parameter"])?;
    let given = |site: &LawSite| table.has(site.key());
    let site = match LawSite::ALL.into_iter().filter(given).collect::<Vec<_>>()[..] {
        [site] => site,
        [] => LawSite::Torque,
        _ => {
            return Err(table.bad(
                "friction",
                "`torque` and `friction` in one law",
                "write two [[expression]] tables, each with its own name",
            ));
        }
    };
    let parameters = table.tables("parameter")?;
    let definition = LawDefinition {
        name: table.required_text("name")?.to_string(),
        site,
        expression: table.required_text(site.key())?.to_string(),
        parameters: parameters.iter().map(parameter).collect::<Result<_>>()?,
        slides: true,
    };
    effect(&definition).map_err(|fault| match fault {
        DefinitionFault::Name(problem) => problem.at(table.place_of("name")),
        DefinitionFault::Parameter(index, problem) => problem.at(parameters[index].place_of("key")),
        DefinitionFault::Expression(misplaced) => {
            let place = table.place_of_character(site.key(), misplaced.at);
            misplaced.problem.at(place)
        }
    })
}

fn parameter(table: &Table) -> Result<LawParameter> {
    table.only(&["key", "unit", "meaning", "start", "low", "high"])?;
    let number = |key: &str| table.required_number(key, EITHER_SIGN);
    let text = |key: &str| table.text(key);
    Ok(LawParameter {
        key: table.required_text("key")?.to_string(),
        unit: table.required_text("unit")?.to_string(),
        meaning: text("meaning")?
            .unwrap_or("of the model file's law")
            .to_string(),
        starts: vec![number("start")?],
        bounds: (number("low")?, number("high")?),
    })
}

#[cfg(test)]
mod tests {
    use crate::Model;
    use crate::error::Error;
    use std::path::Path;

    const TEXT: &str = "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.1\n\
        mass_kg = 1.0\ninertia_kg_m2 = 1e-3\n[[joint]]\ndrive = \"passive\"\n\
        [[expression]]\nname = \"wind\"\ntorque = \"-c * w * abs(w)\"\n\
        parameter = [{ key = \"c\", unit = \"N m s^2/rad^2\", start = 0.01, low = 0.0, high = 1.0 }]\n\
        [[effect]]\nkind = \"wind\"\njoint = 1\nc = 0.02\n\
        [log]\ntime = { column = \"t\", unit = \"s\" }\n\
        [[log.joint]]\nposition = { column = \"q\", unit = \"rad\" }\n";

    #[test]
    fn a_law_of_the_file_is_an_effect() {
        let model = Model::parse(TEXT, Path::new("a.toml")).unwrap();
        assert_eq!(model.laws.len(), 1);
        let instance = &model.effects[0];
        assert_eq!(
            (instance.effect.info().id, &*instance.values),
            ("wind", &[0.02][..])
        );
        assert_eq!(model.free[0].to_string(), "wind@1.c");
        assert_eq!(model.free[0].bounds(&model), (0.0, 1.0));
    }

    #[test]
    fn a_friction_is_one_and_no_torque() {
        let text = TEXT.replacen(
            "torque = \"-c * w * abs(w)\"",
            "friction = \"c * abs(q)\"",
            1,
        );
        let model = Model::parse(&text, Path::new("a.toml")).unwrap();
        assert_eq!(model.laws[0].info().site, crate::effects::Site::Friction);
        assert_eq!(model.laws[0].info().law, "friction = c * abs(q)");
        let both = "torque = \"c * w\"\nfriction = \"c\"";
        refused("torque = \"-c * w * abs(w)\"", both, 13, 12);
    }

    #[track_caller]
    fn refused(from: &str, to: &str, line: usize, column: usize) {
        let text = TEXT.replacen(from, to, 1);
        match Model::parse(&text, Path::new("a.toml")) {
            Err(Error::Data { place, .. }) => {
                assert_eq!(
                    (place.line, place.column),
                    (Some(line), Some(column)),
                    "{to}"
                );
            }
            other => panic!("{to}: {other:?}"),
        }
    }

    #[test]
    fn a_wrong_law_is_refused_with_its_column() {
        refused("abs(w)\"", "abs(v)\"", 12, 24);
        refused("abs(w)\"", "abs(w\"", 12, 23);
        refused("-c * w", "-c * * w", 12, 16);
        refused("-c * w", "c := w", 12, 13);
        refused("name = \"wind\"", "name = \"coulomb\"", 11, 8);
        refused("key = \"c\"", "key = \"w\"", 13, 22);
        refused("low = 0.0", "low = 2.0", 13, 22);
        refused(
            "[[effect]]\nkind = \"wind\"",
            "[[effect]]\nkind = \"rain\"",
            15,
            8,
        );
    }
}
