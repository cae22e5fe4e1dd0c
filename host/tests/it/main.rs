//! The built program and the library, seen from outside. One test program: each more would link the
//! library again.

mod common;

mod add;
mod bad_logs;
mod balance;
mod begin;
mod bus;
mod c_header;
mod cart_pole;
mod cli;
mod closed_loop;
mod controllers;
mod deploy;
#[cfg(unix)]
mod dynamixel_sdk;
mod each;
mod ended;
mod examples;
#[cfg(unix)]
mod flash;
mod fuzz;
mod gain_weights;
mod gains;
mod golden;
mod lab;
mod laws;
#[cfg(feature = "parquet")]
mod lerobot;
#[cfg(unix)]
mod mcap;
mod mixed_motions;
#[cfg(feature = "virtual-cm5")]
mod model_plans;
mod names;
mod rate_sensors;
#[cfg(unix)]
mod recipes;
mod record;
mod render;
mod report_page;
mod requests;
mod riccati;
mod robot_demo;
mod rounds;
mod servos;
mod study;
mod sysid;
mod twins;
mod unlike_motions;
mod verification;
mod wrong_values;
