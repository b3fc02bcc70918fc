#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "graspfit/geometry/mesh_query.hpp"

namespace graspfit::geometry {

/// Rays by which local thickness is measured [Shapira, Shamir & Cohen-Or 2008].
struct ShapeDiameterOptions {
  int num_rays = 60;              ///< Rays per face, in [1, 10000].
  double cone_angle_deg = 120.0;  ///< Full opening of the cone of rays, in [0, 179].
  double trim_deviations = 1.0;   ///< Lengths farther from their median than this many standard
                                  ///< deviations do not count; > 0, infinity keeps all.
  int num_threads = 0;            ///< 0: all of the machine. The result does not depend on it.
  void validate() const;          ///< Throws InvalidInput naming the field and its value.
};

/// Local thickness of a solid, face by face.
struct ShapeDiameter {
  std::vector<double> thickness;       ///< [m], one per face; +infinity where no ray found an
                                       ///< opposite wall, so that "thinner than" is false there.
  std::vector<std::int32_t> num_hits;  ///< Rays that found an opposite wall, before trimming.
};

/// Shape diameter: from the centroid of each face rays go into the solid, spread evenly over a cone
/// around the inward normal; each gives the distance to the first face that it meets; the thickness
/// is the mean of those lengths that lie within `trim_deviations` standard deviations of their
/// median.
///
/// A ray counts only if the outward normal of the face that it meets makes more than 90° with the
/// outward normal of the face where the ray starts (*antinormal* hits): other rays run along the
/// inside of a bend. The average depends on the shape: with the default cone a wide slab of
/// thickness t measures 1.29 t, a round bar of diameter d about d (its oblique rays are longer
/// along the bar and shorter across it), a ball of diameter d 0.85 d.
///
/// Approximate: rays and hits in plain doubles. A face without a normal (degenerate), and one from
/// which no ray finds an opposite wall, have infinite thickness. Faces that two overlapping parts
/// bury in each other count as walls. The directions are the same for every face, turned into its
/// frame, so that there is nothing random. Cost: `num_rays` rays per face, about log n each.
ShapeDiameter shape_diameter(const MeshQuery& mesh, const ShapeDiameterOptions& options = {});

/// The shape diameter of some faces only, equal bit for bit to that of all: entry i belongs to
/// `faces[i]`.
/// @throws InvalidInput for a face that does not exist.
ShapeDiameter shape_diameter(const MeshQuery& mesh, std::span<const std::int32_t> faces,
                             const ShapeDiameterOptions& options = {});

}  // namespace graspfit::geometry
