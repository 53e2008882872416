#include "core/identification/prediction_error.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/identification/calibration.hpp"
#include "core/identification/restricted_noise.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct FreeNumber {
  std::size_t channel;
  ShapeNumber which;
};

class CvFitting {
 public:
  CvFitting(const IdentificationData& data, int cv, const NoiseAssumption& noise)
      : data_(data),
        cv_(cv),
        noise_(noise.model),
        inflation_(noise.inflation),
        known_(data.known.col(cv)) {
    spread_ = std::max(kNotZero, spread_of(data.cvs.col(cv), known_));
    weights_ = known_;
    for (const auto& [first, count] : data.runs) {
      Index since = 0;
      for (Index k = first; k < first + count; ++k) {
        if (known_(k) == 0.0) since = 0;
        if (since < noise_.order || known_(k) == 0.0) weights_(k) = 0.0;
        if (known_(k) != 0.0) ++since;
      }
    }
    rows_ = weights_.sum();
  }

  PredictionErrorFit run(std::vector<ChannelShape> channels, int most_steps) {
    double longest = 0.0;
    for (const Run& each : data_.runs) longest = std::max(longest, static_cast<double>(each.count));
    State state = at(std::move(channels), nullptr);
    int steps = most_steps;
    do {
      descend(state, steps, longest);
    } while (steps > 0 && try_other_dead_times(state, longest));
    return finished(std::move(state));
  }

 private:
  struct State {
    std::vector<ChannelShape> channels;
    std::vector<VectorXd> responses;
    std::vector<VectorXd> beside;  ///< of each run: level, drift, first state
    std::vector<double> decays;
    bool drifts = false;
    Whitening noise;
    VectorXd residual, innovations;
    double variance = 1.0, cost = 0.0;
  };
  struct Step {
    std::vector<FreeNumber> free;
    MatrixXd slopes;
    VectorXd direction;
    MatrixXd covariance;
  };

  /// Gauss-Newton; takes what it used off `steps`.
  void descend(State& state, int& steps, double longest) const {
    for (; steps > 0; --steps) {
      const Step move = linearise(state);
      State next;
      double size = 1.0;
      bool better = false;
      for (int cut = 0; cut <= kMostCuts && !better; ++cut, size /= kCut) {
        next = at(moved(state.channels, move.free, size * move.direction, longest), &state.noise);
        better = next.cost < state.cost;
      }
      if (!better) return;
      const double gained = state.cost - next.cost;
      state = std::move(next);
      if (gained < kConverged) return;
    }
  }

  /// The misfit has a kink wherever a dead time passes a whole sample, where Gauss-Newton may end.
  bool try_other_dead_times(State& state, double longest) const {
    bool better = false;
    for (std::size_t c = 0; c < state.channels.size(); ++c) {
      if (state.channels[c].dead_time_known) continue;
      const double now = state.channels[c].dead_time;
      for (const double other : {std::round(now), now - 0.5, now + 0.5, now - 1.0, now + 1.0}) {
        std::vector<ChannelShape> channels = state.channels;
        set_number(channels[c], ShapeNumber::kDeadTime, other, longest);
        if (channels[c].dead_time == now) continue;
        State next = at(std::move(channels), &state.noise);
        if (next.cost > state.cost - kConverged) continue;
        state = std::move(next);
        better = true;
      }
    }
    return better;
  }

  [[nodiscard]] std::vector<double> decays(const std::vector<ChannelShape>& channels) const {
    std::vector<double> times;
    for (const ChannelShape& shape : channels) {
      const std::vector<double> own = lags(shape);
      times.insert(times.end(), own.begin(), own.end());
      if (own.empty()) times.push_back(slowest_time(shape));
    }
    std::sort(times.rbegin(), times.rend());
    std::vector<double> picked;
    for (const double time : times)
      if (time > 1.0 && (picked.empty() || time * kOtherTime < picked.back()) &&
          static_cast<int>(picked.size()) < kMostDecays)
        picked.push_back(time);
    return picked;
  }

  /// Level, drift, first state of a run, rows x columns.
  [[nodiscard]] MatrixXd beside(const State& state, const Run& run) const {
    const Index drift = state.drifts ? 1 : 0;
    MatrixXd columns(run.count, 1 + drift + static_cast<Index>(state.decays.size()));
    columns.col(0).setOnes();
    for (Index k = 0; k < run.count; ++k) {
      if (state.drifts) columns(k, 1) = static_cast<double>(k) / static_cast<double>(run.count);
      for (std::size_t d = 0; d < state.decays.size(); ++d)
        columns(k, 1 + drift + static_cast<Index>(d)) =
            std::exp(-static_cast<double>(k) / state.decays[d]);
    }
    return columns;
  }

  /// The model with these channels; what is beside them and the noise in turn.
  State at(std::vector<ChannelShape> channels, const Whitening* noise) const {
    State state;
    state.channels = std::move(channels);
    state.decays = decays(state.channels);
    state.drifts = std::any_of(state.channels.begin(), state.channels.end(),
                               [](const ChannelShape& c) { return integrates(c.form); });
    VectorXd error = data_.cvs.col(cv_);
    for (const ChannelShape& shape : state.channels) {
      state.responses.push_back(response(shape, data_.inputs.col(shape.input), data_.runs));
      error -= state.responses.back();
    }
    error = error.cwiseProduct(known_);
    if (noise != nullptr) {
      state.noise = *noise;
    } else {
      state.noise.coefficients = VectorXd::Zero(noise_.order);
      state.noise.borders = data_.borders;
    }
    for (int turn = 0; turn < (noise != nullptr ? 1 : 3); ++turn) {
      take_beside_out(state, error);
      state.noise = fit_whitening(state.residual, weights_, noise_);
      state.noise.borders = data_.borders;
      state.innovations = state.noise.apply(state.residual).cwiseProduct(weights_);
      state.variance =
          std::max(state.innovations.squaredNorm() / rows_, kLeastVariance * spread_ * spread_);
    }
    state.cost = rows_ / inflation_ * std::log(state.variance);
    return state;
  }

  /// Level, drift and first state of each run by weighted least squares.
  void take_beside_out(State& state, const VectorXd& error) const {
    state.residual = error;
    state.beside.clear();
    for (const Run& run : data_.runs) {
      const MatrixXd columns = beside(state, run);
      const MatrixXd system = whitened(state, run, columns);
      const VectorXd right = whitened(state, run, error.segment(run.first, run.count));
      MatrixXd ridged(system.rows() + system.cols(), system.cols());
      ridged << system, ridge(state, system.cols());
      VectorXd target = VectorXd::Zero(ridged.rows());
      target.head(right.size()) = right;
      state.beside.emplace_back(Eigen::ColPivHouseholderQR<MatrixXd>(ridged).solve(target));
      state.residual.segment(run.first, run.count) -= columns * state.beside.back();
    }
    state.residual = state.residual.cwiseProduct(known_);
  }

  /// A first state is of the size of what the CV does; level and drift are free.
  [[nodiscard]] MatrixXd ridge(const State& state, Index columns) const {
    MatrixXd prior = MatrixXd::Zero(columns, columns);
    const Index fixed = state.drifts ? 2 : 1;
    const double sd = state.variance > 0.0 ? std::sqrt(state.variance) : 1.0;
    for (Index c = fixed; c < columns; ++c)
      prior(c, c) = std::min(1.0, sd / (kStartState * spread_));
    for (Index c = 0; c < fixed; ++c) prior(c, c) = kFreePrior;
    return prior;
  }

  /// Rows of one run behind A(q), those without a known past zero.
  [[nodiscard]] MatrixXd whitened(const State& state, const Run& run,
                                  const Eigen::Ref<const MatrixXd>& columns) const {
    Whitening own = state.noise;
    own.borders.clear();
    MatrixXd result(columns.rows(), columns.cols());
    const auto known = known_.segment(run.first, run.count);
    for (Index c = 0; c < columns.cols(); ++c)
      result.col(c) = own.apply(columns.col(c).cwiseProduct(known))
                          .cwiseProduct(weights_.segment(run.first, run.count));
    return result;
  }

  [[nodiscard]] VectorXd slope(const State& state, const FreeNumber& number) const {
    const ChannelShape& shape = state.channels[number.channel];
    const VectorXd& now = state.responses[number.channel];
    ChannelShape other = shape;
    if (number.which == ShapeNumber::kGain) {
      other.gain = 1.0;
      return response(other, data_.inputs.col(shape.input), data_.runs);
    }
    double step = number.which == ShapeNumber::kDeadTime ? kDeadTimeStep : kLogStep;
    if (number.which == ShapeNumber::kLead) step *= std::max(1.0, shape.time_constant);
    const double value = number_of(shape, number.which);
    set_number(other, number.which, value + step, kNoLagLimit);
    if (number.which != ShapeNumber::kDeadTime)
      return (response(other, data_.inputs.col(shape.input), data_.runs) - now) / step;
    ChannelShape earlier = shape;  // the slope changes at whole samples: the mean of both sides
    set_number(earlier, number.which, value - step, kNoLagLimit);
    return (response(other, data_.inputs.col(shape.input), data_.runs) -
            response(earlier, data_.inputs.col(shape.input), data_.runs)) /
           (other.dead_time - earlier.dead_time);
  }

  [[nodiscard]] static std::vector<FreeNumber> free_numbers_of(const State& state) {
    std::vector<FreeNumber> free;
    for (std::size_t c = 0; c < state.channels.size(); ++c)
      for (const ShapeNumber which : free_numbers(state.channels[c])) free.push_back({c, which});
    return free;
  }

  /// Per run: what its level, drift and first state and all free numbers do.
  [[nodiscard]] std::vector<FittedColumns> fitted_columns(
      const State& state, const std::vector<FreeNumber>& free) const {
    MatrixXd slopes(data_.samples(), static_cast<Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i)
      slopes.col(static_cast<Index>(i)) = slope(state, free[i]);
    std::vector<FittedColumns> result;
    for (const Run& run : data_.runs) {
      FittedColumns columns;
      columns.own = beside(state, run);
      columns.own_white.resize(run.count + columns.own.cols(), columns.own.cols());
      columns.own_white << whitened(state, run, columns.own), ridge(state, columns.own.cols());
      columns.shared = slopes.middleRows(run.first, run.count);
      columns.shared_white = whitened(state, run, columns.shared);
      result.push_back(std::move(columns));
    }
    return result;
  }

  [[nodiscard]] Step linearise(const State& state) const {
    Step step;
    step.free = free_numbers_of(state);
    const auto count = static_cast<Index>(step.free.size());
    const std::vector<FittedColumns> columns = fitted_columns(state, step.free);
    step.slopes.resize(data_.samples(), count);
    std::vector<MatrixXd> kept;
    for (std::size_t r = 0; r < columns.size(); ++r) {
      const Run& run = data_.runs[r];
      const FittedColumns& mine = columns[r];
      step.slopes.middleRows(run.first, run.count) = mine.shared_white;
      const Index own = mine.own.cols();
      MatrixXd system = MatrixXd::Zero(run.count + own, own + count + 1);
      system.leftCols(own) = mine.own_white;
      system.block(0, own, run.count, count) = mine.shared_white;
      system.col(own + count).head(run.count) = state.innovations.segment(run.first, run.count);
      const Eigen::HouseholderQR<MatrixXd> qr(system);
      const Index height = std::min(system.rows(), system.cols());
      const MatrixXd triangle = qr.matrixQR().topRows(height).triangularView<Eigen::Upper>();
      if (height > own) kept.emplace_back(triangle.bottomRightCorner(height - own, count + 1));
    }
    Index height = 0;
    for (const MatrixXd& part : kept) height += part.rows();
    MatrixXd stacked(height, count + 1);
    height = 0;
    for (const MatrixXd& part : kept) {
      stacked.middleRows(height, part.rows()) = part;
      height += part.rows();
    }
    const double sd = std::sqrt(state.variance);
    step.slopes /= sd;
    if (count == 0) return step;
    stacked /= sd;
    const VectorXd sizes = stacked.leftCols(count).colwise().norm().cwiseMax(kNotZero);
    // A little damping keeps directions that the data do not know where they are.
    MatrixXd system(stacked.rows() + count, count);
    system.topRows(stacked.rows()) = stacked.leftCols(count) * sizes.cwiseInverse().asDiagonal();
    system.bottomRows(count).setZero();
    system.bottomRows(count).diagonal().setConstant(kDamping);
    VectorXd right = VectorXd::Zero(system.rows());
    right.head(stacked.rows()) = stacked.col(count);
    const Eigen::HouseholderQR<MatrixXd> qr(system);
    const MatrixXd factor = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
    const MatrixXd inverse =
        factor.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(count, count));
    const MatrixXd scaled = sizes.cwiseInverse().asDiagonal() * inverse;
    step.covariance = scaled * scaled.transpose();
    step.direction = qr.solve(right).cwiseQuotient(sizes);
    for (Index i = 0; i < count; ++i) {
      const ShapeNumber which = step.free[static_cast<std::size_t>(i)].which;
      if (which == ShapeNumber::kGain || which == ShapeNumber::kLead) continue;
      const double most = which == ShapeNumber::kDeadTime  ? kStepOfDeadTime
                          : which == ShapeNumber::kDamping ? kStepOfDamping
                                                           : kStepOfTimes;
      step.direction(i) = std::clamp(step.direction(i), -most, most);
    }
    return step;
  }

  static std::vector<ChannelShape> moved(std::vector<ChannelShape> channels,
                                         const std::vector<FreeNumber>& free, const VectorXd& by,
                                         double longest) {
    for (std::size_t i = 0; i < free.size(); ++i) {
      ChannelShape& shape = channels[free[i].channel];
      set_number(shape, free[i].which, number_of(shape, free[i].which) + by(static_cast<Index>(i)),
                 longest);
    }
    return channels;
  }

  [[nodiscard]] PredictionErrorFit finished(State state) const {
    if (noise_.bound == 0.0) take_restricted_noise(state);
    const Step step = linearise(state);
    PredictionErrorFit fit;
    fit.channels = state.channels;
    fit.noise = state.noise;
    fit.variance = state.variance;
    fit.rows = rows_ / inflation_;
    fit.cost = state.cost;
    fit.covariance = inflation_ * step.covariance;
    fit.residual = state.residual;
    fit.innovations = state.innovations;
    fit.weights = weights_;
    fit.slopes = step.slopes;
    fit.level.resize(static_cast<Index>(state.beside.size()));
    for (std::size_t r = 0; r < state.beside.size(); ++r) {
      fit.level(static_cast<Index>(r)) = state.beside[r](0);
      if (state.drifts) fit.drift += state.beside[r](1) / static_cast<double>(data_.samples());
    }
    return fit;
  }

  /// Intervals are those of the noise of most restricted likelihood; the cost stays.
  void take_restricted_noise(State& state) const {
    state.noise = restricted_noise(fitted_columns(state, free_numbers_of(state)), state.residual,
                                   weights_, state.noise, state.variance);
    state.innovations = state.noise.apply(state.residual).cwiseProduct(weights_);
    state.variance =
        std::max(state.innovations.squaredNorm() / rows_, kLeastVariance * spread_ * spread_);
  }

  const IdentificationData& data_;
  int cv_;
  NoiseModel noise_;
  double inflation_;
  VectorXd known_, weights_;
  double rows_ = 0.0, spread_ = 1.0;
};

}  // namespace

PredictionErrorFit fit_prediction_error(const IdentificationData& data, int cv,
                                        std::vector<ChannelShape> channels,
                                        const NoiseAssumption& noise, int most_steps) {
  return CvFitting(data, cv, noise).run(std::move(channels), most_steps);
}

double needed_of_channel(double rows) { return kNumbersOfChannel * std::log(std::max(2.0, rows)); }

NoiseAssumption output_error() { return {{1, kNoWhitening}, 1.0}; }

NoiseAssumption output_error(const PredictionErrorFit& fit) {
  NoiseAssumption noise = output_error();
  const Index rows = fit.residual.size() - 1;
  const double square = fit.residual.squaredNorm();
  if (rows < 2 || !(square > 0.0)) return noise;
  const double r = std::clamp(fit.residual.tail(rows).dot(fit.residual.head(rows)) / square, 0.0,
                              kMostAutocorrelation);
  noise.inflation = (1.0 + r) / (1.0 - r);  // of an autoregression of first order
  return noise;
}

}  // namespace mpm
