#include "io/recorded_hand.hpp"

#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"
#include "graspfit/hands/hand_io.hpp"
#include "graspfit/hands/hand_library.hpp"

namespace graspfit::grasp::internal {
namespace {

namespace fs = std::filesystem;

fs::path find_description(const RecordedHand& record, const fs::path& grasp_folder) {
  const fs::path recorded = record.description_file;
  const auto is_it = [&record](const fs::path& file) {
    std::error_code error;
    return fs::is_regular_file(file, error) &&
           base::sha256_hex(base::read_file(file)) == record.description_sha256;
  };
  if (is_it(recorded)) return recorded;
  if (recorded.is_relative() && is_it(grasp_folder / recorded)) return grasp_folder / recorded;
  if (is_it(grasp_folder / recorded.filename())) return grasp_folder / recorded.filename();
  for (const std::string& name : hands::shipped_hands()) {
    const fs::path shipped = hands::shipped_hand_file(name);
    if (shipped.filename() == recorded.filename() && is_it(shipped)) return shipped;
  }
  throw base::IoError("the hand description " + record.description_file + " with SHA-256 " +
                      record.description_sha256 +
                      " is neither there, nor beside the grasp file, nor among the shipped "
                      "hands");
}

void check_hash(const std::string& what, const std::string& found, const std::string& recorded) {
  if (found == recorded) return;
  throw base::IoError(what + " is not the one recorded: its SHA-256 is " +
                      (found.empty() ? "none" : found) + ", not " +
                      (recorded.empty() ? "none" : recorded));
}

}  // namespace

hands::HandModel read_recorded_hand(const RecordedHand& record, const fs::path& grasp_folder) {
  hands::HandModel hand = hands::read_hand_model(find_description(record, grasp_folder));
  check_hash(hand.sidecar_file.empty() ? "what is derived from " + hand.description_file
                                       : "the sidecar " + hand.sidecar_file,
             hand.sidecar_sha256, record.sidecar_sha256);
  const std::vector<std::string> hashes = hands::link_mesh_hashes(hand);
  if (hashes.size() != record.link_mesh_sha256.size()) {
    throw base::IoError("the hand has " + std::to_string(hashes.size()) + " links, the record " +
                        std::to_string(record.link_mesh_sha256.size()));
  }
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    check_hash("the mesh of link " + hand.links[i].name, hashes[i], record.link_mesh_sha256[i]);
  }
  return hand;
}

}  // namespace graspfit::grasp::internal
