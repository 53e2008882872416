#include "core/model/reduce_step_response.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/model/calibration.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace reduction = calibration::step_reduction;

/// What a transfer function may have, simplest first.
struct Structure {
  int lags = 0;
  bool lead = false;
  bool integrating = false;
};
constexpr std::array<Structure, 8> kStructures = {{{0, false, false},
                                                   {1, false, false},
                                                   {1, true, false},
                                                   {2, false, false},
                                                   {2, true, false},
                                                   {0, false, true},
                                                   {1, false, true},
                                                   {1, true, true}}};

/// Step response of 1 / [s] prod (T s + 1) at t > 0, and its derivative, which a lead adds.
struct UnitResponse {
  double value = 0.0;
  double slope = 0.0;
};

UnitResponse unit_response(const Structure& structure, double t, double t1, double t2) {
  if (structure.lags == 0)
    return structure.integrating ? UnitResponse{t, 1.0} : UnitResponse{1.0, 0.0};
  const double e1 = std::exp(-t / t1);
  if (structure.integrating) return {t - t1 * (1.0 - e1), 1.0 - e1};
  if (structure.lags == 1) return {1.0 - e1, e1 / t1};
  if (std::abs(t1 - t2) < reduction::kEqual * t1)
    return {1.0 - (1.0 + t / t1) * e1, t / (t1 * t1) * e1};
  const double e2 = std::exp(-t / t2);
  return {1.0 - (t1 * e1 - t2 * e2) / (t1 - t2), (e1 - e2) / (t1 - t2)};
}

/// A response at the samples that are fitted, times in samples.
struct Points {
  VectorXd time, value;
};

Points points_of(const std::vector<double>& values) {
  const auto count = static_cast<Index>(values.size());
  const Index points = std::min(count, reduction::kMostPoints);
  Points result{VectorXd(points), VectorXd(points)};
  for (Index i = 0; i < points; ++i) {
    const Index at = points > 1 ? i * (count - 1) / (points - 1) : 0;
    result.time(i) = static_cast<double>(at);
    result.value(i) = at == 0 ? 0.0 : values[static_cast<std::size_t>(at)];
  }
  return result;
}

/// Dead time and time constants, samples; what is linear follows from them.
struct Trial {
  double dead_time = 0.0, t1 = 1.0, t2 = 1.0;
  double gain = 0.0, gain_times_lead = 0.0;
  double error = std::numeric_limits<double>::infinity();  ///< sum of squares
};

Trial tried(const Structure& structure, const Points& points, const Eigen::Vector3d& place) {
  Trial trial{std::abs(place(0)), std::exp(place(1)), std::exp(place(2))};
  MatrixXd columns(points.time.size(), structure.lead ? 2 : 1);
  for (Index i = 0; i < points.time.size(); ++i) {
    const double t = points.time(i) - trial.dead_time;
    const UnitResponse unit =
        t > 0.0 ? unit_response(structure, t, trial.t1, trial.t2) : UnitResponse();
    columns(i, 0) = unit.value;
    if (structure.lead) columns(i, 1) = unit.slope;
  }
  if (!columns.allFinite()) return trial;
  const VectorXd sizes = columns.colPivHouseholderQr().solve(points.value);
  trial.gain = sizes(0);
  trial.gain_times_lead = structure.lead ? sizes(1) : 0.0;
  trial.error = (columns * sizes - points.value).squaredNorm();
  return trial;
}

/// Nelder and Mead (1965) over the first `size` of dead time and logarithms of time constants.
Eigen::Vector3d search(const Structure& structure, const Points& points, Eigen::Vector3d from,
                       int size) {
  struct Corner {
    Eigen::Vector3d place;
    double error;
  };
  const auto corner = [&](const Eigen::Vector3d& place) {
    return Corner{place, tried(structure, points, place).error};
  };
  const auto by_error = [](const Corner& a, const Corner& b) { return a.error < b.error; };
  for (int restart = 0; restart < reduction::kRestarts; ++restart) {
    std::vector<Corner> corners = {corner(from)};
    for (int i = 0; i < size; ++i) {
      Eigen::Vector3d place = from;
      place(i) += i == 0 ? 0.5 : 0.5;
      corners.push_back(corner(place));
    }
    for (int step = 0; step < reduction::kSteps; ++step) {
      std::sort(corners.begin(), corners.end(), by_error);
      Corner& worst = corners.back();
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (int i = 0; i < size; ++i) centre += corners[static_cast<std::size_t>(i)].place / size;
      const Eigen::Vector3d away = centre - worst.place;
      const Corner reflected = corner(centre + away);
      if (reflected.error < corners.front().error) {
        const Corner expanded = corner(centre + 2.0 * away);
        worst = by_error(expanded, reflected) ? expanded : reflected;
      } else if (reflected.error < corners[corners.size() - 2].error) {
        worst = reflected;
      } else {
        const Corner contracted = corner(centre - 0.5 * away);
        if (by_error(contracted, worst)) {
          worst = contracted;
        } else {
          for (std::size_t i = 1; i < corners.size(); ++i)
            corners[i] = corner(0.5 * (corners[i].place + corners.front().place));
        }
      }
    }
    from = std::min_element(corners.begin(), corners.end(), by_error)->place;
  }
  return from;
}

/// Where the search begins: when the response has begun, and 63 % of its end behind that.
Eigen::Vector3d first_place(const std::vector<double>& values, double largest) {
  double begun = 0.0, far = 1.0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(values[i]) > calibration::kNotBegun * largest) {
      begun = static_cast<double>(i - 1);
      break;
    }
  for (std::size_t i = 1; i < values.size(); ++i)
    if (std::abs(values[i] - values.back()) > std::exp(-1.0) * std::abs(values.back()))
      far = static_cast<double>(i);
  const double lag = std::max(1.0, far - begun);
  return {begun, std::log(lag), std::log(reduction::kSecondLag * lag)};
}

double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(reduction::kBase,
                                reduction::kDigits - 1.0 - std::floor(std::log10(std::abs(value))));
  const double result = std::round(value * scale) / scale;
  return std::isfinite(result) ? result : value;
}

TransferFunction transfer_function(const Structure& structure, const Trial& trial,
                                   double sample_time_s) {
  TransferFunction result;
  result.integrating = structure.integrating;
  result.gain = rounded(structure.integrating ? trial.gain / sample_time_s : trial.gain);
  result.dead_time_s =
      trial.dead_time > reduction::kNothing ? rounded(trial.dead_time * sample_time_s) : 0.0;
  if (structure.lags > 0) result.time_constants_s = {rounded(trial.t1 * sample_time_s)};
  if (structure.lags > 1) result.time_constants_s.push_back(rounded(trial.t2 * sample_time_s));
  std::sort(result.time_constants_s.rbegin(), result.time_constants_s.rend());
  if (structure.lead) result.lead_s = rounded(trial.gain_times_lead / trial.gain * sample_time_s);
  return result;
}

/// As it will be simulated; infinite where it cannot be, or settles elsewhere.
double deviation_of(const TransferFunction& dynamics, const std::vector<double>& values,
                    double largest, double sample_time_s) {
  const double infinite = std::numeric_limits<double>::infinity();
  if (!std::isfinite(dynamics.gain) || !std::isfinite(dynamics.lead_s)) return infinite;
  for (const double time_s : dynamics.time_constants_s)
    if (!(time_s > 0.0) || !std::isfinite(time_s) ||
        std::abs(dynamics.lead_s) > reduction::kLongestLead * time_s)
      return infinite;
  if (!(dynamics.dead_time_s < static_cast<double>(values.size()) * sample_time_s)) return infinite;
  ModelSpec spec;
  spec.sample_time_s = sample_time_s;
  spec.input_count = spec.cv_count = 1;
  spec.input_blocks.resize(1);
  spec.output_blocks.resize(1);
  spec.input_origin = spec.output_origin = VectorXd::Zero(1);
  spec.channels = {{0, 0, dynamics}};
  const VectorXd pulses = LinearModel(spec).impulse_response(0, 0, static_cast<int>(values.size()));
  double step = 0.0;
  double farthest = dynamics.integrating ? 0.0 : std::abs(dynamics.gain - values.back());
  for (std::size_t i = 0; i < values.size(); ++i) {
    step += pulses(static_cast<Index>(i));
    if (i > 0) farthest = std::max(farthest, std::abs(step - values[i]));
  }
  return farthest / largest;
}

}  // namespace

std::optional<ReducedStepResponse> reduce_step_response(const StepResponse& response,
                                                        double sample_time_s) {
  const std::vector<double>& values = response.values;
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  if (values.size() < 2 || !(largest > 0.0) || !std::isfinite(largest)) return std::nullopt;
  const Points points = points_of(values);
  const Eigen::Vector3d from = first_place(values, largest);
  std::optional<ReducedStepResponse> best;
  for (const Structure& structure : kStructures) {
    const int numbers = 2 + structure.lags + (structure.lead ? 1 : 0);
    if (static_cast<Index>(values.size()) < reduction::kValuesPerNumber * numbers) continue;
    // One that integrates goes on for ever: only where nothing that settles will do.
    if (structure.integrating && best && !best->dynamics.integrating) continue;
    const Eigen::Vector3d place = search(structure, points, from, 1 + structure.lags);
    const TransferFunction dynamics =
        transfer_function(structure, tried(structure, points, place), sample_time_s);
    const double deviation = deviation_of(dynamics, values, largest, sample_time_s);
    const double wanted = best ? reduction::kMuchNearer * best->deviation : reduction::kTolerance;
    if (deviation <= wanted && !(best && best->deviation < reduction::kExact))
      best = ReducedStepResponse{dynamics, deviation};
  }
  return best;
}

}  // namespace mpm
