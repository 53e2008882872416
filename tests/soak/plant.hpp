#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/model/linear_model.hpp"
#include "core/signal/frame.hpp"

namespace mpm::soak {

/// A time in which one channel's gain is not the model's, on the plant's clock, ns.
struct WrongTime {
  std::string mv, cv;
  std::int64_t from_ns = 0, until_ns = 0;
};

/// The plant of a unit, driven by independent random moves: right for a while, then one channel
/// after the other has half as much gain again, with a right time between two.
class Plant {
 public:
  /// `config`: a model of channels.
  Plant(const config::UnitConfig& config, std::uint64_t seed, int right_samples, int wrong_samples);

  /// The next sample, of interval `frame.interval`, one greater than before.
  [[nodiscard]] const Frame& next();
  /// The controller begins to count anew; the plant's clock goes on.
  void count_anew() { frame_.interval = 0; }
  /// The last one may not have ended.
  [[nodiscard]] const std::vector<WrongTime>& wrong_times() const { return wrong_times_; }
  [[nodiscard]] std::int64_t samples() const { return samples_; }

 private:
  void change_over();

  const config::UnitConfig& config_;
  LinearModel model_;
  std::vector<LinearModel> channels_;  // of the model's, in its order
  int right_samples_, wrong_samples_;
  int left_;                 // samples, of the time at hand
  bool wrong_ = false;       // it is one of those
  std::size_t channel_ = 0;  // whose turn it is
  std::vector<WrongTime> wrong_times_;
  Eigen::VectorXd moves_, noise_;
  std::mt19937_64 random_;
  std::int64_t samples_ = 0;
  Frame frame_;
};

}  // namespace mpm::soak
