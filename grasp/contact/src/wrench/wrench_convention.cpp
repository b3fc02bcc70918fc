#include "graspfit/contact/wrench_convention.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "graspfit/base/number_text.hpp"
#include "graspfit/base/option_check.hpp"
#include "graspfit/geometry/mass_properties.hpp"
#include "wrench/convention_text.hpp"

namespace graspfit::contact {
namespace {

using Eigen::Vector3d;

/// The scale as a number that messages and descriptions can state: NaN where none is given.
double number_of(const std::optional<double>& torque_scale) {
  return torque_scale.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string_view name_of_tool(WrenchTool tool) {
  switch (tool) {
    case WrenchTool::Graspfit:
      return "graspfit";
    case WrenchTool::GraspIt:
      return "GraspIt!";
    case WrenchTool::Simox:
      return "Simox";
    case WrenchTool::DexNet:
      return "Dex-Net";
    case WrenchTool::Frogger:
      return "FRoGGeR";
    case WrenchTool::DexGraspBench:
      return "DexGraspBench";
  }
  return {};
}

std::string_view name_of_outside(OutsideValue outside) {
  switch (outside) {
    case OutsideValue::Zero:
      return "0";
    case OutsideValue::MinusOne:
      return "-1";
    case OutsideValue::Signed:
      return "signed";
  }
  return {};
}

}  // namespace

void WrenchSpaceOptions::validate() const {
  const auto check = [](bool is_met, std::string_view field, auto value, std::string_view rule) {
    base::require(is_met, "WrenchSpaceOptions", field, value, rule);
  };
  check(num_cone_edges >= 3, "num_cone_edges", num_cone_edges, "at least 3");
  check(friction >= 0.0 && std::isfinite(friction), "friction", friction, "finite and at least 0");
  const double scale = number_of(torque_scale);
  check(scale > 0.0 && std::isfinite(scale), "torque_scale", scale, "set, finite and positive");
  check(force_limit > 0.0 && std::isfinite(force_limit), "force_limit", force_limit,
        "finite and positive");
}

std::string internal::describe(const WrenchConvention& convention, std::string_view norm) {
  const auto number = [](double value) { return base::shortest_decimal(value); };
  const WrenchSpaceOptions& options = convention.options;
  const Vector3d& c = convention.reference_point_O;
  std::string text;
  if (convention.tool) text.append(name_of_tool(*convention.tool)).append(": ");
  text.append("torques about (" + number(c.x()) + ", " + number(c.y()) + ", " + number(c.z()) +
              ") m over " + number(number_of(options.torque_scale)) + " m, friction " +
              number(options.friction) + ", " + std::to_string(options.num_cone_edges) +
              " inscribed edges from normal x e_x, ")
      .append(norm)
      .append(", unit ");
  text.append(options.force_scaling == ForceScaling::UnitNormal ? "normal" : "edge")
      .append(" force");
  if (options.force_limit != 1.0) text.append(" x " + number(options.force_limit));
  return text;
}

std::string describe(const WrenchConvention& convention) {
  return internal::describe(convention, "L1")
      .append(", outside ")
      .append(name_of_outside(convention.options.outside));
}

WrenchObject wrench_object(const geometry::TriangleMesh& mesh_O, const Vector3d& center_of_mass_O) {
  return {.center_of_mass_O = center_of_mass_O,
          .largest_radius = geometry::largest_radius(mesh_O, center_of_mass_O),
          .extents_O = geometry::bounding_box(mesh_O).sizes()};
}

WrenchConvention wrench_convention(WrenchTool tool, const WrenchObject& object,
                                   std::span<const Contact> contacts, double friction) {
  WrenchConvention convention;
  convention.tool = tool;
  convention.reference_point_O = object.center_of_mass_O;
  WrenchSpaceOptions& options = convention.options;
  options.friction = friction;
  options.torque_scale = object.largest_radius;
  std::array<double, 3> extents = {object.extents_O.x(), object.extents_O.y(),
                                   object.extents_O.z()};
  std::sort(extents.begin(), extents.end());
  switch (tool) {
    case WrenchTool::Graspfit:
      break;
    case WrenchTool::GraspIt:
      options.outside = OutsideValue::MinusOne;
      break;
    case WrenchTool::Simox:
      options.torque_scale = 0.5 * extents[2];
      options.force_scaling = ForceScaling::UnitEdge;
      break;
    case WrenchTool::DexNet:
      options.torque_scale = extents[1];
      break;
    case WrenchTool::Frogger:
      options.torque_scale = 1.0;
      options.force_scaling = ForceScaling::UnitEdge;
      options.num_cone_edges = 4;
      options.outside = OutsideValue::Signed;
      break;
    case WrenchTool::DexGraspBench: {
      const auto count = static_cast<double>(contacts.size());
      Vector3d centroid = Vector3d::Zero();
      for (const Contact& contact : contacts) centroid += contact.point_O / count;
      double mean_distance = 0.0;
      for (const Contact& contact : contacts) {
        mean_distance += (contact.point_O - centroid).norm() / count;
      }
      convention.reference_point_O = centroid;
      options.torque_scale = mean_distance;
      break;
    }
  }
  options.validate();
  return convention;
}

}  // namespace graspfit::contact
