#pragma once

#include <string>

/// Sound files that the targets put around the one that is fuzzed; seeds are made of them, too.
namespace prowl::fuzz {

inline const std::string kUrdf = R"(<robot name="small">
<link name="base"><inertial><mass value="10"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.4"/></inertial></link>
<link name="leg"><inertial><mass value="1"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"/></inertial></link>
<link name="foot"/>
<joint name="hip" type="revolute"><parent link="base"/><child link="leg"/><axis xyz="1 0 0"/>
<limit lower="-0.5" upper="1.5" velocity="10" effort="50"/></joint>
<joint name="ankle" type="fixed"><parent link="leg"/><child link="foot"/><origin xyz="0 0 -0.5"/></joint>
</robot>
)";

/// Its URDF is never there, so that the copy is used.
inline const std::string kRobot = R"(name = "small"
urdf = "none.urdf"
contact = [{ name = "toe", frame = "foot", radius_m = 0.02 }]
)";

/// The same with a contact at each corner, for gaits.
inline const std::string kQuadruped = R"(name = "four"
urdf = "none.urdf"
contact = [
  { name = "lf", frame = "base", offset_m = [0.2, 0.1, -0.4] }, { name = "rf", frame = "base", offset_m = [0.2, -0.1, -0.4] },
  { name = "lh", frame = "base", offset_m = [-0.2, 0.1, -0.4] }, { name = "rh", frame = "base", offset_m = [-0.2, -0.1, -0.4] },
]
)";

inline const std::string kTask = R"(name = "stand"
robot = "robot.toml"
[[phase]]
contacts = "all"
duration_s = 0.5
intervals = 3
)";

/// A motion of that robot.
inline const std::string kReference =
    "time_s,base_px_m,base_py_m,base_pz_m,base_qx,base_qy,base_qz,base_qw,q_hip_rad\n"
    "0,0,0,0.5,0,0,0,1,0\n0.5,0,0,0.5,0,0,0,1,0.1\n";

}  // namespace prowl::fuzz
