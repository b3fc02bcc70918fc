#include "cells/case_predicate.hpp"

#include <algorithm>
#include <limits>

#include "graspfit/base/list_text.hpp"
#include "graspfit/base/units.hpp"

namespace graspfit::experiments::internal {
namespace {

double read_angle(const base::JsonValue& value, double most_deg) {
  const double angle = value.at("within_deg").positive_number();
  if (angle > most_deg) {
    value.at("within_deg").refuse("must be at most " + std::to_string(static_cast<int>(most_deg)));
  }
  return angle * base::kRadiansPerDegree;
}

/// Reads the largest gap [m]. Without this setting all surface in the clip volumes counts as
/// contact, as in the paper.
double read_largest_gap(const base::JsonValue& value) {
  if (!value.has("largest_gap_mm")) return std::numeric_limits<double>::infinity();
  return value.at("largest_gap_mm").positive_number() * base::kMetersPerMillimeter;
}

CasePredicate read_outer_side(const base::JsonValue& value) {
  value.require_members({}, {"name", "axis"});
  return [axis = sweep::axis_of(value.at("axis"))](const JudgedGrasp& judged) {
    return contacts_on_outer_side(judged.grasp.contacts, judged.object, axis);
  };
}

CasePredicate read_points_to_axis(const base::JsonValue& value) {
  value.require_members({}, {"name", "axis", "within_deg"});
  return [axis = sweep::axis_of(value.at("axis")),
          angle = read_angle(value, 90.0)](const JudgedGrasp& judged) {
    return normal_points_to_axis(judged.grasp.contacts, judged.object, axis, angle);
  };
}

RelativeBox read_box(const base::JsonValue& value) {
  value.require_members({}, {"note", "x", "y", "z"});
  RelativeBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, static_cast<char>('x' + axis));
    if (!value.has(name)) continue;
    const std::vector<base::JsonValue> range = value.at(name).items();
    if (range.size() != 2 || !(range[0].number() < range[1].number())) {
      value.at(name).refuse("must be [from, to] with from < to, shares of the bounding box");
    }
    box.lower[axis] = range[0].number();
    box.upper[axis] = range[1].number();
  }
  return box;
}

CasePredicate read_region(const base::JsonValue& value) {
  value.require_members({}, {"name", "boxes"});
  std::vector<RelativeBox> boxes;
  for (const base::JsonValue& box : value.at("boxes").some_items()) boxes.push_back(read_box(box));
  return [boxes](const JudgedGrasp& judged) {
    return no_contact_in_region(judged.grasp.contacts, judged.object, boxes);
  };
}

CasePredicate read_num_contacts(const base::JsonValue& value) {
  value.require_members({}, {"name", "at_least", "at_most", "largest_gap_mm"});
  const int least = value.at("at_least").small_integer();
  std::optional<int> most;
  if (value.has("at_most")) most = value.at("at_most").small_integer();
  return [least, most, gap = read_largest_gap(value)](const JudgedGrasp& judged) {
    return num_contacts(judged.grasp.contacts, least, most, gap);
  };
}

CasePredicate read_parts_touch(const base::JsonValue& value) {
  value.require_members({}, {"name", "parts", "exactly", "largest_gap_mm"});
  const bool is_exact = value.has("exactly") && value.at("exactly").flag();
  return [parts = sweep::names_of(value.at("parts")), is_exact,
          gap = read_largest_gap(value)](const JudgedGrasp& judged) {
    return parts_touch(judged.grasp.contacts, judged.hand, parts, gap, is_exact);
  };
}

CasePredicate read_approaches(const base::JsonValue& value) {
  value.require_members({}, {"name", "direction", "within_deg"});
  const Eigen::Vector3d direction = sweep::vector_of(value.at("direction"));
  if (direction.isZero(0.0)) value.at("direction").refuse("must not be zero");
  return [direction, angle = read_angle(value, 180.0)](const JudgedGrasp& judged) {
    return approaches_along(judged.grasp, judged.hand, direction, angle);
  };
}

CasePredicate read_not_weak(const base::JsonValue& value) {
  value.require_members({}, {"name"});
  return [](const JudgedGrasp& judged) { return no_contact_on_weak(judged.grasp.contacts); };
}

CasePredicate read_best_style(const base::JsonValue& value) {
  value.require_members({}, {"name", "mode"});
  return [mode = value.at("mode").name()](const JudgedGrasp& judged) {
    return best_style_by_m(judged.best_m, mode);
  };
}

using Reader = CasePredicate (*)(const base::JsonValue&);
constexpr std::array<std::pair<const char*, Reader>, 8> kReaders = {
    {{"contacts_on_outer_side", read_outer_side},
     {"normal_points_to_axis", read_points_to_axis},
     {"no_contact_in_region", read_region},
     {"num_contacts", read_num_contacts},
     {"parts_touch", read_parts_touch},
     {"approaches_along", read_approaches},
     {"no_contact_on_weak", read_not_weak},
     {"best_style_by_m", read_best_style}}};

}  // namespace

CasePredicate read_predicate(const base::JsonValue& value) {
  const base::JsonValue named = value.at("name");
  const std::string name = named.name();
  for (const auto& [known, read] : kReaders) {
    if (name == known) return read(value);
  }
  const auto first = [](const auto& reader) { return reader.first; };
  named.refuse("must be one of " + base::list_text(kReaders, first, "|"));
}

}  // namespace graspfit::experiments::internal
