#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/grasp/grasp_diversity.hpp"
#include "graspfit/grasp/grasp_file_metrics.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/grasp/grasp_metric.hpp"
#include "input/object_loading.hpp"
#include "input/recorded_files.hpp"
#include "output/grasp_text.hpp"
#include "output/metric_report.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;

/// Largest difference of M, epsilon and gaps [m] that counts as the same. Poses are stored as
/// quaternions, which moves them by about 1e-16 m; the measures follow within about 1e-12.
constexpr double kTolerance = 1e-9;

/// Distances by which the diversity of a file's grasps is measured.
constexpr grasp::DistinctOptions kDistinct;

Command evaluate_command() {
  Command command{
      "evaluate", "GRASPS.json",
      "Computes contacts, M, epsilon, gaps and penetration of every grasp in a file again, from "
      "the "
      "meshes\nof object, obstacles and hand alone, and compares; then prints metrics of each "
      "grasp. The hashes of\nall files are checked first.\n",
      option_group("Options"),
      "The same: M, epsilon and the largest gap of a requested contact within 1e-9, and equal "
      "answers to\nwhether every requested contact is there and whether the hand meets object, "
      "itself or surroundings.\n\nMetrics:\n" +
          metrics_help()};
  add_object_flag(command.options);
  add_option(command.options, "metrics", "NAME,...", "all",
             "metrics to print, of those below; all or none");
  add_option(command.options, "convention", grasp::names_of<contact::WrenchTool>(), "graspfit",
             "whose wrench convention metrics are in");
  add_switch(command.options, "json", "print JSON instead of tables");
  add_switch(command.options, "csv", "print metrics as CSV, a row per grasp and metric");
  return command;
}

/// The metrics that --metrics asks for.
grasp::GraspMetrics metrics_of(const Flags& flags) {
  const grasp::GraspMetrics& all = grasp::grasp_metrics();
  const std::vector<std::string> names = flags.words("metrics");
  if (names == std::vector<std::string>{"all"}) return all;
  if (names == std::vector<std::string>{"none"}) return {};
  try {
    return all.selected(names);
  } catch (const base::InvalidInput& error) {
    throw UsageError(std::string("--metrics: ") + error.what());
  }
}

/// A grasp as stored and as computed again.
struct Comparison {
  grasp::Grasp stored;
  grasp::Grasp computed;
  double m_difference = 0.0;
  double epsilon_difference = 0.0;
  double gap_difference = 0.0;  ///< Of the largest requested gap [m].
  /// Largest difference of M, epsilon, gap, M1, M2, M3 and, if the contacts are the same, their
  /// points [m].
  double largest_difference = 0.0;
  bool has_same_contacts = false;  ///< Equally many, on the same pads.
  bool has_same_answers = false;   ///< In all that makes a grasp valid, except M.

  bool is_same() const {
    return m_difference <= kTolerance && epsilon_difference <= kTolerance &&
           gap_difference <= kTolerance && has_same_answers;
  }
};

/// The difference in words, for the first grasp that differs.
std::string difference_text(const Comparison& comparison) {
  if (comparison.m_difference > kTolerance) {
    return "M differs by " + shortest_decimal(comparison.m_difference);
  }
  if (comparison.epsilon_difference > kTolerance) {
    return "epsilon differs by " + shortest_decimal(comparison.epsilon_difference);
  }
  if (comparison.gap_difference > kTolerance) {
    return "the largest gap differs by " + shortest_decimal(comparison.gap_difference) + " m";
  }
  return "what it touches differs";
}

Comparison compare(const grasp::Grasp& stored, const grasp::Grasp& computed) {
  Comparison comparison{stored, computed};
  const contact::ContactQuality& a = stored.quality;
  const contact::ContactQuality& b = computed.quality;
  comparison.m_difference = std::abs(a.m - b.m);
  comparison.epsilon_difference = std::abs(stored.epsilon() - computed.epsilon());
  comparison.gap_difference =
      std::abs(grasp::largest_requested_gap(stored) - grasp::largest_requested_gap(computed));
  comparison.largest_difference =
      std::max({comparison.m_difference, std::abs(a.m1 - b.m1), std::abs(a.m2 - b.m2),
                std::abs(a.m3 - b.m3), comparison.epsilon_difference, comparison.gap_difference});
  const auto answers = [](const grasp::Grasp& grasp) {
    const grasp::GraspPenetration& penetration = grasp.penetration;
    return std::array{grasp.has_all_contacts, penetration.object_intersects,
                      penetration.self_intersects, penetration.surroundings_touched};
  };
  comparison.has_same_answers = answers(stored) == answers(computed);
  comparison.has_same_contacts = std::equal(
      stored.contacts.begin(), stored.contacts.end(), computed.contacts.begin(),
      computed.contacts.end(),
      [](const contact::Contact& s, const contact::Contact& c) { return s.pad == c.pad; });
  if (comparison.has_same_contacts) {
    for (std::size_t i = 0; i < stored.contacts.size(); ++i) {
      comparison.largest_difference =
          std::max(comparison.largest_difference,
                   (stored.contacts[i].point_O - computed.contacts[i].point_O).norm());
    }
  }
  return comparison;
}

std::string table_of(const std::vector<Comparison>& comparisons) {
  std::vector<std::vector<std::string>> rows = {{"rank", "M stored", "M", "M1", "M2", "M3",
                                                 "epsilon stored", "epsilon", "contacts", "gap_mm",
                                                 "penetration_mm", "valid", "difference"}};
  for (const Comparison& comparison : comparisons) {
    const grasp::Grasp& grasp = comparison.computed;
    rows.push_back({std::to_string(rows.size()), fixed_decimal(comparison.stored.quality.m, 6),
                    fixed_decimal(grasp.quality.m, 6), fixed_decimal(grasp.quality.m1, 4),
                    fixed_decimal(grasp.quality.m2, 4), fixed_decimal(grasp.quality.m3, 4),
                    epsilon_text(comparison.stored, 6), epsilon_text(grasp, 6),
                    std::to_string(grasp.contacts.size()),
                    fixed_decimal(1000.0 * grasp::largest_requested_gap(grasp), 4),
                    fixed_decimal(1000.0 * grasp::largest_penetration(grasp), 3),
                    grasp.is_valid() ? "yes" : "no",
                    shortest_decimal(comparison.largest_difference)});
  }
  return text_table(rows);
}

grasp::GraspDiversity diversity_of(const grasp::GraspFile& file) {
  std::vector<hands::HandConfiguration> configurations;
  for (const grasp::Grasp& grasp : file.grasps) configurations.push_back(grasp.configuration);
  return grasp::grasp_diversity(file.hand, configurations, kDistinct);
}

/// The distances that tell clusters apart, as text.
std::string distances_text() {
  const auto number = [](double value) { return significant_decimal(value, 4); };
  return number(kDistinct.translation) + " m, " + number(kDistinct.rotation) + " rad, joints " +
         number(kDistinct.joints) + " rad or " + number(kDistinct.joints * kDistinct.slide_scale) +
         " m";
}

std::string text_of(const grasp::GraspDiversity& diversity) {
  return "diversity: " + std::to_string(diversity.num_clusters) + " clusters of " +
         std::to_string(diversity.num_grasps) + " grasps (apart by " + distances_text() +
         "); variance along the first principal axis: " +
         (diversity.first_axis_share ? fixed_decimal(*diversity.first_axis_share, 4)
                                     : std::string("none")) +
         "\n";
}

std::string json_of(const grasp::GraspDiversity& diversity) {
  return "{\"num_grasps\": " + std::to_string(diversity.num_grasps) +
         ", \"num_clusters\": " + std::to_string(diversity.num_clusters) +
         ", \"first_axis_share\": " +
         (diversity.first_axis_share ? shortest_decimal(*diversity.first_axis_share)
                                     : std::string("null")) +
         ", \"convention\": \"apart by " + distances_text() + "\"}";
}

std::string json_of(const std::vector<Comparison>& comparisons, double largest_m_difference,
                    const grasp::GraspDiversity& diversity, const MetricReport& metrics) {
  const auto quality = [](const grasp::Grasp& grasp) {
    return "{\"m\": " + shortest_decimal(grasp.quality.m) +
           ", \"m1\": " + shortest_decimal(grasp.quality.m1) +
           ", \"m2\": " + shortest_decimal(grasp.quality.m2) +
           ", \"m3\": " + shortest_decimal(grasp.quality.m3) +
           ", \"num_contacts\": " + std::to_string(grasp.contacts.size()) +
           ", \"epsilon\": " + shortest_decimal(grasp.epsilon()) +
           ", \"largest_requested_gap_m\": " +
           shortest_decimal(grasp::largest_requested_gap(grasp)) +
           ", \"largest_contact_gap_m\": " + shortest_decimal(grasp::largest_contact_gap(grasp)) +
           ", \"largest_penetration_m\": " + shortest_decimal(grasp::largest_penetration(grasp)) +
           ", \"surroundings_touched\": " +
           (grasp.penetration.surroundings_touched ? "true" : "false") +
           ", \"usable\": " + (grasp.is_usable() ? "true" : "false") +
           ", \"valid\": " + (grasp.is_valid() ? "true" : "false") + "}";
  };
  std::string text = "{\n  \"largest_m_difference\": " + shortest_decimal(largest_m_difference) +
                     ",\n  \"diversity\": " + json_of(diversity) + ",\n  \"grasps\": [";
  const char* separator = "\n";
  for (const Comparison& comparison : comparisons) {
    text += separator + std::string("    {\"stored\": ") + quality(comparison.stored) +
            ",\n     \"computed\": " + quality(comparison.computed) +
            ",\n     \"same_contacts\": " + (comparison.has_same_contacts ? "true" : "false") +
            ", \"same\": " + (comparison.is_same() ? "true" : "false") +
            ", \"largest_difference\": " + shortest_decimal(comparison.largest_difference) +
            ",\n     \"metrics\": " +
            metrics.json(static_cast<std::size_t>(&comparison - comparisons.data())) + "}";
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
  if (flags.has("json") && flags.has("csv"))
    throw UsageError("--json and --csv exclude each other");
  MetricReport metrics(metrics_of(flags));
  const auto tool = flags.choice<contact::WrenchTool>("convention");
  const grasp::GraspFile file = grasp::read_grasps(flags.positional());
  const geometry::TriangleMesh mesh = load_recorded_object(flags, file);
  warn_of_differences("evaluate", file.object, file.surroundings.obstacles);
  const grasp::RecordedScene scene(file, mesh,
                                   load_recorded_surroundings(file, flags.positional()));

  std::vector<Comparison> comparisons;
  double largest_m_difference = 0.0;
  for (const grasp::Grasp& stored : file.grasps) {
    comparisons.push_back(compare(stored, scene.measure(stored)));
    largest_m_difference = std::max(largest_m_difference, comparisons.back().m_difference);
  }
  const geometry::MeshQuery surface(mesh);
  const grasp::GraspFileMetrics facts(file, surface, tool);
  for (const Comparison& comparison : comparisons) {
    metrics.add(grasp::GraspMetricInput(facts.facts(comparison.computed)));
  }
  if (flags.has("json")) {
    std::fputs(json_of(comparisons, largest_m_difference, diversity_of(file), metrics).c_str(),
               stdout);
  } else if (flags.has("csv")) {
    std::fputs(metrics.csv().c_str(), stdout);
  } else {
    std::printf("%slargest difference of M: %s\n", table_of(comparisons).c_str(),
                shortest_decimal(largest_m_difference).c_str());
    if (!metrics.is_empty()) {
      std::printf("%s\n%s", metrics.tables().c_str(), text_of(diversity_of(file)).c_str());
    }
  }
  const auto different =
      std::find_if_not(comparisons.begin(), comparisons.end(),
                       [](const Comparison& comparison) { return comparison.is_same(); });
  if (different == comparisons.end()) return kSuccess;
  std::fprintf(stderr, "graspfit evaluate: %s: grasp %td: %s\n", flags.positional().c_str(),
               different - comparisons.begin() + 1, difference_text(*different).c_str());
  return kDiffers;
}

}  // namespace graspfit::app
