// The program writes the inputs from which fuzzing starts: write_seeds FOLDER.
#include <cstdio>
#include <filesystem>

#include "graspfit/base/atomic_file.hpp"
#include "seeds.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: graspfit_write_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  for (const auto& [name, input] : graspfit::testing::seeds()) {
    graspfit::base::write_file_atomically(folder / name, input);
  }
}
