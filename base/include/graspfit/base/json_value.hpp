#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graspfit::base {

/// A JSON value together with its location, which begins every error message about it:
/// "grasps.json: /results/grasps/0/quality/m: is missing". Faults that its member functions find
/// are thrown by the document's `Fault`.
class JsonValue {
 public:
  using Json = nlohmann::ordered_json;
  /// A function that throws an error. `location` is the root's location and a JSON pointer from
  /// there, `what` says what is wrong there; both are one line.
  using Fault = std::function<void(const std::string& location, const std::string& what)>;

  /// The root of a document of its own; `location` begins the locations of all its values.
  JsonValue(const Json& root, Fault fault, std::string location = "");

  /// The root of a file with this text, which messages call `file`. Faults of its values are thrown
  /// as `Exception`. @throws IoError "<file>: is not JSON: ..." or if `require_bounded_json`
  /// refuses it, with at most `kMostOrderedMembers` in an object.
  template <class Exception>
  static JsonValue parsed(const std::string& text, const std::string& file) {
    return parsed(text, file, [](const std::string& message) { throw Exception(message); });
  }

  /// The root of another tree, whose faults are thrown as those of this document.
  JsonValue with_root(const Json& root) const;

  const Json& json() const { return *json_; }
  const std::string& location() const { return location_; }

  bool is_null() const;
  bool is_text() const;
  /// Whether this is an object with such a member.
  bool has(const std::string& key) const;
  /// A member of this object; it must exist.
  JsonValue at(const std::string& key) const;
  /// A member of this object unless it is missing or null.
  std::optional<JsonValue> find(const std::string& key) const;
  /// The members of this object, in the order of the file.
  std::vector<std::pair<std::string, JsonValue>> members() const;
  /// Refuses what is no object, lacks a required member, or has one that is in neither list.
  void require_members(const std::vector<std::string>& required,
                       const std::vector<std::string>& optional) const;
  /// The items of this array.
  std::vector<JsonValue> items() const;
  /// The items of this array, which must not be empty.
  std::vector<JsonValue> some_items() const;

  double number() const;
  double positive_number() const;  ///< A number > 0.
  std::int64_t integer() const;
  std::uint64_t unsigned_integer() const;
  int small_integer() const;
  bool flag() const;  ///< true or false.
  std::string text() const;
  std::string name() const;                ///< A text that is not empty.
  std::string path() const;                ///< A file's path, as `path_text` writes it.
  std::vector<std::string> texts() const;  ///< The texts of an array.
  template <std::size_t N>
  std::array<double, N> numbers() const {  ///< The numbers of an array of N.
    std::array<double, N> values{};
    const std::vector<JsonValue> given = items();
    if (given.size() != N) refuse_count(given.size(), N);
    for (std::size_t i = 0; i < N; ++i) values[i] = given[i].number();
    return values;
  }

  /// Throws the fault that `what` is wrong with this value.
  [[noreturn]] void fail(const std::string& what) const;
  /// Throws "is <value>, <rule>", such as "is 3, must be a text".
  [[noreturn]] void refuse(const std::string& rule) const;

 private:
  struct Document;
  JsonValue(std::shared_ptr<const Document> document, const Json* json, std::string location)
      : document_(std::move(document)), json_(json), location_(std::move(location)) {}
  static JsonValue parsed(const std::string& text, const std::string& file,
                          void (*raise)(const std::string& message));
  JsonValue child(const Json& json, const std::string& name) const;
  [[noreturn]] void refuse_count(std::size_t given, std::size_t wanted) const;

  std::shared_ptr<const Document> document_;  ///< Keeps the tree alive that `json_` points into.
  const Json* json_;
  std::string location_;
};

}  // namespace graspfit::base
