#include "graspfit/hold_test/hold_parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <system_error>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"

namespace graspfit::hold_test {
namespace {

using base::InvalidInput;

constexpr std::array kSqueezeRules = {SqueezeRule::Forces, SqueezeRule::Extrapolation,
                                      SqueezeRule::Limits, SqueezeRule::None};
constexpr std::array kLoads = {HoldLoad::SixForces, HoldLoad::SixInTurn, HoldLoad::Lift};

using Member =
    std::variant<double HoldProtocol::*, int HoldProtocol::*, bool HoldProtocol::*,
                 std::array<double, 2> HoldProtocol::*, std::array<double, 3> HoldProtocol::*,
                 SqueezeRule HoldProtocol::*, HoldLoad HoldProtocol::*>;

struct Parameter {
  const char* name;
  Member member;
};

/// The table of all parameters: files and command lines know no others.
const std::vector<Parameter>& parameters() {
  using P = HoldProtocol;
  static const std::vector<Parameter> table = {
      {"load", &P::load},
      {"squeeze", &P::squeeze},
      {"step_s", &P::step},
      {"sliding_friction", &P::sliding_friction},
      {"torsional_friction_m", &P::torsional_friction},
      {"impratio", &P::impratio},
      {"noslip_iterations", &P::noslip_iterations},
      {"hand_solimp", &P::hand_solimp},
      {"hand_solref", &P::hand_solref},
      {"object_solimp", &P::object_solimp},
      {"object_solref", &P::object_solref},
      {"multi_point_contacts", &P::multi_point_contacts},
      {"object_mass_kg", &P::object_mass},
      {"object_density_kg_per_m3", &P::object_density},
      {"object_linear_damping_per_s", &P::object_linear_damping},
      {"object_angular_damping_per_s", &P::object_angular_damping},
      {"stiffness_Nm_per_rad", &P::stiffness},
      {"slide_stiffness_N_per_m", &P::slide_stiffness},
      {"damping_time_s", &P::damping_time},
      {"armature_kg_m2", &P::armature},
      {"slide_armature_kg", &P::slide_armature},
      {"link_density_kg_per_m3", &P::link_density},
      {"extrapolation", &P::extrapolation},
      {"opening_share", &P::opening_share},
      {"closing_share", &P::closing_share},
      {"approach_time_s", &P::approach_time},
      {"squeeze_time_s", &P::squeeze_time},
      {"force_N", &P::force},
      {"gravity_m_per_s2", &P::gravity},
      {"lift_height_m", &P::lift_height},
      {"lift_time_s", &P::lift_time},
      {"hold_time_s", &P::hold_time},
      {"check_interval_s", &P::check_interval},
      {"largest_shift_m", &P::largest_shift},
      {"largest_turn_rad", &P::largest_turn},
      {"largest_penetration_m", &P::largest_penetration},
  };
  return table;
}

/// This does not compile when a protocol gets a field, which the table above then needs, too.
[[maybe_unused]] void require_all_fields(const HoldProtocol& protocol) {
  [[maybe_unused]] const auto& [name, source, k1, k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12,
                                k13, k14, k15, k16, k17, k18, k19, k20, k21, k22, k23, k24, k25,
                                k26, k27, k28, k29, k30, k31, k32, k33, k34, k35, k36] = protocol;
}

const Parameter& parameter_named(const std::string& name) {
  const auto found =
      std::find_if(parameters().begin(), parameters().end(),
                   [&](const Parameter& parameter) { return name == parameter.name; });
  if (found != parameters().end()) return *found;
  throw InvalidInput("no parameter \"" + name + "\" of a hold protocol; there are " +
                     base::list_text(parameters(), &Parameter::name));
}

[[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& why) {
  throw InvalidInput("parameter " + name + ": \"" + text + "\" " + why);
}

/// Reads a text that is a finite number as a whole; empty for any other text.
template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_read = error == std::errc() && end == text.data() + text.size();
  return is_read && std::isfinite(static_cast<double>(number)) ? std::optional(number)
                                                               : std::nullopt;
}

template <class Number>
Number parsed(const std::string& name, const std::string& text, const char* kind) {
  const std::optional<Number> number = number_of<Number>(text);
  if (!number) refuse(name, text, std::string("is not ") + kind);
  return *number;
}

template <std::size_t N>
std::array<double, N> parsed_numbers(const std::string& name, const std::string& text) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    if (const auto number = number_of<double>(part)) numbers.push_back(*number);
  }
  const auto num_parts = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
  if (numbers.size() != N || num_parts != N) {
    refuse(name, text, "is not " + std::to_string(N) + " numbers separated by commas");
  }
  std::array<double, N> array{};
  std::copy(numbers.begin(), numbers.end(), array.begin());
  return array;
}

template <class Choices>
auto parsed_choice(const std::string& name, const std::string& text, const Choices& choices) {
  for (const auto choice : choices) {
    if (text == name_of(choice)) return choice;
  }
  const auto name_of_choice = [](auto choice) { return name_of(choice); };
  refuse(name, text, "is not one of " + base::list_text(choices, name_of_choice, "|"));
}

ParameterValue value_of(double value) { return value; }
ParameterValue value_of(int value) { return value; }
ParameterValue value_of(bool value) { return value; }
template <std::size_t N>
ParameterValue value_of(const std::array<double, N>& values) {
  return std::vector<double>(values.begin(), values.end());
}
template <class Choice>
ParameterValue value_of(Choice choice) {
  return std::string(name_of(choice));
}

void set(double& value, const std::string& name, const std::string& text) {
  value = parsed<double>(name, text, "a number");
}
void set(int& value, const std::string& name, const std::string& text) {
  value = parsed<int>(name, text, "an integer");
}
void set(bool& value, const std::string& name, const std::string& text) {
  if (text != "yes" && text != "no") refuse(name, text, "is neither yes nor no");
  value = text == "yes";
}
template <std::size_t N>
void set(std::array<double, N>& values, const std::string& name, const std::string& text) {
  values = parsed_numbers<N>(name, text);
}
void set(SqueezeRule& rule, const std::string& name, const std::string& text) {
  rule = parsed_choice(name, text, kSqueezeRules);
}
void set(HoldLoad& load, const std::string& name, const std::string& text) {
  load = parsed_choice(name, text, kLoads);
}

}  // namespace

const char* name_of(SqueezeRule rule) {
  switch (rule) {
    case SqueezeRule::Forces:
      return "forces";
    case SqueezeRule::Extrapolation:
      return "extrapolation";
    case SqueezeRule::Limits:
      return "limits";
    case SqueezeRule::None:
      break;
  }
  return "none";
}

const char* name_of(HoldLoad load) {
  switch (load) {
    case HoldLoad::SixForces:
      return "six-forces";
    case HoldLoad::SixInTurn:
      return "six-in-turn";
    case HoldLoad::Lift:
      break;
  }
  return "lift";
}

const std::vector<std::string>& parameter_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Parameter& parameter : parameters()) all.emplace_back(parameter.name);
    return all;
  }();
  return names;
}

ParameterValue parameter_value(const HoldProtocol& protocol, const std::string& name) {
  return std::visit([&](auto member) { return value_of(protocol.*member); },
                    parameter_named(name).member);
}

void set_parameter(HoldProtocol& protocol, const std::string& name, const std::string& text) {
  std::visit([&](auto member) { set(protocol.*member, name, text); }, parameter_named(name).member);
}

}  // namespace graspfit::hold_test
