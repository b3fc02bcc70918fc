#pragma once

#include <string>

namespace graspfit::testing {

/// A gripper that uses most of what a description and its sidecar can say; tests break one part of
/// it at a time. Its mesh is `meshes/bar.obj`.
inline const std::string kSmallHandUrdf = R"(<?xml version="1.0"?>
<robot name="pincer">
  <link name="base">
    <inertial>
      <origin xyz="0 0 -0.005" rpy="0 0 0"/><mass value="0.5"/>
      <inertia ixx="1e-4" ixy="0" ixz="0" iyy="2e-4" iyz="0" izz="2.5e-4"/>
    </inertial>
    <collision><origin xyz="0 0 -0.01"/><geometry><box size="0.12 0.04 0.02"/></geometry></collision>
  </link>
  <link name="left">
    <collision><geometry><mesh filename="meshes/bar.obj" scale="0.01 0.02 0.05"/></geometry></collision>
  </link>
  <link name="right">
    <visual><geometry><cylinder radius="0.008" length="0.04"/></geometry></visual>
  </link>
  <link name="tip">
    <collision><geometry><sphere radius="0.009"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="base"/><child link="left"/>
    <origin xyz="-0.04 0 0.001" rpy="0 0 0.0"/><axis xyz="2 0 0"/>
    <limit lower="0" upper="0.03" effort="1" velocity="1"/>
  </joint>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="right"/>
    <origin xyz="0.04 0 0.025" rpy="0 0 0"/><axis xyz="0 -1 0"/>
    <limit lower="-0.2" upper="1.2" effort="1" velocity="1"/>
  </joint>
  <joint name="bend" type="revolute">
    <parent link="right"/><child link="tip"/>
    <origin xyz="0 0 0.03"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.6" effort="1" velocity="1"/>
    <mimic joint="turn" multiplier="0.5" offset="0.1"/>
  </joint>
</robot>
)";

inline const std::string kSmallHandSidecar = R"({
  "format": {"name": "graspfit hand sidecar", "version": 1},
  "hand": "pincer",
  "fingers": [
    {"name": "one", "thumb": true, "links": ["left"], "joints": ["slide"], "tip_pad": "one_pad"},
    {"name": "two", "thumb": false, "links": ["right", "tip"], "joints": ["turn", "bend"],
     "swing_joint": null, "tip_pad": "two_pad"}
  ],
  "pads": [
    {"name": "one_pad", "link": "left", "finger": "one",
     "frame": {"translation_m": [0.005, 0, 0], "rotation_wxyz": [0.5, 0.5, 0.5, 0.5]},
     "outline_m": [[-0.01, -0.02], [0.01, -0.02], [0.01, 0.02], [-0.01, 0.02]],
     "clip": {"kind": "prism", "thickness_m": 0.001}},
    {"name": "two_pad", "link": "tip", "finger": "two",
     "frame": {"translation_m": [-0.009, 0, 0], "rotation_wxyz": [0.5, 0.5, -0.5, -0.5]},
     "outline_m": [[-0.004, -0.004], [0.004, -0.004], [0.004, 0.004], [-0.004, 0.004]]},
    {"name": "palm_pad", "link": "base", "finger": "palm",
     "frame": {"translation_m": [0, 0, 0], "rotation_wxyz": [1, 0, 0, 0]},
     "outline_m": [[-0.03, -0.01], [0.03, -0.01], [0, 0.02]]}
  ],
  "palm": {"link": "base", "center_m": [0, 0, 0], "direction": [0, 0, 1], "pad": "palm_pad"},
  "closing": {"slide": 1, "turn": 1},
  "couplings": [{"joint": "bend", "leader": "turn", "ratio": 0.5, "offset": 0.1, "breakaway": true}],
  "exclusions": [["base", "left"], ["base", "right"], ["right", "tip"]]
}
)";

/// A closed box from -0.5 to 0.5.
inline const std::string kSmallHandMesh =
    "v -0.5 -0.5 -0.5\nv 0.5 -0.5 -0.5\nv 0.5 0.5 -0.5\nv -0.5 0.5 -0.5\n"
    "v -0.5 -0.5 0.5\nv 0.5 -0.5 0.5\nv 0.5 0.5 0.5\nv -0.5 0.5 0.5\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\n"
    "f 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

}  // namespace graspfit::testing
