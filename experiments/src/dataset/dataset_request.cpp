#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "graspfit/sweep/table_comparison.hpp"

namespace graspfit::experiments {
namespace dataset_request_parts {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 6> kMeshExtensions = {".off", ".obj",  ".ply",
                                                        ".stl", ".gltf", ".glb"};
constexpr std::size_t kLongestName = 80;  // file names end at 255 bytes

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return extension;
}

bool is_mesh(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return std::find(kMeshExtensions.begin(), kMeshExtensions.end(), extension) !=
         kMeshExtensions.end();
}

/// A text of letters, digits and _.+- only, which a label may be.
std::string label_of(const std::string& text) {
  std::string label;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '+' || c == '-';
    label += is_plain ? c : '_';
  }
  if (label.find_first_not_of('.') == std::string::npos) label = "object";
  if (label.size() <= kLongestName) return label;
  return label.substr(0, kLongestName - 9) + '_' + base::sha256_hex(text).substr(0, 8);
}

std::string without_extension(const fs::path& file) {
  return (file.parent_path() / file.stem()).generic_string();
}

std::vector<DatasetObject> meshes_in(const fs::path& folder) {
  std::vector<DatasetObject> objects;
  std::error_code error;
  fs::recursive_directory_iterator entries(folder, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    const fs::path& file = entries->path();
    std::error_code ignored;
    if (!is_mesh(file) || !fs::is_regular_file(file, ignored)) continue;
    DatasetObject object;
    object.file = file;
    object.name = label_of(without_extension(file.lexically_relative(folder)));
    objects.push_back(std::move(object));
  }
  if (error) throw base::IoError(folder.string() + ": " + error.message());
  std::sort(objects.begin(), objects.end(), [](const DatasetObject& a, const DatasetObject& b) {
    return a.file.generic_string() < b.file.generic_string();
  });
  return objects;
}

std::vector<DatasetObject> meshes_of_lines(const fs::path& list) {
  std::vector<DatasetObject> objects;
  const std::string text = base::read_file(list);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    line = line.substr(0, line.find('#'));
    const auto last = line.find_last_not_of(" \t\r");
    if (last == std::string::npos) continue;
    line = line.substr(0, last + 1);
    line.erase(0, line.find_first_not_of(" \t"));
    DatasetObject object;
    object.file = list.parent_path() / line;
    objects.push_back(std::move(object));
  }
  return objects;
}

/// A length above 0 of a table's field; none where the field is empty.
std::optional<double> length_of(const std::string& field, const std::string& where) {
  if (field.empty()) return std::nullopt;
  const std::optional<double> length = sweep::csv_number(field);
  if (!length || !(*length > 0.0)) {
    throw base::InvalidInput(where + " is \"" + field + "\", must be a number > 0");
  }
  return length;
}

std::vector<DatasetObject> meshes_of_table(const fs::path& list) {
  const std::string name = list.string();
  const sweep::CsvTable table = sweep::parse_csv(base::read_file(list), name);
  const std::set<std::string> known = {"file", "name", "longest_m", "meters_per_unit", "license"};
  std::map<std::string, std::size_t> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (!known.contains(table.columns[i])) {
      throw base::InvalidInput(name + ": column \"" + table.columns[i] +
                               "\" is none of file, name, longest_m, meters_per_unit, license");
    }
    columns[table.columns[i]] = i;
  }
  if (!columns.contains("file")) throw base::InvalidInput(name + ": has no column file");
  std::vector<DatasetObject> objects;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const auto field = [&](const char* column) {
      const auto found = columns.find(column);
      return found == columns.end() ? std::string() : table.rows[row][found->second];
    };
    const std::string where = name + ": line " + std::to_string(row + 2);
    if (field("file").empty()) throw base::InvalidInput(where + ": names no file");
    DatasetObject object;
    object.file = list.parent_path() / field("file");
    object.name = field("name").empty() ? "" : label_of(field("name"));
    object.longest = length_of(field("longest_m"), where + ": longest_m");
    object.meters_per_unit = length_of(field("meters_per_unit"), where + ": meters_per_unit");
    object.license = field("license");
    objects.push_back(std::move(object));
  }
  return objects;
}

std::vector<DatasetObject> objects_of(const fs::path& source) {
  std::error_code error;
  const fs::file_status status = fs::status(source, error);
  if (!fs::exists(status)) throw base::IoError(source.string() + ": there is no such file");
  const std::string extension = lower_extension(source);
  std::vector<DatasetObject> objects;
  if (fs::is_directory(status)) {
    objects = meshes_in(source);
  } else if (extension == ".txt") {
    objects = meshes_of_lines(source);
  } else if (extension == ".csv") {
    objects = meshes_of_table(source);
  } else if (is_mesh(source)) {
    objects.emplace_back().file = source;
  } else {
    throw base::InvalidInput(source.string() +
                             ": is no folder, no mesh (off, obj, ply, stl, gltf, glb) and no list "
                             "of meshes (txt, csv)");
  }
  if (objects.empty()) throw base::InvalidInput(source.string() + ": holds no mesh");
  return objects;
}

// The configuration.

/// Gives out labels, each once.
class Labels {
 public:
  std::string unique(const std::string& wanted) {
    std::string label = wanted;
    for (int& count = counts_[wanted]; !used_.insert(label).second;) {
      label = wanted + '_' + std::to_string(++count + 1);
    }
    return label;
  }

 private:
  std::set<std::string> used_;
  std::map<std::string, int> counts_;
};

std::string absolute_text(const fs::path& file) {
  return base::path_text(fs::absolute(file).lexically_normal().string());
}

Json value_of(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  if (value.is_discarded() || !value.is_primitive() || value.is_null()) value = text;
  return value;
}

Json object_values(const DatasetRequest& request) {
  Json values = Json::array();
  Labels labels;
  for (const DatasetObject& object : request.objects) {
    const std::string name =
        object.name.empty() ? label_of(object.file.stem().string()) : object.name;
    std::vector<std::optional<double>> sizes(request.sizes.begin(), request.sizes.end());
    if (object.longest || sizes.empty()) sizes = {object.longest};
    for (const std::optional<double>& size : sizes) {
      const bool has_own_label = size && sizes.size() > 1;
      Json value;
      value["name"] =
          labels.unique(has_own_label ? name + '_' + base::shortest_decimal(*size) + 'm' : name);
      value["file"] = absolute_text(object.file);
      if (size) {
        value["size_m"] = *size;
      } else if (const auto unit =
                     object.meters_per_unit ? object.meters_per_unit : request.meters_per_unit) {
        value["meters_per_unit"] = *unit;
      }
      if (!object.license.empty()) value["license"] = object.license;
      values.push_back(std::move(value));
    }
  }
  return values;
}

Json hand_values(const DatasetRequest& request) {
  Json values = Json::array();
  Labels labels;
  for (const std::string& hand : request.hands) {
    const bool is_file = hand.find('/') != std::string::npos || fs::path(hand).has_extension();
    const std::string name = is_file ? fs::path(hand).stem().string() : hand;
    values.push_back(
        {{"name", labels.unique(label_of(name))}, {"hand", is_file ? absolute_text(hand) : hand}});
  }
  return values;
}

}  // namespace
}  // namespace dataset_request_parts

std::vector<DatasetObject> dataset_objects(std::span<const std::filesystem::path> sources) {
  std::vector<DatasetObject> all;
  for (const std::filesystem::path& source : sources) {
    for (DatasetObject& object : dataset_request_parts::objects_of(source)) {
      all.push_back(std::move(object));
    }
  }
  return all;
}

std::string dataset_config(const DatasetRequest& request) {
  using namespace dataset_request_parts;
  if (request.objects.empty()) throw base::InvalidInput("dataset: there are no objects");
  if (request.hands.empty()) throw base::InvalidInput("dataset: there are no hands");
  Json settings = {{"preset", request.preset},
                   {"count", request.grasps},
                   {"protocol", request.protocol},
                   {"margins", request.margins}};
  for (const auto& [name, value] : request.settings) settings[name] = value_of(value);
  const Json config = {
      {"experiment", kDatasetSlug},
      {"question", "Which grasps have these objects with these hands, and which of them hold?"},
      {"cell",
       "Grasps of one object with one hand, best first, each tested in physics; the grasp file is "
       "in the cell's folder."},
      {"seed", request.seed},
      {"settings", std::move(settings)},
      {"axes", {{"object", object_values(request)}, {"hand", hand_values(request)}}}};
  return config.dump(1) + '\n';
}

}  // namespace graspfit::experiments
