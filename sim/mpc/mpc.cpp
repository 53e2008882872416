#include "sim/mpc/mpc.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/mpc/linear_gain.hpp"

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Ref;
using Eigen::VectorXd;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// Share of the linear slack weight that goes with the square, to keep the Hessian regular.
constexpr double kSlackCurvature = 1e-3;

double low_of(const std::optional<double>& limit) { return limit.value_or(-kUnlimited); }
double high_of(const std::optional<double>& limit) { return limit.value_or(kUnlimited); }

std::vector<int> starts_of(const std::vector<int>& blocks, int horizon) {
  std::vector<int> starts;
  int start = 0;
  for (const int length : blocks) {
    if (length < 1) throw std::invalid_argument("move_blocks: lengths must be positive");
    if (start >= horizon) throw std::invalid_argument("move_blocks reach past the horizon");
    starts.push_back(start);
    start += length;
  }
  if (starts.empty()) throw std::invalid_argument("move_blocks must not be empty");
  return starts;
}

template <class Settings>
void fill_up(std::vector<Settings>& settings, int count, const Settings& value) {
  if (settings.empty()) settings.assign(static_cast<std::size_t>(count), value);
  if (settings.size() != static_cast<std::size_t>(count))
    throw std::invalid_argument("simulation: one entry per signal expected");
}

}  // namespace

Mpc::Mpc(const ModelSpec& model, int mv_count, const config::SimulationSettings& settings,
         double disturbance_feedback)
    : mv_count_(mv_count),
      horizon_(settings.prediction_horizon),
      disturbance_feedback_(disturbance_feedback),
      settings_(settings),
      block_starts_(starts_of(settings.move_blocks, settings.prediction_horizon)),
      model_(model),
      forecast_(model_),
      input_(model.input_origin.size() != 0 ? model.input_origin
                                            : VectorXd::Zero(model.input_count)),
      mv_(input_.head(mv_count)) {
  fill_up(settings_.cv_weights, model.cv_count, 1.0);
  fill_up(settings_.move_weights, mv_count, 1.0);
  fill_up(settings_.mv_limits, mv_count, config::MvLimits{});
  fill_up(settings_.cv_limits, model.cv_count, config::CvLimits{});
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const config::CvLimits& limits = settings_.cv_limits[static_cast<std::size_t>(cv)];
    if (limits.low || limits.high) soft_cvs_.push_back(cv);
  }
  build_step_matrix(model);
  build_program();
}

void Mpc::build_step_matrix(const ModelSpec& model) {
  const MatrixXd slopes = static_slopes(model);
  const Index rows = static_cast<Index>(model.cv_count) * horizon_;
  step_matrix_ = MatrixXd::Zero(rows, move_count());
  for (int cv = 0; cv < model.cv_count; ++cv) {
    for (int mv = 0; mv < mv_count_; ++mv) {
      VectorXd step = slopes(cv, mv) * model_.impulse_response(cv, mv, horizon_ + 1);
      for (Index l = 1; l < step.size(); ++l) step(l) += step(l - 1);
      for (std::size_t block = 0; block < block_starts_.size(); ++block) {
        const Index ahead = horizon_ - block_starts_[block];
        step_matrix_.col(static_cast<Index>(block) * mv_count_ + mv)
            .segment(static_cast<Index>(cv) * horizon_ + block_starts_[block], ahead) =
            step.segment(1, ahead);
      }
    }
  }
  weighted_ = step_matrix_.transpose();
  for (int cv = 0; cv < model.cv_count; ++cv)
    weighted_.middleCols(static_cast<Index>(cv) * horizon_, horizon_) *=
        settings_.cv_weights[static_cast<std::size_t>(cv)];
  hessian_ = weighted_ * step_matrix_;
  for (Index i = 0; i < move_count(); ++i)
    hessian_(i, i) += settings_.move_weights[static_cast<std::size_t>(i % mv_count_)];
  const Eigen::LLT<MatrixXd> factor(hessian_);
  if (factor.info() != Eigen::Success)
    throw std::invalid_argument("simulation: the weights define no unique optimum");
  feedback_ = factor.solve(weighted_);

  free_ = VectorXd::Zero(rows);
  error_ = VectorXd::Zero(rows);
  forced_ = VectorXd::Zero(rows);
  moves_ = VectorXd::Zero(move_count());
  level_ = VectorXd::Zero(mv_count_);
}

/// Rows of the program: moves; MVs after each block; high and low side of each limited CV at each
/// future sample; slacks.
void Mpc::build_program() {
  const auto slacks = static_cast<Index>(soft_cvs_.size());
  const Index moves = move_count();
  MatrixXd hessian = MatrixXd::Zero(moves + slacks, moves + slacks);
  hessian.topLeftCorner(moves, moves) = hessian_;
  const double curvature = std::max(1e-6, kSlackCurvature * settings_.soft_limit_weight);
  hessian.diagonal().tail(slacks).setConstant(curvature);

  MatrixXd rows = MatrixXd::Zero(2 * moves + 2 * slacks * horizon_ + slacks, moves + slacks);
  rows.topLeftCorner(moves, moves).setIdentity();
  for (Index i = 0; i < moves; ++i)
    for (Index j = i % mv_count_; j <= i; j += mv_count_) rows(moves + i, j) = 1.0;
  for (Index s = 0; s < slacks; ++s) {
    const Index cv = soft_cvs_[static_cast<std::size_t>(s)];
    const Index first = 2 * moves + 2 * s * horizon_;
    for (const double side : {-1.0, 1.0}) {
      const Index start = side < 0.0 ? first : first + horizon_;
      rows.block(start, 0, horizon_, moves) = step_matrix_.middleRows(cv * horizon_, horizon_);
      rows.col(moves + s).segment(start, horizon_).setConstant(side);
    }
    rows(rows.rows() - slacks + s, moves + s) = 1.0;
  }
  program_ = std::make_unique<DenseQp>(hessian, rows);
  gradient_ = VectorXd::Zero(moves + slacks);
  lower_ = VectorXd::Constant(rows.rows(), -kUnlimited);
  upper_ = VectorXd::Constant(rows.rows(), kUnlimited);
  gradient_.tail(slacks).setConstant(settings_.soft_limit_weight);
  lower_.tail(slacks).setZero();
  for (Index i = 0; i < moves; ++i) {
    const config::MvLimits& limits = settings_.mv_limits[static_cast<std::size_t>(i % mv_count_)];
    upper_(i) = high_of(limits.max_move);
    lower_(i) = -upper_(i);
  }
}

const VectorXd& Mpc::control(const Ref<const VectorXd>& measured,
                             const Ref<const VectorXd>& setpoint,
                             const Ref<const VectorXd>& disturbance) {
  input_.tail(input_.size() - mv_count_) = disturbance;
  compute_free_response(measured);
  for (Index cv = 0; cv < setpoint.size(); ++cv)
    error_.segment(cv * horizon_, horizon_) =
        setpoint(cv) - free_.segment(cv * horizon_, horizon_).array();
  moves_.noalias() = feedback_ * error_;
  if (!within_limits()) {
    ++limited_count_;
    if (!solve_with_limits()) {
      ++held_count_;
      moves_.setZero();
    }
  }
  apply_moves();
  model_.advance(input_);
  return mv_;
}

const VectorXd& Mpc::hold(const Ref<const VectorXd>& disturbance) {
  input_.tail(input_.size() - mv_count_) = disturbance;
  model_.advance(input_);
  return mv_;
}

const VectorXd& Mpc::follow(const Ref<const VectorXd>& mvs,
                            const Ref<const VectorXd>& disturbance) {
  input_.head(mv_count_) = mv_ = mvs;
  return hold(disturbance);
}

void Mpc::compute_free_response(const Ref<const VectorXd>& measured) {
  forecast_ = model_;
  for (Index l = 0; l < horizon_; ++l) {
    forecast_.advance(input_);
    for (Index cv = 0; cv < measured.size(); ++cv)
      free_(cv * horizon_ + l) =
          forecast_.output()(cv) + disturbance_feedback_ * (measured(cv) - model_.output()(cv));
  }
}

bool Mpc::within_limits() {
  level_ = input_.head(mv_count_);
  for (Index i = 0; i < moves_.size(); ++i) {
    const Index mv = i % mv_count_;
    const config::MvLimits& limits = settings_.mv_limits[static_cast<std::size_t>(mv)];
    level_(mv) += moves_(i);
    if (std::abs(moves_(i)) > high_of(limits.max_move) || level_(mv) < low_of(limits.low) ||
        level_(mv) > high_of(limits.high))
      return false;
  }
  for (const int cv : soft_cvs_) {
    const config::CvLimits& limits = settings_.cv_limits[static_cast<std::size_t>(cv)];
    const Index first = static_cast<Index>(cv) * horizon_;
    forced_.segment(first, horizon_).noalias() = step_matrix_.middleRows(first, horizon_) * moves_;
    forced_.segment(first, horizon_) += free_.segment(first, horizon_);
    if (forced_.segment(first, horizon_).minCoeff() < low_of(limits.low) ||
        forced_.segment(first, horizon_).maxCoeff() > high_of(limits.high))
      return false;
  }
  return true;
}

bool Mpc::solve_with_limits() {
  const Index moves = move_count();
  gradient_.head(moves).noalias() = weighted_ * error_;
  gradient_.head(moves) = -gradient_.head(moves);
  for (Index i = 0; i < moves; ++i) {
    const Index mv = i % mv_count_;
    const config::MvLimits& limits = settings_.mv_limits[static_cast<std::size_t>(mv)];
    lower_(moves + i) = low_of(limits.low) - input_(mv);
    upper_(moves + i) = high_of(limits.high) - input_(mv);
  }
  for (std::size_t s = 0; s < soft_cvs_.size(); ++s) {
    const Index cv = soft_cvs_[s];
    const config::CvLimits& limits = settings_.cv_limits[static_cast<std::size_t>(cv)];
    const Index first = 2 * moves + 2 * static_cast<Index>(s) * horizon_;
    upper_.segment(first, horizon_) =
        high_of(limits.high) - free_.segment(cv * horizon_, horizon_).array();
    lower_.segment(first + horizon_, horizon_) =
        low_of(limits.low) - free_.segment(cv * horizon_, horizon_).array();
  }
  if (program_->solve(gradient_, lower_, upper_) != QpStatus::kOptimal) return false;
  moves_ = program_->solution().head(moves);
  return true;
}

/// The first block's moves. The hard limits hold to the last bit, whatever the solver's rounding.
void Mpc::apply_moves() {
  for (int mv = 0; mv < mv_count_; ++mv) {
    const config::MvLimits& limits = settings_.mv_limits[static_cast<std::size_t>(mv)];
    const double before = input_(mv);
    const double largest = high_of(limits.max_move);
    double after = before + std::clamp(moves_(mv), -largest, largest);
    // A start outside the limits comes back no faster than the move limit allows.
    if (after > high_of(limits.high)) after = std::max(high_of(limits.high), before - largest);
    if (after < low_of(limits.low)) after = std::min(low_of(limits.low), before + largest);
    while (std::abs(after - before) > largest) after = std::nextafter(after, before);
    input_(mv) = after;
  }
  mv_ = input_.head(mv_count_);
}

}  // namespace mpm::sim
