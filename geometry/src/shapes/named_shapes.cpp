#include "graspfit/geometry/named_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/nearest_name.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/geometry/everyday_shapes.hpp"
#include "graspfit/geometry/shapes.hpp"
#include "shapes/shape_dimensions.hpp"

namespace graspfit::geometry {
namespace {

struct NamedShape {
  ShapeDescription description;
  std::size_t num_lengths;
  // Builds the shape from the values of all dimensions, in the order of the description.
  std::function<TriangleMesh(const std::vector<double>&)> build;
};

using Values = std::vector<double>;

int count(double value) { return static_cast<int>(value); }

// A shape whose dimensions are a struct.
template <class Dimensions, std::size_t n, class Build>
NamedShape shape_of(const char* name, const char* what,
                    const std::array<internal::DimensionField<Dimensions>, n>& fields,
                    const std::vector<ShapeDimension>& counts, const Build& build) {
  NamedShape shape{{name, what, {}}, n, {}};
  for (const auto& field : fields) {
    shape.description.dimensions.push_back({field.name, Dimensions{}.*field.member});
  }
  shape.description.dimensions.insert(shape.description.dimensions.end(), counts.begin(),
                                      counts.end());
  shape.build = [fields, build](const Values& values) {
    Dimensions dimensions;
    for (std::size_t i = 0; i < n; ++i) dimensions.*fields[i].member = values[i];
    return build(dimensions, Values(values.begin() + n, values.end()));
  };
  return shape;
}

// A shape of this kind whose only count is its number of segments.
template <class Dimensions, std::size_t n>
NamedShape shape_of(const char* name, const char* what,
                    const std::array<internal::DimensionField<Dimensions>, n>& fields,
                    double segments, TriangleMesh (*build)(const Dimensions&, int)) {
  return shape_of(name, what, fields, {{"segments", segments}},
                  [build](const Dimensions& d, const Values& v) { return build(d, count(v[0])); });
}

std::vector<NamedShape> all_shapes() {
  // Sizes that a hand can hold.
  return {
      {{"ball", "a ball around the origin", {{"radius", 0.04}, {"subdivisions", 4}}},
       1,
       [](const Values& v) { return ball(v[0], count(v[1])); }},
      shape_of("bin", "an open box of five walls, the upper side of its floor at z = 0",
               internal::kBinFields, {},
               [](const BinDimensions& d, const Values&) { return bin(d); }),
      shape_of("bottle", "a filled bottle standing on z = 0", internal::kBottleFields, 96, bottle),
      shape_of("bowling_ball", "a bowling ball around the origin, three holes around +z",
               internal::kBowlingBallFields, 220, bowling_ball),
      shape_of("bowling_pin", "a ten-pin bowling pin standing on z = 0",
               internal::kBowlingPinFields, 96, bowling_pin),
      {{"box", "a box around the origin", {{"x", 0.08}, {"y", 0.06}, {"z", 0.04}}},
       3,
       [](const Values& v) {
         return box({v[0], v[1], v[2]});
       }},
      {{"capsule",
        "a cylinder of `height` between two half-balls, along z around the origin",
        {{"radius", 0.025}, {"height", 0.08}, {"segments", 48}}},
       2,
       [](const Values& v) { return capsule(v[0], v[1], count(v[2])); }},
      {{"cylinder",
        "a cylinder along z around the origin",
        {{"radius", 0.03}, {"height", 0.1}, {"segments", 96}}},
       2,
       [](const Values& v) { return cylinder(v[0], v[1], count(v[2])); }},
      shape_of("flower_pot", "a hollow flower pot standing on z = 0", internal::kFlowerPotFields,
               120, flower_pot),
      shape_of("mug", "a hollow mug standing on z = 0, its handle towards +x", internal::kMugFields,
               150, mug),
      shape_of("octopus", "an octopus with eight arms on z = 0", internal::kOctopusFields, 100,
               octopus),
      shape_of("table", "a table with four legs standing on z = 0", internal::kTableFields, {},
               [](const TableDimensions& d, const Values&) { return table(d); }),
      {{"torus",
        "a torus around the z axis",
        {{"major_radius", 0.05},
         {"minor_radius", 0.015},
         {"major_segments", 96},
         {"minor_segments", 48}}},
       2,
       [](const Values& v) { return torus(v[0], v[1], count(v[2]), count(v[3])); }},
      shape_of("wire_cage", "a cage of round bars on z = 0", internal::kWireCageFields,
               {{"bars_per_side", WireCageDimensions{}.bars_per_side}, {"segments", 10}},
               [](WireCageDimensions d, const Values& v) {
                 d.bars_per_side = count(v[0]);
                 return wire_cage(d, count(v[1]));
               }),
  };
}

}  // namespace

std::vector<ShapeDescription> shape_descriptions() {
  std::vector<ShapeDescription> descriptions;
  for (const NamedShape& shape : all_shapes()) descriptions.push_back(shape.description);
  return descriptions;
}

TriangleMesh named_shape(const std::string& name, const std::vector<ShapeDimension>& dimensions) {
  const std::vector<NamedShape> shapes = all_shapes();
  const auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const NamedShape& candidate) {
    return candidate.description.name == name;
  });
  const auto listed = [](const std::string& unknown, const auto& items) {
    std::vector<std::string> names;
    for (const auto& item : items) names.push_back(item.name);
    return base::known_names(unknown, names);
  };
  if (shape == shapes.end()) {
    throw base::InvalidInput("there is no shape \"" + name + "\"; there are " +
                             listed(name, shape_descriptions()));
  }
  const std::vector<ShapeDimension>& known = shape->description.dimensions;
  Values values;
  for (const ShapeDimension& dimension : known) values.push_back(dimension.value);
  std::vector<char> is_given(known.size(), 0);
  for (const ShapeDimension& dimension : dimensions) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const ShapeDimension& other) {
      return other.name == dimension.name;
    });
    if (found == known.end()) {
      throw base::InvalidInput(name + ": has no dimension \"" + dimension.name + "\"; there are " +
                               listed(dimension.name, known));
    }
    const std::size_t i = found - known.begin();
    if (is_given[i]) throw base::InvalidInput(name + ": " + dimension.name + " is given twice");
    constexpr double kMostCount = 1e9;  // fits an int
    if (i >= shape->num_lengths && !(std::abs(dimension.value) <= kMostCount &&
                                     std::trunc(dimension.value) == dimension.value)) {
      throw base::InvalidInput(name + ": " + dimension.name + " is " +
                               base::shortest_decimal(dimension.value) + ", must be an integer");
    }
    is_given[i] = 1;
    values[i] = dimension.value;
  }
  return shape->build(values);
}

}  // namespace graspfit::geometry
