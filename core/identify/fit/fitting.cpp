#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/problem.hpp"
#include "core/identify/fit/triangle.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTiny = 1e-300;

double prior_units(const Coordinate& c) { return (c.value - c.prior_mean) / c.prior_sd; }

double log_square(double value) { return 2.0 * std::log(std::max(kTiny, std::abs(value))); }

}  // namespace

/// Gauss-Newton steps, each halved until the misfit falls. A CV's nuisances are eliminated first:
/// what is left of it is its square-root information on the free coordinates, which all CVs share.
class Problem::Fitting {
 public:
  /// `at_level`: a single run starts at its own level where that is far off.
  Fitting(Problem& problem, std::vector<Effect> effects, std::size_t first_free,
          const std::vector<int>& cvs, bool at_level)
      : problem_(problem), effects_(std::move(effects)), at_level_(at_level) {
    for (std::size_t e = first_free; e < effects_.size(); ++e)
      for (std::size_t c = 0; c < effects_[e].coordinates.size(); ++c) free_.push_back({e, c});
    for (const int cv : cvs) {
      CvFit state;
      state.cv = cv;
      state.beta.setZero(problem_.data(cv).nuisances.cols());
      start_at_levels(state);
      states_.push_back(std::move(state));
      small_.push_back(problem_.nuisances(effects_, cv));
    }
  }

  /// Whether some CV has a single run whose level is far off.
  [[nodiscard]] bool has_far_level() const { return far_level_; }

  Fit run(int iterations) {
    Fit best;
    best.cost = std::numeric_limits<double>::infinity();
    best.effects = effects_;
    double best_misfit = std::numeric_limits<double>::infinity();
    std::vector<Effect> origin = effects_;  // of the step that is being tried
    std::vector<CvFit> origin_states = states_;
    int halvings = 0;
    for (int iteration = 0;; ++iteration) {
      const double misfit = simulate();
      const double before = best_misfit;
      if (iteration == 0 && !std::isfinite(misfit)) return best;
      if (!(misfit < before) && iteration > 0) {
        if (++halvings > kMostHalvings || iteration >= iterations) break;
        go_half_way_back_to(origin, origin_states);
        continue;
      }
      halvings = 0;
      best_misfit = misfit;

      linearise();
      if (!step_.allFinite() || !std::isfinite(log_determinant_)) break;
      keep(misfit, best);
      if (iteration >= iterations) break;
      origin = effects_;
      origin_states = states_;
      const double movement = move();
      if (movement < kNoMovement || (iteration > 1 && before - misfit < kWorthAnotherStep)) break;
    }
    // A start that is no model at all stays at infinite cost.
    for (const Effect& effect : best.effects) best.cost += effect.search_cost;
    return best;
  }

 private:
  struct Free {
    std::size_t effect, coordinate;
  };
  /// A CV's own rows, reduced.
  struct Reduced {
    MatrixXd triangle;         ///< of [nuisances, its coordinates, right-hand side]
    std::vector<Index> where;  ///< its coordinates among the free ones
  };

  /// Runs far apart in level would at first look like one wandering noise, which leaves the levels
  /// free and holds the fit there: so each of several runs starts at its own.
  void start_at_levels(CvFit& state) {
    const CvData& data = problem_.data(state.cv);
    const VectorXd misfit =
        (data.measured - problem_.simulate(effects_, state.cv)).cwiseProduct(data.known);
    if (!misfit.allFinite()) return;
    for (std::size_t r = 0; r < data.runs.size(); ++r) {
      const auto& [first, count] = data.runs[r];
      const auto column = static_cast<Index>(r);
      const double known = std::max(1.0, data.known.segment(first, count).sum());
      const double level = misfit.segment(first, count).sum() / known;
      const double square = misfit.segment(first, count).squaredNorm() / known;
      const bool far = level * level >= kLevelFarOff * square;
      far_level_ = far_level_ || (data.runs.size() == 1 && far);
      if (data.runs.size() == 1 && !(far && at_level_)) return;
      state.beta(column) = level / data.nuisances(first, column);
    }
  }

  [[nodiscard]] Index count() const { return static_cast<Index>(free_.size()); }

  Coordinate& coordinate(std::vector<Effect>& effects, Index i) const {
    const Free& free = free_[static_cast<std::size_t>(i)];
    return effects[free.effect].coordinates[free.coordinate];
  }
  Coordinate& coordinate(Index i) { return coordinate(effects_, i); }

  /// Brings the states up to the effects and nuisances as they are; returns the misfit with all
  /// penalties.
  double simulate() {
    double misfit = 0.0;
    simulated_.clear();
    for (std::size_t s = 0; s < states_.size(); ++s) {
      CvFit& state = states_[s];
      simulated_.push_back(problem_.simulate(effects_, state.cv));
      problem_.update(state, simulated_.back(), small_[s]);
      misfit += problem_.data(state.cv).rows * std::log(state.variance) + state.beta.squaredNorm();
    }
    for (Index i = 0; i < count(); ++i) misfit += std::pow(prior_units(coordinate(i)), 2);
    return misfit;
  }

  void go_half_way_back_to(std::vector<Effect>& origin, const std::vector<CvFit>& states) {
    for (Index i = 0; i < count(); ++i)
      coordinate(i).value = 0.5 * (coordinate(i).value + coordinate(origin, i).value);
    for (std::size_t s = 0; s < states_.size(); ++s)
      states_[s].beta = 0.5 * (states_[s].beta + states[s].beta);
  }

  Reduced reduce(std::size_t s) {
    const CvFit& state = states_[s];
    const CvData& data = problem_.data(state.cv);
    Reduced reduced;
    for (Index i = 0; i < count(); ++i)
      if (touches(effects_[free_[static_cast<std::size_t>(i)].effect], problem_.model_, state.cv))
        reduced.where.push_back(i);
    const Index nuisances = small_[s].cols(), m = static_cast<Index>(reduced.where.size());
    const Index samples = data.measured.size();
    const WhitenedRows rows_of(data, state);
    MatrixXd system = MatrixXd::Zero(samples + nuisances, nuisances + m + 1);
    for (Index b = 0; b < nuisances; ++b) {
      system.col(b).head(samples) = rows_of(small_[s].col(b));
      system(samples + b, b) = 1.0;
    }
    for (Index c = 0; c < m; ++c) {
      const Index i = reduced.where[static_cast<std::size_t>(c)];
      const Free& f = free_[static_cast<std::size_t>(i)];
      system.col(nuisances + c).head(samples) =
          rows_of(problem_.sensitivity(effects_, f.effect, f.coordinate, state.cv, simulated_[s]));
    }
    system.col(nuisances + m).head(samples) = rows_of(data.measured - simulated_[s]);
    reduced.triangle = triangle(system);
    return reduced;
  }

  /// The step of the free coordinates from where they are, and what the data add to the prior's
  /// information.
  void linearise() {
    log_determinant_ = 0.0;
    reduced_.clear();
    MatrixXd stacked(0, count() + 1);
    for (std::size_t s = 0; s < states_.size(); ++s) {
      reduced_.push_back(reduce(s));
      const MatrixXd& r = reduced_.back().triangle;
      const std::vector<Index>& where = reduced_.back().where;
      const Index nuisances = small_[s].cols(), m = static_cast<Index>(where.size());
      for (Index b = 0; b < nuisances; ++b) log_determinant_ += log_square(r(b, b));
      const Index old = stacked.rows();
      stacked.conservativeResize(old + m, Eigen::NoChange);
      stacked.bottomRows(m).setZero();
      for (Index row = 0; row < m; ++row) {
        for (Index c = 0; c < m; ++c)
          stacked(old + row, where[static_cast<std::size_t>(c)]) =
              r(nuisances + row, nuisances + c);
        stacked(old + row, count()) = r(nuisances + row, nuisances + m);
      }
    }
    const Index data_rows = stacked.rows();
    stacked.conservativeResize(data_rows + count(), Eigen::NoChange);
    stacked.bottomRows(count()).setZero();
    for (Index i = 0; i < count(); ++i) {
      stacked(data_rows + i, i) = 1.0;
      stacked(data_rows + i, count()) = -prior_units(coordinate(i));
    }
    step_ = VectorXd::Zero(count());
    if (count() == 0) return;
    shared_ = triangle(stacked);
    for (Index i = 0; i < count(); ++i) log_determinant_ += log_square(shared_(i, i));
    step_ = information().solve(shared_.col(count()).head(count()));
  }

  [[nodiscard]] Eigen::TriangularView<const Eigen::Block<const MatrixXd>, Eigen::Upper>
  information() const {
    return static_cast<const MatrixXd&>(shared_)
        .topLeftCorner(count(), count())
        .triangularView<Eigen::Upper>();
  }

  void keep(double misfit, Fit& best) {
    best.effects = effects_;
    best.cvs = states_;
    best.cost = misfit + log_determinant_;
    best.misfit = 0.0;
    best.complexity = log_determinant_;
    for (const CvFit& state : states_) {
      best.misfit += problem_.data(state.cv).rows * std::log(state.variance);
      best.complexity += state.beta.squaredNorm();
    }
    for (Index i = 0; i < count(); ++i) best.complexity += std::pow(prior_units(coordinate(i)), 2);
    if (count() == 0) return;
    const MatrixXd inverse = information().solve(MatrixXd::Identity(count(), count()));
    VectorXd scales(count());
    for (Index i = 0; i < count(); ++i) scales(i) = coordinate(i).prior_sd;
    best.covariance = scales.asDiagonal() * (inverse * inverse.transpose()) * scales.asDiagonal();
  }

  /// Takes the step, the nuisances along with it; returns the largest movement, prior s.d.
  double move() {
    double movement = 0.0;
    for (Index i = 0; i < count(); ++i) {
      Coordinate& c = coordinate(i);
      c.value = std::clamp(c.value + step_(i) * c.prior_sd, c.low, c.high);
    }
    for (std::size_t s = 0; s < states_.size(); ++s) {
      const MatrixXd& r = reduced_[s].triangle;
      const auto m = static_cast<Index>(reduced_[s].where.size());
      const Index nuisances = states_[s].beta.size();
      VectorXd mine(m);
      for (Index c = 0; c < m; ++c) mine(c) = step_(reduced_[s].where[static_cast<std::size_t>(c)]);
      const VectorXd right =
          r.col(nuisances + m).head(nuisances) - r.block(0, nuisances, nuisances, m) * mine;
      const VectorXd beta =
          r.topLeftCorner(nuisances, nuisances).triangularView<Eigen::Upper>().solve(right);
      movement = std::max(movement, (beta - states_[s].beta).norm());
      states_[s].beta = beta;
    }
    if (count() > 0) movement = std::max(movement, step_.cwiseAbs().maxCoeff());
    return movement;
  }

  Problem& problem_;
  std::vector<Effect> effects_;
  bool at_level_;
  bool far_level_ = false;
  std::vector<Free> free_;
  std::vector<CvFit> states_;
  std::vector<MatrixXd> small_;  // the nuisances of each CV
  std::vector<VectorXd> simulated_;
  std::vector<Reduced> reduced_;
  MatrixXd shared_;  // triangle of the free coordinates' information
  VectorXd step_;    // prior s.d.
  double log_determinant_ = 0.0;
};

Fit Problem::fit(std::vector<Effect> effects, std::size_t first_free, const std::vector<int>& cvs,
                 int iterations) {
  Fitting from_zero(*this, effects, first_free, cvs, false);
  Fit fit = from_zero.run(iterations);
  if (!from_zero.has_far_level()) return fit;
  // A level far off beside all that moves may be one, or what a wrong gain makes of an input that
  // is never negative, or noise that wanders.
  Fit other = Fitting(*this, std::move(effects), first_free, cvs, true).run(iterations);
  return other.cost < fit.cost ? other : fit;
}

}  // namespace mpm
