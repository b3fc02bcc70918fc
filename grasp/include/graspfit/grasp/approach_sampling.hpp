#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "graspfit/geometry/surface_sampling.hpp"
#include "graspfit/grasp/object_model.hpp"

namespace graspfit::grasp {

/// Where the surface points come from along whose normals a hand approaches.
enum class ApproachSource {
  Surface,  ///< Drawn uniformly by area.
  BoxRays,  ///< First hits of rays cast inward from a grid on a box around the object, which leaves
            ///< out what lies in concavities.
};

/// Surface samples that guide a hand (the baseline GS of the paper's Table 1). All [R]: the paper
/// names the idea and cites a work that could not be identified with certainty.
struct ApproachSamplingOptions {
  ApproachSource source = ApproachSource::Surface;
  int count = 1000;  ///< Of surface samples (K), in [1, 10⁶]; the box has as many as its grid.
  double box_margin = 0.01;         ///< By which the box is larger on every side [m], > 0.
  double box_spacing = 0.02;        ///< Of the grid on the box's faces [m], > 0.
  double largest_standoff = 0.025;  ///< Standoff of the palm from the sample, taken with
                                    ///< probability ½, else none [m], ≥ 0.
  void validate() const;            ///< Throws InvalidInput naming the field and its value.
};

/// The samples, points with outward normals, of which each attempt takes one at random. Surface
/// samples depend on `seed`; those of the box do not. A ray of the box that meets nothing, or a
/// face without area, gives none.
///
/// Box: the grid starts in the middle of each face; rays run along the face's inward normal.
/// @throws InvalidInput for bad options or a box with more than a million grid points.
std::vector<geometry::SurfaceSample> approach_samples(const ObjectModel& object,
                                                      const ApproachSamplingOptions& options,
                                                      std::uint64_t seed);

}  // namespace graspfit::grasp
