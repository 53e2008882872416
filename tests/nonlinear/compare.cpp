#include "tests/nonlinear/compare.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "core/mismatch/lagged_correlation.hpp"
#include "core/monitor/monitor.hpp"
#include "core/nonlinear/rank_window.hpp"
#include "sim/loop/closed_loop.hpp"
#include "sim/scenario/prepare.hpp"
#include "tests/nonlinear/one_run.hpp"
#include "tests/study/interval.hpp"
#include "tests/study/report.hpp"

namespace mpm::nonlinear {
namespace {

constexpr int kSamples = kAsked.back();
constexpr std::size_t kMethodCount = kMethods.size();

// Seconds of this thread.
double computing_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::size_t index_of(Method method) { return static_cast<std::size_t>(method); }

/// What one loop's samples are given to, and what is asked of it.
class Watcher {
 public:
  virtual ~Watcher() = default;
  virtual void push(const Frame& frame) = 0;
  /// Per channel.
  virtual void ask(Comparison& into, std::size_t moment) = 0;
  double seconds = 0.0;
};

Eigen::VectorXd residual_of(const Frame& frame) {
  return frame[SignalKind::kCv].values - frame[SignalKind::kPrediction].values;
}

Eigen::VectorXd inputs_of(const Frame& frame) {
  const Eigen::VectorXd& mv = frame[SignalKind::kMv].values;
  const Eigen::VectorXd& dv = frame[SignalKind::kDv].values;
  Eigen::VectorXd inputs(mv.size() + dv.size());
  inputs << mv, dv;
  return inputs;
}

class Correlations : public Watcher {
 public:
  Correlations(Method method, const SignalCounts& counts, CorrelationKind kind)
      : method_(method),
        correlation_({counts.inputs(), counts.cv, kControlled, kFirstLag, kLastLag, kind},
                     kLambda) {}
  void push(const Frame& frame) override {
    correlation_.update(inputs_of(frame), residual_of(frame));
  }
  void ask(Comparison& into, std::size_t moment) override {
    correlation_.evaluate();
    std::vector<double>& says = into.says[index_of(method_)][moment];
    for (int i = 0; i < correlation_.inputs(); ++i)
      for (int j = 0; j < correlation_.cvs(); ++j)
        says.push_back(correlation_.correlations(j, i).cwiseAbs().maxCoeff());
  }

 private:
  // As the monitor's (core/monitor/settings.hpp).
  static constexpr int kControlled = 40, kFirstLag = -10, kLastLag = 20;
  static constexpr double kLambda = 3999.0 / 4001.0;
  Method method_;
  LaggedCorrelation correlation_;
};

// Signals: the inputs as of 20 samples ago, and the residuals of each CV from then on.
class Ranks : public Watcher {
 public:
  explicit Ranks(const SignalCounts& counts)
      : inputs_(counts.inputs()),
        cvs_(counts.cv),
        past_(kLast + 1, Eigen::VectorXd::Zero(inputs_)),
        residuals_(kLast + 1, Eigen::VectorXd::Zero(cvs_)),
        window_(inputs_ + cvs_ * kLags, kSamples),
        row_(window_.signals()) {}
  void push(const Frame& frame) override {
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    std::rotate(residuals_.begin(), residuals_.end() - 1, residuals_.end());
    past_.front() = inputs_of(frame);
    residuals_.front() = residual_of(frame);
    if (++seen_ <= kLast) return;
    row_.head(inputs_) = past_.back();
    for (int j = 0; j < cvs_; ++j)
      for (int l = 0; l < kLags; ++l)
        row_(signal(j, l)) = residuals_[static_cast<std::size_t>(kLast - l * kEvery)](j);
    window_.push(row_);
  }
  void ask(Comparison& into, std::size_t moment) override {
    for (int i = 0; i < inputs_; ++i) {
      std::vector<int> others;
      for (int o = 0; o < inputs_; ++o)
        if (o != i) others.push_back(o);
      for (int j = 0; j < cvs_; ++j) {
        double plain = 0.0, partial = 0.0;
        for (int l = 0; l < kLags; ++l) {
          plain = std::max(plain, std::abs(window_.coefficient(i, signal(j, l))));
          partial =
              std::max(partial, std::abs(window_.partial_coefficient(i, signal(j, l), others)));
        }
        into.says[index_of(Method::kSpearman)][moment].push_back(plain);
        into.says[index_of(Method::kRankPartial)][moment].push_back(partial);
      }
    }
  }

 private:
  static constexpr int kLast = 20, kEvery = 5, kLags = kLast / kEvery + 1;
  [[nodiscard]] int signal(int cv, int lag) const { return inputs_ + cv * kLags + lag; }
  int inputs_, cvs_;
  int seen_ = 0;
  std::vector<Eigen::VectorXd> past_, residuals_;  // newest first
  RankWindow window_;
  Eigen::VectorXd row_;
};

class Monitored : public Watcher {
 public:
  Monitored(Method method, config::UnitConfig unit, NonlinearTest test) : method_(method) {
    unit.monitor.nonlinear = test;
    counts_ = unit.counts();
    std::vector<bool> has_prediction;
    for (const config::CvSignal& cv : unit.cv) has_prediction.push_back(!cv.prediction.empty());
    monitor_ =
        std::make_unique<Monitor>(unit.model, counts_, has_prediction, unit.monitor, unit.alarms);
  }
  void push(const Frame& frame) override { monitor_->push(frame); }
  void ask(Comparison& into, std::size_t moment) override {
    for (int i = 0; i < counts_.inputs(); ++i)
      for (int j = 0; j < counts_.cv; ++j) {
        const bool said =
            method_ == Method::kLinear
                ? monitor_->channel(j, i).verdict == Verdict::kMismatch
                : monitor_->nonlinearity(j, i).verdict == NonlinearVerdict::kNonlinear;
        into.says[index_of(method_)][moment].push_back(said ? 1.0 : 0.0);
      }
  }

 private:
  Method method_;
  SignalCounts counts_;
  std::unique_ptr<Monitor> monitor_;
};

template <class Run>
void for_each(int count, int threads, Run run) {
  std::atomic<int> next{0};
  std::vector<std::jthread> workers;
  for (int t = 0; t < threads; ++t)
    workers.emplace_back([&] {
      for (int i = next++; i < count; i = next++) run(i);
    });
}

std::vector<Comparison> compare_all(const Case& one, std::uint64_t first, int runs, int threads) {
  std::string why_not;
  const auto prepared = prepare_case(one, kSamples, NonlinearTest::kOff, why_not);
  if (!prepared) throw std::runtime_error(one.name + ": " + why_not);
  std::vector<Comparison> all(static_cast<std::size_t>(runs));
  for_each(runs, threads, [&](int i) {
    all[static_cast<std::size_t>(i)] = compare(*prepared, first + static_cast<std::uint64_t>(i));
  });
  return all;
}

/// Per method and moment the magnitude beyond which a channel counts as seen.
using Thresholds = std::array<std::array<double, kAsked.size()>, kMethodCount>;

Thresholds thresholds_of(const std::vector<Comparison>& healthy) {
  constexpr double kQuantile = 0.99;
  Thresholds thresholds;
  for (std::size_t m = 0; m < kMethodCount; ++m)
    for (std::size_t t = 0; t < kAsked.size(); ++t) {
      std::vector<double> values;
      for (const Comparison& run : healthy)
        values.insert(values.end(), run.says[m][t].begin(), run.says[m][t].end());
      thresholds[m][t] = m < kCorrelations ? study::quantile(values, kQuantile) : 0.5;
    }
  return thresholds;
}

bool sees(const Case& one, const Comparison& run, std::size_t method, std::size_t moment,
          const Thresholds& thresholds) {
  return std::any_of(one.nonlinear.begin(), one.nonlinear.end(), [&](int channel) {
    return run.says[method][moment][static_cast<std::size_t>(channel)] > thresholds[method][moment];
  });
}

std::string percent(const study::Share& share) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.0f [%.0f, %.0f]", 100.0 * share.rate(),
                100.0 * share.interval.low, 100.0 * share.interval.high);
  return share.total > 0 ? text.data() : "-";
}

// Samples from which on nine runs of ten see it.
std::string samples_needed(const Case& one, const std::vector<Comparison>& runs, std::size_t method,
                           const Thresholds& thresholds) {
  constexpr double kMostRuns = 0.9;
  std::size_t from = kAsked.size();
  for (std::size_t t = kAsked.size(); t-- > 0;) {
    double seen = 0.0, total = 0.0;
    for (const Comparison& run : runs) {
      if (run.diverged) continue;
      seen += sees(one, run, method, t, thresholds) ? 1.0 : 0.0;
      total += 1.0;
    }
    if (seen < kMostRuns * total) break;
    from = t;
  }
  return from < kAsked.size() ? std::to_string(kAsked[from]) : "-";
}

std::string cell(const Case& one, const std::vector<Comparison>& runs, std::size_t method,
                 const Thresholds& thresholds) {
  const std::size_t last = kAsked.size() - 1;
  std::vector<study::Count> found, blamed;
  for (const Comparison& run : runs) {
    if (run.diverged) continue;
    if (!one.nonlinear.empty())
      found.push_back({sees(one, run, method, last, thresholds) ? 1 : 0, 1});
    study::Count others;
    for (std::size_t c = 0; c < run.says[method][last].size(); ++c) {
      if (std::find(one.nonlinear.begin(), one.nonlinear.end(), static_cast<int>(c)) !=
          one.nonlinear.end())
        continue;
      others.hits += run.says[method][last][c] > thresholds[method][last] ? 1 : 0;
      ++others.total;
    }
    blamed.push_back(others);
  }
  const std::string others = percent(study::share_of(blamed));
  if (one.nonlinear.empty()) return others;
  return percent(study::share_of(found)) + "; " + samples_needed(one, runs, method, thresholds) +
         "; " + others;
}

Blame blame_of(const Case& one, const std::vector<Comparison>& runs, const Thresholds& thresholds) {
  const std::size_t last = kAsked.size() - 1;
  Blame blame{one, 0, {}};
  for (const Comparison& run : runs) {
    if (run.diverged) continue;
    ++blame.runs;
    for (std::size_t m = 0; m < kMethodCount; ++m) {
      const std::vector<double>& says = run.says[m][last];
      blame.blamed[m].resize(says.size());
      for (std::size_t c = 0; c < says.size(); ++c)
        blame.blamed[m][c] += says[c] > thresholds[m][last] ? 1 : 0;
    }
  }
  return blame;
}

}  // namespace

Comparison compare(const study::Prepared& prepared, std::uint64_t seed) {
  sim::LoopSetup setup = prepared.setup;
  setup.seed = seed;
  sim::hide_changes(setup);
  setup.changes.insert(setup.changes.end(), prepared.experiment.changes.begin(),
                       prepared.experiment.changes.end());
  const SignalCounts counts = setup.unit.counts();
  std::vector<std::unique_ptr<Watcher>> watchers;
  watchers.push_back(std::make_unique<Correlations>(Method::kConventional, counts,
                                                    CorrelationKind::kConventional));
  watchers.push_back(std::make_unique<Correlations>(Method::kLaggedPartial, counts,
                                                    CorrelationKind::kLaggedPartial));
  watchers.push_back(std::make_unique<Ranks>(counts));
  const auto monitored = [&](Method method, NonlinearTest test) {
    watchers.push_back(std::make_unique<Monitored>(method, setup.unit, test));
  };
  monitored(Method::kLinear, NonlinearTest::kOff);
  monitored(Method::kPolynomial, NonlinearTest::kPolynomial);
  monitored(Method::kKernel, NonlinearTest::kKernel);
  monitored(Method::kRandomFeatures, NonlinearTest::kRandomFeatures);
  sim::ClosedLoop loop(setup);
  Comparison result;
  std::size_t moment = 0;
  for (int k = 0; k < kSamples; ++k) {
    const Frame& frame = loop.step();
    if (!loop.finite()) {
      result.diverged = true;
      return result;
    }
    for (const auto& watcher : watchers) {
      const double begin = computing_time_s();
      watcher->push(frame);
      watcher->seconds += computing_time_s() - begin;
    }
    if (k + 1 != kAsked[moment]) continue;
    for (const auto& watcher : watchers) watcher->ask(result, moment);
    ++moment;
  }
  // The ranks serve two methods; the nonlinear tests take what they add to the linear one.
  constexpr std::array<std::size_t, kMethodCount> kWatcher = {0, 1, 2, 2, 3, 4, 5, 6};
  for (std::size_t m = 0; m < kMethodCount; ++m)
    result.microseconds[m] = 1e6 * watchers[kWatcher[m]]->seconds / kSamples;
  const double linear = result.microseconds[index_of(Method::kLinear)];
  for (std::size_t m = index_of(Method::kPolynomial); m < kMethodCount; ++m)
    result.microseconds[m] -= linear;
  return result;
}

MethodScores compare_methods(const CompareOptions& options) {
  const std::vector<Comparison> healthy = compare_all(
      Case{.name = "healthy"}, options.first_healthy, options.healthy_runs, options.threads);
  const Thresholds thresholds = thresholds_of(healthy);
  MethodScores scores;
  std::string& table = scores.table;
  table = "| case";
  for (const char* name : kMethodNames) table += std::string(" | ") + name;
  table += " |\n|---|---|---|---|---|---|---|---|---|\n";
  std::array<std::vector<double>, kMethodCount> times;
  for (const Case& one : all_cases()) {
    const bool compared = one.truth == Truth::kNonlinear || one.name == "shell3x3_none" ||
                          one.name == "linear_gain+50_y1u1";
    if (!compared || !study::matches(options.only, one.name)) continue;
    const std::vector<Comparison> runs =
        compare_all(one, options.first, options.runs, options.threads);
    std::string row = "| " + one.name;
    for (std::size_t m = 0; m < kMethodCount; ++m) row += " | " + cell(one, runs, m, thresholds);
    row += " |\n";
    std::cout << row << std::flush;
    table += row;
    scores.blames.push_back(blame_of(one, runs, thresholds));
    for (const Comparison& run : runs)
      for (std::size_t m = 0; m < kMethodCount && !run.diverged; ++m)
        times[m].push_back(run.microseconds[m]);
  }
  table += "| us a sample";
  for (const std::vector<double>& of : times) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), " | %.3g", study::quantile(of, 0.5));
    table += text.data();
  }
  table += " |\n";
  return scores;
}

}  // namespace mpm::nonlinear
