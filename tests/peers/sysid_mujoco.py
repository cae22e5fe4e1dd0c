"""Fit four parameters of a servo arm's logs with mujoco.sysid.

The arm of arm_log.py as an MJCF hinge: joint damping (N m s/rad), frictionloss
(N m), armature (kg m^2, the whole inertia about the joint less the m l^2 of the
known point mass) and the motor's gear (N m per N m of command). MuJoCo's step is
1 ms (implicitfast), the command is held over each sample, the only residual is
the angle at each sample, from rest at q = 0. All three optimisers of
mujoco.sysid can be chosen; parameters start a factor 2 off the truth, with
bounds a factor 20 off it.

mujoco.sysid gives no count of simulations, so the residual function is wrapped
and its columns counted. Prints one JSON object.
"""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

import arm_log

STEP = 1e-3  # s
POINT = arm_log.MASS * arm_log.ARM**2  # kg m^2 of the known point mass
START = {"viscous": 2.0, "coulomb": 0.5, "inertia": 2.0, "torque_constant": 0.5}

# A sphere's own inertia of 1e-6 kg m^2 is subtracted from the armature as well.
SPHERE = 1e-6
XML = f"""
<mujoco>
  <option gravity="0 {-arm_log.GRAVITY} 0" timestep="{STEP}" integrator="implicitfast">
    <flag contact="disable"/>
  </option>
  <worldbody>
    <body name="arm">
      <joint name="joint" type="hinge" axis="0 0 1" damping="0.01" frictionloss="0.01"
             armature="0.001"/>
      <inertial pos="0 {-arm_log.ARM} 0" mass="{arm_log.MASS}"
                diaginertia="{SPHERE} {SPHERE} {SPHERE}"/>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="joint" gear="1"/></actuator>
  <sensor><jointpos name="angle" joint="joint"/></sensor>
</mujoco>
"""


def set_viscous(spec, p):
    # The spec keeps the damping as a polynomial in the speed since MuJoCo 4.
    joint = spec.joint("joint")
    if np.ndim(joint.damping):
        joint.damping[0] = p.value[0]
    else:
        joint.damping = p.value[0]


def set_coulomb(spec, p):
    spec.joint("joint").frictionloss = p.value[0]


def set_inertia(spec, p):
    spec.joint("joint").armature = max(0.0, p.value[0] - POINT - SPHERE)


def set_torque_constant(spec, p):
    spec.actuator("motor").gear[0] = p.value[0]


SETTERS = {
    "viscous": set_viscous,
    "coulomb": set_coulomb,
    "inertia": set_inertia,
    "torque_constant": set_torque_constant,
}
