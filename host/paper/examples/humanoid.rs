//! Prints the humanoid with its 18 servos as a URDF file:
//! `cargo run -p handstand-paper --example humanoid > host/models/humanoid.urdf`.

use handstand_paper::{Computed, humanoid_urdf};

fn main() -> handstand_model::error::Result<()> {
    print!("{}", humanoid_urdf(&Computed::new()?.model));
    Ok(())
}
