#pragma once

#include <Eigen/Core>
#include <vector>

#include "graspfit/hands/hand_configuration.hpp"

namespace graspfit::grasp::internal {

/// The entries of small motions of a hand, whatever its configuration is: lengths for the palm's
/// translation in O, its rotation about a pivot (angle times a length), then one entry per joint
/// that is free to move (times its lever). In these units a motion of 1 mm is one of at most about
/// 1 mm of any point of the hand.
///
/// Free are the independent joints, and breakaway joints, which may go further closed than their
/// coupling (`HandMotion::breakaway_rows`) and are then moved on their own.
class MotionEntries {
 public:
  /// What the entry of a breakaway joint is.
  enum class Breakaway {
    Alone,   ///< All of its motion; `breakaway_rows` keep it at its coupling.
    Beyond,  ///< What it moves beyond its coupling; with its leader it moves anyhow.
  };

  /// Refers to `hand`.
  MotionEntries(const hands::HandModel& hand, bool palm_translates, bool palm_turns,
                Breakaway breakaway = Breakaway::Alone);

  Eigen::Index size() const { return 6 + std::ssize(free_joints_); }

 private:
  friend class HandMotion;

  bool is_beyond(int joint) const;

  const hands::HandModel& hand_;
  bool palm_translates_;
  bool palm_turns_;
  Breakaway breakaway_;
  std::vector<int> free_joints_;
  /// Per link: those that move it, distal ones first.
  std::vector<std::vector<int>> joints_above_;
  /// Per joint: the entry of the motion that drives it, or its leader.
  std::vector<int> entry_of_joint_;
  std::vector<double> lever_;  ///< Per joint [m/rad; 1 of a prismatic joint].
  Eigen::VectorXd open_q_;     ///< Of the open hand.
};

/// Small motions of a hand from one configuration, as vectors of `MotionEntries`. Cheap to make:
/// it is made anew for every configuration.
class HandMotion {
 public:
  /// Refers to `entries`, to the configuration that motions start from and to its link poses
  /// `X_OL`; the palm turns about `pivot_O`.
  HandMotion(const MotionEntries& entries, const hands::HandConfiguration& configuration,
             const std::vector<hands::RigidTransform>& X_OL, const Eigen::Vector3d& pivot_O);

  Eigen::Index size() const { return entries_.size(); }

  /// The derivative of direction · point, for a point of a link in O, over the motion.
  Eigen::RowVectorXd row(int link, const Eigen::Vector3d& point_O,
                         const Eigen::Vector3d& direction_O) const;
  /// The derivative of axis · angular displacement of a link.
  Eigen::RowVectorXd turn_row(int link, const Eigen::Vector3d& axis_O) const;

  /// Least and greatest value of every entry: joint limits, and `trust` [m] each way; what a
  /// breakaway joint moves beyond its coupling is also limited by how far it is beyond it.
  struct Bounds {
    Eigen::VectorXd lower, upper;
  };
  Bounds bounds(double trust) const;

  /// A limit: row · motion ≥ least ≤ 0.
  struct Limit {
    Eigen::RowVectorXd row;
    double least;
  };
  /// Breakaway joints stay at least as closed as their couplings ask.
  std::vector<Limit> breakaway_rows() const;

  /// The motion that opens the joints between a link and the palm, each by `step` [m] at its end.
  Eigen::VectorXd opening(int link, double step) const;

  /// The same for joints that neither open nor close (spread, abduction), toward their positions in
  /// the open hand: this separates fingers that cross.
  Eigen::VectorXd straightening(int link, double step) const;

  /// The configuration after a motion; couplings and limits hold.
  hands::HandConfiguration moved(const Eigen::VectorXd& motion) const;

 private:
  double share_of_entry(int joint) const;
  /// `row` with what every joint above a link does: `rate` of its `hands::JointVelocity`.
  template <class Rate>
  Eigen::RowVectorXd with_joints(Eigen::RowVectorXd row, int link, const Eigen::Vector3d& point_O,
                                 const Rate& rate) const;

  const MotionEntries& entries_;
  const hands::HandModel& hand_;
  const hands::HandConfiguration& configuration_;
  const std::vector<hands::RigidTransform>& X_OL_;
  const Eigen::Vector3d pivot_O_;
};

/// Lever by which turns of the palm become lengths, about half a hand [m/rad].
inline constexpr double kTurnLever = 0.1;

}  // namespace graspfit::grasp::internal
