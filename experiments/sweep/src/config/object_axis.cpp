#include "config/object_axis.hpp"

#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "config/axis_label.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/geometry/mesh_io.hpp"
#include "graspfit/sweep/data_needs.hpp"

namespace graspfit::sweep::internal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The file's name without its ending as a label.
std::string label_of(const fs::path& file) {
  std::string label = file.stem().string();
  for (char& c : label) {
    if (!is_label_character(c)) c = '_';
  }
  return is_label(label) ? label : "object";
}

/// Returns the settings of a mesh file as text.
std::string file_settings(const fs::path& file, const std::optional<double>& longest) {
  Json settings = {{"file", file.string()}};
  if (longest) {
    settings["size_m"] = *longest;
    settings["size_axis"] = "longest";
  }
  try {
    return settings.dump();
  } catch (const Json::exception&) {
    throw base::InvalidInput("--object " + file.string() +
                             ": the path is not UTF-8, which a manifest is; give the file "
                             "another name, or a link to it");
  }
}

}  // namespace

std::vector<AxisValue> default_objects(bool has_sizes) {
  Json elephant = {{"packaged", "elephant.off"}};
  if (!has_sizes) elephant["size_m"] = 0.12;  // a gripper closes around it
  std::vector<AxisValue> objects = {{"elephant", elephant.dump()}};
  for (const char* const shape : {"box", "bottle", "mug", "torus"}) {
    objects.push_back({std::string("shape_") + shape, Json{{"shape", shape}}.dump()});
  }
  std::erase_if(objects, [](const AxisValue& object) { return !has_all_data(object.settings); });
  return objects;
}

std::vector<AxisValue> object_file_values(const std::vector<fs::path>& files,
                                          const std::optional<double>& longest,
                                          const std::vector<AxisValue>& taken) {
  std::set<std::string> labels;
  for (const AxisValue& value : taken) labels.insert(value.label);
  std::vector<AxisValue> values;
  for (const fs::path& file : files) {
    const std::string settings = file_settings(fs::absolute(file).lexically_normal(), longest);
    geometry::read_mesh(file);  // what cannot be read is refused before any cell runs
    const std::string base = label_of(file);
    std::string label = base;
    for (int number = 2; !labels.insert(label).second; ++number) {
      label = base + '_' + std::to_string(number);
    }
    values.push_back({label, settings});
  }
  return values;
}

}  // namespace graspfit::sweep::internal
