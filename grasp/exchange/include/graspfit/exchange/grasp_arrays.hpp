#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "graspfit/grasp/grasp_io.hpp"

namespace graspfit::exchange {

/// What a hold test said of a grasp.
struct HoldFinding {
  std::optional<bool> is_held;          ///< Empty: not tested.
  std::optional<double> margin_force;   ///< Smallest force that fails [N]; empty: not searched for.
  std::optional<double> margin_torque;  ///< Smallest torque that fails [N m].
};

/// Grasps of one hand on many objects as plain arrays in a NumPy NPZ file, with DexGraspBench's
/// names where it has them (`dexgraspbench_npz`). Lengths are in meters, angles in radians; O is
/// the object's frame, that of its file scaled by `object_scale`. For K objects, G grasps, C
/// contacts and a hand of dof joints:
///
/// | array | shape, type | holds |
/// | --- | --- | --- |
/// | `hand` | text | the hand's name |
/// | `joint_names` | [dof] texts | order of the joints |
/// | `object_name`, `object_path`, `object_sha256`, `object_license` | [K] texts | the object, its
/// file as recorded and that file's hash; the license as given, or empty |
/// | `object_scale` | [K] doubles | meters per unit of that file |
/// | `object_pose` | [K, 7] doubles | O in the world: identity, or as the object was laid down |
/// | `object_index` | [G] integers | which object a grasp is of, from 0 |
/// | `rank` | [G] integers | among the grasps of its object, from 1 |
/// | `pregrasp_qpos`, `grasp_qpos`, `squeeze_qpos` | [G, 7 + dof] doubles | position and quaternion
/// w, x, y, z of the hand's root link in O, joints; NaN where there is none |
/// | `m`, `epsilon`, `largest_gap` | [G] doubles | the paper's M; ε by GraspIt!'s convention, NaN
/// without; the largest gap of a contact that was asked for |
/// | `held` | [G] integers | 1 held, 0 lost, −1 not tested |
/// | `margin_force`, `margin_torque` | [G] doubles | smallest load that fails [N], [N m], or NaN |
/// | `contact_start` | [G + 1] integers | contacts of grasp g are those from start[g] to
/// start[g + 1] |
/// | `contact_point`, `contact_normal` | [C, 3] doubles | in O; unit normals into the object |
/// | `contact_gap`, `contact_area` | [C] doubles | distance of pad and object; touched area [m²] |
/// | `contact_link` | [C] texts | link whose pad touches |
class GraspArrays {
 public:
  /// Appends an object with the grasps of its file, and a finding per grasp.
  /// @throws InvalidInput if the file's hand is another one than that of the first object, or there
  /// are not as many findings as grasps.
  void add(const std::string& name, const std::string& license, const grasp::GraspFile& file,
           const std::vector<HoldFinding>& findings);

  std::size_t num_objects() const { return names_.size(); }
  std::size_t num_grasps() const { return object_index_.size(); }

  /// The bytes of the file, which are the same for the same grasps. @throws InvalidInput above
  /// 4 GiB.
  std::string npz() const;

 private:
  void add_grasp(const grasp::GraspFile& file, const grasp::Grasp& grasp,
                 const HoldFinding& finding);

  std::string hand_;
  std::vector<std::string> joints_;
  std::vector<std::string> names_, paths_, hashes_, licenses_;
  std::vector<double> scales_, poses_;
  std::vector<std::int64_t> object_index_, ranks_, held_, contact_start_ = {0};
  std::vector<double> before_, at_, beyond_;
  std::vector<double> m_, epsilon_, gaps_, forces_, torques_;
  std::vector<double> points_, normals_, contact_gaps_, areas_;
  std::vector<std::string> links_;
};

}  // namespace graspfit::exchange
