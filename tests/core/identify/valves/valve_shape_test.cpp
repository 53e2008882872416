#include "core/identify/valves/valve_shape.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/core/identify/small_plant.hpp"

namespace mpm::valve_shape_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::uniform;
using Verdict = ValveShape::Verdict;

constexpr Index kRows = 1500;
constexpr std::uint64_t kSeeds = 100;

double between(std::uint64_t seed, int draw, double low, double high) {
  return low + (high - low) * 0.5 * (1.0 + uniform(seed, draw));
}

/// The two-parameter valve of Choudhury, Thornhill and Shah (2005, figure 4): it waits for S after
/// it has stopped or turned, then jumps by J and follows until it stops again.
struct Valve {
  double band = 0.0, jump = 0.0;
  double position = 0.0, stopped_at = 0.0, last = 0.0;
  double last_move = 0.0;
  bool stuck = true;

  double operator()(double command) {
    const double move = command - last;
    const bool turned = move * last_move < 0.0 || move == 0.0;
    if (turned && !stuck) {
      stopped_at = last;
      stuck = true;
    }
    if (move != 0.0) last_move = move;
    last = command;
    if (band == 0.0) return position = command;
    if (stuck && std::abs(command - stopped_at) > band) stuck = false;
    if (!stuck) position = command - (move > 0.0 ? 1.0 : -1.0) * 0.5 * (band - jump);
    return position;
  }
};

/// A lag and dead time under PI control, written without any simulator of ours.
struct Loop {
  double lag = 5.0;  ///< samples; gain 1
  Index dead = 1;
  double gain = 0.5, integral = 10.0;  ///< of the controller; samples
  Valve valve = {};
  double noise = 0.0;
  VectorXd load = VectorXd::Zero(kRows);  ///< added to the process value
  VectorXd setpoint = VectorXd::Constant(kRows, 50.0);

  [[nodiscard]] ValveShape judged(std::uint64_t seed) const {
    const VectorXd e = noise * test::normal(seed, kRows);
    VectorXd op(kRows), pv(kRows);
    std::vector<double> moved(static_cast<std::size_t>(dead) + 1, 0.0);
    Valve own = valve;
    const double pole = std::exp(-1.0 / lag);
    double y = 0.0, sum = 0.0;
    for (Index k = 0; k < kRows; ++k) {
      pv(k) = 50.0 + y + load(k) + e(k);
      const double error = setpoint(k) - pv(k);
      sum += error / integral;
      const double command = gain * (error + sum);
      op(k) = 50.0 + command;
      const auto slot = static_cast<std::size_t>(k % (dead + 1));
      moved[slot] = own(command);
      const double late = moved[static_cast<std::size_t>((k + 1) % (dead + 1))];
      y = pole * y + (1.0 - pole) * late;
    }
    return judge_valve(op, pv, setpoint, 1.0);
  }
};

/// Flow loops (fast) and temperature loops (slow), with a PI controller that is neither sluggish
/// nor tight: gain 0.4 .. 0.8 of lag / (dead time + 1), integral time 1 .. 1.5 lags and at least
/// the dead time.
Loop drawn(std::uint64_t seed) {
  Loop loop;
  loop.lag = between(seed, 0, 2.0, 30.0);
  loop.dead = static_cast<Index>(between(seed, 1, 1.0, 1.0 + 0.3 * loop.lag));
  const auto late = static_cast<double>(loop.dead + 1);
  loop.gain = between(seed, 2, 0.4, 0.8) * loop.lag / late * 0.5;
  loop.integral = std::max(late, between(seed, 3, 1.0, 1.5) * loop.lag);
  return loop;
}

struct Counts {
  int sticks = 0, sound = 0, others = 0;
};

template <class Make>
Counts counted(Make make) {
  Counts counts;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ValveShape shape = make(seed).judged(1000 + seed);
    if (shape.verdict == Verdict::kSticks)
      ++counts.sticks;
    else if (shape.verdict == Verdict::kSound)
      ++counts.sound;
    else
      ++counts.others;
  }
  return counts;
}

}  // namespace

TEST_CASE("a valve that sticks is named in most loops that swing by it") {
  const Counts counts = counted([](std::uint64_t seed) {
    Loop loop = drawn(seed);
    loop.valve.band = between(seed, 4, 2.0, 6.0);
    loop.valve.jump = between(seed, 5, 0.3, 1.0) * loop.valve.band;
    loop.load.setConstant(between(seed, 6, 2.0, 6.0));
    loop.noise = 0.05;
    return loop;
  });
  INFO(counts.sticks << " named, " << counts.sound << " called sound, " << counts.others);
  CHECK(counts.sticks >= 50);  // such tests reach 50 .. 80 % (Jelali and Huang 2010, chapter 13)
  CHECK(counts.sound <= 3);
}

TEST_CASE("a sine that comes in from outside is no sticking valve") {
  const Counts counts = counted([](std::uint64_t seed) {
    Loop loop = drawn(seed);
    const double period = between(seed, 4, 3.0, 10.0) * (loop.lag + static_cast<double>(loop.dead));
    loop.load = VectorXd::NullaryExpr(kRows, [&](Index k) {
      return 3.0 * std::sin(2.0 * M_PI * static_cast<double>(k) / period);
    });
    loop.noise = between(seed, 5, 0.05, 0.5);
    return loop;
  });
  INFO(counts.sticks << " named, " << counts.sound << " called sound, " << counts.others);
  CHECK(counts.sticks <= 1);
}

TEST_CASE("a controller that is too tight is no sticking valve") {
  const Counts counts = counted([](std::uint64_t seed) {
    Loop loop = drawn(seed);
    // Where the phase is -180 degrees (by the lag's -90 and the dead time's, nearly), less 5 .. 20
    // %.
    const double late = static_cast<double>(loop.dead) + 0.5;
    const double ultimate = 0.5 * M_PI * loop.lag / late;
    loop.integral = 10.0 * (loop.lag + late);
    loop.gain = between(seed, 4, 0.8, 0.95) * ultimate;
    loop.noise = 0.2;
    return loop;
  });
  INFO(counts.sticks << " named, " << counts.sound << " called sound, " << counts.others);
  CHECK(counts.sticks <= 1);
}

TEST_CASE("noise is no sticking valve") {
  const Counts counts = counted([](std::uint64_t seed) {
    Loop loop = drawn(seed);
    loop.load =
        test::autoregressive(0.2 * test::normal(5000 + seed, kRows), between(seed, 4, 0.0, 0.98));
    loop.noise = 0.1;
    return loop;
  });
  INFO(counts.sticks << " named, " << counts.sound << " called sound, " << counts.others);
  CHECK(counts.sticks <= 1);
}

TEST_CASE("a loop that swings with its set-point says nothing of its valve") {
  Loop loop;
  loop.setpoint = VectorXd::NullaryExpr(kRows, [](Index k) {
    return std::remainder(static_cast<double>(k), 80.0) < 0.0 ? 48.0 : 52.0;
  });
  loop.noise = 0.05;
  CHECK(loop.judged(1).verdict == Verdict::kFollows);
}

TEST_CASE("what is too short, constant or unknown is no swing") {
  const VectorXd none = VectorXd::Constant(100, std::nan(""));
  const VectorXd constant = VectorXd::Ones(100);
  CHECK(judge_valve(none, none, none, 1.0).verdict == Verdict::kNoSwing);
  CHECK(judge_valve(constant, constant, constant, 1.0).verdict == Verdict::kNoSwing);
  CHECK(judge_valve(VectorXd(0), VectorXd(0), VectorXd(0), 1.0).verdict == Verdict::kNoSwing);
}

}  // namespace mpm::valve_shape_test
