#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::hands::internal {

/// The sidecar as the file says it (schema: hands/models/hand_sidecar.schema.json): names not yet
/// resolved, meaning not yet checked.
struct SidecarFinger {
  std::string name;
  bool is_thumb = false;
  std::vector<std::string> links;
  std::vector<std::string> joints;
  std::optional<std::string> swing_joint;
  std::optional<std::string> tip_pad;
};

struct SidecarPad {
  std::string name;
  std::string link;
  std::string finger;  ///< A finger's name or "palm".
  geometry::RigidTransform X_LC = geometry::RigidTransform::Identity();
  std::vector<Eigen::Vector2d> outline;
  std::vector<Eigen::Vector3d> surface;  ///< Empty for a flat pad.
  std::optional<double> clip_thickness;
};

struct SidecarPalm {
  std::string link;
  Eigen::Vector3d center_H = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_H = Eigen::Vector3d::UnitZ();  ///< Unit.
  std::optional<std::string> pad;
};

struct SidecarCoupling {
  std::string joint;
  std::string leader;
  double ratio = 1.0;
  double offset = 0.0;
  bool breakaway = false;
};

/// What a member holds is taken; a member that is not there is derived from the description.
struct Sidecar {
  std::string description;  ///< One sentence for people; empty where the file has none.
  std::optional<std::vector<SidecarFinger>> fingers;
  std::optional<std::vector<SidecarPad>> pads;
  std::optional<SidecarPalm> palm;
  std::optional<std::map<std::string, int>> closing;
  /// Couplings that replace the description's of the same joints; not set: only the description's
  /// count.
  std::optional<std::vector<SidecarCoupling>> couplings;
  std::optional<std::vector<std::pair<std::string, std::string>>> exclusions;

  /// Whether nothing is left to derive.
  bool is_complete() const { return fingers && pads && palm && closing && exclusions; }
};

/// Parses the text of a sidecar: structure, types and ranges of single values.
/// @throws IoError or InvalidInput, prefixed by `file` and the item.
Sidecar parse_sidecar(const std::string& text, const std::string& file);

/// The text of a sidecar, as `parse_sidecar` reads it back: numbers in the fewest digits that give
/// the same doubles, members that are not there left out.
/// `hand` is the name that people see, `description` one sentence on where it comes from.
std::string sidecar_text(const Sidecar& sidecar, const std::string& hand,
                         const std::string& description);

}  // namespace graspfit::hands::internal
