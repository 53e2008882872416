#include "core/identification/start_values.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/prediction_error.hpp"

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
  const bool integrates = hint.integrating.value_or(false);
  const double slowest = integrates ? kFastestStart : kSlowestStart * longest;  // no lag to choose
  std::vector<ChannelShape> shapes;
  for (double time = kFastestStart; time <= slowest; time *= kStartGrowth)
    for (const double dead : dead_times) {
      ChannelShape shape;
      shape.input = hint.input;
      shape.gain = 1.0;
      shape.time_constant = time;
      shape.dead_time = dead;
      shape.dead_time_known = hint.dead_time_s.has_value();
      shape.sign = hint.sign;
      shape.may_integrate = hint.integrating.value_or(true);
      if (integrates) shape.form = ChannelForm::kIntegrator;
      shapes.push_back(shape);
    }
  return shapes;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
    choices.dead_times =
        std::count_if(choices.shapes.begin(), choices.shapes.end(), [&](const ChannelShape& shape) {
          return shape.time_constant == choices.shapes.front().time_constant;
        });
    MatrixXd coefficients(own, static_cast<Index>(choices.shapes.size()));
    for (Index c = 0; c < coefficients.cols(); ++c)
      coefficients.col(c) = coefficients_of(choices.shapes[static_cast<std::size_t>(c)], model);
    choices.columns =
        model.factor.middleCols(model.column_of(static_cast<int>(i)), own) * coefficients;
  }
  right_ = model.right - model.factor.leftCols(model.past) * model.noise;
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

ChannelShape StartSearch::best_shape(std::size_t input, const Found& found) const {
  ChannelShape shape = choices_[input].shapes[static_cast<std::size_t>(found.which)];
  shape.gain = found.gain;
  return shape;
}

VectorXd StartSearch::column(const ChannelShape& shape) const {
  return model_.factor.middleCols(model_.column_of(shape.input),
                                  static_cast<Index>(model_.blocks.size())) *
         coefficients_of(shape, model_);
}

MatrixXd StartSearch::columns(const std::vector<ChannelShape>& channels) const {
  MatrixXd result(model_.factor.rows(), static_cast<Index>(channels.size()));
  for (std::size_t c = 0; c < channels.size(); ++c)
    result.col(static_cast<Index>(c)) = column(channels[c]).normalized();
  return result;
}

/// Gauss-Newton on the factor: a few hundred rows, whatever the data had.
StartSearch::Set StartSearch::fitted(std::vector<ChannelShape> channels) const {
  const double longest = kSlowestStart * model_.blocks.back().last;
  const auto error = [&](const std::vector<ChannelShape>& shapes) {
    VectorXd left = right_;
    for (const ChannelShape& shape : shapes) left -= shape.gain * column(shape);
    return left;
  };
  Set set{std::move(channels), 0.0};
  VectorXd left = error(set.channels);
  set.left = left.squaredNorm();
  for (int step = 0; step < kSetSteps; ++step) {
    std::vector<std::pair<std::size_t, ShapeNumber>> numbers;
    for (std::size_t c = 0; c < set.channels.size(); ++c)
      for (const ShapeNumber which : free_numbers(set.channels[c])) numbers.emplace_back(c, which);
    const auto count = static_cast<Index>(numbers.size());
    MatrixXd slopes(left.size(), count);
    for (Index n = 0; n < count; ++n) {
      const auto& [c, which] = numbers[static_cast<std::size_t>(n)];
      ChannelShape other = set.channels[c];
      const VectorXd now = column(other);
      if (which == ShapeNumber::kGain) {
        slopes.col(n) = now;
        continue;
      }
      const double by = which == ShapeNumber::kDeadTime ? kDeadTimeStep : kLogStep;
      set_number(other, which, number_of(other, which) + by, 2.0 * longest);
      slopes.col(n) = other.gain * (column(other) - now) / by;
    }
    const VectorXd sizes = slopes.colwise().norm().cwiseMax(kNotZero);
    MatrixXd system = MatrixXd::Zero(left.size() + count, count);
    system.topRows(left.size()) = slopes * sizes.cwiseInverse().asDiagonal();
    system.bottomRows(count).diagonal().setConstant(kSetDamping);
    VectorXd target = VectorXd::Zero(system.rows());
    target.head(left.size()) = left;
    const VectorXd move = Eigen::HouseholderQR<MatrixXd>(system).solve(target).cwiseQuotient(sizes);
    const double before = set.left;
    double size = 1.0;
    for (int cut = 0; cut <= kMostCuts; ++cut, size /= kCut) {
      std::vector<ChannelShape> next = set.channels;
      for (Index n = 0; n < count; ++n) {
        const auto& [c, which] = numbers[static_cast<std::size_t>(n)];
        const double most = which == ShapeNumber::kGain ? std::numeric_limits<double>::infinity()
                            : which == ShapeNumber::kDeadTime ? kStepOfDeadTime
                                                              : kStepOfTimes;
        set_number(next[c], which,
                   number_of(next[c], which) + std::clamp(size * move(n), -most, most), longest);
      }
      const VectorXd now = error(next);
      if (!(now.squaredNorm() < set.left)) continue;
      set = {std::move(next), now.squaredNorm()};
      left = now;
      break;
    }
    if (before - set.left < kSetConverged * model_.variance) break;
  }
  return set;
}

double StartSearch::bic(const Set& set) const {
  return set.left / model_.variance +
         needed_of_channel(model_.rows) * static_cast<double>(set.channels.size());
}

std::vector<bool> StartSearch::inputs_of(const Set& set) const {
  std::vector<bool> taken(hints_.size(), false);
  for (const ChannelShape& shape : set.channels)
    taken[static_cast<std::size_t>(shape.input)] = true;
  return taken;
}

void StartSearch::grow(std::vector<Set>& sets) const {
  std::vector<Set> beam = {fitted({})};
  double least = bic(beam.front());
  sets.push_back(beam.front());
  for (std::size_t size = 1; size <= hints_.size(); ++size) {
    std::vector<Set> grown;
    for (const Set& set : beam) {
      const std::vector<bool> taken = inputs_of(set);
      const MatrixXd there = columns(set.channels);
      for (std::size_t i = 0; i < taken.size(); ++i) {
        if (taken[i] || choices_[i].shapes.empty()) continue;
        const Found found = best(i, there);
        if (found.explained < 0.0) continue;
        std::vector<ChannelShape> channels = set.channels;
        channels.push_back(best_shape(i, found));
        grown.push_back(fitted(std::move(channels)));
      }
    }
    std::stable_sort(grown.begin(), grown.end(),
                     [this](const Set& a, const Set& b) { return better(a, b); });
    beam.clear();
    for (Set& set : grown) {  // the same inputs in another order may have ended elsewhere
      const auto same = [&](const Set& kept) { return inputs_of(kept) == inputs_of(set); };
      if (beam.size() < kSetsKept && std::none_of(beam.begin(), beam.end(), same))
        beam.push_back(std::move(set));
    }
    if (beam.empty()) return;
    sets.insert(sets.end(), beam.begin(), beam.end());
    if (bic(beam.front()) > least + kHopelessSets * std::log(model_.rows)) return;
    least = std::min(least, bic(beam.front()));
  }
}

StartSearch::Set StartSearch::full(double time_constant, double dead_time) const {
  std::vector<ChannelShape> channels;
  for (const Choices& choices : choices_) {
    if (choices.shapes.empty()) continue;
    ChannelShape shape = choices.shapes.front();
    shape.time_constant = time_constant;
    if (!shape.dead_time_known) shape.dead_time = dead_time;
    channels.push_back(shape);
  }
  return fitted_from_gains(std::move(channels));
}

void StartSearch::shrink(std::vector<Set>& sets) const {
  std::vector<Set> starts;
  for (const double time_constant : kFullTimes)
    for (const double dead_time : kFullDeadTimes) starts.push_back(full(time_constant, dead_time));
  std::stable_sort(starts.begin(), starts.end(),
                   [this](const Set& a, const Set& b) { return better(a, b); });
  for (std::size_t s = 0; s < std::min(kFullsKept, starts.size()); ++s) {
    Set now = starts[s];
    double least = bic(now);
    sets.push_back(now);
    while (now.channels.size() > 1) {
      Set next;
      for (std::size_t c = 0; c < now.channels.size(); ++c) {
        std::vector<ChannelShape> rest = now.channels;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(c));
        Set without = fitted(std::move(rest));
        if (next.channels.empty() || without.left < next.left) next = std::move(without);
      }
      now = std::move(next);
      sets.push_back(now);
      if (bic(now) > least + kHopelessSets * std::log(model_.rows)) break;
      least = std::min(least, bic(now));
    }
  }
}

std::vector<std::vector<ChannelShape>> StartSearch::best_sets() const {
  std::vector<Set> all;
  grow(all);
  if (std::any_of(choices_.begin(), choices_.end(),
                  [](const Choices& choices) { return !choices.shapes.empty(); }))
    shrink(all);
  std::stable_sort(all.begin(), all.end(),
                   [this](const Set& a, const Set& b) { return better(a, b); });
  std::vector<Set> tried;
  for (Set& set : all) {
    const auto same = [&](const Set& kept) { return inputs_of(kept) == inputs_of(set); };
    if (tried.size() < kSetsTried && std::none_of(tried.begin(), tried.end(), same))
      tried.push_back(std::move(set));
  }
  std::vector<std::vector<ChannelShape>> sets;
  sets.reserve(tried.size());
  for (Set& set : tried) sets.push_back(std::move(set.channels));
  return sets;
}

std::optional<std::vector<ChannelShape>> StartSearch::enlarged(
    const std::vector<ChannelShape>& channels) const {
  const MatrixXd there = columns(channels);
  std::vector<bool> taken(hints_.size(), false);
  for (const ChannelShape& shape : channels) taken[static_cast<std::size_t>(shape.input)] = true;
  const double before = fitted(channels).left;
  std::optional<Set> most;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (taken[i] || choices_[i].shapes.empty()) continue;
    const Found found = best(i, there);
    if (found.explained < 0.0) continue;
    std::vector<ChannelShape> more = channels;
    more.push_back(best_shape(i, found));
    Set set = fitted(std::move(more));
    if (!most || set.left < most->left) most = std::move(set);
  }
  if (!most || !(before - most->left > kWorthTrying * model_.variance)) return std::nullopt;
  return std::move(most->channels);
}

StartSearch::Set StartSearch::fitted_from_gains(std::vector<ChannelShape> channels) const {
  MatrixXd all(model_.factor.rows(), static_cast<Index>(channels.size()));
  for (std::size_t c = 0; c < channels.size(); ++c)
    all.col(static_cast<Index>(c)) = column(channels[c]);
  const VectorXd gains = Eigen::ColPivHouseholderQR<MatrixXd>(all).solve(right_);
  for (std::size_t c = 0; c < channels.size(); ++c)
    set_number(channels[c], ShapeNumber::kGain, gains(static_cast<Index>(c)), 0.0);
  Set set = fitted(std::move(channels));
  return fitted(std::move(set.channels));  // once more: it began far away
}

StartSearch::Start StartSearch::beside(const std::vector<ChannelShape>& channels, int input) const {
  std::vector<double> times, dead_times;
  times.reserve(channels.size());
  dead_times.reserve(channels.size());
  for (const ChannelShape& shape : channels) {
    times.push_back(shape.time_constant);
    dead_times.push_back(shape.dead_time);
  }
  std::optional<Set> best;
  for (const double ratio : kBesideTimes) {
    std::vector<ChannelShape> more = channels;
    ChannelShape shape = choices_[static_cast<std::size_t>(input)].shapes.front();
    shape.time_constant = std::max(kFastestStart, ratio * median(times));
    if (!shape.dead_time_known) shape.dead_time = median(dead_times);
    more.push_back(shape);
    Set set = fitted_from_gains(std::move(more));
    if (!best || set.left < best->left) best = std::move(set);
  }
  return {std::move(best->channels), best->left / model_.variance};
}

StartSearch::Start StartSearch::alone(const std::vector<ChannelShape>& channels) const {
  Set set = fitted(channels);
  return {std::move(set.channels), set.left / model_.variance};
}

StartSearch::Shared StartSearch::solved(const std::vector<ChannelShape>& channels,
                                        std::vector<Pair> pairs) const {
  MatrixXd all(model_.factor.rows(), 2 * static_cast<Index>(pairs.size()));
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const MatrixXd& columns = choices_[static_cast<std::size_t>(channels[c].input)].columns;
    all.col(2 * static_cast<Index>(c)) = columns.col(pairs[c].slow);
    all.col(2 * static_cast<Index>(c) + 1) = columns.col(pairs[c].fast);
  }
  Shared result{std::move(pairs), Eigen::ColPivHouseholderQR<MatrixXd>(all).solve(right_), 0.0};
  result.left = (right_ - all * result.parts).squaredNorm();
  return result;
}

std::optional<std::vector<ChannelShape>> StartSearch::with_shared_lags(
    const std::vector<ChannelShape>& channels) const {
  std::optional<Shared> best;
  for (const ChannelShape& shape : channels)
    if (integrates(shape.form) || shape.sign != 0) return std::nullopt;
  if (channels.empty()) return std::nullopt;
  const auto choices = [&](std::size_t c) -> const Choices& {
    return choices_[static_cast<std::size_t>(channels[c].input)];
  };
  Index times = std::numeric_limits<Index>::max();
  for (std::size_t c = 0; c < channels.size(); ++c)
    times = std::min(times, static_cast<Index>(choices(c).shapes.size()) / choices(c).dead_times);
  const auto pairs_of = [&](Index slow, Index fast, const std::vector<Index>& dead) {
    std::vector<Pair> pairs;
    for (std::size_t c = 0; c < channels.size(); ++c)
      pairs.push_back(
          {slow * choices(c).dead_times + dead[c], fast * choices(c).dead_times + dead[c]});
    return pairs;
  };
  // Dead times as they were found, then each in turn where it is best beside the others.
  std::vector<Index> nearest(channels.size(), 0);
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (Index d = 1; d < choices(c).dead_times; ++d) {
      const auto away = [&](Index which) {
        return std::abs(choices(c).shapes[static_cast<std::size_t>(which)].dead_time -
                        channels[c].dead_time);
      };
      if (away(d) < away(nearest[c])) nearest[c] = d;
    }
  for (Index slow = 1; slow < times; ++slow)
    for (Index fast = 0; fast < slow; ++fast) {
      std::vector<Index> dead = nearest;
      Shared now = solved(channels, pairs_of(slow, fast, dead));
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const Index latest = std::min(choices(c).dead_times, nearest[c] + kLaterDeadTimes);
        for (Index d = 0; d < latest; ++d) {
          std::vector<Index> other = dead;
          other[c] = d;
          Shared tried = solved(channels, pairs_of(slow, fast, other));
          if (tried.left < now.left) now = std::move(tried), dead = std::move(other);
        }
      }
      if (!best || now.left < best->left) best = std::move(now);
    }
  if (!best) return std::nullopt;
  std::vector<ChannelShape> result = channels;
  for (std::size_t c = 0; c < result.size(); ++c) {
    const auto at = [&](Index which) { return choices(c).shapes[static_cast<std::size_t>(which)]; };
    const ChannelShape slow = at(best->pairs[c].slow), fast = at(best->pairs[c].fast);
    const double part = best->parts(2 * static_cast<Index>(c)),
                 rest = best->parts(2 * static_cast<Index>(c) + 1);
    ChannelShape& shape = result[c];
    shape.form = ChannelForm::kSecondOrderLead;
    shape.gain = part + rest;
    if (!(std::abs(shape.gain) > kLeastSharedGain * (std::abs(part) + std::abs(rest))))
      return std::nullopt;
    shape.time_constant = slow.time_constant;
    shape.second = fast.time_constant;
    shape.lead = (part * fast.time_constant + rest * slow.time_constant) / shape.gain;
    shape.dead_time = slow.dead_time;
  }
  return result;
}

double gain_sd(const HighOrderModel& model, int input, double time_constant) {
  ChannelShape shape;
  shape.time_constant = time_constant;
  const double size = (partial(model, input) * coefficients_of(shape, model)).norm();
  return size > 0.0 ? std::sqrt(model.variance) / size : std::numeric_limits<double>::infinity();
}

}  // namespace mpm
