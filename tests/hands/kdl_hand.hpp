#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graspfit::testing {

/// Reads a URDF as two other libraries understand it: urdfdom parses the file, Orocos KDL computes
/// its kinematics (kdl_parser joins them). The tests compare our own reading with it.
class KdlHand {
 public:
  /// @throws std::runtime_error if urdfdom refuses the file.
  explicit KdlHand(const std::filesystem::path& urdf);

  struct Mimic {
    std::string joint;
    double multiplier = 1.0;
    double offset = 0.0;
  };
  struct Joint {
    std::string name;
    bool is_prismatic = false;
    double lower = 0.0;  ///< [rad] or [m]; ±π for continuous joints.
    double upper = 0.0;
    std::optional<Mimic> mimic;
  };
  struct Link {
    std::string name;
    std::optional<std::string> parent;  ///< Empty for the root.
    /// Mesh files of the collision geometry, or of the visual one where there is none, as written.
    std::vector<std::string> mesh_files;
  };

  const std::vector<Link>& links() const;    ///< In the order of their names.
  const std::vector<Joint>& joints() const;  ///< Movable ones, in the order of their names.

  /// The chain of joints from one link to another that hangs on it.
  class Chain {
   public:
    /// Movable joints from base to tip.
    const std::vector<std::string>& joints() const;
    /// Pose of the tip link in the base link's frame, positions in the order of `joints`.
    Eigen::Isometry3d pose(const Eigen::VectorXd& q) const;
    /// Returns 6 x joints, [linear; angular] in the base link's frame, of a point of the tip link.
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(const Eigen::VectorXd& q,
                                                      const Eigen::Vector3d& point_tip) const;

   private:
    friend class KdlHand;
    struct Parts;
    std::shared_ptr<Parts> parts_;
  };
  Chain chain(const std::string& base, const std::string& tip) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace graspfit::testing
