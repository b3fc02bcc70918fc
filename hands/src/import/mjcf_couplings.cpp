#include "import/mjcf_couplings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "description/joint_motion.hpp"
#include "graspfit/base/number_text.hpp"

namespace graspfit::hands::internal {

namespace {

using base::shortest_decimal;

/// Coefficients of a polynomial, from the constant one up.
using Polynomial = std::array<double, 5>;

double value(const Polynomial& p, double x) {
  return p[0] + x * (p[1] + x * (p[2] + x * (p[3] + x * p[4])));
}

bool is_linear(const Polynomial& p) { return p[2] == 0.0 && p[3] == 0.0 && p[4] == 0.0; }

/// The line q(follower) = ratio · q(leader) + offset.
struct Line {
  double ratio = 0.0;
  double offset = 0.0;
};

/// The line nearest to p over [lower, upper] in the least squares. With x = center + half · t it is
/// the part of p's expansion in Legendre polynomials of t of degree 0 and 1, whose coefficients are
/// integrals over [−1, 1]: of t^k, 2/(k + 1) for even k; of t^k · t, 2/(k + 2) for odd k.
Line nearest_line(const Polynomial& p, double lower, double upper) {
  const double center = 0.5 * (lower + upper);
  const double half = 0.5 * (upper - lower);
  if (half == 0.0) return {0.0, value(p, center)};
  // Taylor coefficients about the center, by repeated synthetic division.
  Polynomial c = p;
  for (std::size_t i = 0; i + 1 < c.size(); ++i) {
    for (std::size_t k = c.size() - 1; k-- > i;) c[k] += center * c[k + 1];
  }
  const double h2 = half * half;
  const double mean = c[0] + h2 * (c[2] / 3.0 + h2 * c[4] / 5.0);
  const double slope = c[1] + h2 * c[3] * 3.0 / 5.0;
  return {slope, mean - slope * center};
}

/// A joint and its factor in a tendon's length.
struct Term {
  int joint = -1;  ///< Index in MuJoCo's model.
  double coefficient = 0.0;
};

class CouplingReader {
 public:
  CouplingReader(const mjModel& model, const std::vector<std::optional<int>>& link_of,
                 const std::vector<std::optional<int>>& joint_of, RobotDescription& description,
                 Findings& findings)
      : model_(model),
        link_of_(link_of),
        joint_of_(joint_of),
        description_(description),
        findings_(findings) {}

  void read() {
    for (int e = 0; e < model_.neq; ++e) equality(e);
    for (int a = 0; a < model_.nu; ++a) actuator(a);
    fix_followers_of_fixed_joints();
  }

 private:
  std::string name_of(mjtObj kind, int id, const std::string& what) const {
    const char* name = mj_id2name(&model_, kind, id);
    return what + " " + (name && *name ? std::string(name) : std::to_string(id));
  }

  bool is_kept(int joint) const { return joint_of_[joint].has_value(); }
  DescribedJoint& described(int joint) { return description_.joints[*joint_of_[joint]]; }
  double ref(int joint) const { return model_.qpos0[model_.jnt_qposadr[joint]]; }

  void equality(int e) {
    const std::string item = name_of(mjOBJ_EQUALITY, e, "equality");
    if (!model_.eq_active[e]) {
      findings_.note(item, "is not active and left out");
      return;
    }
    const mjtNum* data = model_.eq_data + mjNEQDATA * e;
    const Polynomial p = {data[0], data[1], data[2], data[3], data[4]};
    const int first = model_.eq_obj1id[e];
    const int second = model_.eq_obj2id[e];
    switch (model_.eq_type[e]) {
      case mjEQ_JOINT:
        if (!is_kept(first)) return;
        if (second < 0) {
          fix(first, ref(first) + p[0], item);
        } else if (is_kept(second)) {
          couple(first, second, p, item);
        }
        return;
      case mjEQ_TENDON:
        tendon_equality(first, second, p, item);
        return;
      default:
        closed_loop(first, second, item);
    }
  }

  void closed_loop(int first, int second, const std::string& item) {
    const auto text = [&](int body) { return name_of(mjOBJ_BODY, body, "body"); };
    if (link_of_[first] && link_of_[second]) {
      findings_.suspicious(item, "joins " + text(first) + " and " + text(second) +
                                     ": closed loops are not kept; couple the joints by "
                                     "\"couplings\" in the sidecar");
    } else {
      findings_.note(item, "joins " + text(first) + " and " + text(second) +
                               ", not both of the hand, and is left out");
    }
  }

  /// Couples joint 1, the follower, to joint 2, the leader, by q1 = ref1 + p(q2 − ref2).
  void couple(int follower, int leader, const Polynomial& p, const std::string& item) {
    const double lower = described(leader).lower - ref(leader);
    const double upper = described(leader).upper - ref(leader);
    Line line{p[1], p[0]};
    if (!is_linear(p)) {
      line = nearest_line(p, lower, upper);
      constexpr int kSamples = 1000;  // the largest deviation to three digits or so
      double deviation = 0.0;
      for (int i = 0; i <= kSamples; ++i) {
        const double x = lower + (upper - lower) * i / kSamples;
        deviation = std::max(deviation, std::abs(value(p, x) - line.ratio * x - line.offset));
      }
      findings_.suspicious(item, "is a curve between joints " + described(leader).name + " and " +
                                     described(follower).name +
                                     "; the nearest line is kept, up to " +
                                     shortest_decimal(deviation) + " from it");
    }
    line.offset += ref(follower) - line.ratio * ref(leader);
    if (line.ratio == 0.0) {
      fix(follower, line.offset, item);
    } else {
      set(follower, leader, line, false, item);
    }
  }

  void set(int follower, int leader, const Line& line, bool breakaway, const std::string& item) {
    DescribedJoint& joint = described(follower);
    const std::string& leader_name = described(leader).name;
    if (fixed_.contains(joint.name)) return;
    if (joint.coupling) {
      findings_.suspicious(item, "joint " + joint.name + " follows " + joint.coupling->joint +
                                     " already; that it follows " + leader_name + " is not kept");
      return;
    }
    if (follows(leader_name, joint.name)) {
      findings_.suspicious(item, "joint " + leader_name + " follows " + joint.name +
                                     " already; the other way round is not kept");
      return;
    }
    joint.coupling = DescribedCoupling{leader_name, line.ratio, line.offset, breakaway};
  }

  DescribedJoint& by_name(const std::string& name) {
    return *std::find_if(description_.joints.begin(), description_.joints.end(),
                         [&](const DescribedJoint& joint) { return joint.name == name; });
  }

  /// Whether `joint` is `leader` or follows it, perhaps through others.
  bool follows(const std::string& joint, const std::string& leader) {
    std::string at = joint;
    while (at != leader) {
      const DescribedJoint& described_joint = by_name(at);
      if (!described_joint.coupling) return false;
      at = described_joint.coupling->joint;
    }
    return true;
  }

  void fix(int joint, double q, const std::string& item) {
    if (fixed_.contains(described(joint).name)) return;
    findings_.note(
        item, "joint " + described(joint).name + " is held and fixed at " + shortest_decimal(q));
    fix(described(joint), q);
  }

  void fix(DescribedJoint& joint, double q) {
    joint.X_PJ = joint.X_PJ * joint_motion(joint, q);
    joint.type = DescribedJoint::Type::Fixed;
    joint.lower = joint.upper = 0.0;
    joint.coupling.reset();
    fixed_.emplace(joint.name, q);
  }

  void fix_followers_of_fixed_joints() {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (DescribedJoint& joint : description_.joints) {
        if (!joint.coupling) continue;
        const auto leader = fixed_.find(joint.coupling->joint);
        if (leader == fixed_.end()) continue;
        fix(joint, joint.coupling->multiplier * leader->second + joint.coupling->offset);
        goes_on = true;
      }
    }
  }

  /// The terms of a fixed tendon's length, each joint once, in the order of the joints; none for a
  /// tendon that runs through space.
  std::vector<Term> terms(int tendon) const {
    std::map<int, double> sum;
    for (int w = 0; w < model_.tendon_num[tendon]; ++w) {
      const int at = model_.tendon_adr[tendon] + w;
      if (model_.wrap_type[at] != mjWRAP_JOINT) return {};
      sum[model_.wrap_objid[at]] += model_.wrap_prm[at];
    }
    std::vector<Term> result;
    for (const auto& [joint, coefficient] : sum) {
      if (coefficient != 0.0) result.push_back({joint, coefficient});
    }
    return result;
  }

  /// Reads the constraint L1 − L1(ref) = p(L2 − L2(ref)) between the lengths L = Σ c q of two
  /// tendons.
  void tendon_equality(int first, int second, const Polynomial& p, const std::string& item) {
    const std::vector<Term> left = terms(first);
    const std::vector<Term> right = second < 0 ? std::vector<Term>{} : terms(second);
    const auto all_kept = [&](const std::vector<Term>& side) {
      return std::all_of(side.begin(), side.end(), [&](const Term& t) { return is_kept(t.joint); });
    };
    const auto not_kept = [&](const std::string& why) {
      findings_.suspicious(item, why +
                                     ": it is not kept; couple the joints by \"couplings\" in the "
                                     "sidecar");
    };
    if (left.empty() || (second >= 0 && right.empty())) {
      return not_kept("joins tendons that run through space");
    }
    if (!all_kept(left) || !all_kept(right)) return;
    if (left.size() == 1 && right.empty()) {
      return fix(left[0].joint, ref(left[0].joint) + p[0] / left[0].coefficient, item);
    }
    if (left.size() == 1 && right.size() == 1) {
      // c1 (q1 − ref1) = p(c2 (q2 − ref2))
      Polynomial of_joints = p;
      double factor = 1.0 / left[0].coefficient;
      for (double& coefficient : of_joints) {
        coefficient *= factor;
        factor *= right[0].coefficient;
      }
      return couple(left[0].joint, right[0].joint, of_joints, item);
    }
    if (left.size() == 2 && right.empty()) {
      // c1 (q1 − ref1) + c2 (q2 − ref2) = a0; the joint nearer to the palm leads.
      const Polynomial of_joints = {p[0] / left[1].coefficient,
                                    -left[0].coefficient / left[1].coefficient, 0.0, 0.0, 0.0};
      return couple(left[1].joint, left[0].joint, of_joints, item);
    }
    not_kept("joins " + std::to_string(left.size() + right.size()) + " joints by one equation");
  }

  bool has_own_actuator(int joint) const {
    for (int a = 0; a < model_.nu; ++a) {
      const int kind = model_.actuator_trntype[a];
      if ((kind == mjTRN_JOINT || kind == mjTRN_JOINTINPARENT) &&
          model_.actuator_trnid[2 * a] == joint) {
        return true;
      }
    }
    return false;
  }

  void actuator(int a) {
    if (model_.actuator_trntype[a] != mjTRN_TENDON) return;
    const int tendon = model_.actuator_trnid[2 * a];
    const std::string item = name_of(mjOBJ_TENDON, tendon, "tendon");
    const std::string driver = name_of(mjOBJ_ACTUATOR, a, "actuator");
    const std::vector<Term> all = terms(tendon);
    if (all.empty()) {
      findings_.suspicious(item, "runs through space and is driven by " + driver +
                                     ": how it couples joints is not kept");
      return;
    }
    std::vector<Term> free;
    for (const Term& term : all) {
      if (!is_kept(term.joint) || has_own_actuator(term.joint)) continue;
      const DescribedJoint& joint = described(term.joint);
      if (!joint.coupling && joint.type != DescribedJoint::Type::Fixed) free.push_back(term);
    }
    if (free.size() < 2) return;
    const DescribedJoint& leader = described(free[0].joint);
    for (std::size_t i = 1; i < free.size(); ++i) {
      const DescribedJoint& follower = described(free[i].joint);
      const double leader_range = leader.upper - leader.lower;
      if (leader_range == 0.0 || follower.upper == follower.lower) continue;
      const double share = (follower.upper - follower.lower) / leader_range;
      const bool same_way = free[0].coefficient * free[i].coefficient > 0.0;
      const Line line = same_way ? Line{share, follower.lower - share * leader.lower}
                                 : Line{-share, follower.upper + share * leader.lower};
      findings_.note(item, "is driven by " + driver + " and shared by joints " + leader.name +
                               " and " + follower.name +
                               ": read as going through their ranges "
                               "together, " +
                               follower.name +
                               " going on alone when the other is "
                               "blocked");
      set(free[i].joint, free[0].joint, line, true, item);
    }
  }

  const mjModel& model_;
  const std::vector<std::optional<int>>& link_of_;
  const std::vector<std::optional<int>>& joint_of_;
  RobotDescription& description_;
  Findings& findings_;
  std::map<std::string, double> fixed_;  ///< Joints that constraints hold, and their positions.
};

}  // namespace

void read_mjcf_couplings(const mjModel& model, const std::vector<std::optional<int>>& link_of,
                         const std::vector<std::optional<int>>& joint_of,
                         RobotDescription& description, Findings& findings) {
  CouplingReader(model, link_of, joint_of, description, findings).read();
}

}  // namespace graspfit::hands::internal
