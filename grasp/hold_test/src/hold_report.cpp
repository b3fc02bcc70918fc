#include "graspfit/hold_test/hold_report.hpp"

#include <nlohmann/json.hpp>

#include "graspfit/base/number_text.hpp"
#include "graspfit/hold_test/hold_parameters.hpp"
#include "io/json_text.hpp"
#include "io/record_json.hpp"

namespace graspfit::hold_test {
namespace {

using base::shortest_decimal;
using grasp::internal::Json;
using grasp::internal::or_null;
using grasp::internal::to_json;

Json conventions() {
  return {
      {"units", "newtons, newton meters, meters, radians, seconds, kilograms as the keys say"},
      {"frame",
       "O: object, the axes and origin of the object's file after scaling, as in the grasp file; "
       "it stays where the object was planned to be, and the base of the hand stands still in it"},
      {"three_configurations",
       "the hand goes from the pre-grasp to the grasp and on to the squeeze, commanded linearly; "
       "then the load begins. squeeze says where the last one comes from: forces (the grasp file's "
       "own), extrapolation (as far beyond the grasp as the pre-grasp is before it, times "
       "extrapolation), none (the grasp)"},
      {"stage",
       "rejected: not simulated, see reason; approach: lost before the load; load: lost under it; "
       "held: not lost under any"},
      {"lost",
       "at a check, every check_interval_s, the center of mass has moved by largest_shift_m or the "
       "object has turned by largest_turn_rad, from its pose after squeezing (before the load: "
       "from the planned one), in the palm's frame"},
      {"approach_shift_m",
       "largest one at any check before the load, from the planned pose; approach_turn_rad alike"},
      {"squeeze_force_N", "sum of the normal forces on the object once it is squeezed"},
      {"failed_at_s", "the first such check, since the load began"},
      {"margin",
       "smallest loads that fail, least over the six directions (force_N, at the center of mass) "
       "and the six axes (torque_Nm); 0 where the grasp is lost without load, and no more than is "
       "tried (100 N, 10 Nm); null where not asked for"},
      {"near_limit",
       "whether 0.9 or 1.1 times the load changes whether the grasp holds; null where not asked "
       "for"},
      {"pieces",
       "convex pieces stand for the object and for each link. volume_error_rel: (volume of their "
       "union - the solid's) / the solid's; outward_deviation_m: how far a piece reaches out of "
       "the solid; inward_deviation_m: how far the solid's surface is from the nearest piece"}};
}

Json parameter_json(const ParameterValue& value) {
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json protocol_json(const HoldReport& report) {
  Json parameters = Json::object();
  for (const std::string& name : parameter_names()) {
    parameters[name] = parameter_json(parameter_value(report.protocol, name));
  }
  return {{"name", report.protocol.name},
          {"source", report.protocol.source},
          {"changed_parameters", report.changed_parameters},
          {"parameters", parameters}};
}

Json pieces_json(const PiecesReport& pieces) {
  return {{"name", pieces.name},
          {"num_pieces", pieces.num_pieces},
          {"volume_error_rel", pieces.volume_error},
          {"outward_deviation_m", pieces.outward_deviation},
          {"inward_deviation_m", pieces.inward_deviation},
          {"is_within_deviation", pieces.is_within_deviation}};
}

Json direction_json(const std::string& name, const DirectionVerdict& direction) {
  return {{"load", name},
          {"direction_O", to_json(direction.direction_O)},
          {"stage", name_of(direction.stage)},
          {"failed_at_s", or_null(direction.failed_at)},
          {"largest_shift_m", direction.largest_shift},
          {"largest_turn_rad", direction.largest_turn}};
}

Json margin_json(const std::optional<HoldMargin>& margin) {
  if (!margin) return nullptr;
  return {{"force_N", margin->force},
          {"force_direction_O", to_json(margin->force_direction_O)},
          {"torque_Nm", margin->torque},
          {"torque_axis_O", to_json(margin->torque_axis_O)}};
}

Json results_json(const HoldReport& report) {
  Json stages = Json::object();
  for (const auto& [stage, count] : count_stages(report.tested)) stages[name_of(stage)] = count;
  const std::vector<std::string> loads = load_names(report.protocol);
  Json grasps = Json::array();
  for (const TestedGrasp& tested : report.tested) {
    const HoldVerdict& verdict = tested.verdict;
    Json directions = Json::array();
    for (std::size_t i = 0; i < verdict.directions.size(); ++i) {
      directions.push_back(direction_json(loads.at(i), verdict.directions[i]));
    }
    grasps.push_back({{"rank", tested.index + 1},
                      {"held", verdict.held()},
                      {"stage", name_of(verdict.stage)},
                      {"reason", verdict.reason.empty() ? Json(nullptr) : Json(verdict.reason)},
                      {"approach_shift_m", verdict.approach_shift},
                      {"approach_turn_rad", verdict.approach_turn},
                      {"squeeze_force_N", verdict.squeeze_force},
                      {"directions", directions},
                      {"near_limit", or_null(tested.is_near_limit)},
                      {"margin", margin_json(tested.margin)}});
  }
  return {{"num_grasps", report.num_grasps},
          {"num_tested", report.tested.size()},
          {"stages", stages},
          {"grasps", grasps}};
}

/// A text with a separator or a quote in it is quoted as RFC 4180 says.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string cell(const std::optional<double>& value) {
  return value ? ',' + shortest_decimal(*value) : ",";
}

std::string row(const TestedGrasp& tested, std::size_t num_loads) {
  const HoldVerdict& verdict = tested.verdict;
  std::string cells = std::to_string(tested.index + 1);
  cells += verdict.held() ? ",true," : ",false,";
  cells += name_of(verdict.stage) + (',' + quoted(verdict.reason));
  for (const double value :
       {verdict.approach_shift, verdict.approach_turn, verdict.squeeze_force}) {
    cells += cell(value);
  }
  cells += tested.is_near_limit ? (*tested.is_near_limit ? ",true" : ",false") : ",";
  cells += cell(tested.margin ? std::optional(tested.margin->force) : std::nullopt);
  cells += cell(tested.margin ? std::optional(tested.margin->torque) : std::nullopt);
  for (const DirectionVerdict& direction : verdict.directions) {
    cells += std::string(",") + name_of(direction.stage) + cell(direction.failed_at) +
             cell(direction.largest_shift) + cell(direction.largest_turn);
  }
  constexpr std::size_t kCellsPerLoad = 4;
  return cells + std::string(kCellsPerLoad * (num_loads - verdict.directions.size()), ',') + '\n';
}

}  // namespace

PiecesReport pieces_report(const std::string& name, const geometry::ConvexDecomposition& shape) {
  return {.name = name,
          .num_pieces = shape.pieces.size(),
          .volume_error = shape.volume_error,
          .outward_deviation = shape.outward_deviation,
          .inward_deviation = shape.inward_deviation,
          .is_within_deviation = shape.is_within_deviation};
}

std::vector<std::string> changed_parameters(const HoldProtocol& protocol) {
  const HoldProtocol shipped = hold_protocol(protocol.name);
  std::vector<std::string> changed;
  for (const std::string& name : parameter_names()) {
    if (parameter_value(protocol, name) != parameter_value(shipped, name)) changed.push_back(name);
  }
  return changed;
}

std::vector<std::string> load_names(const HoldProtocol& protocol) {
  if (protocol.load == HoldLoad::Lift) return {"lift"};
  if (protocol.load == HoldLoad::SixInTurn) return {"in_turn"};
  return {"+x", "-x", "+y", "-y", "+z", "-z"};
}

std::string to_json(const HoldReport& report) {
  Json links = Json::array();
  for (const PiecesReport& link : report.links) links.push_back(pieces_json(link));
  return grasp::internal::json_text(
      {{"format", "graspfit-hold"},
       {"version", 3},
       {"conventions", conventions()},
       {"grasp_file", {{"file", report.grasp_file}, {"sha256", report.grasp_sha256}}},
       {"engine", {{"name", "MuJoCo"}, {"version", GRASPFIT_ENGINE_VERSION}}},
       {"protocol", protocol_json(report)},
       {"decomposition",
        {{"largest_deviation_m", report.decomposition.largest_deviation},
         {"max_pieces", report.decomposition.max_pieces}}},
       {"object", {{"sha256", report.object_sha256}, {"pieces", pieces_json(report.object)}}},
       {"hand", {{"name", report.hand_name}, {"links", links}}},
       {"results", results_json(report)}});
}

std::string to_csv(const HoldReport& report) {
  std::string csv =
      "rank,held,stage,reason,approach_shift_m,approach_turn_rad,squeeze_force_N,near_limit,"
      "margin_force_N,margin_torque_Nm";
  const std::vector<std::string> loads = load_names(report.protocol);
  for (const std::string& load : loads) {
    for (const char* column : {"stage", "failed_at_s", "largest_shift_m", "largest_turn_rad"}) {
      csv += ',' + load + '_' + column;
    }
  }
  csv += '\n';
  for (const TestedGrasp& tested : report.tested) csv += row(tested, loads.size());
  return csv;
}

}  // namespace graspfit::hold_test
