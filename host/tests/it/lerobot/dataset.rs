//! Data sets as LeRobot writes them, of a robot that the program's own simulation moves.
//!
//! Written to the format as `datasets/utils.py`, `datasets/lerobot_dataset.py` and
//! `motors/motors_bus.py` of huggingface/lerobot 0.4.4 have it: the package itself asks for torch.

use handstand::Model;
use handstand::model::import::{
    JointPlan, LogPlan, ServoFigures, SpacePlan, import_for_log, moving_joints,
};
use handstand::motion::Motion;
use handstand::sim::{Plant, PlantMemory, StartState, predict};
use parquet::data_type::{FloatType, Int64Type};
use parquet::errors::Result;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

/// Rows per second.
const FPS: f64 = 30.0;
const ROWS: usize = 120;
pub const EPISODES: usize = 3;
/// Counts per turn of an STS3215.
const COUNTS: f64 = 4096.0;

/// A robot with the names of an SO-101's joints: it slews, lifts, and grips.
pub const ROBOT: &str = r#"<robot name="arm"><link name="base"/>
<link name="mast"><inertial><origin xyz="0.05 0 0"/><mass value="0.4"/>
<inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="boom"><inertial><origin xyz="0.1 0.02 0"/><mass value="0.2"/>
<inertia ixx="3e-4" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="jaw"><inertial><origin xyz="0.03 0.02 -0.02"/><mass value="0.1"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder_pan" type="revolute"><parent link="base"/><child link="mast"/>
<axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="10" velocity="10"/></joint>
<joint name="shoulder_lift" type="revolute"><parent link="mast"/><child link="boom"/>
<origin xyz="0.1 0 0.1"/><axis xyz="0 1 0"/>
<limit lower="-1.7" upper="1.7" effort="10" velocity="10"/></joint>
<joint name="gripper" type="revolute"><parent link="boom"/><child link="jaw"/>
<origin xyz="0.2 0 0"/><axis xyz="1 0 0"/>
<limit lower="-0.2" upper="1.7" effort="10" velocity="10"/></joint>
</robot>"#;

pub const JOINTS: [&str; 3] = ["shoulder_pan", "shoulder_lift", "gripper"];

/// Ranges of the servos' counts; the second counts the other way round.
pub const RANGES: [(f64, f64, bool); 3] = [
    (700.0, 3300.0, false),
    (900.0, 3100.0, true),
    (2030.0, 3370.0, false),
];
/// Where the gripper is at its least count, rad.
const CLOSED_RAD: f64 = -0.2;

/// How LeRobot writes angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Written {
    Rad,
    Degrees,
    Percent,
}

/// The calibration, as `lerobot-calibrate` saves it.
pub fn calibration() -> Value {
    let motor = |(index, name): (usize, &&str)| {
        let (min, max, reversed) = RANGES[index];
        let own = json!({
            "id": index + 1, "drive_mode": u8::from(reversed), "homing_offset": -1470,
            "range_min": min as i64, "range_max": max as i64,
        });
        ((*name).to_string(), own)
    };
    Value::Object(JOINTS.iter().enumerate().map(motor).collect())
}

/// What LeRobot makes of an angle: counts as whole numbers, then `_normalize`.
fn written(joint: usize, angle_rad: f64, unit: Written) -> f64 {
    let (min, max, reversed) = RANGES[joint];
    let middle = (min + max) / 2.0;
    let count = match joint {
        2 => min + (angle_rad - CLOSED_RAD) * COUNTS / TAU,
        _ => middle + angle_rad * COUNTS / TAU,
    };
    let count = count.round();
    let share = (count.clamp(min, max) - min) / (max - min);
    match (unit, joint) {
        (Written::Rad, _) => angle_rad,
        (_, 2) if reversed => 100.0 - 100.0 * share,
        (_, 2) => 100.0 * share,
        (Written::Degrees, _) => (count - middle) * 360.0 / (COUNTS - 1.0),
        (Written::Percent, _) if reversed => 100.0 - 200.0 * share,
        (Written::Percent, _) => 200.0 * share - 100.0,
    }
}

/// One episode: state and action of each row, as they are written.
pub struct Episode {
    pub state: Vec<Vec<f64>>,
    pub action: Vec<Vec<f64>>,
}

/// The episodes of a robot whose servos are those that `init` guesses; in rad, angles and goals of
/// each joint.
pub fn simulated(folder: &Path) -> Vec<[Vec<Vec<f64>>; 2]> {
    let robot = folder.join("robot.urdf");
    let joints = moving_joints(ROBOT, &robot, &[]).unwrap();
    let plan = LogPlan {
        name: None,
        comments: Vec::new(),
        head: "time = { column = \"t\", unit = \"s\" }\n".into(),
        joints: (0..joints.len())
            .map(|joint| JointPlan {
                columns: format!(
                    "position = {{ column = \"q{joint}\", unit = \"rad\" }}\n\
                     input = {{ column = \"u{joint}\", unit = \"rad\" }}\n"
                ),
                drive: "position",
                servo: ServoFigures {
                    gain: 8.0,
                    stall_torque_nm: 1.5,
                    no_load_speed_rad_s: 6.0,
                    armature_kg_m2: 0.01,
                },
            })
            .collect(),
    };
    let space = SpacePlan {
        robot: "robot.urdf".into(),
        locked: Vec::new(),
    };
    std::fs::write(&robot, ROBOT).unwrap();
    let imported = import_for_log(ROBOT, &robot, &space, &plan).unwrap();
    let model = Model::parse(&imported.toml, &folder.join("truth.toml")).unwrap();
    (0..EPISODES)
        .map(|number| episode(&model, number))
        .collect()
}

fn episode(model: &Model, number: usize) -> [Vec<Vec<f64>>; 2] {
    let joints = model.link_count();
    let time_s: Vec<f64> = (0..ROWS)
        .map(|row| f64::from((row as f64 / FPS) as f32))
        .collect();
    let goal = |joint: usize, t: f64| {
        let rate = 2.0 + 0.9 * joint as f64 + 0.4 * number as f64;
        let middle = if joint == 2 { 0.7 } else { 0.1 };
        middle + 0.4 * (rate * t + number as f64).sin() + 0.2 * (2.7 * rate * t).cos()
    };
    let goals: Vec<Vec<f64>> = (0..joints)
        .map(|joint| time_s.iter().map(|t| goal(joint, *t)).collect())
        .collect();
    let motion = Motion {
        position_rad: vec![vec![f64::NAN; ROWS]; joints],
        velocity_rad_s: vec![None; joints],
        input: goals.iter().cloned().map(Some).collect(),
        time_s,
        ..Motion::default()
    };
    let start = StartState {
        angle_rad: goals.iter().map(|goal| goal[0]).collect(),
        speed_rad_s: vec![0.0; joints],
        ..StartState::default()
    };
    let plant = Plant::new(model, &motion);
    let mut readings = vec![0.0; plant.signals() * ROWS];
    let memory = &mut PlantMemory::default();
    predict(&plant, &motion, 0..ROWS, &start, memory, &mut readings);
    let angles = readings.chunks(ROWS).take(joints).map(<[f64]>::to_vec);
    [angles.collect(), goals]
}

/// A data set to write.
pub struct Dataset {
    /// `v2.0`, `v2.1` or `v3.0`.
    pub version: &'static str,
    /// What it calls its elements.
    pub names: Value,
    pub episodes: Vec<Episode>,
}

impl Dataset {
    /// The episodes of a simulation in this unit.
    pub fn of(
        version: &'static str,
        names: Value,
        angles: &[[Vec<Vec<f64>>; 2]],
        unit: Written,
    ) -> Self {
        let rows = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let row = |k: usize| {
                let own = all.iter().enumerate();
                own.map(|(joint, values)| written(joint, values[k], unit))
                    .collect()
            };
            (0..ROWS).map(row).collect()
        };
        let episodes = angles.iter().map(|[angle, goal]| Episode {
            state: rows(angle),
            action: rows(goal),
        });
        Dataset {
            version,
            names,
            episodes: episodes.collect(),
        }
    }

    /// Its first episode as a plain table, as an owner's own loop around LeRobot's robot writes it.
    pub fn table(&self) -> String {
        let columns = JOINTS.map(|joint| format!("{joint}.pos,{joint}.goal"));
        let mut text = format!("time_s,{}\n", columns.join(","));
        let Episode { state, action } = &self.episodes[0];
        for (row, (angles, goals)) in state.iter().zip(action).enumerate() {
            text += &(row as f64 / FPS).to_string();
            for (angle, goal) in angles.iter().zip(goals) {
                text += &format!(",{angle},{goal}");
            }
            text.push('\n');
        }
        text
    }

    /// Writes it, the first two episodes of v3.0 in one file.
    pub fn write(&self, folder: &Path) {
        let is_v3 = self.version == "v3.0";
        for inner in ["meta", "data/chunk-000"] {
            std::fs::create_dir_all(folder.join(inner)).unwrap();
        }
        let info = serde_json::to_string_pretty(&self.info(is_v3)).unwrap();
        std::fs::write(folder.join("meta/info.json"), info).unwrap();
        let data = folder.join("data/chunk-000");
        let all: Vec<usize> = (0..self.episodes.len()).collect();
        if is_v3 {
            let (first, rest) = all.split_at(2);
            self.rows(&data.join("file-000.parquet"), first).unwrap();
            self.rows(&data.join("file-001.parquet"), rest).unwrap();
            let listed = folder.join("meta/episodes/chunk-000");
            std::fs::create_dir_all(&listed).unwrap();
            let files: Vec<i64> = all.iter().map(|own| i64::from(*own > 1)).collect();
            list(&listed.join("file-000.parquet"), &files, "data/file_index").unwrap();
        } else {
            for own in all {
                let file = data.join(format!("episode_{own:06}.parquet"));
                self.rows(&file, &[own]).unwrap();
            }
        }
    }

    fn info(&self, is_v3: bool) -> Value {
        let list = json!({"dtype": "float32", "shape": [JOINTS.len()], "names": self.names});
        let one = |kind: &str| json!({"dtype": kind, "shape": [1], "names": null});
        json!({
            "codebase_version": self.version,
            "robot_type": "so101_follower",
            "total_episodes": self.episodes.len(),
            "total_frames": self.episodes.len() * ROWS,
            "total_tasks": 1,
            "chunks_size": 1000,
            "fps": FPS,
            "splits": {"train": format!("0:{}", self.episodes.len())},
            "data_path": if is_v3 {
                "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
            } else {
                "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet"
            },
            "video_path": null,
            "features": {
                "observation.state": list,
                "action": list,
                "timestamp": one("float32"),
                "frame_index": one("int64"),
                "episode_index": one("int64"),
                "index": one("int64"),
                "task_index": one("int64"),
            },
        })
    }

    /// The rows of some episodes as one file.
    fn rows(&self, file: &Path, episodes: &[usize]) -> Result<()> {
        let list = |name: &str| {
            let inner = "repeated group list { optional float element; }";
            format!("optional group {name} (LIST) {{ {inner} }}")
        };
        let schema = format!(
            "message schema {{ {} {} optional float timestamp; optional int64 frame_index; \
             optional int64 episode_index; }}",
            list("observation.state"),
            list("action")
        );
        let schema = Arc::new(parse_message_type(&schema)?);
        let mut writer =
            SerializedFileWriter::new(std::fs::File::create(file)?, schema, Arc::default())?;
        for own in episodes {
            let episode = &self.episodes[*own];
            let mut group = writer.next_row_group()?;
            lists(&mut group, &episode.state)?;
            lists(&mut group, &episode.action)?;
            let time: Vec<f32> = (0..episode.state.len())
                .map(|row| (row as f64 / FPS) as f32)
                .collect();
            let frames: Vec<i64> = (0..time.len() as i64).collect();
            plain::<FloatType>(&mut group, &time)?;
            plain::<Int64Type>(&mut group, &frames)?;
            plain::<Int64Type>(&mut group, &vec![*own as i64; time.len()])?;
            group.close()?;
        }
        writer.close().map(drop)
    }
}

type Group<'a> = SerializedRowGroupWriter<'a, std::fs::File>;

fn plain<T: parquet::data_type::DataType>(group: &mut Group, values: &[T::T]) -> Result<()> {
    let mut column = group.next_column()?.expect("a column more");
    let defined = vec![1; values.len()];
    column
        .typed::<T>()
        .write_batch(values, Some(&defined), None)?;
    column.close()
}

fn lists(group: &mut Group, rows: &[Vec<f64>]) -> Result<()> {
    let values: Vec<f32> = rows.iter().flatten().map(|value| *value as f32).collect();
    let repeated = rows
        .iter()
        .flat_map(|row| (0..row.len()).map(|place| i16::from(place > 0)));
    let repeated: Vec<i16> = repeated.collect();
    let mut column = group.next_column()?.expect("a column more");
    let defined = vec![3; values.len()];
    let typed = column.typed::<FloatType>();
    typed.write_batch(&values, Some(&defined), Some(&repeated))?;
    column.close()
}

/// What `meta/episodes` lists: the file of each episode, under this name.
pub fn list(file: &Path, files: &[i64], name: &str) -> Result<()> {
    let schema = format!(
        "message schema {{ optional int64 episode_index; optional int64 data/chunk_index; \
         optional int64 {name}; }}"
    );
    let schema = Arc::new(parse_message_type(&schema)?);
    let mut writer =
        SerializedFileWriter::new(std::fs::File::create(file)?, schema, Arc::default())?;
    let mut group = writer.next_row_group()?;
    let episodes: Vec<i64> = (0..files.len() as i64).collect();
    plain::<Int64Type>(&mut group, &episodes)?;
    plain::<Int64Type>(&mut group, &vec![0; files.len()])?;
    plain::<Int64Type>(&mut group, files)?;
    group.close()?;
    writer.close().map(drop)
}
