#include "graspfit/grasp/grasp_planner.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/stopwatch.hpp"
#include "graspfit/hands/hand_model.hpp"
#include "planner/planner_attempts.hpp"
#include "targets/object_size.hpp"

namespace graspfit::grasp {
namespace {

using Clock = std::chrono::steady_clock;

/// Takes the results of attempts in the order of their numbers, whoever made them, until the run is
/// over. So nothing depends on the number of threads.
class Search {
 public:
  Search(const ObjectModel& object, const hands::HandModel& hand, const PlannerOptions& options,
         const Surroundings& surroundings, const PlanningRun& run)
      : attempts_(object, hand, options, surroundings, run.methods),
        hand_(hand),
        options_(options),
        run_(run) {
    for (int outcome = 0; outcome <= static_cast<int>(AttemptOutcome::PoorShape); ++outcome) {
      result_.statistics.outcomes[static_cast<AttemptOutcome>(outcome)] = 0;
    }
    for (const std::string& failure : attempts_.guidance().failures()) {
      result_.statistics.target_failures[failure] = 0;
    }
    result_.statistics.guidance = attempts_.guidance().counts();
    result_.timings.object = object.timings;
    result_.timings.guidance_s = attempts_.guidance_s();
  }

  PlannerResult operator()() {
    const std::size_t wanted = run_.num_threads > 0
                                   ? static_cast<std::size_t>(run_.num_threads)
                                   : std::max(1U, std::thread::hardware_concurrency());
    const std::size_t useful =
        std::min(wanted, static_cast<std::size_t>(std::max(1, options_.max_attempts)));
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 1; t < useful; ++t) threads.emplace_back([this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    if (!is_over_ && run_.stop.stop_requested()) end(PlannerStop::Interrupted);
    select();
    result_.timings.total_s = base::seconds_since(start_);
    return std::move(result_);
  }

 private:
  /// One thread: makes attempts until there are no more to make.
  void work() {
    while (!is_over_ && !run_.stop.stop_requested()) {
      const std::int64_t number = next_++;
      if (number >= options_.max_attempts) return;
      try {
        internal::AttemptResult made = attempts_.make(number, run_.tried_start);
        const std::lock_guard<std::mutex> lock(lock_);
        waiting_.emplace(number, std::move(made));
        take_in_order();
      } catch (...) {
        const std::lock_guard<std::mutex> lock(lock_);
        if (!failure_) failure_ = std::current_exception();
        is_over_ = true;
      }
    }
  }

  void take_in_order() {
    while (!is_over_ && !waiting_.empty() && waiting_.begin()->first == num_taken_) {
      take(std::move(waiting_.begin()->second));
      waiting_.erase(waiting_.begin());
    }
  }

  void take(internal::AttemptResult made) {
    ++num_taken_;
    PlannerStatistics& statistics = result_.statistics;
    result_.timings += made.timings;
    if (made.target_failure) {
      ++statistics.target_failures[*made.target_failure];
    }
    if (made.is_exhausted) {
      end(PlannerStop::Exhausted);
      return;
    }
    ++statistics.attempts;
    ++statistics.outcomes[made.outcome];
    statistics.seeds_tried += made.seeds_tried;
    statistics.fitting_iterations += made.fitting_iterations;
    statistics.refinement_iterations += made.refinement_iterations;
    if (made.grasp && made.is_accepted) keep(std::move(*made.grasp));
    if (run_.progress) {
      run_.progress(statistics.attempts, num_counted());
    }
    if (options_.search != SearchRule::Best && num_counted() >= options_.count) {
      end(PlannerStop::Count);
    } else if (num_taken_ == options_.max_attempts) {
      end(PlannerStop::Attempts);
    } else if (options_.max_iterations &&
               statistics.fitting_iterations + statistics.refinement_iterations >=
                   *options_.max_iterations) {
      end(PlannerStop::Iterations);
    } else if (options_.wall_clock_limit_s &&
               base::seconds_since(start_) > *options_.wall_clock_limit_s) {
      end(PlannerStop::WallClock);
    }
  }

  /// Whether an accepted grasp is one of those that are wanted.
  bool counts(const Grasp& grasp) const {
    return options_.search != SearchRule::Closed || grasp.is_closed();
  }
  std::int64_t num_counted() const {
    return std::count_if(result_.grasps.begin(), result_.grasps.end(),
                         [&](const Grasp& grasp) { return counts(grasp); });
  }

  void end(PlannerStop stop) {
    result_.stop = stop;
    is_over_ = true;
  }

  bool are_unlike(const Grasp& a, const Grasp& b) const {
    return are_distinct(hand_, a.configuration, b.configuration, options_.distinct);
  }

  /// Keeps a grasp; in the search for the first grasps, only one that differs from all that count
  /// before it.
  void keep(Grasp grasp) {
    const bool is_new =
        options_.search == SearchRule::Best || !counts(grasp) ||
        std::none_of(result_.grasps.begin(), result_.grasps.end(), [&](const Grasp& other) {
          return counts(other) && !are_unlike(grasp, other);
        });
    if (is_new) {
      result_.grasps.push_back(std::move(grasp));
    } else {
      ++result_.statistics.duplicates;
    }
  }

  /// The grasps, best first, without those that are too like a better one.
  void select() {
    std::vector<Grasp> ranked = by_rank(std::move(result_.grasps));
    if (options_.search == SearchRule::First) {
      result_.grasps = std::move(ranked);
      return;
    }
    if (options_.search == SearchRule::Closed) {
      std::stable_partition(ranked.begin(), ranked.end(), std::mem_fn(&Grasp::is_closed));
    }
    std::vector<Grasp> selected;
    for (Grasp& grasp : ranked) {
      const bool is_unlike = std::all_of(selected.begin(), selected.end(), [&](const Grasp& other) {
        return are_unlike(grasp, other);
      });
      if (!is_unlike) {
        ++result_.statistics.duplicates;
      } else if (std::ssize(selected) < options_.count) {
        selected.push_back(std::move(grasp));
      }
    }
    result_.grasps = std::move(selected);
  }

  std::vector<Grasp> by_rank(std::vector<Grasp> grasps) const {
    using Rank = std::pair<double, double>;
    std::vector<std::pair<Rank, std::size_t>> order;
    for (std::size_t i = 0; i < grasps.size(); ++i) {
      const double strength = options_.rank == RankRule::M ? 0.0 : attempts_.strength(grasps[i]);
      order.push_back({{strength, grasps[i].quality.m}, i});
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Grasp> ranked;
    for (const auto& [rank, index] : order) ranked.push_back(std::move(grasps[index]));
    return ranked;
  }

  const Clock::time_point start_ = Clock::now();
  const internal::PlannerAttempts attempts_;
  const hands::HandModel& hand_;
  const PlannerOptions& options_;
  const PlanningRun& run_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> is_over_ = false;
  std::mutex lock_;  ///< Of all below.
  std::map<std::int64_t, internal::AttemptResult> waiting_;
  std::int64_t num_taken_ = 0;
  std::exception_ptr failure_;
  PlannerResult result_;
};

}  // namespace

std::optional<std::string> size_refusal(const geometry::TriangleMesh& mesh,
                                        const hands::HandModel& hand,
                                        const PlannerOptions& options) {
  return internal::size_refusal(mesh, hand, requested_parts(hand, options));
}

ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const PlannerOptions& options,
                           const base::ContentCache& cache) {
  options.validate();
  ObjectModelOptions object_options;
  object_options.resolution = options.resolution;
  object_options.averaging = options.averaging;
  object_options.score = options.score;
  object_options.weak = options.weak;
  return cached_object_model(mesh, object_options, cache);
}

ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options, const base::ContentCache& cache) {
  options.validate();
  if (const auto refusal = size_refusal(mesh, hand, options)) throw base::InvalidInput(*refusal);
  return prepare_object(mesh, options, cache);
}

PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const Surroundings& surroundings,
                          const PlanningRun& run) {
  return Search(object, hand, options, surroundings, run)();
}

GuidanceModel guidance_model(const ObjectModel& object, const hands::HandModel& hand,
                             const PlannerOptions& options, const Surroundings& surroundings) {
  return internal::PlannerAttempts(object, hand, options, surroundings, planning_methods())
      .guidance()
      .model();
}

void visit_starts(const ObjectModel& object, const hands::HandModel& hand,
                  const PlannerOptions& options, std::int64_t num_attempts,
                  const std::function<void(const GuidedStart&)>& visit,
                  const Surroundings& surroundings) {
  const internal::PlannerAttempts attempts(object, hand, options, surroundings, planning_methods());
  for (std::int64_t number = 0; number < num_attempts; ++number) {
    const GuidedStarts guided = attempts.guidance().starts(number);
    for (const GuidedStart& start : guided.starts) visit(start);
    if (guided.is_exhausted) return;
  }
}

}  // namespace graspfit::grasp
