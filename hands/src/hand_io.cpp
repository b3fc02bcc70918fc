#include "graspfit/hands/hand_io.hpp"

#include "internal/derivation.hpp"
#include "internal/findings.hpp"
#include "internal/hand_assembly.hpp"
#include "internal/sidecar.hpp"

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
  const std::string description =
      sources.sidecar.description.empty()
          ? "Derived by graspfit from " + description_file.filename().string() +
                "; edit what is wrong, delete a member to derive it again."
          : sources.sidecar.description;
  return internal::sidecar_text(internal::completed(*sources.tree, sources.sidecar, findings),
                                sources.tree->name, description);
}

}  // namespace graspfit::hands
