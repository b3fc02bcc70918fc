#include <cmath>
#include <string_view>
#include <type_traits>
#include <vector>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/json_value.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/option_names.hpp"
#include "io/json_text.hpp"
#include "io/record_json.hpp"
#include "rows/option_rows.hpp"

namespace graspfit::grasp {
namespace {

using internal::Json;

Json number_schema(const char* type, const base::NumberRange& range, std::string_view unit) {
  Json schema = {{"type", type}};
  const auto bound = [&](const char* key, double value) {
    if (std::isinf(value)) return;
    const double in_file = to_field_unit(value, unit);
    schema[key] = in_file == std::trunc(in_file) ? Json(std::int64_t(in_file)) : Json(in_file);
  };
  bound(range.has_least ? "minimum" : "exclusiveMinimum", range.least);
  bound(range.has_most ? "maximum" : "exclusiveMaximum", range.most);
  return schema;
}

Json or_null_schema(const Json& schema) { return {{"anyOf", {schema, {{"type", "null"}}}}}; }

/// The schema of what `JsonWriter` writes for an option's field.
template <class Value>
struct FieldSchema {
  static Json of(const OptionRow& row) {
    if constexpr (std::is_enum_v<Value>) {
      Json names = Json::array();
      for (const auto& named : named_values<Value>()) names.push_back(named.name);
      return {{"enum", names}};
    } else if constexpr (std::is_same_v<Value, bool>) {
      return {{"type", "boolean"}};
    } else if constexpr (std::is_integral_v<Value>) {
      return number_schema("integer", row.range, row.unit);
    } else if constexpr (std::is_same_v<Value, double>) {
      return number_schema("number", row.range, row.unit);
    } else if constexpr (std::is_same_v<Value, std::string>) {
      return {{"type", "string"}, {"minLength", 1}};
    } else if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      return {{"$ref", "#/$defs/vector"}};
    } else {
      static_assert(std::is_same_v<Value, std::vector<std::string>>);
      return {{"type", "array"}, {"items", FieldSchema<std::string>::of(row)}};
    }
  }
};
template <class Value>
struct FieldSchema<std::optional<Value>> {
  static Json of(const OptionRow& row) {
    const Json schema = FieldSchema<Value>::of(row);
    return row.is_zero_if_empty ? schema : or_null_schema(schema);
  }
};

/// Puts the schemas of a struct's fields into `properties`.
class SchemaWriter {
 public:
  explicit SchemaWriter(Json& properties) : properties_(properties) {}

  template <class Value>
  void operator()(const Value&, const OptionRow& row) {
    Json schema = Json::object();
    if (!row.meaning.empty()) schema["description"] = row.meaning;
    Json field = FieldSchema<Value>::of(row);
    if (row.may_be_infinite) field = {{"anyOf", {field, {{"const", "infinity"}}}}};
    schema.update(field);
    properties_[std::string(row.key)] = schema;
  }
  template <class Options, class Rows>
  void group(std::string_view key, const Options& within, const Rows& rows) {
    properties_[std::string(key)] = object_schema(within, rows);
  }
  template <class Options, class Rows>
  void optional_group(std::string_view key, const std::optional<Options>&, const Rows& rows) {
    Json schema = {{"description", "null: without"}};
    schema.update(or_null_schema(object_schema(Options{}, rows)));
    properties_[std::string(key)] = schema;
  }

  /// Without required members: options that a file lacks have their defaults.
  template <class Options, class Rows>
  static Json object_schema(const Options& options, const Rows& rows) {
    Json properties = Json::object();
    SchemaWriter writer(properties);
    rows(writer, options);
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  }

 private:
  Json& properties_;
};

}  // namespace

std::string with_option_schema(const std::string& schema, const std::string& file) {
  const base::JsonValue root = base::JsonValue::parsed<base::IoError>(schema, file);
  root.at("$defs").at("options");
  Json changed = root.json();
  Json options = {{"description",
                   "every option of the planner; one that is missing has its default. Descriptions "
                   "name other options as flags. Written by graspfit options --schema"}};
  options.update(SchemaWriter::object_schema(PlannerOptions{}, internal::planner_rows));
  changed["$defs"]["options"] = options;
  return internal::json_text(changed);
}

}  // namespace graspfit::grasp
