#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "graspfit/contact/contact.hpp"
#include "graspfit/geometry/triangle_mesh.hpp"

namespace graspfit::contact {

/// Which length of a unit force is one.
enum class ForceScaling {
  UnitNormal,  ///< The length of its normal part: cone edges are √(1 + μ²) long.
  UnitEdge,    ///< Its full length, along a cone edge.
};

/// What ε is while the origin lies outside the wrench space.
enum class OutsideValue {
  Zero,
  MinusOne,
  Signed,  ///< Minus the largest distance from the origin to the plane of a facet that cuts it off.
};

/// Linearization and scaling of the grasp wrench space, in which the sum of all forces is at most
/// one (the norm is L1): it is one convex hull.
struct WrenchSpaceOptions {
  int num_cone_edges = 8;  ///< Edges per friction cone, ≥ 3. Eight lose at most 7.6 % of μ in some
                           ///< direction; four up to 29 %.
  double friction = 1.0;  ///< Coulomb's μ of all contacts, ≥ 0. The paper's cone of 45°.
  /// Length that divides torques [m], > 0. Required, since ε depends on it: `validate` refuses
  /// options without one.
  std::optional<double> torque_scale = std::nullopt;
  ForceScaling force_scaling = ForceScaling::UnitNormal;
  double force_limit = 1.0;  ///< Factor on all forces, > 0.
  OutsideValue outside = OutsideValue::Zero;
  void validate() const;  ///< Throws InvalidInput naming the field and its value.
};

/// Tools whose wrench conventions are known. Each line states the length that divides torques,
/// which length of a unit force is one, and the value of ε where the origin is outside. All tools
/// but DexGraspBench take torques about the center of mass.
enum class WrenchTool {
  Graspfit,       ///< Largest radius of the surface; unit normal; 0.
  GraspIt,        ///< Largest radius, here from the center of mass; unit normal; −1.
  Simox,          ///< Half the longest extent; unit edge; reports none, 0 stands for it.
  DexNet,         ///< Median extent; unit normal; 0.
  Frogger,        ///< 1 m; unit edge of four; signed.
  DexGraspBench,  ///< Mean distance of the contacts from their centroid, about that centroid; unit
                  ///< normal; reports the residual of a balance instead, 0 stands for it.
};

/// Everything that ε and the volume depend on besides the contacts. It accompanies these numbers:
/// two values are comparable only if their conventions agree.
///
/// Of the cone edges only the number can be selected: they are those of `cone_edges`, an inscribed
/// pyramid from normal × e_x on.
struct WrenchConvention {
  Eigen::Vector3d reference_point_O = Eigen::Vector3d::Zero();  ///< Origin of torques [m].
  WrenchSpaceOptions options;
  std::optional<WrenchTool> tool = std::nullopt;  ///< Tool of this convention; empty for one of the
                                                  ///< user's own.
};

/// Describes a convention in one line: "graspfit: torques about (0, 0, 0.1) m over 0.075 m,
/// friction 0.5, 8 inscribed edges from normal x e_x, L1, unit normal force, outside 0".
std::string describe(const WrenchConvention& convention);

/// Properties of an object by which conventions scale.
struct WrenchObject {
  Eigen::Vector3d center_of_mass_O = Eigen::Vector3d::Zero();  ///< [m]
  double largest_radius = 0.0;  ///< Largest distance of the surface from the center of mass [m].
  Eigen::Vector3d extents_O = Eigen::Vector3d::Zero();  ///< Extents of the bounding box [m].
};

/// Measures a mesh; its center of mass is given because density need not be uniform.
WrenchObject wrench_object(const geometry::TriangleMesh& mesh_O,
                           const Eigen::Vector3d& center_of_mass_O);

/// Returns the convention of a tool at the given friction, as `WrenchTool` states it, with eight
/// edges per cone (Frogger: four). The azimuths of the edges are ours: with few edges ε agrees with
/// the tool's only up to the rotation of its pyramids about the normals. Friction limits and
/// contact models beyond Coulomb's cone (soft fingers) are not covered.
/// @throws InvalidInput if the torque scale comes out not positive, as for no contacts or all
/// contacts in one point with DexGraspBench.
WrenchConvention wrench_convention(WrenchTool tool, const WrenchObject& object,
                                   std::span<const Contact> contacts, double friction);

}  // namespace graspfit::contact
