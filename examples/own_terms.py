"""Two terms of one's own: the hand keeps away from a ball, and goes to a point. CasADi differentiates both.

own_terms.py OUT: plans the motion and writes the folder OUT.
"""

import sys

import casadi
import numpy as np

import prowl

BALL, POINT, HAND = np.array([0.75, -0.1, 1.05]), np.array([0.8, -0.25, 0.85]), ("position", "gripperStator")

y = casadi.SX.sym("y", 3)
from_ball = casadi.Function("from_ball", [y], [casadi.norm_2(y - BALL)])
from_point = casadi.Function("from_point", [y], [y - POINT])

task = {
    "name": "own terms",
    "robot": "b1_z1",
    "phase": [{"contacts": "all", "duration_s": 2.0}],
    "goal": [
        {
            "time_s": 2.0,
            "base_displacement_m": [0, 0, 0],
            "base_rpy_rad": [0, 0, 0],
            "base_linear_velocity_mps": [0, 0, 0],
            "base_angular_velocity_radps": [0, 0, 0],
        }
    ],
    "term": [
        {
            "name": "clear of the ball",
            "own": prowl.own_term(from_ball, reads=[HAND], rows=["distance"], unit="m"),
            "value": [[0.12, "free"]],
        },
        {
            "name": "hand at the point",
            "own": prowl.own_term(from_point, reads=[HAND], rows=["x", "y", "z"], unit="m"),
            "value": [0, 0, 0],
            "time_s": 2.0,
        },
    ],
    "cost": {"joint_velocity": 0.1, "base_linear_acceleration": 1, "base_angular_acceleration": 1}
    | {"joint_acceleration": 0.01, "torque": 1e-4},
}

plan = prowl.solve(task)
print(plan.certificate)
plan.write(sys.argv[1])
