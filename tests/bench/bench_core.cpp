// Times one case at a time, on request, so that the caller can take turns with the peers: reads
// lines "case seconds" and answers each with the median microseconds per call.
#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "core/mismatch/lagged_correlation.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/monitor/monitor.hpp"
#include "core/regression/givens_qr.hpp"
#include "sim/loop/closed_loop.hpp"

namespace mpm {
namespace {

using Step = std::function<void()>;
using Clock = std::chrono::steady_clock;

constexpr double kLambda = 0.999;
constexpr int kPool = 1024;  // different samples, then again from the first
constexpr int kFrames = 4000;
constexpr int kRemembered =
    8000;  // samples: of fewer rows than it takes nothing older is forgotten

double elapsed_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Median microseconds of one step, over batches of at least `fewest` and long enough for the
/// clock.
double measure(const Step& step, double seconds, int fewest) {
  constexpr double kBatch = 50e-6;
  const Clock::time_point begin = Clock::now();
  int batch = fewest;
  for (;; batch *= 2) {
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < batch; ++i) step();
    if (elapsed_s(start) >= kBatch) break;
  }
  std::vector<double> times;
  do {
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < batch; ++i) step();
    times.push_back(elapsed_s(start) / batch);
  } while (elapsed_s(begin) < seconds);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle * 1e6;
}

/// Columns of autoregressive noise, pole 0.5.
class Signals {
 public:
  Signals(int count, std::uint64_t seed, int samples = kPool) : values_(count, samples) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXd state = Eigen::VectorXd::Zero(count);
    for (int k = 0; k < samples; ++k) {
      for (int i = 0; i < count; ++i) state(i) = 0.5 * state(i) + normal(random);
      values_.col(k) = state;
    }
  }
  [[nodiscard]] Eigen::MatrixXd::ConstColXpr next() {
    at_ = at_ + 1 == values_.cols() ? 0 : at_ + 1;
    return now();
  }
  [[nodiscard]] Eigen::MatrixXd::ConstColXpr now() const { return values_.col(at_); }

 private:
  Eigen::MatrixXd values_;
  Eigen::Index at_ = 0;
};

struct Size {
  int mvs;
  int cvs;
  int lags;  // g
};
constexpr Size kSmall{3, 3, 40};
constexpr Size kLarge{10, 20, 60};

struct Lagged {
  explicit Lagged(const Size& size)
      : inputs(size.mvs, 1),
        residuals(size.cvs, 2),
        correlation({size.mvs, size.cvs, size.lags, -10, 20}, kLambda) {
    for (int k = 0; k < kPool; ++k) update();
    correlation.evaluate();
  }
  void update() { correlation.update(inputs.next(), residuals.next()); }

  Signals inputs, residuals;
  LaggedCorrelation correlation;
};

ModelSpec first_order_model(const Size& size) {
  ModelSpec spec;
  spec.input_count = size.mvs;
  spec.cv_count = size.cvs;
  for (int i = 0; i < size.mvs; ++i)
    for (int j = 0; j < size.cvs; ++j)
      spec.channels.push_back({j, i, TransferFunction{1.0 + i + j, {40.0}, 0.0, 5.0, false}});
  return spec;
}

/// Of samples that came before a test would find more than noise.
struct Channels {
  explicit Channels(const Size& size)
      : inputs(size.mvs, 1, kRemembered),
        residuals(size.cvs, 2, kRemembered),
        test({size.mvs, size.cvs, 20, 8, {std::exp(-1.0 / 40.0)}}, {{0.9995, 0}, {0.998, 0}},
             kRemembered, 8, LinearModel(first_order_model(size))) {
    while (test.memory(0).rows < 11 * test.shape().columns()) update();  // rows wait by now
    evaluate();
  }
  void evaluate() {
    for (int m = 0; m < test.memory_count(); ++m)
      for (int j = 0; j < test.shape().cvs; ++j) test.evaluate(j, m);
  }
  void update() { test.update(inputs.next(), residuals.next()); }

  Signals inputs, residuals;
  MismatchDetector test;
};

/// Noise that goes from each CV to the next one, of each of which one channel is wrong: all are
/// judged together with others.
struct Coupled {
  explicit Coupled(const Size& size)
      : inputs(size.mvs, 1, kRemembered),
        noise(size.cvs, 2, kRemembered),
        wrong(errors_of(first_order_model(size))),
        test({size.mvs, size.cvs, 20, 8, {std::exp(-1.0 / 40.0)}}, {{1.0, 0}}, kRemembered, 8,
             LinearModel(first_order_model(size))) {
    constexpr int kRowsPerColumn = 16;
    Eigen::VectorXd residuals = Eigen::VectorXd::Zero(size.cvs);
    for (int k = 0; k < kRowsPerColumn * test.shape().columns(); ++k) {
      for (int j = size.cvs - 1; j >= 0; --j)
        residuals(j) = 0.7 * residuals(j) + 0.25 * residuals(j > 0 ? j - 1 : size.cvs - 1);
      residuals += noise.next();
      test.update(inputs.next(), residuals + wrong.output());
      wrong.advance(inputs.now());
    }
    evaluate();
  }
  void evaluate() {
    for (int j = 0; j < test.shape().cvs; ++j) test.evaluate(j);
  }
  static ModelSpec errors_of(ModelSpec spec) {
    for (ChannelSpec& channel : spec.channels)
      std::get<TransferFunction>(channel.dynamics).gain *=
          channel.cv % spec.input_count == channel.input ? 1.0 : 0.0;
    return spec;
  }

  Signals inputs, noise;
  LinearModel wrong;
  MismatchDetector test;
};

struct Factor {
  Factor(int columns, int responses) : rows(columns + responses, 1), factor(columns, responses) {
    for (int k = 0; k < kPool; ++k) update();
  }
  void update() {
    std::copy_n(rows.next().data(), factor.columns() + factor.responses(), factor.row());
    factor.update(kLambda);
  }

  Signals rows;
  GivensQr factor;
};

/// The Shell unit under its controller.
struct Shell {
  explicit Shell(double max_move) {
    const std::string path = std::string(MPM_SOURCE_DIR) + "/config/plants/shell3x3.yaml";
    config::LoadResult loaded = config::load_unit(path);
    if (!loaded.ok()) throw std::runtime_error("cannot read " + path);
    setup.unit = std::move(loaded.config);
    for (config::MvLimits& limits : setup.unit.simulation.mv_limits)
      limits.max_move = std::min(max_move, limits.max_move.value_or(max_move));
    setup.controller_model = setup.unit.model;
    sim::ClosedLoop loop(setup);
    for (int k = 0; k < kFrames; ++k) frames.push_back(loop.step());
  }
  [[nodiscard]] Frame& next() {
    Frame& frame = frames[static_cast<std::size_t>(interval % kFrames)];
    frame.interval = interval++;
    return frame;
  }

  sim::LoopSetup setup;
  std::vector<Frame> frames;
  std::int64_t interval = 0;
};

struct Controlled : Shell {
  explicit Controlled(double largest)
      : Shell(largest), mpc(setup.controller_model, 3, setup.unit.simulation, 1.0) {}
  void step() {
    const Frame& frame = next();
    move = mpc.control(frame[SignalKind::kCv].values, frame[SignalKind::kSetpoint].values,
                       frame[SignalKind::kDv].values);
  }

  sim::Mpc mpc;
  Eigen::VectorXd move;
};

struct Monitored : Shell {
  Monitored()
      : Shell(1.0),
        monitor(setup.unit.model, setup.unit.counts(), {true, true, true}, setup.unit.monitor,
                setup.unit.alarms) {
    for (int k = 0; k < kFrames; ++k) step();
  }
  void step() { monitor.push(next()); }

  Monitor monitor;
};

/// A step that owns what it works on.
template <class T, class... Arguments>
std::shared_ptr<T> make(Arguments... arguments) {
  return std::make_shared<T>(arguments...);
}

int columns_of(const Size& size) { return (size.mvs - 1) * (size.lags + 1) + 1; }
int responses_of(const Size& size) { return 1 + 31 * size.cvs; }

Step lagged_step(const Size& size) {
  return [lagged = make<Lagged>(size)] {
    lagged->update();
    lagged->correlation.evaluate();
  };
}
Step lagged_update(const Size& size) {
  return [lagged = make<Lagged>(size)] { lagged->update(); };
}
Step lagged_evaluate(const Size& size) {
  return [lagged = make<Lagged>(size)] { lagged->correlation.evaluate(); };
}
Step channel_update(const Size& size) {
  return [channels = make<Channels>(size)] { channels->update(); };
}
Step channel_evaluate(const Size& size) {
  return [channels = make<Channels>(size)] { channels->evaluate(); };
}
Step coupled_evaluate(const Size& size) {
  return [coupled = make<Coupled>(size)] { coupled->evaluate(); };
}
Step givens_update(const Size& size) {
  return [factor = make<Factor>(columns_of(size), responses_of(size))] { factor->update(); };
}
Step mpc_step(double max_move) {
  return [controlled = make<Controlled>(max_move)] { controlled->step(); };
}
Step monitor_push() {
  return [monitored = make<Monitored>()] { monitored->step(); };
}

const std::map<std::string, std::function<Step()>>& cases() {
  static const std::map<std::string, std::function<Step()>> all{
      {"lagged_step_3x3", [] { return lagged_step(kSmall); }},
      {"lagged_step_10x20", [] { return lagged_step(kLarge); }},
      {"lagged_update_3x3", [] { return lagged_update(kSmall); }},
      {"lagged_update_10x20", [] { return lagged_update(kLarge); }},
      {"lagged_evaluate_3x3", [] { return lagged_evaluate(kSmall); }},
      {"lagged_evaluate_10x20", [] { return lagged_evaluate(kLarge); }},
      {"givens_update_3x3", [] { return givens_update(kSmall); }},
      {"givens_update_10x20", [] { return givens_update(kLarge); }},
      {"channel_update_3x3", [] { return channel_update(kSmall); }},
      {"channel_update_10x20", [] { return channel_update(kLarge); }},
      {"channel_evaluate_3x3", [] { return channel_evaluate(kSmall); }},
      {"channel_evaluate_10x20", [] { return channel_evaluate(kLarge); }},
      {"coupled_evaluate_3x3", [] { return coupled_evaluate(kSmall); }},
      {"coupled_evaluate_10x20", [] { return coupled_evaluate(kLarge); }},
      {"mpc_step_free", [] { return mpc_step(1.0); }},
      {"mpc_step_limited", [] { return mpc_step(0.02); }},
      {"monitor_push_3x3", [] { return monitor_push(); }},
  };
  return all;
}

int serve() {
  std::map<std::string, Step> made;
  std::string name;
  double seconds = 0.0;
  std::cout << MPM_COMPILER << std::endl;
  while (std::cin >> name >> seconds) {
    auto step = made.find(name);
    if (step == made.end()) {
      const auto found = cases().find(name);
      if (found == cases().end()) {
        std::cerr << "bench_core: no case " << name << '\n';
        return 3;
      }
      step = made.emplace(name, found->second()).first;
    }
    // Where rows wait for each other most steps do next to nothing.
    const bool waits = name.find("update") != std::string::npos || name.rfind("monitor_", 0) == 0;
    std::cout << measure(step->second, seconds, waits ? 64 : 1) << std::endl;
  }
  return 0;
}

}  // namespace
}  // namespace mpm

int main() {
  try {
    return mpm::serve();
  } catch (const std::exception& error) {
    std::cerr << "bench_core: " << error.what() << '\n';
    return 2;
  }
}
