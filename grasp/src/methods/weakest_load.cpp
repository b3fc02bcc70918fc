#include "methods/weakest_load.hpp"

#include <algorithm>
#include <limits>

#include "graspfit/base/random.hpp"

namespace graspfit::grasp::internal {
namespace {

using Load = Eigen::Matrix<double, 6, 1>;

// More loads and steps make the bound tighter.
constexpr std::size_t kLoads = 64;
constexpr int kSteps = 60;
constexpr double kFirstStep = 0.5;  // of a unit load

}  // namespace

WeakestLoad::WeakestLoad() {
  base::Random random(1);
  while (loads_.size() < kLoads) {
    Load load;
    for (int i = 0; i < 6; ++i) load[i] = random.uniform(-1.0, 1.0);
    if (load.squaredNorm() <= 1.0 && load.squaredNorm() > 0.01) loads_.push_back(load.normalized());
  }
}

double WeakestLoad::withstood(const contact::Wrenches& wrenches) const {
  Load weakest = loads_.front();
  double least = std::numeric_limits<double>::infinity();
  for (const Load& load : loads_) {
    const double value = (load.transpose() * wrenches).maxCoeff();
    if (value >= least) continue;
    least = value;
    weakest = load;
  }
  for (int step = 1; step <= kSteps; ++step) {
    Eigen::Index farthest = 0;
    least = std::min(least, (weakest.transpose() * wrenches).maxCoeff(&farthest));
    const Load wrench = wrenches.col(farthest);
    const Load across = wrench - wrench.dot(weakest) * weakest;
    if (!(across.norm() > 0.0)) break;
    weakest = (weakest - (kFirstStep / step) * across.normalized()).normalized();
  }
  return least;
}

}  // namespace graspfit::grasp::internal
