#include "hands/kdl_hand.hpp"

#include <urdf_parser/urdf_parser.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <numbers>
#include <stdexcept>

namespace graspfit::testing {
namespace {

Eigen::Isometry3d isometry(const KDL::Frame& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) X.linear()(i, j) = frame.M(i, j);
    X.translation()[i] = frame.p[i];
  }
  return X;
}

KDL::JntArray joint_array(const Eigen::VectorXd& q) {
  KDL::JntArray result(static_cast<unsigned>(q.size()));
  result.data = q;
  return result;
}

void require_success(int status) {
  if (status < 0) throw std::runtime_error("KDL: status " + std::to_string(status));
}

}  // namespace

struct KdlHand::Parts {
  KDL::Tree tree;
  std::vector<Link> links;
  std::vector<Joint> joints;
};

struct KdlHand::Chain::Parts {
  explicit Parts(const KDL::Chain& from_base) : chain(from_base), forward(chain), jacobian(chain) {}
  KDL::Chain chain;  // It comes before the solvers, which refer to it.
  KDL::ChainFkSolverPos_recursive forward;
  KDL::ChainJntToJacSolver jacobian;
  std::vector<std::string> joints;
};

KdlHand::KdlHand(const std::filesystem::path& file) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDFFile(file.string());
  auto parts = std::make_shared<Parts>();
  if (!model || !kdl_parser::treeFromUrdfModel(*model, parts->tree)) {
    throw std::runtime_error("urdfdom refuses " + file.string());
  }
  for (const auto& [name, link] : model->links_) {
    Link entry{.name = name, .parent = {}, .mesh_files = {}};
    if (link->getParent()) entry.parent = link->getParent()->name;
    const auto add = [&](const auto& shapes) {
      for (const auto& shape : shapes) {
        if (const auto mesh = std::dynamic_pointer_cast<urdf::Mesh>(shape->geometry)) {
          entry.mesh_files.push_back(mesh->filename);
        }
      }
    };
    if (link->collision_array.empty()) {
      add(link->visual_array);
    } else {
      add(link->collision_array);
    }
    parts->links.push_back(std::move(entry));
  }
  for (const auto& [name, joint] : model->joints_) {
    if (joint->type == urdf::Joint::FIXED) continue;
    Joint entry{.name = name, .is_prismatic = joint->type == urdf::Joint::PRISMATIC, .mimic = {}};
    if (joint->type == urdf::Joint::CONTINUOUS) {
      entry.lower = -std::numbers::pi;
      entry.upper = std::numbers::pi;
    } else {
      entry.lower = joint->limits->lower;
      entry.upper = joint->limits->upper;
    }
    if (joint->mimic) {
      entry.mimic = Mimic{joint->mimic->joint_name, joint->mimic->multiplier, joint->mimic->offset};
    }
    parts->joints.push_back(std::move(entry));
  }
  parts_ = std::move(parts);
}

const std::vector<KdlHand::Link>& KdlHand::links() const { return parts_->links; }

const std::vector<KdlHand::Joint>& KdlHand::joints() const { return parts_->joints; }

KdlHand::Chain KdlHand::chain(const std::string& base, const std::string& tip) const {
  KDL::Chain from_base;
  if (!parts_->tree.getChain(base, tip, from_base)) {
    throw std::runtime_error("KDL: no chain from " + base + " to " + tip);
  }
  Chain result;
  result.parts_ = std::make_shared<Chain::Parts>(from_base);
  for (const KDL::Segment& segment : from_base.segments) {
    if (segment.getJoint().getType() != KDL::Joint::Fixed) {
      result.parts_->joints.push_back(segment.getJoint().getName());
    }
  }
  return result;
}

const std::vector<std::string>& KdlHand::Chain::joints() const { return parts_->joints; }

Eigen::Isometry3d KdlHand::Chain::pose(const Eigen::VectorXd& q) const {
  KDL::Frame frame;
  require_success(parts_->forward.JntToCart(joint_array(q), frame));
  return isometry(frame);
}

Eigen::Matrix<double, 6, Eigen::Dynamic> KdlHand::Chain::jacobian(
    const Eigen::VectorXd& q, const Eigen::Vector3d& point_tip) const {
  KDL::Jacobian result(static_cast<unsigned>(q.size()));
  require_success(parts_->jacobian.JntToJac(joint_array(q), result));
  const Eigen::Vector3d arm = pose(q).linear() * point_tip;
  result.changeRefPoint(KDL::Vector(arm.x(), arm.y(), arm.z()));
  return result.data;
}

}  // namespace graspfit::testing
