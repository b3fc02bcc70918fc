#include "graspfit/sweep/data_needs.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "graspfit/sweep/data_files.hpp"

namespace graspfit::sweep {
namespace {

DataNeed file_need(const std::string& file) {
  const bool is_there = find_data_file(file).has_value();
  if (std::filesystem::path(file).is_absolute()) return {DataSource::OwnFile, file, is_there};
  const bool has_twin = packaged_twin(file).has_value();
  return {has_twin ? DataSource::DataFolderOrPackaged : DataSource::DataFolder, file, is_there};
}

void add_needs(const nlohmann::json& json, std::vector<DataNeed>& needs) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_structured()) {
      add_needs(value, needs);
    } else if (json.is_object() && value.is_string()) {
      const auto name = value.get<std::string>();
      const bool is_own_hand = key == "hand" && name.find('/') != std::string::npos;
      if (key == "file" || is_own_hand) needs.push_back(file_need(name));
      if (key == "shape") needs.push_back({DataSource::BuiltIn, name, true});
      if (key == "packaged") {
        const bool is_there = find_packaged_mesh(name).has_value();
        needs.push_back({DataSource::Packaged, name, is_there});
      }
    }
  }
}

}  // namespace

std::vector<DataNeed> data_needs(const std::string& settings) {
  std::vector<DataNeed> needs;
  add_needs(nlohmann::json::parse(settings), needs);
  return needs;
}

bool has_all_data(const std::string& settings) {
  const std::vector<DataNeed> needs = data_needs(settings);
  return std::all_of(needs.begin(), needs.end(),
                     [](const DataNeed& need) { return need.is_there; });
}

}  // namespace graspfit::sweep
