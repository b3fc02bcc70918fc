#include "graspfit/exchange/exchange_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "graspfit/base/number_text.hpp"
#include "graspfit/exchange/graspit_world.hpp"
#include "yaml/yaml_text.hpp"

namespace graspfit::exchange {
namespace {

struct FormatNames {
  ExchangeFormat format;
  std::string_view name;
  std::string_view extension;
};
constexpr std::array<FormatNames, 5> kFormats = {{
    {ExchangeFormat::IsaacGrasp, "isaac", "yaml"},
    {ExchangeFormat::DexGraspBench, "dexgraspbench", "npz"},
    {ExchangeFormat::MoveItGrasp, "moveit", "yaml"},
    {ExchangeFormat::GraspItWorld, "graspit", "xml"},
    {ExchangeFormat::PosedGlb, "glb", "glb"},
}};

const FormatNames& names_of(ExchangeFormat format) {
  return *std::find_if(kFormats.begin(), kFormats.end(),
                       [&](const FormatNames& names) { return names.format == format; });
}

/// "1, 3 and 4": the grasps for which `test` holds, counted from 1; empty if there are none.
template <class Test>
std::string ranks_where(const grasp::GraspFile& file, const Test& test) {
  std::vector<std::string> ranks;
  for (std::size_t i = 0; i < file.grasps.size(); ++i) {
    if (test(file.grasps[i])) ranks.push_back(std::to_string(i + 1));
  }
  if (ranks.size() == file.grasps.size() && ranks.size() > 1) return "all grasps";
  std::string text;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == ranks.size() ? " and " : ", ") + ranks[i];
  }
  return text.empty() ? text : (ranks.size() == 1 ? "grasp " : "grasps ") + text;
}

std::string without_pre_grasp(const grasp::GraspFile& file) {
  return ranks_where(file, [](const grasp::Grasp& grasp) { return !grasp.pre_grasp; });
}

std::string with_retreat(const grasp::GraspFile& file) {
  return ranks_where(file, [](const grasp::Grasp& grasp) {
    return grasp.pre_grasp && grasp.pre_grasp->retreat > 0.0;
  });
}

/// Returns the ranks of grasps in which a coupled joint is not where its leader puts it.
std::string off_coupling(const grasp::GraspFile& file) {
  return ranks_where(file, [&](const grasp::Grasp& grasp) {
    for (std::size_t j = 0; j < file.hand.joints.size(); ++j) {
      const hands::Joint& joint = file.hand.joints[j];
      if (!joint.coupling) continue;
      const Eigen::VectorXd& q = grasp.configuration.q;
      const double follows = hands::followed_position(joint, q);
      if (std::abs(q[j] - follows) > 1e-9) return true;
    }
    return false;
  });
}

/// Adds `sentence` with the grasps in front, if there are any.
void add_for(const std::string& grasps, const std::string& sentence,
             std::vector<std::string>& limits) {
  if (!grasps.empty()) limits.push_back(grasps + sentence);
}

constexpr const char* kNoMeasures =
    "left out: contacts, areas, gaps, penetration, epsilon and all terms of M";

void add_scale(const grasp::GraspFile& file, const std::string& what,
               std::vector<std::string>& limits) {
  if (file.object.meters_per_file_unit == 1.0) return;
  limits.push_back(what + " by " + base::shortest_decimal(file.object.meters_per_file_unit) +
                   " to be in meters: the poses are for that size");
}

void isaac_limits(const grasp::GraspFile& file, std::vector<std::string>& limits) {
  limits.push_back("confidence is M / (1 + M), no probability");
  limits.push_back(std::string(kNoMeasures) + ", squeeze");
  add_for(with_retreat(file),
          ": the palm's retreat before the grasp is left out, its pre-grasp is joints only",
          limits);
  add_for(without_pre_grasp(file), ": no pregrasp_cspace_position, as there is no pre-grasp",
          limits);
  add_scale(file, "the object's file is multiplied", limits);
}

void dexgraspbench_limits(const grasp::GraspFile& file, std::vector<std::string>& limits) {
  limits.push_back(
      "joints stand in the order of joint_names; a simulator's model may have another");
  limits.push_back("obj_path is the mesh file, not a folder of processed object assets");
  limits.push_back(std::string(kNoMeasures));
  add_for(without_pre_grasp(file), ": no pre-grasp, its row of pregrasp_qpos is NaN", limits);
  add_for(ranks_where(file, [](const grasp::Grasp& grasp) { return !grasp.squeeze; }),
          ": no squeeze, its row of squeeze_qpos is NaN", limits);
}

void moveit_limits(const grasp::GraspFile& file, std::vector<std::string>& limits) {
  limits.push_back("grasp_pose is that of link \"" + file.hand.links[0].name +
                   "\"; MoveIt! means the link that the hand hangs on");
  limits.push_back(
      "grasp_quality is M; its terms, contacts, gaps, epsilon and squeeze are left out");
  limits.push_back(
      "post_grasp_retreat and post_place_retreat are not planned, their distance is 0");
  add_for(without_pre_grasp(file), ": empty pre_grasp_posture, as there is no pre-grasp", limits);
  add_for(off_coupling(file),
          ": a coupled joint has closed further than its leader (a clutch), which is left out",
          limits);
  add_scale(file, "the object's file is multiplied", limits);
}

void graspit_limits(const grasp::GraspFile& file, std::vector<std::string>& limits) {
  limits.push_back("one grasp a file; its pre-grasp, squeeze and all measures are left out");
  limits.push_back("GraspIt! looks for object and hand below $GRASPIT");
  if (!is_graspit_hand(file.hand)) {
    limits.push_back("hand " + file.hand.name + " is described by " +
                     internal::in_quotes(file.hand.description_file) +
                     ", which GraspIt! does not read: name a robot file with the same base frame "
                     "and the independent joints in the same order");
    add_for(off_coupling(file),
            ": a coupled joint has closed further than its leader (a clutch), which is left out",
            limits);
  }
}

}  // namespace

std::string_view name_of(ExchangeFormat format) { return names_of(format).name; }

std::string_view extension_of(ExchangeFormat format) { return names_of(format).extension; }

std::optional<ExchangeFormat> format_named(std::string_view name) {
  for (const FormatNames& names : kFormats) {
    if (names.name == name) return names.format;
  }
  return std::nullopt;
}

std::optional<ExchangeFormat> format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (extension == ".yml") return ExchangeFormat::IsaacGrasp;
  for (const FormatNames& names : kFormats) {  // isaac precedes moveit, also .yaml
    if (extension == '.' + std::string(names.extension)) return names.format;
  }
  return std::nullopt;
}

bool holds_one_grasp(ExchangeFormat format) {
  return format == ExchangeFormat::GraspItWorld || format == ExchangeFormat::PosedGlb;
}

std::vector<std::string> limits_of(ExchangeFormat format, const grasp::GraspFile& file) {
  std::vector<std::string> limits;
  switch (format) {
    case ExchangeFormat::IsaacGrasp:
      isaac_limits(file, limits);
      break;
    case ExchangeFormat::DexGraspBench:
      dexgraspbench_limits(file, limits);
      break;
    case ExchangeFormat::MoveItGrasp:
      moveit_limits(file, limits);
      break;
    case ExchangeFormat::GraspItWorld:
      graspit_limits(file, limits);
      break;
    case ExchangeFormat::PosedGlb:
      limits.push_back(
          "meshes and poses of one grasp, single precision: no joints, no contacts, no measures");
      limits.push_back(std::string("the axes are those of the ") +
                       (file.object.laid ? "table" : "object's file") + "; viewers take +y as up");
      break;
  }
  const grasp::SurroundingsRecord& around = file.surroundings;
  if (around.table_z_O || !around.obstacles.empty()) {
    limits.push_back("table and obstacles are left out");
  }
  return limits;
}

}  // namespace graspfit::exchange
