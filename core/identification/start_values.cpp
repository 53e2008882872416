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

struct Candidate {
  double time_constant = 1.0;
  double dead_time = 0.0;
};

/// Coefficients of the blocks that a first-order channel of gain 1 has in the regression: its
/// impulse response behind A(q), averaged over each block.
VectorXd coefficients_of(const Candidate& candidate, const HighOrderModel& model) {
  const int longest = model.blocks.back().last;
  VectorXd impulse(longest + 1);
  double before = 0.0;
  for (int l = 0; l <= longest; ++l) {
    const double since = static_cast<double>(l) - candidate.dead_time;
    const double step = since > 0.0 ? -std::expm1(-since / candidate.time_constant) : 0.0;
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

std::vector<Candidate> grid(const HighOrderModel& model, std::optional<double> dead_time) {
  const double longest = model.blocks.back().last;
  std::vector<double> dead_times;
  if (dead_time) {
    dead_times.push_back(*dead_time);
  } else {
    for (const LagBlock& block : model.blocks)
      if (block.first - 1.0 <= kLatestStart * longest) dead_times.push_back(block.first - 1.0);
  }
  std::vector<Candidate> candidates;
  for (double time = kFastestStart; time <= kSlowestStart * longest; time *= kStartGrowth)
    for (const double dead : dead_times) candidates.push_back({time, dead});
  return candidates;
}

/// The best of some candidates for what is left of the right-hand side.
struct Best {
  std::size_t which = 0;
  double gain = 0.0;
  double explained = -1.0;  ///< fall of the squared error; < 0: none fits
};

Best best_of(const MatrixXd& columns, const Eigen::Ref<const VectorXd>& right, int sign) {
  Best best;
  for (Index c = 0; c < columns.cols(); ++c) {
    const double square = columns.col(c).squaredNorm(), product = columns.col(c).dot(right);
    if (!(square > 0.0) || (sign != 0 && product * sign < 0.0)) continue;
    const double explained = product * product / square;
    if (explained > best.explained)
      best = {static_cast<std::size_t>(c), product / square, explained};
  }
  return best;
}

/// The factor's columns of one input, and the right-hand side, with all other columns taken out.
struct Partial {
  MatrixXd factor;
  VectorXd right;
};

Partial partial(const HighOrderModel& model, int input) {
  const Index columns = model.factor.cols(), own = static_cast<Index>(model.blocks.size()),
              first = model.column_of(input);
  MatrixXd reordered(columns, columns + 1);
  reordered.leftCols(first) = model.factor.leftCols(first);
  reordered.middleCols(first, columns - first - own) =
      model.factor.rightCols(columns - first - own);
  reordered.middleCols(columns - own, own) = model.factor.middleCols(first, own);
  reordered.col(columns) = model.right;
  // The first `first` columns are triangular already.
  const Index rest = columns - first;
  const Eigen::HouseholderQR<MatrixXd> qr(reordered.bottomRightCorner(rest, rest + 1));
  const MatrixXd triangle = qr.matrixQR().triangularView<Eigen::Upper>();
  return {triangle.block(rest - own, rest - own, own, own), triangle.col(rest).tail(own)};
}

/// `columns` without what the orthonormal `basis` spans.
void take_out(const MatrixXd& basis, Eigen::Ref<MatrixXd> columns) {
  if (basis.cols() > 0) columns -= basis * (basis.transpose() * columns);
}

/// The grid of one input.
struct Choices {
  std::vector<Candidate> candidates;
  MatrixXd coefficients;  ///< blocks x candidates
};

Choices choices_of(const HighOrderModel& model, std::optional<double> dead_time) {
  Choices choices{grid(model, dead_time), {}};
  choices.coefficients.resize(static_cast<Index>(model.blocks.size()),
                              static_cast<Index>(choices.candidates.size()));
  for (std::size_t c = 0; c < choices.candidates.size(); ++c)
    choices.coefficients.col(static_cast<Index>(c)) =
        coefficients_of(choices.candidates[c], model);
  return choices;
}

}  // namespace

std::vector<ChannelShape> start_values(const HighOrderModel& model,
                                       const std::vector<ChannelHint>& hints,
                                       double sample_time_s) {
  const auto inputs = hints.size();
  const auto own = static_cast<Index>(model.blocks.size());
  const Choices usual = choices_of(model, std::nullopt);
  std::vector<Choices> special(inputs);
  std::vector<std::optional<Best>> found(inputs);
  const auto choices = [&](std::size_t i) -> const Choices& {
    return hints[i].dead_time_s ? special[i] : usual;
  };
  for (std::size_t i = 0; i < inputs; ++i) {
    if (hints[i].no_relation) continue;
    if (hints[i].dead_time_s)
      special[i] = choices_of(model, *hints[i].dead_time_s / sample_time_s);
    const Partial rest = partial(model, static_cast<int>(i));
    const Best best = best_of(rest.factor * choices(i).coefficients, rest.right, hints[i].sign);
    if (best.explained > kWorthTrying * model.variance) found[i] = best;
  }
  // What the CV's own past explains stays as the regression says.
  const VectorXd right = model.right - model.factor.leftCols(model.past) * model.noise;
  const auto column = [&](std::size_t i) -> VectorXd {
    return model.factor.middleCols(model.column_of(static_cast<int>(i)), own) *
           choices(i).coefficients.col(static_cast<Index>(found[i]->which));
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < inputs; ++i) {
      if (hints[i].no_relation) continue;
      MatrixXd others(model.factor.rows(), static_cast<Index>(inputs));
      Index count = 0;
      for (std::size_t m = 0; m < inputs; ++m)
        if (m != i && found[m]) others.col(count++) = column(m).normalized();
      const Eigen::HouseholderQR<MatrixXd> qr(others.leftCols(count));
      const MatrixXd basis =
          qr.householderQ() * MatrixXd::Identity(others.rows(), count);
      MatrixXd columns = model.factor.middleCols(model.column_of(static_cast<int>(i)), own) *
                         choices(i).coefficients;
      VectorXd left = right;
      take_out(basis, columns);
      take_out(basis, left);
      const Best best = best_of(columns, left, hints[i].sign);
      found[i].reset();
      if (best.explained > kWorthTrying * model.variance) found[i] = best;
    }
  std::vector<ChannelShape> shapes;
  for (std::size_t i = 0; i < inputs; ++i) {
    if (!found[i]) continue;
    const Candidate& candidate = choices(i).candidates[found[i]->which];
    ChannelShape shape;
    shape.input = static_cast<int>(i);
    shape.gain = found[i]->gain;
    shape.time_constant = candidate.time_constant;
    shape.dead_time = candidate.dead_time;
    shape.dead_time_known = hints[i].dead_time_s.has_value();
    shape.sign = hints[i].sign;
    shapes.push_back(shape);
  }
  return shapes;
}

double gain_sd(const HighOrderModel& model, int input, double time_constant) {
  const Partial rest = partial(model, input);
  const double size = (rest.factor * coefficients_of({time_constant, 0.0}, model)).norm();
  return size > 0.0 ? std::sqrt(model.variance) / size : std::numeric_limits<double>::infinity();
}

}  // namespace mpm
