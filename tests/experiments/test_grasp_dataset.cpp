#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "graspfit/base/errors.hpp"
#include "graspfit/experiments/experiment_registry.hpp"
#include "graspfit/experiments/grasp_dataset.hpp"
#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace test_grasp_dataset {

using namespace graspfit;
using namespace graspfit::experiments;
using testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

std::vector<DatasetObject> objects_of(const fs::path& source) {
  return dataset_objects(std::array{source});
}

nlohmann::json objects_in(const DatasetRequest& request) {
  return nlohmann::json::parse(dataset_config(request)).at("axes").at("object");
}

DatasetRequest request_for(const std::vector<DatasetObject>& objects) {
  DatasetRequest request;
  request.objects = objects;
  request.hands = {"barrett"};
  return request;
}

}  // namespace

TEST_CASE("A folder gives all meshes in it, by their paths", "[experiments][dataset]") {
  const TemporaryFolder folder;
  for (const char* const name : {"b.STL", "a/z.off", "a/y.obj", "c.txt", "d.mtl", "e.glb"}) {
    write(folder.path() / name, "");
  }
  const auto objects = objects_of(folder.path());
  std::vector<std::string> names;
  for (const DatasetObject& object : objects) names.push_back(object.name);
  CHECK(names == std::vector<std::string>{"a_y", "a_z", "b", "e"});
  CHECK(objects[0].file == folder.path() / "a/y.obj");
}

TEST_CASE("Names of a data set's objects are labels, each of its own", "[experiments][dataset]") {
  const auto object = [](const char* file, const char* name = "") {
    DatasetObject made;
    made.file = file;
    made.name = name;
    return made;
  };
  const auto values = objects_in(request_for(
      {object("/x/a b.off"), object("/y/a b.obj"), object("/z/a_b_2.off"), object("/z/...off"),
       object(("/z/" + std::string(300, 'n') + ".off").c_str()), object("/z/q.off", "mug")}));
  std::vector<std::string> names;
  for (const auto& value : values) names.push_back(value.at("name"));
  CHECK(names[0] == "a_b");
  CHECK(names[1] == "a_b_2");
  CHECK(names[2] == "a_b_2_2");
  CHECK(names[4].size() <= 80);
  CHECK(names[5] == "mug");
  CHECK(values[0].at("file") == "/x/a b.off");
}

TEST_CASE("An object's own size comes before the request's sizes, and those before units",
          "[experiments][dataset]") {
  DatasetObject plain;
  plain.file = "/x/a.off";
  DatasetObject sized = plain;
  sized.longest = 0.3;
  DatasetObject with_unit = plain;
  with_unit.meters_per_unit = 0.01;
  DatasetRequest request = request_for({plain, sized, with_unit});
  request.meters_per_unit = 0.001;
  auto values = objects_in(request);
  REQUIRE(values.size() == 3);
  CHECK(values[0].at("meters_per_unit") == 0.001);
  CHECK(values[1].at("size_m") == 0.3);
  CHECK_FALSE(values[1].contains("meters_per_unit"));
  CHECK(values[2].at("meters_per_unit") == 0.01);
  request.sizes = {0.1, 0.2};
  values = objects_in(request);
  REQUIRE(values.size() == 5);
  CHECK(values[0].at("name") == "a_0.1m");
  CHECK(values[1].at("size_m") == 0.2);
  CHECK(values[2].at("size_m") == 0.3);
  CHECK_FALSE(values[0].contains("meters_per_unit"));
}

TEST_CASE("A data set's configuration is one of its experiment", "[experiments][dataset]") {
  const TemporaryFolder folder;
  DatasetObject object;
  object.file = folder.path() / "none.off";
  object.license = "CC BY 4.0";
  DatasetRequest request = request_for({object});
  request.protocol = kNoProtocol;
  request.settings = {{"resolution", "24"}, {"style", "power"}};
  const fs::path file = folder.path() / "dataset.config.json";
  write(file, dataset_config(request));
  const sweep::ExperimentConfig config = sweep::read_config(dataset_experiment(), file);
  CHECK(config.sweep.num_cells() == 1);
  CHECK(&find_experiment("dataset") == &dataset_experiment());
  // The mesh is not there: that is for the cell to say.
  CHECK_THROWS_AS(dataset_experiment().run(config.sweep.cell(0), folder.path() / "cell"),
                  sweep::MissingData);
  request.settings = {{"resolution", "0"}};
  write(file, dataset_config(request));
  CHECK_THROWS_WITH(sweep::read_config(dataset_experiment(), file),
                    testing::Contains("resolution"));
  CHECK_THROWS_AS(dataset_config({}), base::InvalidInput);
}

}  // namespace test_grasp_dataset
