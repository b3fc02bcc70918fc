#include "graspfit/sweep/run_manifest.hpp"

#include <sys/utsname.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "build_source.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/json_bounds.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/sweep/column_dictionary.hpp"
#include "run/sweep_tables.hpp"

namespace graspfit::sweep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

Json machine() {
  utsname system{};
  ::uname(&system);
  return {{"system", std::string(system.sysname) + ' ' + system.release + ' ' + system.machine},
          {"processor", processor_name()},
          {"num_processors", std::thread::hardware_concurrency()}};
}

/// Returns a text as one word of the shell, quoted if it has characters that are special there.
std::string shell_word(const std::string& text) {
  constexpr const char* kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.,:/=+@%-";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// What git prints in a repository, and whether it ended well.
struct GitAnswer {
  bool is_success = false;
  std::string output;
};
GitAnswer git(const fs::path& repository, const std::string& arguments) {
  const std::string command =
      "git -C " + shell_word(repository.string()) + ' ' + arguments + " 2>/dev/null";
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  GitAnswer answer;
  std::array<char, 4096> buffer;
  for (std::size_t count; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    answer.output.append(buffer.data(), count);
  }
  answer.is_success = ::pclose(pipe) == 0;
  return answer;
}

[[noreturn]] void refuse(const std::string& why) {
  throw base::InvalidInput("results are not published: " + why);
}

}  // namespace

BuildSource build_source() { return {kBuildCommit, kIsBuildClean}; }

std::string program_sha256() {
  static const std::string hash = [] {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return error ? "" : base::sha256_of_file(program);
  }();
  return hash;
}

std::string recorded_command(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--out") {
      ++i;  // and the folder that follows
    } else if (words[i].rfind("--out=", 0) != 0) {
      text += (text.empty() ? "" : " ") + shell_word(words[i]);
    }
  }
  return text;
}

std::string to_json(const RunManifest& manifest, const ExperimentConfig& config,
                    const std::string& status_counts_json) {
  Json versions;
  for (const auto& [name, version] : manifest.versions) versions[name] = version;
  Json json = {{"experiment", config.sweep.experiment},
               {"command", manifest.command},
               {"cells", Json::parse(status_counts_json)},
               {"config",
                {{"file", fs::path(config.file).filename().string()},
                 {"sha256", config.sha256},
                 {"is_quick", config.is_quick},
                 {"is_modified", config.is_modified},
                 {"as_run", Json::parse(config.identity())}}},
               {"seed", config.sweep.base_seed},
               {"commit", manifest.source.commit},
               {"is_commit_clean", manifest.source.is_clean},
               {"program_sha256", manifest.program},
               {"versions", versions},
               {"machine", machine()},
               {"inputs_sha256", Json(manifest.inputs)}};
  if (!manifest.tables.empty()) json["tables_sha256"] = Json(manifest.tables);
  for (const std::string& text : manifest.shards) {
    const Json shard = Json::parse(text);
    Json& part = json["shards"].emplace_back();
    for (const char* const key : {"command", "cells", "machine"}) part[key] = shard.at(key);
  }
  return json.dump(2) + '\n';
}

void require_publishable(const ExperimentConfig& config, const fs::path& sources) {
  if (config.is_quick) refuse("--quick runs a few cells only");
  if (!config.left_out.empty()) refuse("data are not there: " + config.left_out);
  if (config.is_modified) refuse("--set and --object change the configuration");
  std::error_code error;
  const fs::path configs = sources / "experiments/configs";
  if (!fs::equivalent(fs::path(config.file).parent_path(), configs, error)) {
    refuse("the configuration " + config.file + " is not one of " + configs.string());
  }
  const BuildSource built = build_source();
  if (built.commit.empty() || !built.is_clean) {
    refuse("the program was not built from a clean commit; commit, build again and run again");
  }
  // What publishing itself writes is left aside, as in write_build_source.cmake.
  constexpr const char* kAside = " -- . ':(exclude)notebooks-data' ':(exclude)paper-figures/data'";
  const GitAnswer untracked =
      git(sources, std::string("ls-files --others --exclude-standard") + kAside);
  if (!untracked.is_success) refuse(sources.string() + " is not under version control");
  if (!untracked.output.empty()) {
    refuse(sources.string() + " has files that are not committed: " +
           untracked.output.substr(0, untracked.output.find('\n')));
  }
  const GitAnswer changed = git(sources, "diff --name-only " + built.commit + kAside);
  if (!changed.is_success) refuse("commit " + built.commit + " is not in " + sources.string());
  if (!changed.output.empty()) {
    refuse(sources.string() + " is no longer what the program was built from (" + built.commit +
           "): " + changed.output.substr(0, changed.output.find('\n')));
  }
}

void require_publishable_manifest(const fs::path& manifest) {
  const Json json = Json::parse(base::read_json_file(manifest), nullptr, false);
  const auto has_object = [&](const char* name) {
    return json.is_object() && json.contains(name) && json.at(name).is_object();
  };
  if (!has_object("cells") || !has_object("inputs_sha256")) {
    refuse(manifest.string() + " is damaged");
  }
  if (const auto skipped = json.at("cells").value("skipped", std::size_t{0}); skipped > 0) {
    refuse(std::to_string(skipped) + " cells were skipped for want of data");
  }
  if (const auto count = json.at("cells").value("not_final", std::size_t{0}); count > 0) {
    refuse(std::to_string(count) + " cells failed for a reason that may pass (files, memory); " +
           "run the experiment again");
  }
  for (const auto& [file, hash] : json.at("inputs_sha256").items()) {
    if (!fs::path(file).is_absolute()) continue;
    refuse("input " + file + " lies neither in the data folder nor among the sources");
  }
}

void require_tables_of_manifest(const fs::path& manifest) {
  const Json json = Json::parse(base::read_json_file(manifest), nullptr, false);
  if (!json.is_object()) throw base::InvalidInput(manifest.string() + ": is damaged");
  if (!json.contains("tables_sha256")) return;
  for (const auto& [name, hash] : json.at("tables_sha256").items()) {
    const fs::path table = manifest.parent_path() / name;
    if (hash == Json(base::sha256_of_file(table))) continue;
    throw base::InvalidInput(table.string() + ": is not the table that " +
                             manifest.filename().string() +
                             " was written for (tables_sha256); run or publish it again");
  }
}

void publish(const Experiment& experiment, const ExperimentConfig& config, const fs::path& folder,
             const fs::path& sources, const fs::path& published) {
  require_publishable(config, sources);
  const fs::path manifest = folder / (experiment.slug + ".manifest.json");
  require_publishable_manifest(manifest);
  require_tables_of_manifest(manifest);
  std::error_code error;
  fs::create_directories(published, error);
  if (error) throw base::IoError(published.string() + ": " + error.message());
  const auto copy = [&](const std::string& name) {
    base::write_file_atomically(published / name, base::read_file(folder / name));
  };
  for (const std::string& name : internal::table_names(experiment)) copy(name);
  base::write_file_atomically(published / (experiment.slug + ".columns.json"),
                              column_dictionary(experiment, config));
  copy(manifest.filename().string());  // last: until then its hashes are not those of the tables
}

}  // namespace graspfit::sweep
