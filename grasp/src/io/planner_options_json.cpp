#include "io/planner_options_json.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "graspfit/base/errors.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp::internal {
namespace {

using Json = nlohmann::ordered_json;

/// Puts fields into a JSON object under their names.
class Writer {
 public:
  explicit Writer(Json& json) : json_(json) {}

  template <class Value>
  void operator()(const Value& value, const OptionRow& row) {
    json_[row.key] = to_json(value);
  }
  template <class Options, class Fields>
  void group(std::string_view name, const Options& options, const Fields& fields) {
    Json json = Json::object();
    Writer writer(json);
    fields(writer, options);
    json_[name] = std::move(json);
  }
  template <class Options, class Fields>
  void optional_group(std::string_view name, const std::optional<Options>& options,
                      const Fields& fields) {
    json_[name] = nullptr;
    if (options) group(name, *options, fields);
  }

 private:
  static Json to_json(double value) {
    return std::isinf(value) ? Json("infinity") : Json(value);  // JSON has no infinity
  }
  static Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
  template <class Value>
  static Json to_json(const std::optional<Value>& value) {
    return value ? to_json(*value) : Json(nullptr);
  }
  template <class Value>
  static Json to_json(const Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      return std::string(name_of(value));
    } else {
      return value;
    }
  }

  Json& json_;
};

/// Sets fields from the members of a JSON object with their names.
class Reader {
 public:
  explicit Reader(JsonNode node) : node_(std::move(node)) {}

  template <class Value>
  void operator()(Value& value, const OptionRow& row) const {
    read(node_.at(std::string(row.key)), value);
  }
  template <class Options, class Fields>
  void group(std::string_view name, Options& options, const Fields& fields) const {
    Reader reader(node_.at(std::string(name)));
    fields(reader, options);
  }
  template <class Options, class Fields>
  void optional_group(std::string_view name, std::optional<Options>& options,
                      const Fields& fields) const {
    options.reset();
    if (!node_.at(std::string(name)).is_null()) group(name, options.emplace(), fields);
  }

 private:
  static void read(const JsonNode& node, double& value) {
    if (node.is_text() && node.text() == "infinity") {
      value = std::numeric_limits<double>::infinity();
    } else {
      value = node.number();
    }
  }
  static void read(const JsonNode& node, int& value) { value = node.small_integer(); }
  static void read(const JsonNode& node, std::int64_t& value) { value = node.integer(); }
  static void read(const JsonNode& node, bool& value) { value = node.flag(); }
  static void read(const JsonNode& node, std::string& value) { value = node.text(); }
  static void read(const JsonNode& node, std::vector<std::string>& value) { value = node.texts(); }
  static void read(const JsonNode& node, Eigen::Vector3d& value) { value = node.vector3(); }
  template <class Value>
  static void read(const JsonNode& node, std::optional<Value>& value) {
    value.reset();
    if (!node.is_null()) read(node, value.emplace());
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  static void read(const JsonNode& node, Enum& value) { value = node.choice<Enum>(); }

  JsonNode node_;
};

}  // namespace

Json planner_options_json(const PlannerOptions& options) {
  Json json = Json::object();
  Writer writer(json);
  planner_rows(writer, options);
  return json;
}

PlannerOptions read_planner_options(const JsonNode& node, std::uint64_t seed) {
  PlannerOptions options;
  Reader reader(node);
  planner_rows(reader, options);
  options.seed = seed;
  try {
    options.validate();
  } catch (const base::InvalidInput& error) {
    node.fail(error.what());
  }
  return options;
}

}  // namespace graspfit::grasp::internal
