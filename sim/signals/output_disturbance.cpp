#include "sim/signals/output_disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace mpm::sim {
namespace {

using config::DisturbanceKind;
using Eigen::Index;

Index index_of(const std::string& tag, const config::UnitConfig& unit) {
  const std::vector<std::string> cvs = unit.cv_tags();
  const auto place = std::find(cvs.begin(), cvs.end(), tag);
  if (place == cvs.end()) throw std::invalid_argument("no cv '" + tag + "' in this unit");
  return place - cvs.begin();
}

/// Streams of one purpose: many per CV, one for each use of it.
std::uint64_t stream_index(Index cv, std::size_t use) {
  return (static_cast<std::uint64_t>(cv) << 32U) + use;
}

double factor_of(const config::Disturbance& disturbance, double sample_time_s) {
  switch (disturbance.kind) {
    case DisturbanceKind::kStep:
      return disturbance.time_constant_s > 0.0
                 ? std::exp(-sample_time_s / disturbance.time_constant_s)
                 : 0.0;
    case DisturbanceKind::kRamp:
      return disturbance.duration_s / sample_time_s;
    case DisturbanceKind::kDrift:
      return disturbance.pole;
    case DisturbanceKind::kPeriodic:
      return 2.0 * std::numbers::pi * sample_time_s / disturbance.period_s;
    case DisturbanceKind::kSensorNoise:
      return 0.0;
  }
  return 0.0;
}

}  // namespace

OutputDisturbance::OutputDisturbance(const config::UnitConfig& unit,
                                     const config::ScenarioConfig& scenario, std::uint64_t seed)
    : level_(Eigen::VectorXd::Ones(unit.model.cv_count)),
      value_(Eigen::VectorXd::Zero(unit.model.cv_count)) {
  std::vector<config::NoiseSettings> noise = unit.simulation.noise;
  noise.resize(unit.cv.size());
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise_.emplace_back(noise[i], RandomStream(seed, StreamPurpose::kNoise, i));
  for (const config::NoiseChange& change : scenario.noise) add_noise_change(change, unit, seed);
  for (const config::Disturbance& disturbance : scenario.disturbances)
    add_shape(disturbance, unit, seed);
  std::int64_t longest = 0;
  for (const Coupling& coupling : couplings_) longest = std::max(longest, coupling.lag);
  own_ = Eigen::MatrixXd::Zero(value_.size(), longest + 1);
}

void OutputDisturbance::add_noise_change(const config::NoiseChange& change,
                                         const config::UnitConfig& unit, std::uint64_t seed) {
  const IntervalRange range(change.from_s, change.until_s, unit.sample_time_s);
  const Index first = change.cv ? index_of(*change.cv, unit) : 0;
  const Index end = change.cv ? first + 1 : value_.size();
  for (Index cv = first; cv < end; ++cv) {
    if (change.sigma_ratio != 1.0) levels_.push_back({range, cv, change.sigma_ratio});
    if (change.student_t) {
      const double freedom = *change.student_t;
      const auto use = static_cast<std::size_t>(std::count_if(
          tails_.begin(), tails_.end(), [cv](const Tails& other) { return other.cv == cv; }));
      tails_.push_back({range, cv, freedom, std::sqrt((freedom - 2.0) / freedom),
                        RandomStream(seed, StreamPurpose::kTails, stream_index(cv, use))});
    }
    if (change.follows)
      couplings_.push_back(
          {range, cv, index_of(*change.follows, unit), change.lag_samples, change.gain});
  }
}

void OutputDisturbance::add_shape(const config::Disturbance& disturbance,
                                  const config::UnitConfig& unit, std::uint64_t seed) {
  const Index cv = index_of(disturbance.cv, unit);
  const auto use = static_cast<std::size_t>(std::count_if(
      shapes_.begin(), shapes_.end(),
      [&](const Shape& other) { return other.cv == cv && other.kind == disturbance.kind; }));
  const StreamPurpose purpose = disturbance.kind == DisturbanceKind::kDrift
                                    ? StreamPurpose::kDrift
                                    : StreamPurpose::kSensorNoise;
  shapes_.push_back({disturbance.kind,
                     {disturbance.from_s, disturbance.until_s, unit.sample_time_s},
                     cv,
                     disturbance.size,
                     factor_of(disturbance, unit.sample_time_s),
                     disturbance.phase_degrees * std::numbers::pi / 180.0,
                     0.0,
                     RandomStream(seed, purpose, stream_index(cv, use))});
}

const Eigen::VectorXd& OutputDisturbance::next() {
  compute_own();
  const Index columns = own_.cols();
  value_ = own_.col(interval_ % columns);
  for (const Coupling& coupling : couplings_)
    if (coupling.range.contains(interval_) && interval_ >= coupling.lag)
      value_(coupling.cv) +=
          coupling.gain * own_(coupling.leader, (interval_ - coupling.lag) % columns);
  for (Shape& shape : shapes_) value_(shape.cv) += value_of(shape);
  ++interval_;
  return value_;
}

void OutputDisturbance::compute_own() {
  level_.setOnes();
  for (const NoiseLevel& level : levels_)
    if (level.range.contains(interval_)) level_(level.cv) *= level.ratio;
  Eigen::Ref<Eigen::VectorXd> own = own_.col(interval_ % own_.cols());
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    const auto cv = static_cast<Index>(i);
    Tails* heavy = nullptr;
    for (Tails& tails : tails_)
      if (tails.cv == cv && tails.range.contains(interval_)) heavy = &tails;
    own(cv) = heavy == nullptr ? noise_[i].next(level_(cv))
                               : noise_[i].next_with(level_(cv) * heavy->scale *
                                                     heavy->stream.student_t(heavy->freedom));
  }
}

double OutputDisturbance::value_of(Shape& shape) const {
  const bool active = shape.range.contains(interval_);
  switch (shape.kind) {
    case DisturbanceKind::kStep:
      shape.state = shape.factor * shape.state + (1.0 - shape.factor) * (active ? shape.size : 0.0);
      return shape.state;
    case DisturbanceKind::kRamp:
      return active
                 ? shape.size * std::min(1.0, static_cast<double>(interval_ - shape.range.first) /
                                                  shape.factor)
                 : 0.0;
    case DisturbanceKind::kDrift:
      if (!active) return 0.0;
      shape.state = shape.factor * shape.state + shape.size * shape.stream.normal();
      return shape.state;
    case DisturbanceKind::kPeriodic:
      return active ? shape.size *
                          std::sin(shape.factor * static_cast<double>(interval_) + shape.phase)
                    : 0.0;
    case DisturbanceKind::kSensorNoise:
      return active ? shape.size * shape.stream.normal() : 0.0;
  }
  return 0.0;
}

}  // namespace mpm::sim
