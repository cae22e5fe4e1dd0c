//! The columns of a Parquet schema: their names, and what their numbers mean.

use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::schema::types::Type;

/// A column that holds values, in the order of the schema.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ParquetLeaf {
    /// Names of its groups and its own, joined by dots.
    pub name: String,
    /// What its numbers mean, or why it is left out.
    pub meaning: Result<LeafMeaning, &'static str>,
    /// Level of definition at which a value is there.
    pub value_level: i16,
    /// Level from which on an element is there, be it null, where the column holds lists.
    pub element_level: Option<i16>,
}

/// What numbers mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LeafMeaning {
    /// What they say.
    Number,
    /// Whole numbers without a sign.
    Unsigned,
    /// Whole numbers to be divided: decimals, and times of day in s.
    Over(f64),
    /// Moments, so many to the second: they count in s from the first.
    Moment(f64),
}

/// Where a field stands.
#[derive(Clone)]
struct Within {
    name: String,
    /// Levels that add no name: the two within a list.
    unnamed: usize,
    /// Optional and repeated fields so far.
    level: i16,
    element_level: Option<i16>,
    refused: Option<&'static str>,
}

/// The columns of a schema.
pub(super) fn leaves(schema: &Type) -> Vec<ParquetLeaf> {
    let mut found = Vec::new();
    let top = Within {
        name: String::new(),
        unnamed: 0,
        level: 0,
        element_level: None,
        refused: None,
    };
    for field in children(schema) {
        descend(field, &top, &mut found);
    }
    found
}

fn children(field: &Type) -> &[parquet::schema::types::TypePtr] {
    match field {
        Type::GroupType { fields, .. } => fields,
        Type::PrimitiveType { .. } => &[],
    }
}

fn descend(field: &Type, within: &Within, found: &mut Vec<ParquetLeaf>) {
    let facts = field.get_basic_info();
    let mut here = within.clone();
    match (here.unnamed, here.name.is_empty()) {
        (0, true) => here.name = field.name().to_string(),
        (0, false) => here.name = format!("{}.{}", here.name, field.name()),
        _ => here.unnamed -= 1,
    }
    let repetition = facts.has_repetition().then(|| facts.repetition());
    if repetition != Some(Repetition::REQUIRED) {
        here.level += 1;
    }
    if repetition == Some(Repetition::REPEATED) {
        if here.element_level.is_some() {
            here.refused = Some("lists within lists");
        }
        here.element_level = Some(here.level);
    }
    if field.is_primitive() {
        found.push(ParquetLeaf {
            meaning: here.refused.map_or_else(|| meaning(field), Err),
            name: here.name,
            value_level: here.level,
            element_level: here.element_level,
        });
        return;
    }
    match (facts.logical_type_ref(), facts.converted_type()) {
        (Some(LogicalType::List), _) | (None, ConvertedType::LIST) => here.unnamed = 2,
        (Some(LogicalType::Map), _) | (None, ConvertedType::MAP | ConvertedType::MAP_KEY_VALUE) => {
            here.refused = Some("a map")
        }
        _ => {}
    }
    for child in children(field) {
        descend(child, &here, found);
    }
}

fn meaning(field: &Type) -> Result<LeafMeaning, &'static str> {
    let facts = field.get_basic_info();
    let per_s = |unit: &TimeUnit| match unit {
        TimeUnit::MILLIS => 1e3,
        TimeUnit::MICROS => 1e6,
        TimeUnit::NANOS => 1e9,
    };
    let decimal = |scale: i32| LeafMeaning::Over(10f64.powi(scale));
    let is_decimal = matches!(facts.logical_type_ref(), Some(LogicalType::Decimal(_)))
        || facts.converted_type() == ConvertedType::DECIMAL;
    match field.get_physical_type() {
        Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY if is_decimal => {
            return Err("decimals of up to 128 bits; save it as float64");
        }
        Physical::BYTE_ARRAY => return Err("text or bytes"),
        Physical::FIXED_LEN_BYTE_ARRAY => return Err("bytes"),
        Physical::INT96 => return Ok(LeafMeaning::Moment(1e9)),
        Physical::INT32 | Physical::INT64 => {}
        Physical::BOOLEAN | Physical::FLOAT | Physical::DOUBLE => return Ok(LeafMeaning::Number),
    }
    Ok(match (facts.logical_type_ref(), facts.converted_type()) {
        (Some(LogicalType::Timestamp(time)), _) => LeafMeaning::Moment(per_s(&time.unit)),
        (Some(LogicalType::Time(time)), _) => LeafMeaning::Over(per_s(&time.unit)),
        (Some(LogicalType::Decimal(decimal_of)), _) => decimal(decimal_of.scale),
        (Some(LogicalType::Integer(whole)), _) if !whole.is_signed => LeafMeaning::Unsigned,
        (Some(_), _) => LeafMeaning::Number,
        (None, ConvertedType::TIMESTAMP_MILLIS) => LeafMeaning::Moment(1e3),
        (None, ConvertedType::TIMESTAMP_MICROS) => LeafMeaning::Moment(1e6),
        (None, ConvertedType::TIME_MILLIS) => LeafMeaning::Over(1e3),
        (None, ConvertedType::TIME_MICROS) => LeafMeaning::Over(1e6),
        (None, ConvertedType::DECIMAL) => decimal(field.get_scale()),
        (
            None,
            ConvertedType::UINT_8
            | ConvertedType::UINT_16
            | ConvertedType::UINT_32
            | ConvertedType::UINT_64,
        ) => LeafMeaning::Unsigned,
        (None, _) => LeafMeaning::Number,
    })
}
