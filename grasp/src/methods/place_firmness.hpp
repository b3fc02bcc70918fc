#pragma once

#include <cstdint>
#include <vector>

#include "graspfit/contact/grasp_wrench_space.hpp"
#include "graspfit/grasp/object_model.hpp"
#include "targets/target_feasibility.hpp"

namespace graspfit::grasp::internal {

/// How firm grasps with contacts on some places of an object would be, for comparing them by the
/// thousand: `firmness` of point contacts there.
class PlaceFirmness {
 public:
  /// Refers to the places, which are the object's. Known for those in the pool.
  PlaceFirmness(const ObjectModel& object, const std::vector<SurfacePlace>& places,
                const std::vector<PoolPoint>& pool, double friction);

  /// Pads come to touch beside the places that they are meant for, where the surface may face
  /// elsewhere: the mean over contacts that lie on places about these (the same ones for the same
  /// places), but no more than that of the places themselves. Of what is no more than `least`, a
  /// candidate that is not wanted then, only so much is known: draws after which the mean would
  /// hardly exceed it are left out.
  double expected(const std::vector<std::int32_t>& places, double least) const;

  /// That of contacts on the places themselves; of what is no more than `least` only so much is
  /// known.
  double nominal(const std::vector<std::int32_t>& places, double least) const;

 private:
  const std::vector<SurfacePlace>& places_;
  const double friction_;
  /// Per place: those about it that face about the same way, itself among them; empty for one that
  /// is not in the pool.
  std::vector<std::vector<std::int32_t>> around_;
  Eigen::Index num_edges_ = 0;  ///< Of a friction cone.
  /// Per place that is about some other, itself or not, a column per edge of a contact on it.
  contact::Wrenches wrenches_;
};

}  // namespace graspfit::grasp::internal
