#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/model/linear_model.hpp"
#include "core/signal/frame.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::test {

/// A 2 x 2 plant in open loop, sampled each second, of which the model is right but for channel
/// (CV 0, input 1): between `from` and `until` its gain and time constant are so many times the
/// model's, and it answers `later` samples later.
struct OpenLoopUnit {
  ModelSpec model;
  double gain_ratio = 1.0, time_constant_ratio = 1.0, later = 0.0;
  int from = 0, until = 1000000;  ///< samples
  std::uint64_t seed = 0;
  bool graded = false;                    ///< inputs move to any value, not to one of two
  double alike = 0.0;                     ///< so much of input 1 is what input 0 does, -1..1
  int still_from = 1000000;               ///< input 1 stays where it was, samples
  std::optional<TransferFunction> plant;  ///< what the channel is in truth, before these changes
  SignalCounts counts{2, 0, 2, 0};

  OpenLoopUnit() {
    model.sample_time_s = 1.0;
    model.input_count = model.cv_count = 2;
    model.input_blocks.resize(2);
    model.output_blocks.resize(2);
    model.input_origin = Eigen::Vector2d(10.0, -3.0);
    model.output_origin = Eigen::Vector2d(50.0, 2.0);
    model.channels = {{0, 0, TransferFunction{2.0, {12}, 0, 2, false}},
                      {0, 1, TransferFunction{-1.0, {8}, 0, 1, false}},
                      {1, 0, TransferFunction{0.5, {6}, 0, 0, false}},
                      {1, 1, TransferFunction{1.5, {15}, 0, 3, false}}};
  }

  /// Of channel (CV 0, input 1) in the model.
  [[nodiscard]] TransferFunction& channel() {
    return std::get<TransferFunction>(model.channels[1].dynamics);
  }

  /// Calls each(frame) for k = 0 .. samples - 1, all qualities good.
  template <class Each>
  void run(int samples, Each each) const {
    ModelSpec wrong = model;
    auto& channel = std::get<TransferFunction>(wrong.channels[1].dynamics);
    if (plant) channel = *plant;
    channel.gain *= gain_ratio;
    for (double& time_constant_s : channel.time_constants_s) time_constant_s *= time_constant_ratio;
    channel.dead_time_s += later;
    LinearModel changed_plant(wrong), controller_model(model);
    Eigen::Vector2d u, noise(0.0, 0.0);
    for (int k = 0; k < samples; ++k) {
      for (int i = 0; i < 2; ++i) {
        const auto s = static_cast<std::uint64_t>(i);
        const double own = uniform(700 + 10 * seed + s, k / 20);
        const double level = i == 0 ? own
                                    : alike * uniform(700 + 10 * seed, k / 20) +
                                          std::sqrt(1.0 - alike * alike) * own;
        if (i == 0 || k == 0 || k < still_from)
          u(i) = model.input_origin(i) + (graded ? 2.0 * level : level > 0 ? 1.0 : -1.0);
        noise(i) = 0.7 * noise(i) + 0.1 * uniform(800 + 10 * seed + s, k);
      }
      Frame frame(counts);
      for (SignalBlock& block : frame.blocks)
        std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
      frame.interval = k;
      frame.source_time_ns = k * std::int64_t{1'000'000'000};
      frame[SignalKind::kMv].values = u;
      const bool changed = k >= from && k < until;
      frame[SignalKind::kCv].values =
          (changed ? changed_plant.output() : controller_model.output()) + noise;
      frame[SignalKind::kPrediction].values = controller_model.output();
      each(frame);
      changed_plant.advance(u);
      controller_model.advance(u);
    }
  }
};

}  // namespace mpm::test
