#include "core/identification/start_values.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/identification/calibration.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Coefficients of the blocks that a channel of gain 1 has in the regression: its impulse response
/// behind A(q), averaged over each block. Of two lags the sum counts.
VectorXd coefficients_of(const ChannelShape& shape, const HighOrderModel& model) {
  const int longest = model.blocks.back().last;
  const bool two = shape.form == ChannelForm::kSecondOrder;
  const double time_constant = shape.time_constant + (two ? shape.second : 0.0);
  VectorXd impulse(longest + 1);
  double before = 0.0;
  for (int l = 0; l <= longest; ++l) {
    const double since = std::max(0.0, static_cast<double>(l) - shape.dead_time);
    const double step = integrates(shape.form) ? since : -std::expm1(-since / time_constant);
    impulse(l) = step - before;
    before = step;
  }
  VectorXd means(static_cast<Index>(model.blocks.size()));
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const auto [first, last] = model.blocks[b];
    double sum = 0.0;
    for (int l = first; l <= last; ++l) {
      sum += impulse(l);
      for (int m = 1; m <= model.past && m < l; ++m) sum -= model.noise(m - 1) * impulse(l - m);
    }
    means(static_cast<Index>(b)) = sum / static_cast<double>(last - first + 1);
  }
  return means;
}

std::vector<ChannelShape> grid(const HighOrderModel& model, const ChannelHint& hint,
                               double sample_time_s) {
  const double longest = model.blocks.back().last;
  std::vector<double> dead_times;
  if (hint.dead_time_s) {
    dead_times.push_back(*hint.dead_time_s / sample_time_s);
  } else {
    for (const LagBlock& block : model.blocks)
      if (block.first - 1.0 <= kLatestStart * longest) dead_times.push_back(block.first - 1.0);
  }
  std::vector<ChannelShape> shapes;
  for (double time = kFastestStart; time <= kSlowestStart * longest; time *= kStartGrowth)
    for (const double dead : dead_times) {
      ChannelShape shape;
      shape.input = hint.input;
      shape.gain = 1.0;
      shape.time_constant = time;
      shape.dead_time = dead;
      shape.dead_time_known = hint.dead_time_s.has_value();
      shape.sign = hint.sign;
      shapes.push_back(shape);
    }
  return shapes;
}

/// An orthonormal basis of what the columns span.
MatrixXd basis_of(const MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::HouseholderQR<MatrixXd> qr(columns);
  return qr.householderQ() * MatrixXd::Identity(columns.rows(), columns.cols());
}

/// The factor's columns of one input with all other columns taken out.
MatrixXd partial(const HighOrderModel& model, int input) {
  const Index columns = model.factor.cols(), own = static_cast<Index>(model.blocks.size()),
              first = model.column_of(input), rest = columns - first;
  // What stands before is triangular already.
  MatrixXd reordered(rest, rest);
  reordered << model.factor.bottomRightCorner(rest, rest - own),
      model.factor.block(first, first, rest, own);
  const Eigen::HouseholderQR<MatrixXd> qr(reordered);
  const MatrixXd triangle = qr.matrixQR().triangularView<Eigen::Upper>();
  return triangle.bottomRightCorner(own, own);
}

}  // namespace

StartSearch::StartSearch(const HighOrderModel& model, const std::vector<ChannelHint>& hints,
                         double sample_time_s)
    : model_(model), hints_(hints), choices_(hints.size()) {
  const auto own = static_cast<Index>(model.blocks.size());
  for (std::size_t i = 0; i < hints.size(); ++i) {
    if (hints[i].no_relation) continue;
    Choices& choices = choices_[i];
    choices.shapes = grid(model, hints[i], sample_time_s);
    MatrixXd coefficients(own, static_cast<Index>(choices.shapes.size()));
    for (Index c = 0; c < coefficients.cols(); ++c)
      coefficients.col(c) = coefficients_of(choices.shapes[static_cast<std::size_t>(c)], model);
    choices.columns =
        model.factor.middleCols(model.column_of(static_cast<int>(i)), own) * coefficients;
  }
  right_ = model.right - model.factor.leftCols(model.past) * model.noise;
}

bool StartSearch::worth(const Found& found) const {
  return found.explained > kWorthTrying * model_.variance;
}

StartSearch::Found StartSearch::best(std::size_t input, const MatrixXd& others) const {
  Found found;
  const MatrixXd& columns = choices_[input].columns;
  const MatrixXd basis = basis_of(others);
  const MatrixXd shares = basis.transpose() * columns;
  const VectorXd left = right_ - basis * (basis.transpose() * right_);
  const int sign = hints_[input].sign;
  for (Index c = 0; c < columns.cols(); ++c) {
    const double whole = columns.col(c).squaredNorm();
    const double square = whole - shares.col(c).squaredNorm();
    const double product = columns.col(c).dot(left);
    if (!(square > kDependent * whole) || (sign != 0 && product * sign < 0.0)) continue;
    const double explained = product * product / square;
    if (explained > found.explained) found = {c, product / square, explained};
  }
  return found;
}

MatrixXd StartSearch::columns_of(const State& state, std::size_t but) const {
  MatrixXd columns(model_.factor.rows(), static_cast<Index>(state.size()));
  Index count = 0;
  for (std::size_t m = 0; m < state.size(); ++m)
    if (m != but && state[m])
      columns.col(count++) = choices_[m].columns.col(state[m]->which).normalized();
  return columns.leftCols(count);
}

void StartSearch::sweep(State& state) const {
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!state[i]) continue;
    const Found found = best(i, columns_of(state, i));
    if (found.explained >= 0.0) state[i] = found;
  }
}

ChannelShape StartSearch::shape_of(std::size_t input, const Found& found) const {
  ChannelShape shape = choices_[input].shapes[static_cast<std::size_t>(found.which)];
  shape.gain = found.gain;
  return shape;
}

std::vector<ChannelShape> StartSearch::shapes_of(const State& state) const {
  std::vector<ChannelShape> shapes;
  for (std::size_t i = 0; i < state.size(); ++i)
    if (state[i]) shapes.push_back(shape_of(i, *state[i]));
  return shapes;
}

std::vector<ChannelShape> StartSearch::one_by_one() const {
  State state(hints_.size());
  for (std::size_t step = 0; step < state.size(); ++step) {
    const MatrixXd there = columns_of(state, state.size());
    std::size_t which = state.size();
    Found most;
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (state[i] || choices_[i].shapes.empty()) continue;
      const Found found = best(i, there);
      if (found.explained > most.explained) most = found, which = i;
    }
    if (!worth(most)) break;
    state[which] = most;
    for (int turn = 0; turn < kSweeps; ++turn) sweep(state);
  }
  return shapes_of(state);
}

std::vector<ChannelShape> StartSearch::all_at_once() const {
  State state(hints_.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (choices_[i].shapes.empty()) continue;
    const Found found = best(i, columns_of(state, i));
    if (found.explained >= 0.0) state[i] = found;
  }
  for (int turn = 0; turn < kSweeps; ++turn) sweep(state);
  return shapes_of(state);
}

std::optional<ChannelShape> StartSearch::addition(const std::vector<ChannelShape>& channels) const {
  MatrixXd there(model_.factor.rows(), static_cast<Index>(channels.size()));
  std::vector<bool> taken(hints_.size(), false);
  const auto own = static_cast<Index>(model_.blocks.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    taken[static_cast<std::size_t>(channels[c].input)] = true;
    there.col(static_cast<Index>(c)) =
        model_.factor.middleCols(model_.column_of(channels[c].input), own) *
        coefficients_of(channels[c], model_);
    there.col(static_cast<Index>(c)).normalize();
  }
  std::size_t which = taken.size();
  Found most;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (taken[i] || choices_[i].shapes.empty()) continue;
    const Found found = best(i, there);
    if (found.explained > most.explained) most = found, which = i;
  }
  if (!worth(most)) return std::nullopt;
  return shape_of(which, most);
}

double gain_sd(const HighOrderModel& model, int input, double time_constant) {
  ChannelShape shape;
  shape.time_constant = time_constant;
  const double size = (partial(model, input) * coefficients_of(shape, model)).norm();
  return size > 0.0 ? std::sqrt(model.variance) / size : std::numeric_limits<double>::infinity();
}

}  // namespace mpm
