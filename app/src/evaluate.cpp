#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "command_line.hpp"
#include "commands.hpp"
#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"
#include "graspfit/geometry/mesh_query.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "text_table.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using geometry::shortest_decimal;

/// Largest difference of M that counts as the same. Poses are stored as quaternions, which moves
/// them by about 1e-16 m; M follows within about 1e-12.
constexpr double kTolerance = 1e-9;

Command evaluate_command() {
  Command command{
      "evaluate", "GRASPS.json",
      "Computes contacts and measures of every grasp in a file again, from the meshes of "
      "object and\nhand alone, and compares. The hashes of all files are checked first.\n",
      option_group("Options"), ""};
  add_option(command.options, "object", "FILE", std::nullopt,
             "the object's file, if it is no longer where the grasp file says");
  add_switch(command.options, "json", "print JSON instead of a table");
  return command;
}

/// What one grasp was and what it is computed to be.
struct Comparison {
  grasp::Grasp stored;
  grasp::Grasp computed;
  double m_difference = 0.0;
  double largest_difference = 0.0;  ///< Over M, M1, M2, M3 and, if as many, contact points [m].
  bool has_same_contacts = false;   ///< As many, on the same pads.
};

Comparison compare(const grasp::Grasp& stored, const grasp::Grasp& computed) {
  Comparison comparison{stored, computed};
  const grasp::ContactQuality& a = stored.quality;
  const grasp::ContactQuality& b = computed.quality;
  comparison.m_difference = std::abs(a.m - b.m);
  comparison.largest_difference = std::max({comparison.m_difference, std::abs(a.m1 - b.m1),
                                            std::abs(a.m2 - b.m2), std::abs(a.m3 - b.m3)});
  comparison.has_same_contacts =
      std::equal(stored.contacts.begin(), stored.contacts.end(), computed.contacts.begin(),
                 computed.contacts.end(),
                 [](const grasp::Contact& s, const grasp::Contact& c) { return s.pad == c.pad; });
  if (comparison.has_same_contacts) {
    for (std::size_t i = 0; i < stored.contacts.size(); ++i) {
      comparison.largest_difference =
          std::max(comparison.largest_difference,
                   (stored.contacts[i].point_O - computed.contacts[i].point_O).norm());
    }
  }
  return comparison;
}

/// The object's file: where the user says, where the record says, or beside the grasp file.
std::filesystem::path find_object(const Flags& flags, const grasp::ObjectRecord& record) {
  if (flags.has("object")) return flags.text("object");
  const std::filesystem::path file = record.file;
  const std::filesystem::path beside =
      std::filesystem::path(flags.positional()).parent_path() / file.filename();
  std::error_code error;
  for (const std::filesystem::path& candidate : {file, beside}) {
    if (std::filesystem::exists(candidate, error)) return candidate;
  }
  throw geometry::IoError("the object's file " + record.file +
                          " is not there; --object FILE says where it is");
}

std::string table_of(const std::vector<Comparison>& comparisons) {
  std::vector<std::vector<std::string>> rows = {{"rank", "M stored", "M", "M1", "M2", "M3",
                                                 "contacts", "gap_mm", "penetration_mm", "valid",
                                                 "difference"}};
  for (const Comparison& comparison : comparisons) {
    const grasp::Grasp& grasp = comparison.computed;
    rows.push_back({std::to_string(rows.size()), fixed_decimal(comparison.stored.quality.m, 6),
                    fixed_decimal(grasp.quality.m, 6), fixed_decimal(grasp.quality.m1, 4),
                    fixed_decimal(grasp.quality.m2, 4), fixed_decimal(grasp.quality.m3, 4),
                    std::to_string(grasp.contacts.size()),
                    fixed_decimal(1000.0 * grasp::largest_contact_gap(grasp), 3),
                    fixed_decimal(1000.0 * grasp::largest_penetration(grasp), 3),
                    grasp.is_valid() ? "yes" : "no",
                    shortest_decimal(comparison.largest_difference)});
  }
  return text_table(rows);
}

std::string json_of(const std::vector<Comparison>& comparisons, double largest_m_difference) {
  const auto quality = [](const grasp::Grasp& grasp) {
    return "{\"m\": " + shortest_decimal(grasp.quality.m) +
           ", \"m1\": " + shortest_decimal(grasp.quality.m1) +
           ", \"m2\": " + shortest_decimal(grasp.quality.m2) +
           ", \"m3\": " + shortest_decimal(grasp.quality.m3) +
           ", \"num_contacts\": " + std::to_string(grasp.contacts.size()) +
           ", \"largest_contact_gap_m\": " + shortest_decimal(grasp::largest_contact_gap(grasp)) +
           ", \"largest_penetration_m\": " + shortest_decimal(grasp::largest_penetration(grasp)) +
           ", \"usable\": " + (grasp.is_usable() ? "true" : "false") +
           ", \"valid\": " + (grasp.is_valid() ? "true" : "false") + "}";
  };
  std::string text = "{\n  \"largest_m_difference\": " + shortest_decimal(largest_m_difference) +
                     ",\n  \"grasps\": [";
  const char* separator = "\n";
  for (const Comparison& comparison : comparisons) {
    text += separator + std::string("    {\"stored\": ") + quality(comparison.stored) +
            ",\n     \"computed\": " + quality(comparison.computed) +
            ",\n     \"same_contacts\": " + (comparison.has_same_contacts ? "true" : "false") +
            ", \"largest_difference\": " + shortest_decimal(comparison.largest_difference) + "}";
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace

ExitCode run_evaluate(const std::vector<std::string>& arguments) {
  const Command command = evaluate_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const grasp::GraspFile file = grasp::read_grasps(flags.positional());
  const geometry::TriangleMesh mesh =
      grasp::read_object(file.object, find_object(flags, file.object));
  const geometry::MeshQuery object(mesh);
  const hands::HandCollision collision(file.hand);
  const grasp::QualityContext context = grasp::quality_context(file, mesh);
  grasp::RequestedParts requested;
  for (const std::string& name : file.fingers) {
    requested.fingers.push_back(file.hand.finger_index(name));
  }
  const grasp::SurroundingsCollision surroundings(file.hand, {});
  const grasp::MeasuringScene scene{
      .hand = file.hand,
      .collision = collision,
      .object = object,
      .surroundings = surroundings,
      .wrench_object = grasp::wrench_object(mesh, context.center_of_mass_O),
      .quality_context = context,
      .quality_options = grasp::quality_options(file),
      .contact_options = grasp::contact_options(file)};

  std::vector<Comparison> comparisons;
  double largest_m_difference = 0.0;
  for (const grasp::Grasp& stored : file.grasps) {
    comparisons.push_back(
        compare(stored, grasp::measure_grasp(scene, stored.configuration, requested)));
    largest_m_difference = std::max(largest_m_difference, comparisons.back().m_difference);
  }
  if (flags.has("json")) {
    std::fputs(json_of(comparisons, largest_m_difference).c_str(), stdout);
  } else {
    std::printf("%slargest difference of M: %s\n", table_of(comparisons).c_str(),
                shortest_decimal(largest_m_difference).c_str());
  }
  if (largest_m_difference <= kTolerance) return kSuccess;
  std::fprintf(stderr, "graspfit evaluate: %s: M differs by %s, more than %s\n",
               flags.positional().c_str(), shortest_decimal(largest_m_difference).c_str(),
               shortest_decimal(kTolerance).c_str());
  return kDiffers;
}

}  // namespace graspfit::app
