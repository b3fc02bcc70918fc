#include "graspfit/grasp/option_row.hpp"

#include "graspfit/base/units.hpp"

namespace graspfit::grasp {

double to_field_unit(double value, std::string_view unit) {
  if (unit == "mm") return value / 1000.0;
  return unit == "deg" ? value * base::kRadiansPerDegree : value;
}

double from_field_unit(double value, std::string_view unit) {
  if (unit == "mm") return value * 1000.0;
  return unit == "deg" ? value / base::kRadiansPerDegree : value;
}

}  // namespace graspfit::grasp
