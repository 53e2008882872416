#include "core/identify/evidence/unanswered_pulses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/identify/evidence/calibration.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "core/identify/fit/whitening.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Median of the moves from one known value to the next; 0 where there is none.
double usual_move(const Eigen::Ref<const VectorXd>& values) {
  std::vector<double> moves;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (std::isfinite(last) && value != last) moves.push_back(std::abs(value - last));
    last = value;
  }
  if (moves.empty()) return 0.0;
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::nth_element(moves.begin(), middle, moves.end());
  return *middle;
}

/// The pulse that begins at `row` of a run, if there is one: so far from the value before it, in
/// one direction, and as far from the one after it.
bool pulse_at(const Eigen::Ref<const VectorXd>& values, Index row, double before, double least,
              Pulse& pulse) {
  const double away = values(row) - before;
  if (!(std::abs(away) > least)) return false;
  double nearest = std::abs(away);
  pulse = {pulse.input, row, 1, values(row), before};
  for (Index next = row + 1; next < values.size(); ++next) {
    if (!std::isfinite(values(next))) return false;
    const double distance = std::copysign(1.0, away) * (values(next) - before);
    if (distance < kPulseBack * nearest) return nearest - distance > least;
    if (++pulse.rows > kLongestGlitch) return false;
    if (distance > std::abs(pulse.value - before)) pulse.value = values(next);
    nearest = std::min(nearest, distance);
  }
  return false;
}

std::vector<Pulse> pulses_of(const Recording& recording, int input) {
  std::vector<Pulse> pulses;
  const double least = kPulseMoves * usual_move(recording.inputs.col(input));
  for (const Run& run : runs_of(recording)) {
    const auto values = recording.inputs.col(input).segment(run.first, run.count);
    double before = values(0);
    for (Index k = 1; k < values.size(); ++k) {
      Pulse pulse{input};
      if (std::isfinite(before) && pulse_at(values, k, before, least, pulse)) {
        k += pulse.rows - 1;
        pulse.row += run.first;
        pulses.push_back(pulse);
      } else if (std::isfinite(values(k))) {
        before = values(k);
      }
    }
  }
  if (static_cast<double>(pulses.size()) > kMostPulses * static_cast<double>(recording.samples()))
    pulses.clear();
  return pulses;
}

/// What tells of one CV's answers: its noise, whitened.
struct Noise {
  Whitening whitening;
  VectorXd innovations, weights;
  double variance = 0.0;
};

Noise noise_of(const VectorXd& residual, const std::vector<Border>& borders) {
  Noise noise;
  noise.weights = VectorXd::Ones(residual.size());
  VectorXd filled = residual.array().isFinite().select(residual, 0.0);
  const double known = static_cast<double>(residual.array().isFinite().count());
  const double mean = known > 0.0 ? filled.sum() / known : 0.0;
  Index known_since = 0;
  auto border = borders.begin();
  for (Index k = 0; k < residual.size(); ++k, ++known_since) {
    if (border != borders.end() && border->row == k) ++border, known_since = 0;
    filled(k) = std::isfinite(residual(k)) ? filled(k) - mean : 0.0;
    if (!std::isfinite(residual(k))) known_since = -1;
    if (known_since < kPulseNoise.order) noise.weights(k) = 0.0;
  }
  noise.whitening = fit_whitening(filled, noise.weights, kPulseNoise);
  noise.whitening.borders = borders;
  noise.innovations = noise.whitening.apply(filled).cwiseProduct(noise.weights);
  const double rows = noise.weights.sum();
  if (rows > 0.0) noise.variance = noise.innovations.squaredNorm() / rows;
  return noise;
}

/// A CV's answer to a pulse, as a share of the model's; and its s.d.
struct Answer {
  double share = 0.0;
  double sd = std::numeric_limits<double>::infinity();
};

/// `end`: first row behind the pulse's run.
Answer answer_to(const Noise& noise, const VectorXd& impulse_response, const Pulse& pulse,
                 Index end) {
  const Index order = noise.whitening.coefficients.size();
  const Index first = std::max(Index{0}, pulse.row - order);
  const Index behind = std::min(end, pulse.row + impulse_response.size());
  VectorXd expected = VectorXd::Zero(behind - first);
  for (Index k = pulse.row; k < behind; ++k)
    for (Index m = 0; m < pulse.rows && m <= k - pulse.row; ++m)
      expected(k - first) += (pulse.value - pulse.before) * impulse_response(k - pulse.row - m);
  const Whitening alone{noise.whitening.coefficients, {}};
  expected = alone.apply(expected).cwiseProduct(noise.weights.segment(first, expected.size()));
  const double square = expected.squaredNorm();
  if (!(square > 0.0) || !(noise.variance > 0.0)) return {};
  return {expected.dot(noise.innovations.segment(first, expected.size())) / square,
          std::sqrt(noise.variance / square)};
}

Index end_of_run(const Recording& recording, Index row) {
  for (const Border& border : recording.borders)
    if (border.row > row) return border.row;
  return recording.samples();
}

}  // namespace

std::vector<Pulse> short_pulses(const Recording& recording) {
  std::vector<Pulse> all;
  for (int i = 0; i < recording.inputs.cols(); ++i) {
    const std::vector<Pulse> own = pulses_of(recording, i);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

Recording without(Recording recording, const std::vector<Pulse>& pulses) {
  for (const Pulse& pulse : pulses)
    recording.inputs.col(pulse.input)
        .segment(pulse.row, pulse.rows)
        .setConstant(std::numeric_limits<double>::quiet_NaN());
  return recording;
}

std::vector<Pulse> unanswered(const ModelSpec& model, const Recording& recording,
                              const std::vector<Pulse>& pulses) {
  if (pulses.empty()) return {};
  const LinearModel linear(model);
  const int length = std::min(linear.settling_samples(), kLongestPulseAnswer);
  const Eigen::MatrixXd residuals = free_run_residuals(model, recording);
  std::vector<bool> told(pulses.size(), false), seen(pulses.size(), false);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const Noise noise = noise_of(residuals.col(cv), recording.borders);
    for (int input = 0; input < recording.inputs.cols(); ++input) {
      const VectorXd response = linear.impulse_response(cv, input, length);
      for (std::size_t p = 0; p < pulses.size(); ++p) {
        if (pulses[p].input != input) continue;
        const Answer answer =
            answer_to(noise, response, pulses[p], end_of_run(recording, pulses[p].row));
        if (!(answer.sd < kAnswerTold)) continue;
        told[p] = true;
        seen[p] = seen[p] || std::abs(answer.share) >= kAnswered;
      }
    }
  }
  std::vector<Pulse> none;
  for (std::size_t p = 0; p < pulses.size(); ++p)
    if (told[p] && !seen[p]) none.push_back(pulses[p]);
  return none;
}

}  // namespace mpm
