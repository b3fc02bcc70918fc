#include "output/dataset_archive.hpp"

#include <array>
#include <system_error>
#include <vector>

#include "cli/interrupts.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 6> kNeeded = {
    "CARD.md",     "dataset.columns.json", "dataset.config.json",
    "dataset.csv", "dataset.details.csv",  "dataset.manifest.json"};
constexpr std::array<const char*, 2> kFolders = {"arrays", "cells"};  // none without grasps

std::vector<std::string> members_of(const fs::path& folder) {
  std::error_code error;
  const std::string name = fs::absolute(folder).filename().string();
  std::vector<std::string> members;
  for (const char* const file : kNeeded) {
    if (!fs::is_regular_file(folder / file, error)) {
      throw base::InvalidInput(folder.string() + ": has no " + file +
                               ": no finished data set; graspfit dataset run or merge makes it so");
    }
    members.push_back(name + '/' + file);
  }
  for (const char* const part : kFolders) {
    if (fs::is_directory(folder / part, error)) members.push_back(name + '/' + part);
  }
  return members;
}

/// Runs GNU tar, which every Debian has.
void run_tar(const fs::path& parent, const std::vector<std::string>& members,
             const fs::path& archive) {
  std::vector<std::string> command = {"tar",
                                      "--create",
                                      "--format=gnu",
                                      "--sort=name",
                                      "--mtime=@0",
                                      "--owner=0",
                                      "--group=0",
                                      "--numeric-owner",
                                      "--mode=u=rwX,go=rX",
                                      "--use-compress-program=gzip -n",
                                      "--file=" + fs::absolute(archive).string(),
                                      "--force-local",
                                      "--directory=" + parent.string(),
                                      "--"};
  command.insert(command.end(), members.begin(), members.end());
  const ProgramEnd end = run_program(command);
  if (end.code != 0) {
    throw base::IoError(archive.string() +
                        ": tar failed: " + end.errors.substr(0, end.errors.find('\n')));
  }
}

}  // namespace

DatasetArchive pack_dataset(const fs::path& folder, const fs::path& archive) {
  const std::vector<std::string> members = members_of(folder);
  fs::path partial = archive;
  partial += ".part";
  const auto remove_partial = [&] {
    std::error_code ignored;
    fs::remove(partial, ignored);
  };
  const CleanupOnInterrupt cleanup(remove_partial);
  DatasetArchive packed;
  packed.file = archive;
  packed.card = archive;
  packed.card += ".card.md";
  try {
    run_tar(fs::absolute(folder).parent_path(), members, partial);
    packed.size = static_cast<std::int64_t>(fs::file_size(partial));
    packed.sha256 = base::sha256_of_file(partial);
    const std::string card = base::read_file(folder / "CARD.md") + "\n## Archive\n\n`" +
                             archive.filename().string() + "`, " + std::to_string(packed.size) +
                             " bytes, SHA-256 `" + packed.sha256 + "`.\n";
    fs::rename(partial, archive);
    base::write_file_atomically(packed.card, card);
  } catch (const fs::filesystem_error& error) {
    remove_partial();
    throw base::IoError(archive.string() + ": " + error.code().message());
  } catch (const base::Error&) {
    remove_partial();
    throw;
  }
  return packed;
}

}  // namespace graspfit::app
