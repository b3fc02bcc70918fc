#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "graspfit/base/atomic_file.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/base/path_text.hpp"
#include "graspfit/base/units.hpp"
#include "graspfit/grasp/grasp_diversity.hpp"
#include "graspfit/grasp/grasp_io.hpp"
#include "graspfit/hold_test/hold_batch.hpp"
#include "input/grasp_sets.hpp"
#include "input/hold_flags.hpp"
#include "input/imported_files.hpp"
#include "input/object_loading.hpp"
#include "input/recorded_files.hpp"
#include "output/comparison.hpp"
#include "output/comparison_chart.hpp"
#include "output/output_folder.hpp"
#include "output/progress_bar.hpp"

namespace graspfit::app {
namespace {

namespace po = boost::program_options;
using base::shortest_decimal;

constexpr const char* kCompareTable = "compare.csv";
constexpr const char* kComparePicture = "compare.svg";

Command compare_command() {
  Command command{
      "compare",
      "A",
      "Compares two sets of grasps on the same objects. A and B are each a grasp file, a folder "
      "with "
      "any number\nof grasps.json in it and below it, or another tool's file: isaac_grasp (.yaml) "
      "or "
      "arrays under\nDexGraspBench's names (.npz), for which --hand and --object say whose they "
      "are.\n",
      option_group(),
      "Everything is measured again from the meshes, of both sides by the same friction, accepted "
      "gap "
      "and other\nsettings: those of A's file of the object, if B's has others. Only contacts "
      "within "
      "the accepted gap bear\nforces, of other tools' grasps too. Rates have their two-sided 95 % "
      "intervals behind them.\n"
      "  touching  every part that must touch has contact within the accepted gap\n"
      "  clear     the hand enters neither object, itself nor surroundings, exactly\n"
      "  valid     both, M above 0, and a free way from an open hand to the grasp\n"
      "  closed    force closure at the friction of epsilon; of others epsilon counts as 0\n"
      "  held      in the physics test, by the file's own pre-grasp and squeeze\n"
      "Clusters are grasps that differ little from the next one, as of evaluate; times are those "
      "recorded when\nthe grasps were planned. Objects are the same if their files have the same "
      "bytes "
      "and the same size.\n",
      "B"};
  po::options_description general = option_group("Options");
  add_option(general, "protocol", "NAME", hold_test::hold_protocol_names().front(),
             "of the physics test: " + base::list_text(hold_test::hold_protocol_names(), {}, "|"));
  add_switch(general, "no-hold", "leave the physics test out");
  add_option(general, "margins", "N", "0",
             "smallest force and torque that fail, of the first N grasps of each file");
  add_option(general, "jobs", "INTEGER", "0",
             "grasps tested side by side; 0: as many as the machine has processors; the verdicts "
             "do not depend on it");
  add_option(
      general, "out", "DIR", std::nullopt,
      "write compare.csv, a row for each side and object, and the picture compare.svg there");
  add_option(
      general, "object", "FILE", std::nullopt,
      "of .yaml and .npz: the object; else its file, if it is no longer where the grasp files "
      "say");
  add_switch(general, "quiet", "no progress bar, no table and no notes");
  command.options.add(general).add(import_options());
  return command;
}

/// What the command is to do, without the files that it reads.
struct CompareRequest {
  std::optional<hold_test::HoldProtocol> protocol;  ///< Empty: no physics test.
  std::size_t num_margins = 0;
  int num_threads = 0;
  std::vector<std::string> notes;
};

CompareRequest read_compare_request(const Flags& flags) {
  CompareRequest request;
  const hold_test::HoldProtocol protocol = hold_protocol_named("protocol", flags.text("protocol"));
  request.num_margins = static_cast<std::size_t>(flags.integer("margins", base::at_least(0)));
  request.num_threads = flags.integer("jobs", base::at_least(0));
  const bool is_asked_for = request.num_margins > 0 || !flags.is_default("protocol");
  if (flags.has("no-hold")) {
    if (is_asked_for) {
      throw UsageError(std::string("--no-hold and --") +
                       (request.num_margins > 0 ? "margins" : "protocol") + " exclude each other");
    }
    return request;
  }
  if (request.num_margins > 0 && !protocol.has_margins()) {
    throw UsageError("--margins: protocol " + protocol.name +
                     " does not pull six ways from the same state");
  }
  if (!hold_test::is_available() && !is_asked_for) {
    request.notes.emplace_back("held is left out: this build has no physics engine");
    return request;
  }
  require_physics();
  request.protocol = protocol;
  return request;
}

/// Everything by which `RecordedScene` measures a grasp, but object, surroundings and the parts
/// that must touch, taken from `reference`, so that the grasps of `file` are measured as its are.
grasp::GraspFile measured_as(const grasp::GraspFile& reference, grasp::GraspFile file) {
  const grasp::PlannerOptions& from = reference.options;
  grasp::PlannerOptions& to = file.options;
  to.friction = from.friction;
  to.quality = from.quality;
  to.weak = from.weak;
  to.refine = from.refine;
  to.refinement.largest_gap = from.refinement.largest_gap;
  to.averaging = from.averaging;
  to.counted_pads = grasp::contact_estimation(from, reference.clip_thickness).pads;
  to.contact_pieces = from.contact_pieces;
  to.contact_faces = from.contact_faces;
  file.clip_thickness = reference.clip_thickness;
  file.merge_distance = reference.merge_distance;
  file.imported.reset();  // of imported grasps all contacts bear forces, whatever their gap
  return file;
}

bool has_same_weights(const contact::QualityOptions& a, const contact::QualityOptions& b) {
  return a.alpha == b.alpha && a.beta == b.beta && a.w1 == b.w1 && a.w2 == b.w2 && a.w3 == b.w3 &&
         a.theta_max == b.theta_max && a.units == b.units && a.regularity == b.regularity &&
         a.centroid == b.centroid;
}

/// How a file's grasps were measured otherwise than those of `reference`, in words; empty if alike.
std::string measuring_difference(const grasp::GraspFile& reference, const grasp::GraspFile& file) {
  const grasp::PlannerOptions& a = reference.options;
  const grasp::PlannerOptions& b = file.options;
  std::vector<std::string> words;
  if (a.friction != b.friction) words.push_back("friction " + shortest_decimal(b.friction));
  const auto gap_a = grasp::bearing_gap(a);
  const auto gap_b = grasp::bearing_gap(b);
  if (gap_a != gap_b) {
    words.push_back(gap_b ? "an accepted gap of " + base::plain_decimal(1000.0 * *gap_b) + " mm"
                          : "no accepted gap, as without refinement");
  }
  const auto contacts_a = grasp::contact_estimation(a, reference.clip_thickness);
  const auto contacts_b = grasp::contact_estimation(b, file.clip_thickness);
  if (contacts_a.pads != contacts_b.pads) {
    words.emplace_back(contacts_b.pads == contact::CountedPads::All ? "contacts of all pads"
                                                                    : "contacts of tips and palm");
  }
  if (contacts_a.clip_thickness != contacts_b.clip_thickness || a.averaging != b.averaging ||
      contacts_a.pieces != contacts_b.pieces || contacts_a.faces != contacts_b.faces) {
    words.emplace_back("other clip volumes");
  }
  if (!has_same_weights(a.quality, b.quality) || reference.merge_distance != file.merge_distance) {
    words.emplace_back("another M");
  }
  if (a.weak.has_value() != b.weak.has_value() ||
      (a.weak && a.weak->weak_thickness != b.weak->weak_thickness)) {
    words.emplace_back("other weak features");
  }
  return base::list_text(words);
}

/// Measures the grasps of both sides on one object after the other.
class Measuring {
 public:
  Measuring(const Flags& flags, const CompareRequest& request, ProgressBar& progress)
      : flags_(flags), request_(request), progress_(progress) {}

  /// Both sides are measured as A's first file of the object says.
  ComparedObject measure(const CommonObject& object) {
    const SetFile& reference = *object.files[0].front();
    progress_.clear();
    warn_of_differences("compare", reference.file.object, reference.file.surroundings.obstacles);
    ComparedObject compared{object.name, reference.file.object.sha256, {}};
    for (std::size_t side = 0; side < object.files.size(); ++side) {
      for (const SetFile* file : object.files[side]) note_differences(reference, *file);
      compared.sides[side] = measure(object.files[side], reference.file);
    }
    return compared;
  }

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void note_differences(const SetFile& reference, const SetFile& file) {
    const std::string difference = measuring_difference(reference.file, file.file);
    if (!difference.empty()) {
      notes_.push_back(file.path + " was measured with " + difference +
                       "; here it is measured as " + reference.path);
    }
    const grasp::ObjectRecord& a = reference.file.object;
    const grasp::ObjectRecord& b = file.file.object;
    const bool is_laid_alike = a.laid.has_value() == b.laid.has_value() &&
                               (!a.laid || (a.laid->rotation_wxyz == b.laid->rotation_wxyz &&
                                            a.laid->translation == b.laid->translation));
    if (!is_laid_alike && request_.protocol) {
      notes_.push_back(file.path + " has the object in another pose than " + reference.path +
                       "; the loads of the physics test are along other axes of it");
    }
    const auto has_surroundings = [](const grasp::GraspFile& one) {
      return one.surroundings.table_z_O.has_value() || !one.surroundings.obstacles.empty();
    };
    if (has_surroundings(reference.file) != has_surroundings(file.file)) {
      const bool is_mine = has_surroundings(file.file);
      notes_.push_back((is_mine ? file : reference).path + " has a table or obstacles, which " +
                       (is_mine ? reference : file).path + " has not; clear means each its own");
    }
  }

  /// The grasps of several files on one object.
  ComparedSet measure(const std::vector<const SetFile*>& files, const grasp::GraspFile& reference) {
    ComparedSet set;
    // Only grasps of one hand differ by distances of their joints.
    std::map<std::string, std::vector<hands::HandConfiguration>> configurations;
    std::map<std::string, const hands::HandModel*> models;
    for (const SetFile* one : files) {
      const grasp::GraspFile& file = one->file;
      add_grasps(*one, reference, set);
      if (file.timings.total_s > 0.0 && !file.imported) {
        set.seconds += file.timings.total_s;
        set.num_timed += file.grasps.size();
      }
      const std::string hand = file.hand.description_file + '\n' + file.hand.name;
      models.emplace(hand, &file.hand);
      for (const grasp::Grasp& grasp : file.grasps) {
        hands::HandConfiguration in_file_frame = grasp.configuration;
        in_file_frame.X_OH = file.object.in_file_frame(grasp.configuration.X_OH);
        configurations[hand].push_back(in_file_frame);
      }
    }
    for (const auto& [hand, of_hand] : configurations) {
      const grasp::GraspDiversity diversity = grasp::grasp_diversity(*models.at(hand), of_hand);
      set.num_clusters += diversity.num_clusters;
      if (diversity.first_axis_share) set.first_axis_shares.push_back(*diversity.first_axis_share);
    }
    return set;
  }

  void add_grasps(const SetFile& one, const grasp::GraspFile& reference, ComparedSet& set) {
    if (one.file.grasps.empty()) return;
    progress_.clear();
    const geometry::TriangleMesh mesh_O =
        one.mesh_O ? *one.mesh_O : load_recorded_object(flags_, one.file, one.path);
    const grasp::GraspFile file = measured_as(reference, one.file);
    const grasp::RecordedScene scene(file, mesh_O, load_recorded_surroundings(file, one.path));
    const std::size_t first = set.grasps.size();
    for (const grasp::Grasp& stored : file.grasps) {
      progress_.show("measuring " + one.path);
      set.grasps.push_back(compared(stored, scene.measure(stored), file.options.pre_grasps));
    }
    if (request_.protocol) test(one, mesh_O, first, set);
  }

  static ComparedGrasp compared(const grasp::Grasp& stored, const grasp::Grasp& measured,
                                bool has_ways_in) {
    ComparedGrasp grasp;
    grasp.touches = measured.has_all_contacts;
    grasp.is_clear = !measured.penetration.is_any();
    if (has_ways_in) grasp.valid = measured.is_valid() && stored.pre_grasp.has_value();
    grasp.is_closed = measured.is_closed();
    for (const contact::Contact& contact : measured.contacts) {
      if (contact.is_target) grasp.gaps.push_back(contact.gap);
    }
    grasp.depth = grasp::largest_penetration(measured);
    grasp.m = measured.quality.m;
    grasp.epsilon = measured.is_closed() ? measured.epsilon() : 0.0;
    return grasp;
  }

  /// Tests the grasps of a file in physics; they stand in `set` from `first` on.
  void test(const SetFile& one, const geometry::TriangleMesh& mesh_O, std::size_t first,
            ComparedSet& set) {
    progress_.show("convex pieces");
    const hold_test::HoldHand& hand = hold_hand(one.file.hand);
    const hold_test::HoldObject object = hold_test::prepare_hold_object(mesh_O);
    const auto show = [&](std::size_t done, std::size_t total) {
      progress_.show(
          static_cast<std::int64_t>(done), static_cast<std::int64_t>(total),
          std::to_string(done) + " of " + std::to_string(total) + " grasps of " + one.path);
    };
    hold_test::HoldBatchOptions options;
    options.num_threads = request_.num_threads;
    const std::size_t num_grasps = one.file.grasps.size();
    const std::size_t num_margins = std::min(request_.num_margins, num_grasps);
    for (const bool with_margin : {true, false}) {
      options.indices.clear();
      for (std::size_t i = with_margin ? 0 : num_margins;
           i < (with_margin ? num_margins : num_grasps); ++i) {
        options.indices.push_back(i);
      }
      if (options.indices.empty()) continue;  // which would mean all
      options.margin = with_margin;
      for (const hold_test::TestedGrasp& tested : hold_test::test_grasps(
               hand, object, *request_.protocol, one.file.grasps, options, show)) {
        ComparedGrasp& grasp = set.grasps[first + tested.index];
        grasp.held = tested.verdict.held();
        if (!tested.margin) continue;
        grasp.margin_force = tested.margin->force;
        grasp.margin_torque = tested.margin->torque;
      }
    }
  }

  const hold_test::HoldHand& hold_hand(const hands::HandModel& hand) {
    const std::string key = hand.description_file + '\n' + hand.name;
    const auto found = hold_hands_.find(key);
    if (found != hold_hands_.end()) return found->second;
    return hold_hands_.emplace(key, hold_test::prepare_hold_hand(hand)).first->second;
  }

  const Flags& flags_;
  const CompareRequest& request_;
  ProgressBar& progress_;
  std::map<std::string, hold_test::HoldHand> hold_hands_;  ///< By description and name.
  std::vector<std::string> notes_;
};

bool is_compare_file(const std::string& name) {
  return name == kCompareTable || name == kComparePicture;
}

}  // namespace

ExitCode run_compare(const std::vector<std::string>& arguments) {
  const Command command = compare_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const std::array<std::string, 2> paths = {flags.positional(), flags.second_positional()};
  const CompareRequest request = read_compare_request(flags);
  if (std::none_of(paths.begin(), paths.end(), is_importable)) {
    refuse_import_flags(flags, "is for .yaml and .npz files; grasp files of graspfit say it");
  }
  std::optional<OutputFolder> out;
  if (flags.has("out")) out.emplace(flags.text("out"), is_compare_file);

  ProgressBar progress(!flags.has("quiet"));
  std::vector<std::string> notes = request.notes;
  std::array<GraspSet, 2> sets;
  for (std::size_t side = 0; side < sets.size(); ++side) {
    progress.show("reading " + paths[side]);
    sets[side] = read_grasp_set("compare", flags, paths[side]);
    for (const std::string& note : sets[side].notes) {
      notes.push_back((side == 0 ? "A: " : "B: ") + note);
    }
  }
  const CommonObjects common = common_objects(sets[0], sets[1]);
  notes.insert(notes.end(), common.notes.begin(), common.notes.end());
  SetComparison comparison;
  comparison.names = {base::path_text(paths[0]), base::path_text(paths[1])};
  if (request.protocol) comparison.protocol = request.protocol->name;
  Measuring measuring(flags, request, progress);
  for (const CommonObject& object : common.objects) {
    comparison.objects.push_back(measuring.measure(object));
  }
  notes.insert(notes.end(), measuring.notes().begin(), measuring.notes().end());
  if (out) {
    progress.show("writing files");
    base::write_file_atomically(out->staging() / kComparePicture, comparison_chart_svg(comparison));
    base::write_file_atomically(out->staging() / kCompareTable, comparison_csv(comparison));
    out->commit(kCompareTable);
  }
  progress.clear();
  if (flags.has("quiet")) return kSuccess;
  std::fputs(comparison_text(comparison).c_str(), stdout);
  for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
  if (out) std::printf("written to %s\n", out->target().c_str());
  return kSuccess;
}

}  // namespace graspfit::app
