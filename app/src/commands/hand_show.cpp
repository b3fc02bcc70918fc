#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "commands/hand_commands.hpp"
#include "graspfit/base/errors.hpp"
#include "graspfit/base/list_text.hpp"
#include "graspfit/hands/hand_collision.hpp"
#include "graspfit/hands/hand_workspace.hpp"
#include "graspfit/viewer/hand_page.hpp"
#include "input/hand_loading.hpp"
#include "input/hand_poses.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/text_table.hpp"

namespace graspfit::app {
namespace {

namespace fs = std::filesystem;
using hands::HandModel;

Command show_command() {
  Command command{
      "hand show", "HAND",
      "Shows a hand, a shipped name or a file: its links, joints, fingers, pads and palm as "
      "tables,\n"
      "or as a picture or a page that any browser opens from disk, with a slider per joint.\n",
      option_group("Options"),
      "Angles are radians and lengths meters unless a column says otherwise.\n"};
  add_option(command.options, "pose", "POSE,...", "open,half,closed",
             "poses side by side: open, half, closed, or JOINT=VALUE [rad or m], which changes the "
             "pose before it, or else the open hand. Half and closed: every joint that far to the "
             "limit that closes it, each finger stopped where it would touch the hand itself");
  add_option(command.options, "png", "FILE", std::nullopt,
             "write a picture instead of tables (needs python3-vtk9)");
  add_option(command.options, "html", "FILE", std::nullopt, "write a page instead of tables");
  add_option(command.options, "clip-thickness-mm", "NUMBER", "3",
             "drawn thickness of clip volumes whose pad states none: those take the planner's");
  return command;
}

void print_fact(const std::string& name, const std::string& value) {
  std::printf("%-12s%s\n", name.c_str(), value.c_str());
}

void print_table(const std::string& name, const std::vector<std::vector<std::string>>& rows) {
  std::printf("\n%s\n%s", name.c_str(), text_table(rows).c_str());
}

template <class Items>
std::string names_of(const Items& items, const std::vector<int>& indices) {
  const auto name = [&](int i) { return items[i].name; };
  return base::list_text(indices, name, " ");
}

template <class Items>
std::string name_or_dash(const Items& items, std::optional<int> index) {
  return index ? items[*index].name : "-";
}

std::string coupling_text(const HandModel& hand, const hands::Joint& joint) {
  if (!joint.coupling) return "-";
  const hands::Coupling& coupling = *joint.coupling;
  std::string text =
      fixed_decimal(coupling.ratio, 4) + " " + name_or_dash(hand.joints, coupling.leader);
  if (coupling.offset != 0.0) {
    text += (coupling.offset < 0.0 ? " - " : " + ") + fixed_decimal(std::abs(coupling.offset), 4);
  }
  return coupling.breakaway ? text + " breakaway" : text;
}

void print_links(const HandModel& hand) {
  std::vector<std::vector<std::string>> rows = {{"link", "parent", "joint", "faces", "mass_kg"}};
  for (const hands::Link& link : hand.links) {
    const bool is_fixed = link.parent_link && !link.parent_joint;
    rows.push_back({link.name, name_or_dash(hand.links, link.parent_link),
                    is_fixed ? "fixed" : name_or_dash(hand.joints, link.parent_joint),
                    std::to_string(link.mesh_L.faces.size()),
                    link.inertia ? fixed_decimal(link.inertia->mass, 4) : "-"});
  }
  print_table("links", rows);
}

void print_joints(const HandModel& hand, const std::vector<viewer::HandPose>& poses) {
  std::vector<std::vector<std::string>> rows = {
      {"joint", "moves", "type", "unit", "lower", "upper", "closes", "follows"}};
  for (const viewer::HandPose& pose : poses) rows[0].push_back(pose.name);
  for (std::size_t j = 0; j < hand.joints.size(); ++j) {
    const hands::Joint& joint = hand.joints[j];
    const bool is_angle = joint.type == hands::JointType::Revolute;
    std::vector<std::string> row = {joint.name,
                                    name_or_dash(hand.links, joint.child_link),
                                    is_angle ? "revolute" : "prismatic",
                                    is_angle ? "rad" : "m",
                                    fixed_decimal(joint.lower, 4),
                                    fixed_decimal(joint.upper, 4),
                                    joint.closing_sign > 0   ? "upward"
                                    : joint.closing_sign < 0 ? "downward"
                                                             : "-",
                                    coupling_text(hand, joint)};
    for (const viewer::HandPose& pose : poses) {
      row.push_back(fixed_decimal(pose.q[j], 4));
    }
    rows.push_back(std::move(row));
  }
  print_table("joints", rows);
}

void print_fingers(const HandModel& hand) {
  std::vector<std::vector<std::string>> rows = {
      {"finger", "thumb", "tip pad", "swing joint", "links", "joints"}};
  for (const hands::Finger& finger : hand.fingers) {
    rows.push_back({finger.name, finger.is_thumb ? "yes" : "-",
                    name_or_dash(hand.pads, finger.tip_pad),
                    name_or_dash(hand.joints, finger.swing_joint),
                    names_of(hand.links, finger.links), names_of(hand.joints, finger.joints)});
  }
  print_table("fingers", rows);
}

void print_pads(const HandModel& hand) {
  std::vector<std::vector<std::string>> rows = {
      {"pad", "finger", "link", "area_mm2", "inradius_mm", "height_mm", "clip_mm"}};
  for (const hands::ContactPad& pad : hand.pads) {
    rows.push_back({pad.name, hand.part_name(pad.finger), name_or_dash(hand.links, pad.link),
                    fixed_decimal(1e6 * pad_area(pad), 1),
                    fixed_decimal(1e3 * largest_boundary_distance(pad), 2),
                    fixed_decimal(1e3 * pad_height(pad), 2),
                    pad.clip_thickness ? fixed_decimal(1e3 * *pad.clip_thickness, 2) : "-"});
  }
  print_table("pads", rows);
}

/// A range in millimeters as text: "12.5 to 80.0"; "-" if it is empty.
std::string range_text(const hands::DistanceRange& range) {
  if (range.largest <= 0.0) return "-";
  return fixed_decimal(1e3 * range.smallest, 1) + " to " + fixed_decimal(1e3 * range.largest, 1);
}

/// Prints what the fingertips reach over all configurations.
void print_workspace(const HandModel& hand) {
  const hands::HandWorkspace workspace = hands::cached_hand_workspace(hand);
  const int thumb = hand.thumb();
  std::vector<std::vector<std::string>> rows = {
      {"finger", "palm_to_tip_mm", hand.fingers[thumb].name + "_to_tip_mm", "graspable_mm"}};
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    rows.push_back({hand.fingers[f].name, range_text(workspace.palm_to_tip[f]),
                    range_text(workspace.tip_to_tip[thumb][f]),
                    range_text(workspace.graspable_diameter[f])});
  }
  rows.push_back({"any", "", "", range_text(workspace.any_graspable_diameter)});
  print_table("workspace", rows);
}

/// Prints for each pose whether links of the hand overlap, and the deepest overlap.
void print_overlaps(const HandModel& hand, const std::vector<viewer::HandPose>& poses) {
  const hands::HandCollision collision(hand);
  std::vector<std::vector<std::string>> rows = {{"pose", "links that overlap", "depth_mm"}};
  for (const viewer::HandPose& pose : poses) {
    const hands::HandCollision::Result found = collision.against_self(
        hands::forward_kinematics(hand, {hands::RigidTransform::Identity(), pose.q}));
    rows.push_back({pose.name,
                    found.intersects ? name_or_dash(hand.links, found.link_a) + " and " +
                                           name_or_dash(hand.links, found.link_b)
                                     : "none",
                    found.intersects ? fixed_decimal(1e3 * found.depth, 2) : "-"});
  }
  print_table("poses", rows);
}

void print_tables(const viewer::HandScene& scene) {
  const HandModel& hand = scene.hand;
  print_fact("hand", hand.name);
  if (!scene.description.empty()) print_fact("what", scene.description);
  print_fact("file", hand.description_file);
  print_fact("sidecar", hand.sidecar_file.empty() ? "none: derived" : hand.sidecar_file);
  print_fact("joints", std::to_string(hand.joints.size()) + ", independent " +
                           std::to_string(hand.num_intrinsic_dof()));
  print_fact("palm", "link " + hand.links[0].name + ", center " +
                         vector_text(hand.palm.center_H, 4) + " m, direction " +
                         vector_text(hand.palm.direction_H, 4) + ", pad " +
                         name_or_dash(hand.pads, hand.palm.pad));
  print_fact("exclusions", std::to_string(hand.exclusions.size()) + " pairs of links");
  print_links(hand);
  print_joints(hand, scene.poses);
  print_fingers(hand);
  print_pads(hand);
  print_workspace(hand);
  print_overlaps(hand, scene.poses);
}

}  // namespace

ExitCode run_hand_show(const std::vector<std::string>& arguments) {
  const Command command = show_command();
  const Flags flags(command, arguments);
  if (flags.wants_help()) {
    std::fputs(help_text(command).c_str(), stdout);
    return kSuccess;
  }
  const double thickness = flags.number("clip-thickness-mm") / 1000.0;
  if (!(thickness > 0.0)) {
    throw UsageError("--clip-thickness-mm " + flags.text("clip-thickness-mm") + " is not above 0");
  }
  const std::vector<std::string> words = flags.words("pose");
  if (words.empty()) throw UsageError("--pose names no pose");
  hands::HandReading reading = load_hand(flags.positional());
  for (const std::string flag : {"png", "html"}) {
    if (flags.has(flag)) require_parent_folder("--" + flag, flags.text(flag));
  }
  if (flags.has("png")) require_pictures("--png");
  viewer::HandScene scene;
  scene.poses = read_poses(words, reading.model);
  scene.description = reading.description;
  scene.clip_thickness = thickness;
  warn_of_findings(command.name, reading);
  scene.hand = std::move(reading.model);

  if (flags.has("png")) {
    draw_hand_picture(viewer::hand_scene_json(scene), flags.text("png"));
    std::printf("written to %s\n", flags.text("png").c_str());
  }
  if (flags.has("html")) {
    viewer::write_hand_page(flags.text("html"), scene);
    std::printf("written to %s\n", flags.text("html").c_str());
  }
  if (!flags.has("png") && !flags.has("html")) print_tables(scene);
  return kSuccess;
}

}  // namespace graspfit::app
