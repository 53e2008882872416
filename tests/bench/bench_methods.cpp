// What each method of looking for a mismatch takes (docs/nonlinear.md), on a unit under random
// moves whose channels are those of config/plants/shell3x3.yaml, over and over:
//   bench_methods MVS CVS SECONDS ROUNDS
// A line for each method: its name, microseconds of computing time a sample, microseconds to read
// all channels off where that waits until somebody asks (else 0), kilobytes of heap once it has all
// that it needs; times are medians of rounds of so many seconds, in which the methods take turns.
#include <malloc.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/mismatch/lagged_correlation.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/monitor.hpp"
#include "core/nonlinear/rank_window.hpp"

namespace mpm {
namespace {

constexpr int kBlock = 128;    // samples between two looks at the clock
constexpr int kFewest = 4000;  // samples before anything is measured
constexpr int kMostWarming = 40000;

/// Of this process, all its threads.
double computing_time_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Large blocks are not among `uordblks`.
double heap_kb() {
  const auto now = mallinfo2();
  return static_cast<double>(now.uordblks + now.hblkhd) / 1024.0;
}

struct Size {
  int mvs, cvs;
};

ModelSpec model_of(const Size& size) {
  struct Shell {
    double gain, time_constant, dead_time;
  };
  constexpr std::array<std::array<Shell, 3>, 3> kShell = {
      {{{{4.05, 50, 6}, {1.77, 60, 7}, {5.88, 50, 6}}},
       {{{5.39, 50, 4}, {5.72, 60, 3}, {6.90, 40, 3}}},
       {{{4.38, 33, 5}, {4.42, 44, 5}, {7.20, 19, 0}}}}};
  ModelSpec spec;
  spec.input_count = size.mvs;
  spec.cv_count = size.cvs;
  for (int j = 0; j < size.cvs; ++j)
    for (int i = 0; i < size.mvs; ++i) {
      const Shell& shell = kShell[static_cast<std::size_t>(j % 3)][static_cast<std::size_t>(i % 3)];
      spec.channels.push_back(
          {j, i, TransferFunction{shell.gain, {shell.time_constant}, 0.0, shell.dead_time, false}});
    }
  return spec;
}

/// Autoregressive signals that never come again: a sample that does is no new evidence, and what is
/// chance in it looks like a mismatch for ever.
class Noise {
 public:
  Noise(int count, double pole, double innovation, std::uint64_t seed)
      : pole_(pole), innovation_(innovation), state_(Eigen::VectorXd::Zero(count)), random_(seed) {}
  const Eigen::VectorXd& next() {
    for (double& value : state_) value = pole_ * value + innovation_ * normal_(random_);
    return state_;
  }

 private:
  double pole_, innovation_;
  Eigen::VectorXd state_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// The controller's model is right.
class Unit {
 public:
  explicit Unit(const Size& size)
      : plant_(model_of(size)), moves_(size.mvs, 0.95, 0.05, 1), noise_(size.cvs, 0.95, 0.01, 2) {
    const SignalCounts counts{size.mvs, 0, size.cvs};
    for (Frame& frame : frames_)
      for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv, SignalKind::kPrediction}) {
        frame[kind].resize(counts.of(kind));
        std::fill(frame[kind].quality.begin(), frame[kind].quality.end(), Quality::kGood);
      }
  }
  /// The next ones.
  const std::vector<Frame>& block() {
    for (Frame& frame : frames_) {
      frame.interval = interval_++;
      frame.source_time_ns = frame.interval * 1'000'000'000;
      frame[SignalKind::kMv].values = moves_.next();
      frame[SignalKind::kPrediction].values = plant_.output();
      frame[SignalKind::kCv].values = plant_.output() + noise_.next();
      plant_.advance(frame[SignalKind::kMv].values);
    }
    return frames_;
  }

 private:
  LinearModel plant_;
  Noise moves_, noise_;
  std::vector<Frame> frames_ = std::vector<Frame>(kBlock);
  std::int64_t interval_ = 0;
};

class Method {
 public:
  virtual ~Method() = default;
  virtual void push(const Frame& frame) = 0;
  /// All channels; false: `push` has done it.
  virtual bool read_off() = 0;
  /// Costs what it will cost for good.
  [[nodiscard]] virtual bool warm() const = 0;
};

/// Lags, controls and memory as the monitor has them.
class Correlations : public Method {
 public:
  Correlations(const Size& size, CorrelationKind kind)
      : correlation_({size.mvs, size.cvs, 40, -10, 20, kind}, 3999.0 / 4001.0) {}
  void push(const Frame& frame) override {
    correlation_.update(frame[SignalKind::kMv].values,
                        frame[SignalKind::kCv].values - frame[SignalKind::kPrediction].values);
  }
  bool read_off() override {
    correlation_.evaluate();
    return true;
  }
  [[nodiscard]] bool warm() const override { return true; }

 private:
  LaggedCorrelation correlation_;
};

/// Ranks of all inputs and of all residuals at five lags, over 3000 samples.
class Ranks : public Method {
 public:
  Ranks(const Size& size, bool partial)
      : size_(size),
        partial_(partial),
        window_(size.mvs + kLags * size.cvs, 3000),
        past_(kLags * size.cvs),
        row_(window_.signals()) {
    past_.setZero();
  }
  void push(const Frame& frame) override {
    // Which samples the residuals are of makes no difference to the cost.
    past_.tail((kLags - 1) * size_.cvs) = past_.head((kLags - 1) * size_.cvs).eval();
    past_.head(size_.cvs) = frame[SignalKind::kCv].values - frame[SignalKind::kPrediction].values;
    row_ << frame[SignalKind::kMv].values, past_;
    window_.push(row_);
  }
  bool read_off() override {
    double largest = 0.0;
    for (int i = 0; i < size_.mvs; ++i) {
      std::vector<int> others;
      for (int o = 0; o < size_.mvs; ++o)
        if (o != i) others.push_back(o);
      for (int s = size_.mvs; s < window_.signals(); ++s)
        largest = std::max(largest, std::abs(partial_ ? window_.partial_coefficient(i, s, others)
                                                      : window_.coefficient(i, s)));
    }
    return largest >= 0.0;
  }
  [[nodiscard]] bool warm() const override { return true; }

 private:
  static constexpr int kLags = 5;
  Size size_;
  bool partial_;
  RankWindow window_;
  Eigen::VectorXd past_, row_;
};

/// The whole monitor, with this nonlinear test beside the linear one.
class Monitored : public Method {
 public:
  Monitored(const Size& size, NonlinearTest test)
      : size_(size),
        on_(test != NonlinearTest::kOff),
        monitor_(model_of(size), {size.mvs, 0, size.cvs},
                 std::vector<bool>(static_cast<std::size_t>(size.cvs), true), with(test), {}) {}
  void push(const Frame& frame) override { monitor_.push(frame); }
  bool read_off() override { return false; }
  [[nodiscard]] bool warm() const override {
    for (int j = 0; j < size_.cvs; ++j)
      for (int i = 0; i < size_.mvs; ++i)
        if (on_ ? !(monitor_.nonlinearity(j, i).statistic > 0.0)
                : monitor_.channel(j, i).reason == Reason::kWarmingUp)
          return false;
    return true;
  }

 private:
  static MonitorSettings with(NonlinearTest test) {
    MonitorSettings settings;
    settings.nonlinear = test;
    return settings;
  }
  Size size_;
  bool on_;
  Monitor monitor_;
};

struct Row {
  std::string name;
  std::function<std::unique_ptr<Method>()> make;
  std::unique_ptr<Method> method = nullptr;
  std::unique_ptr<Unit> unit = nullptr;  // each sees the same signals
  double kilobytes = 0.0;
  std::vector<double> sample_us = {}, read_us = {};
};

void warm_up(Row& row, const Size& size) {
  row.unit = std::make_unique<Unit>(size);
  const double before = heap_kb();
  row.method = row.make();
  for (int k = 0; k < kFewest || (!row.method->warm() && k < kMostWarming); k += kBlock)
    for (const Frame& frame : row.unit->block()) row.method->push(frame);
  static_cast<void>(row.method->read_off());
  row.kilobytes = heap_kb() - before;
  if (!row.method->warm()) throw std::runtime_error(row.name + " never says anything");
}

void time(Row& row, double seconds) {
  double took = 0.0;
  int samples = 0;
  do {
    const std::vector<Frame>& frames = row.unit->block();
    const double begin = computing_time_s();
    for (const Frame& frame : frames) row.method->push(frame);
    took += computing_time_s() - begin;
    samples += kBlock;
  } while (took < seconds);
  row.sample_us.push_back(1e6 * took / samples);
  const double begin = computing_time_s();
  const bool waits = row.method->read_off();
  row.read_us.push_back(waits ? 1e6 * (computing_time_s() - begin) : 0.0);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void run(const Size& size, double seconds, int rounds) {
  std::vector<Row> rows;
  const auto add = [&](const char* name, auto make) { rows.push_back({name, make}); };
  for (const auto& [name, kind] : {std::pair{"correlation", CorrelationKind::kConventional},
                                   {"lagged_partial", CorrelationKind::kLaggedPartial}})
    add(name, [size, kind = kind] { return std::make_unique<Correlations>(size, kind); });
  for (const auto& [name, partial] : {std::pair{"spearman", false}, {"rank_partial", true}})
    add(name, [size, partial = partial] { return std::make_unique<Ranks>(size, partial); });
  for (const auto& [name, test] : {std::pair{"linear", NonlinearTest::kOff},
                                   {"polynomial", NonlinearTest::kPolynomial},
                                   {"kernel", NonlinearTest::kKernel},
                                   {"random_features", NonlinearTest::kRandomFeatures}})
    add(name, [size, test = test] { return std::make_unique<Monitored>(size, test); });
  for (Row& row : rows) warm_up(row, size);
  for (int round = 0; round < rounds; ++round)
    for (Row& row : rows) time(row, seconds);
  for (const Row& row : rows)
    std::cout << row.name << ' ' << median(row.sample_us) << ' ' << median(row.read_us) << ' '
              << row.kilobytes << '\n';
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() != 4) throw std::invalid_argument("four numbers, see the head of it");
    mpm::run({std::stoi(arguments[0]), std::stoi(arguments[1])}, std::stod(arguments[2]),
             std::stoi(arguments[3]));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_methods: " << error.what() << '\n';
    return 2;
  }
}
