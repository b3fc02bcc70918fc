#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/distance_map.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_model.hpp"

namespace graspfit::grasp {

/// A hand prepared for fitting to objects of one voxel size: points that cover every link's
/// surface, in a tree of balls so that those far from the object are passed over together.
class FittingHand {
 public:
  /// @throws InvalidInput unless `sample_spacing` is a positive length [m].
  FittingHand(const hands::HandModel& hand, double sample_spacing);

  /// A ball around some of the points, in the link's frame [m].
  struct Ball {
    Eigen::Vector3d center_L = Eigen::Vector3d::Zero();
    double radius = 0.0;
    std::int32_t first = 0;  ///< Leaf: first of its points. Inner node: its second child; the first
                             ///< child follows the node itself.
    std::int32_t count = 0;  ///< Leaf: number of points, > 0. Inner node: 0.
  };
  /// The points of one link; both lists are empty for a link without a mesh.
  struct LinkSamples {
    std::vector<Ball> balls;  ///< The root is ball 0.
    std::vector<Eigen::Vector3d> points_L;
    double reach = 0.0;  ///< Largest distance of a point from the origin of the link's frame [m].
  };
  /// A small piece of a link's surface, for nearest points in several places of one link.
  struct Piece {
    geometry::MeshQuery surface_L;
    /// Center of a ball that contains the piece [m].
    Eigen::Vector3d center_L = Eigen::Vector3d::Zero();
    double radius = 0.0;
  };
  const hands::HandModel& model() const { return model_; }
  /// The surface of a link, cut into pieces of at most a centimeter and a half, more or less.
  const std::vector<Piece>& pieces(int link) const { return pieces_[link]; }
  /// `hands::pad_surface_L` of a pad.
  const geometry::MeshQuery& pad_surface(int pad) const { return pad_surfaces_[pad]; }
  const LinkSamples& samples(int link) const { return samples_[link]; }
  const hands::HandCollision& collision() const { return collision_; }

 private:
  hands::HandModel model_;
  hands::HandCollision collision_;
  std::vector<LinkSamples> samples_;
  std::vector<std::vector<Piece>> pieces_;
  std::vector<geometry::MeshQuery> pad_surfaces_;
};

/// The paper's d_min: smallest value of the distance map over the voxels that a link's surface
/// occupies [voxels]. A value above `enough` is not searched further: of such a result it is only
/// known that the value is above `enough`, too. Approximate: the surface is represented by points
/// at the chosen spacing.
float smallest_distance(const FittingHand& hand, int link, const geometry::RigidTransform& X_OL,
                        const geometry::SignedDistanceMap& map, float enough);

}  // namespace graspfit::grasp
