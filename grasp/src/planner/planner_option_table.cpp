#include "graspfit/grasp/planner_option_table.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <type_traits>
#include <utility>

#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/grasp_guidance.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp {
namespace {

/// The number to twelve digits: digits behind these come from the conversion of units, not from the
/// option.
std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.11e", value);
  return base::plain_decimal(std::strtod(text, nullptr));
}

/// Lists the options that have a name.
class Listing {
 public:
  std::vector<PlannerOption> options;

  template <class Value>
  void operator()(const Value& value, const OptionRow& row) {
    if (row.name.empty()) return;
    PlannerOption option = option_of<Value>(row);
    if constexpr (std::is_enum_v<Value>) {
      option.fallback = name_of(value);
    } else if constexpr (std::is_same_v<Value, bool>) {
      option.fallback = value ? "true" : "false";
    } else if constexpr (std::is_arithmetic_v<Value>) {
      option.fallback = number_text(from_field_unit(static_cast<double>(value), row.unit));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      option.fallback = value;
    }
    options.push_back(std::move(option));
  }
  template <class Value>
  void operator()(const std::optional<Value>&, const OptionRow& row) {
    if (!row.name.empty()) options.push_back(option_of<Value>(row));
  }
  template <class Options, class Rows>
  void group(std::string_view key, const Options& within, const Rows& rows) {
    const std::string outer = within_;
    within_ += std::string(key) + '.';
    rows(*this, within);
    within_ = outer;
  }
  template <class Options, class Rows>
  void optional_group(std::string_view key, const std::optional<Options>&, const Rows& rows) {
    group(key, Options{}, rows);
  }

 private:
  std::string within_;  // the path of the struct at hand, "fitting."

  template <class Value>
  PlannerOption option_of(const OptionRow& row) const {
    PlannerOption option{row};
    option.path = within_ + std::string(row.key);
    if constexpr (std::is_enum_v<Value>) {
      option.kind = OptionKind::Choice;
      for (const auto& named : named_values<Value>()) option.choices.emplace_back(named.name);
    } else if constexpr (std::is_same_v<Value, std::string>) {
      option.kind = OptionKind::Choice;  // The only text is the name of a method.
      for (const auto& method : planning_methods().all()) option.choices.push_back(method.name);
    } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
      option.kind = OptionKind::Names;
    } else if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      option.kind = OptionKind::Direction;
    } else if constexpr (std::is_same_v<Value, bool>) {
      option.kind = OptionKind::YesNo;
    } else if constexpr (std::is_integral_v<Value>) {
      option.kind = OptionKind::Integer;
    }
    return option;
  }
};

/// Sets the field whose row has a name.
class Assignment {
 public:
  Assignment(std::string_view name, const OptionValue& value) : name_(name), value_(value) {}

  template <class Field>
  void operator()(Field& field, const OptionRow& row) {
    if (row.name != name_) return;
    is_done_ = true;
    if constexpr (std::is_enum_v<Field>) {
      field = value_named<Field>(std::get<std::string>(value_)).value();
    } else if constexpr (std::is_same_v<Field, double>) {
      field = to_field_unit(std::get<double>(value_), row.unit);
    } else if constexpr (std::is_integral_v<Field> && !std::is_same_v<Field, bool>) {
      field = static_cast<Field>(std::get<std::int64_t>(value_));
    } else {
      field = std::get<Field>(value_);
    }
  }
  template <class Field>
  void operator()(std::optional<Field>& field, const OptionRow& row) {
    if (row.name == name_) (*this)(field.emplace(), row);
  }
  template <class Options, class Rows>
  void group(std::string_view, Options& within, const Rows& rows) {
    rows(*this, within);
  }
  template <class Options, class Rows>
  void optional_group(std::string_view, std::optional<Options>& within, const Rows& rows) {
    Options changed = within.value_or(Options{});
    const bool was_done = is_done_;
    rows(*this, changed);
    if (is_done_ && !was_done) within = changed;
  }

 private:
  std::string_view name_;
  const OptionValue& value_;
  bool is_done_ = false;
};

}  // namespace

bool PlannerOption::has_choice(std::string_view text) const {
  return std::find(choices.begin(), choices.end(), text) != choices.end();
}

std::string PlannerOption::choices_text() const { return base::list_text(choices, {}, "|"); }

std::string PlannerOption::source_text() const {
  if (source.empty()) return "";
  return " [" + std::string(source) + (reading.empty() ? "" : ", ") + std::string(reading) + ']';
}

const std::vector<PlannerOption>& planner_option_table() {
  static const std::vector<PlannerOption> table = [] {
    Listing listing;
    const PlannerOptions defaults;
    internal::planner_rows(listing, defaults);
    return std::move(listing.options);
  }();
  return table;
}

void set_option(PlannerOptions& options, const PlannerOption& option, const OptionValue& value) {
  Assignment assignment(option.name, value);
  internal::planner_rows(assignment, options);
  if (option.name == "theta-max-deg") options.targets.theta_max = options.quality.theta_max;
  if (option.name == "fingers") options.num_contacts = static_cast<int>(options.fingers.size());
  if (option.name == "weak-thickness-mm" && options.weak->weak_thickness == 0.0) {
    options.weak.reset();
  }
}

}  // namespace graspfit::grasp
