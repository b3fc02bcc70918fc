#include "graspfit/hands/hand_io.hpp"

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/sha256.hpp"
#include "library/hand_assembly.hpp"
#include "model/findings.hpp"

namespace graspfit::hands {

namespace fs = std::filesystem;
using internal::Findings;

fs::path sidecar_file_of(const fs::path& description_file) {
  return fs::path(description_file).replace_extension(".graspfit.json");
}

HandReading read_hand(const fs::path& description_file) {
  Findings findings(Findings::AtFault::Throw);
  const internal::HandSources sources = internal::read_sources(description_file, findings);
  HandReading reading;
  reading.description = sources.sidecar.description;
  reading.model = *internal::assemble(sources, findings);
  reading.findings = findings.list();
  return reading;
}

HandModel read_hand_model(const fs::path& description_file) {
  return read_hand(description_file).model;
}

std::string derived_sidecar_text(const fs::path& description_file) {
  Findings findings(Findings::AtFault::Throw);
  const internal::HandSources sources = internal::read_sources(description_file, findings);
  return internal::completed_sidecar_text(sources, findings);
}

std::vector<std::string> link_mesh_hashes(const HandModel& hand) {
  const fs::path folder = fs::weakly_canonical(hand.description_file).parent_path();
  std::vector<std::string> hashes;
  for (const Link& link : hand.links) {
    std::string bytes;
    for (const std::string& file : link.mesh_files) bytes += base::read_file(folder / file);
    hashes.push_back(link.mesh_files.empty() ? std::string() : base::sha256_hex(bytes));
  }
  return hashes;
}

}  // namespace graspfit::hands
