#include "graspfit/grasp/grasp_planner.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "graspfit/hands/hand_model.hpp"
#include "internal/object_size.hpp"
#include "internal/planner_attempts.hpp"
#include "internal/sized_planning.hpp"

namespace graspfit::grasp {
namespace {

using Clock = std::chrono::steady_clock;

/// Takes the results of attempts in the order of their numbers, whoever made them, until the run is
/// over. So nothing depends on the number of threads.
class Run {
 public:
  Run(const ObjectModel& object, const hands::HandModel& hand, const PlannerOptions& options,
      const Surroundings& surroundings, internal::SizeCheck size_check,
      const PlannerProgress& progress, const std::stop_token& stop)
      : attempts_(object, hand, options, surroundings, size_check),
        hand_(hand),
        options_(options),
        progress_(progress),
        stop_(stop) {
    for (int outcome = 0; outcome <= static_cast<int>(AttemptOutcome::PoorShape); ++outcome) {
      result_.statistics.outcomes[static_cast<AttemptOutcome>(outcome)] = 0;
    }
    for (const std::string& failure : attempts_.guidance().failures()) {
      result_.statistics.target_failures[failure] = 0;
    }
    result_.statistics.guidance = attempts_.guidance().counts();
    result_.timings.guidance_s = attempts_.guidance_s();
  }

  PlannerResult operator()(int num_threads) {
    const std::size_t wanted = num_threads > 0 ? static_cast<std::size_t>(num_threads)
                                               : std::max(1U, std::thread::hardware_concurrency());
    const std::size_t useful =
        std::min(wanted, static_cast<std::size_t>(std::max(1, options_.max_attempts)));
    {
      std::vector<std::jthread> threads;
      for (std::size_t t = 1; t < useful; ++t) threads.emplace_back([this] { work(); });
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    if (!is_over_ && stop_.stop_requested()) end(PlannerStop::Interrupted);
    select();
    result_.timings.total_s = seconds_since_start();
    return std::move(result_);
  }

 private:
  double seconds_since_start() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

  /// One thread: makes attempts until there are no more to make.
  void work() {
    while (!is_over_ && !stop_.stop_requested()) {
      const std::int64_t number = next_++;
      if (number >= options_.max_attempts) return;
      try {
        internal::AttemptResult made = attempts_.make(number);
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
    if (progress_) {
      progress_(statistics.attempts, static_cast<std::int64_t>(result_.grasps.size()));
    }
    if (options_.search == SearchRule::First &&
        static_cast<int>(result_.grasps.size()) >= options_.count) {
      end(PlannerStop::Count);
    } else if (num_taken_ == options_.max_attempts) {
      end(PlannerStop::Attempts);
    } else if (options_.max_iterations &&
               statistics.fitting_iterations + statistics.refinement_iterations >=
                   *options_.max_iterations) {
      end(PlannerStop::Iterations);
    } else if (options_.wall_clock_limit_s &&
               seconds_since_start() > *options_.wall_clock_limit_s) {
      end(PlannerStop::WallClock);
    }
  }

  void end(PlannerStop stop) {
    result_.stop = stop;
    is_over_ = true;
  }

  bool is_unlike(const Grasp& grasp, const std::vector<Grasp>& others) const {
    return std::all_of(others.begin(), others.end(), [&](const Grasp& other) {
      return are_distinct(hand_, grasp.configuration, other.configuration, options_.distinct);
    });
  }

  /// In the search for the first grasps, only those that differ from all before them.
  void keep(Grasp grasp) {
    if (options_.search == SearchRule::Best || is_unlike(grasp, result_.grasps)) {
      result_.grasps.push_back(std::move(grasp));
    } else {
      ++result_.statistics.duplicates;
    }
  }

  /// Best M first; of those too like a better one, none.
  void select() {
    std::stable_sort(result_.grasps.begin(), result_.grasps.end(),
                     [](const Grasp& a, const Grasp& b) { return a.quality.m > b.quality.m; });
    if (options_.search == SearchRule::First) return;
    std::vector<Grasp> selected;
    for (Grasp& grasp : result_.grasps) {
      if (!is_unlike(grasp, selected)) {
        ++result_.statistics.duplicates;
      } else if (static_cast<int>(selected.size()) < options_.count) {
        selected.push_back(std::move(grasp));
      }
    }
    result_.grasps = std::move(selected);
  }

  const Clock::time_point start_ = Clock::now();
  const internal::PlannerAttempts attempts_;
  const hands::HandModel& hand_;
  const PlannerOptions& options_;
  const PlannerProgress& progress_;
  const std::stop_token& stop_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> is_over_ = false;
  std::mutex lock_;  ///< Of all below.
  std::map<std::int64_t, internal::AttemptResult> waiting_;
  std::int64_t num_taken_ = 0;
  std::exception_ptr failure_;
  PlannerResult result_;
};

}  // namespace

PlannerTimings& PlannerTimings::operator+=(const PlannerTimings& other) {
  targets_s += other.targets_s;
  fitting_s += other.fitting_s;
  contact_tests_s += other.contact_tests_s;
  refinement_s += other.refinement_s;
  measure_s += other.measure_s;
  pre_grasp_s += other.pre_grasp_s;
  return *this;
}

ObjectModel prepare_object(const geometry::TriangleMesh& mesh, const hands::HandModel& hand,
                           const PlannerOptions& options, ObjectModelTimings* timings,
                           const geometry::ContentCache& cache) {
  options.validate();
  internal::check_object_size(mesh, hand, requested_parts(hand, options).fingers,
                              2.0 * hands::largest_reach(hand));
  return internal::prepare_sized_object(mesh, options, timings, cache);
}

ObjectModel internal::prepare_sized_object(const geometry::TriangleMesh& mesh,
                                           const PlannerOptions& options,
                                           ObjectModelTimings* timings,
                                           const geometry::ContentCache& cache) {
  ObjectModelOptions object_options;
  object_options.resolution = options.resolution;
  object_options.averaging = options.averaging;
  object_options.score = options.score;
  object_options.weak = options.weak;
  return cached_object_model(mesh, object_options, cache, timings);
}

PlannerResult plan_grasps(const ObjectModel& object, const hands::HandModel& hand,
                          const PlannerOptions& options, const Surroundings& surroundings,
                          int num_threads, const PlannerProgress& progress,
                          const std::stop_token& stop) {
  return Run(object, hand, options, surroundings, internal::SizeCheck::Due, progress,
             stop)(num_threads);
}

PlannerResult internal::plan_sized_grasps(const ObjectModel& object, const hands::HandModel& hand,
                                          const PlannerOptions& options,
                                          const Surroundings& surroundings, int num_threads) {
  const PlannerProgress silent;
  const std::stop_token none;
  return Run(object, hand, options, surroundings, SizeCheck::Done, silent, none)(num_threads);
}

}  // namespace graspfit::grasp
