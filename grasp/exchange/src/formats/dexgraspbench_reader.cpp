#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "archive/npz_reader.hpp"
#include "formats/stated_joints.hpp"
#include "graspfit/base/number_text.hpp"
#include "graspfit/exchange/dexgraspbench.hpp"
#include "graspfit/geometry/rigid_transform.hpp"

namespace graspfit::exchange {
namespace {

using Row = std::span<const double>;

constexpr std::size_t kPoseSize = 7;  // position and quaternion
constexpr double kSamePalm = 1e-6;    // [m], and of a rotation's entries: single precision

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t extent : shape)
    text += (text.empty() ? "" : ", ") + std::to_string(extent);
  return '[' + text + ']';
}

bool has_nan(Row row) {
  return std::any_of(row.begin(), row.end(), [](double value) { return std::isnan(value); });
}

/// "grasp_qpos[3]", as NumPy writes it.
std::string place_of(const std::string& array, std::size_t row) {
  return array + '[' + std::to_string(row) + ']';
}

/// An array as rows, be it one row or several.
class Rows {
 public:
  /// @throws IoError unless the array has one or two dimensions.
  Rows(const internal::NpzReader& npz, std::string name)
      : name_(std::move(name)), array_(npz.numbers(name_)) {
    const std::size_t dimensions = array_.shape.size();
    if (dimensions != 1 && dimensions != 2) {
      npz.fail(name_, "has the shape " + shape_text(array_.shape) + ", not rows of numbers");
    }
    width_ = array_.shape.back();
    count_ = dimensions == 1 ? 1 : array_.shape.front();
  }

  const std::string& name() const { return name_; }
  const std::vector<std::size_t>& shape() const { return array_.shape; }
  std::size_t width() const { return width_; }
  std::size_t count() const { return count_; }
  Row operator[](std::size_t row) const { return Row(array_.values).subspan(row * width_, width_); }

 private:
  std::string name_;
  internal::NpzArray<double> array_;
  std::size_t width_ = 0;
  std::size_t count_ = 0;
};

/// Turns the arrays of a file into grasps of one hand.
class QposReader {
 public:
  QposReader(const internal::NpzReader& npz, const hands::HandModel& hand,
             const ImportTolerances& tolerances)
      : npz_(npz), hand_(hand), tolerances_(tolerances) {}

  DexGraspBenchGrasps read() {
    const Rows grasps(npz_, "grasp_qpos");
    if (grasps.width() <= kPoseSize) {
      npz_.fail(grasps.name(), "has the shape " + shape_text(grasps.shape()) +
                                   "; a row is position, quaternion and joints, 7 + dof numbers");
    }
    find_columns(grasps.width() - kPoseSize);
    std::optional<Rows> before;
    if (npz_.has("pregrasp_qpos")) {
      before.emplace(npz_, "pregrasp_qpos");
      if (before->shape() != grasps.shape()) {
        npz_.fail(before->name(), "has the shape " + shape_text(before->shape()) +
                                      ", but grasp_qpos has " + shape_text(grasps.shape()));
      }
    }
    const std::vector<geometry::RigidTransform> X_WO = object_poses(grasps.count());
    read_.meters_per_file_unit = scale();
    for (std::size_t row = 0; row < grasps.count(); ++row) {
      if (has_nan(grasps[row])) {
        note(place_of(grasps.name(), row) + " has NaN, and is left out");
        continue;
      }
      read_.grasps.push_back(grasp(grasps, before, row, X_WO[X_WO.size() == 1 ? 0 : row]));
    }
    if (read_.grasps.empty()) npz_.fail(grasps.name(), "holds no grasp");
    return std::move(read_);
  }

 private:
  void note(const std::string& text) { read_.notes.push_back(text); }

  ImportedGrasp grasp(const Rows& grasps, const std::optional<Rows>& before, std::size_t row,
                      const geometry::RigidTransform& X_WO) {
    ImportedGrasp grasp;
    grasp.name = "grasp_" + std::to_string(row);
    const std::string place = place_of(grasps.name(), row);
    const geometry::RigidTransform X_WH = pose(place, grasps[row]);
    // The identity keeps every bit.
    const bool is_same_frame = X_WO.matrix() == Eigen::Matrix4d::Identity();
    grasp.configuration.X_OH = is_same_frame ? X_WH : geometry::relative_pose(X_WO, X_WH);
    grasp.configuration.q = joints(place, grasps[row]);
    if (!before || has_nan((*before)[row])) return grasp;
    const std::string place_before = place_of(before->name(), row);
    const geometry::RigidTransform X_WP = pose(place_before, (*before)[row]);
    const Eigen::VectorXd q = joints(place_before, (*before)[row]);
    if ((X_WP.matrix() - X_WH.matrix()).cwiseAbs().maxCoeff() <= kSamePalm) {
      grasp.pre_grasp_q = q;
    } else {
      note(grasp.name + ": its pre-grasp has the palm elsewhere than the grasp, and is left out");
    }
    return grasp;
  }

  geometry::RigidTransform pose(const std::string& place, Row row) const {
    require_finite(place, row);
    const std::array<double, 4> wxyz = {row[3], row[4], row[5], row[6]};
    const double norm = std::hypot(std::hypot(row[3], row[4]), std::hypot(row[5], row[6]));
    if (!(std::abs(norm - 1.0) <= tolerances_.largest_norm_error)) {
      npz_.fail(place, "its quaternion (w x y z) is no unit quaternion, its norm is " +
                           base::shortest_decimal(norm));
    }
    return geometry::rigid_transform({row[0], row[1], row[2]}, wxyz);
  }

  Eigen::VectorXd joints(const std::string& place, Row row) const {
    internal::StatedJoints joints(hand_);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto fault = joints.state(columns_[i], row[kPoseSize + i], tolerances_);
      if (fault) npz_.fail(place, "joint " + joint_name(columns_[i]) + ' ' + *fault);
    }
    if (const auto fault = joints.complete(tolerances_)) npz_.fail(place, *fault);
    return joints.q();
  }

  void require_finite(const std::string& place, Row row) const {
    const auto bad =
        std::find_if_not(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    if (bad == row.end()) return;
    npz_.fail(place + '[' + std::to_string(bad - row.begin()) + ']', "is not a finite number");
  }

  const std::string& joint_name(Eigen::Index joint) const {
    return hand_.joints[static_cast<std::size_t>(joint)].name;
  }

  /// Finds which joint each column behind the pose is.
  void find_columns(std::size_t dof) {
    const std::string array = "joint_names";
    if (!npz_.has(array)) {
      columns_by_order(dof);
      return;
    }
    const internal::NpzArray<std::string> names = npz_.texts(array);
    if (names.shape.size() != 1 || names.values.size() != dof) {
      npz_.fail(array, "has the shape " + shape_text(names.shape) + ", but grasp_qpos has " +
                           std::to_string(dof) + " joints in a row");
    }
    const internal::StatedJoints known(hand_);
    for (std::size_t i = 0; i < dof; ++i) {
      const auto joint = known.index_of(names.values[i]);
      const std::string place = place_of(array, i);
      if (!joint) npz_.fail(place, '"' + names.values[i] + "\": " + known.unknown_text());
      if (std::find(columns_.begin(), columns_.end(), *joint) != columns_.end()) {
        npz_.fail(place, '"' + names.values[i] + "\" is there twice");
      }
      columns_.push_back(*joint);
    }
  }

  void columns_by_order(std::size_t dof) {
    std::vector<Eigen::Index> independent;
    for (int j = 0; j < std::ssize(hand_.joints); ++j) {
      columns_.push_back(j);
      if (!hand_.joints[j].coupling) independent.push_back(j);
    }
    const bool are_all = columns_.size() == dof;
    if (!are_all && independent.size() != dof) {
      npz_.fail("grasp_qpos", "has " + std::to_string(dof) + " joints in a row; hand " +
                                  hand_.name + " has " + std::to_string(columns_.size()) + ", " +
                                  std::to_string(independent.size()) +
                                  " of them independent, and joint_names does not say which they "
                                  "are");
    }
    if (!are_all) columns_ = independent;
    note("the file has no joint_names; its joints are taken in the order of hand " + hand_.name +
         (are_all ? "" : ", the independent ones only"));
  }

  /// The object's pose in the frame of all poses, for all grasps or for each.
  std::vector<geometry::RigidTransform> object_poses(std::size_t num_grasps) const {
    if (!npz_.has("obj_pose")) return {geometry::RigidTransform::Identity()};
    const Rows rows(npz_, "obj_pose");
    const bool has_one = rows.count() == 1;
    if (rows.width() != kPoseSize || (!has_one && rows.count() != num_grasps)) {
      npz_.fail(rows.name(), "has the shape " + shape_text(rows.shape()) +
                                 ", not [7], nor 7 numbers for each grasp");
    }
    std::vector<geometry::RigidTransform> poses;
    for (std::size_t row = 0; row < rows.count(); ++row) {
      poses.push_back(pose(has_one ? rows.name() : place_of(rows.name(), row), rows[row]));
    }
    return poses;
  }

  std::optional<double> scale() const {
    const std::string array = "obj_scale";
    if (!npz_.has(array)) return std::nullopt;
    const std::vector<double> values = npz_.numbers(array).values;
    if (values.empty()) npz_.fail(array, "holds no number");
    for (const double value : values) {
      if (value > 0.0 && std::isfinite(value) && value == values.front()) continue;
      npz_.fail(array, base::shortest_decimal(value) +
                           (value == values.front() || std::isnan(value)
                                ? " is not a finite number above 0"
                                : " differs from " + base::shortest_decimal(values.front()) +
                                      "; one file is read for one size of the object"));
    }
    return values.front();
  }

  const internal::NpzReader& npz_;
  const hands::HandModel& hand_;
  const ImportTolerances& tolerances_;
  std::vector<Eigen::Index> columns_;  ///< The joint of each column behind the pose.
  DexGraspBenchGrasps read_;
};

}  // namespace

DexGraspBenchGrasps read_dexgraspbench(const std::filesystem::path& path,
                                       const hands::HandModel& hand,
                                       const ImportTolerances& tolerances) {
  tolerances.validate();
  const internal::NpzReader npz(path);
  return QposReader(npz, hand, tolerances).read();
}

}  // namespace graspfit::exchange
