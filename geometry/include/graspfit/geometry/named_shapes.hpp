#pragma once

#include <string>
#include <vector>

#include "graspfit/geometry/triangle_mesh.hpp"

/// \file
/// The shapes of shapes.hpp and everyday_shapes.hpp by name, for programs and files.

namespace graspfit::geometry {

/// A dimension of a shape [m], or a count.
struct ShapeDimension {
  std::string name;
  double value = 0.0;

  bool operator==(const ShapeDimension&) const = default;
};

/// What a named shape is and what it is made from.
struct ShapeDescription {
  std::string name;
  std::string what;                        ///< In a few words.
  std::vector<ShapeDimension> dimensions;  ///< Defaults, lengths before counts.

  bool operator==(const ShapeDescription&) const = default;
};

/// All named shapes, in order of their names.
std::vector<ShapeDescription> shape_descriptions();

/// The shape `name` with these dimensions in place of its defaults; the same mesh as from its own
/// function.
/// @throws InvalidInput for a name that is none, a dimension that the shape does not have or that
/// is given twice, a count that is no integer, and what the shape's own function refuses.
TriangleMesh named_shape(const std::string& name,
                         const std::vector<ShapeDimension>& dimensions = {});

}  // namespace graspfit::geometry
