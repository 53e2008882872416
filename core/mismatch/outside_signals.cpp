#include "core/mismatch/outside_signals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/mismatch/signature.hpp"
#include "core/statistics/calibration.hpp"
#include "core/statistics/readback.hpp"

namespace mpm {

OutsideSignals::OutsideSignals(const RegressionShape& shape, int signals, std::vector<double> poles,
                               int depth)
    : shape_(shape),
      signals_(signals),
      depth_(depth),
      poles_(std::move(poles)),
      origin_(static_cast<std::size_t>(signals), std::numeric_limits<double>::quiet_NaN()),
      last_(static_cast<std::size_t>(signals), 0.0),
      readbacks_(static_cast<std::size_t>(signals)),
      unknown_(Eigen::VectorXd::Constant(signals, std::numeric_limits<double>::quiet_NaN())),
      inputs_(static_cast<std::size_t>(shape.inputs * shape.block())),
      feed_(shape.lead_in() + VolterraTerms::most_columns() + shape.inputs * kUsualErrors +
            block() + 1),
      alone_(shape.lead_in() + block(), 1),
      beside_(shape.lead_in() + shape.inputs * kUsualErrors + block(), 1) {
  for (int w = 0; w < signals * block(); ++w) windows_.emplace_back(depth);
}

void OutsideSignals::push(const Eigen::Ref<const Eigen::VectorXd>& values) {
  auto window = windows_.begin();
  for (int i = 0; i < signals_; ++i) {
    const auto s = static_cast<std::size_t>(i);
    if (std::isfinite(values(i))) {
      if (std::isnan(origin_[s])) origin_[s] = values(i);
      last_[s] = values(i) - origin_[s];
    }
    (window++)->push(last_[s]);
    for (const double pole : poles_) {
      window->push(pole * window->window()[0] + (1.0 - pole) * last_[s]);
      ++window;
    }
  }
}

void OutsideSignals::skip(std::int64_t missing) {
  for (std::int64_t k = 0; k < std::min<std::int64_t>(missing, depth_); ++k) push(unknown_);
}

void OutsideSignals::archive(Archive& a) {
  // not archived: signals_, depth_, poles_, unknown_ (construction)
  // not archived: shape_, inputs_, feed_, alone_, beside_ (made anew where a CV is followed)
  a(origin_, last_, readbacks_, windows_);
}

FollowedSignal OutsideSignals::followed(int cv, const RegressionHistory& history,
                                        const ResidualRegression& regression,
                                        const Eigen::MatrixXd& usual) {
  FollowedSignal best;
  const int span = std::min(regression.span(), depth_);
  for (int i = 0; i < signals_; ++i) {
    if (reads_an_input_back(i, history, span)) continue;
    const double explained = explained_by(i, cv, history, regression, nullptr);
    if (explained <= best.explained) continue;
    best.explained = explained;
    best.signal = i;
  }
  if (best.signal < 0) return best;
  best.beside = explained_by(best.signal, cv, history, regression, &usual);
  best.numbers = block();
  return best;
}

bool OutsideSignals::reads_an_input_back(int signal, const RegressionHistory& history, int span) {
  Readback& known = readbacks_[static_cast<std::size_t>(signal)];
  const int rows = std::min(span, readback::kMostRowsLive);
  if (known.is || rows < rows_to_read_back() || rows < 2 * known.asked_span) return known.is;
  Eigen::MatrixXd moves(rows, history.inputs());
  Eigen::VectorXd values(rows);
  const double* window = windows_[static_cast<std::size_t>(signal * block())].window();
  for (int k = 0; k < rows; ++k) {
    for (int i = 0; i < history.inputs(); ++i) moves(k, i) = history.input(i, rows - 1 - k);
    values(k) = window[rows - 1 - k];
  }
  known = {reads_back(moves, values), rows};
  return known.is;
}

// What such errors make of the row whose response is `age` samples old.
void OutsideSignals::fill_errors(const Eigen::MatrixXd& usual, const RegressionHistory& history,
                                 int age, double* row) {
  history.fill_inputs(age, inputs_.data());
  for (int i = 0; i < shape_.inputs; ++i) {
    const auto block = Eigen::VectorXd::Map(inputs_.data() + i * shape_.block(), shape_.block());
    for (int e = i * kUsualErrors; e < (i + 1) * kUsualErrors; ++e)
      row[e] = usual.col(e).dot(block);
  }
}

// What is left to the signal beside the CV's own past, and beside such errors of its channels.
double OutsideSignals::explained_by(int signal, int cv, const RegressionHistory& history,
                                    const ResidualRegression& regression,
                                    const Eigen::MatrixXd* beside) {
  const int lead_in = regression.lead_in();
  const int first = lead_in + (beside != nullptr ? shape_.inputs * kUsualErrors : 0);
  GivensQr& factor = beside != nullptr ? beside_ : alone_;
  if (factor.columns() != first + block()) factor = GivensQr(first + block(), 1);
  factor.clear();
  const double lambda = regression.memory(0).length.lambda;
  for (int age = std::min(regression.span(), depth_) - 1; age >= 0; --age) {
    const double weight = regression.row_weight(age);
    if (!(weight > 0.0)) continue;
    double* row = feed_.next_row(factor, lambda);
    regression.fill_lead_in(history, age, row);
    if (beside != nullptr) fill_errors(*beside, history, age, row + lead_in);
    for (int w = 0; w < block(); ++w)
      row[first + w] = windows_[static_cast<std::size_t>(signal * block() + w)].window()[age];
    row[factor.columns()] = history.residual(cv, age);
    for (int c = 0; c <= factor.columns(); ++c) row[c] *= weight;
  }
  feed_.flush(factor, lambda);
  double explained = 0.0;
  for (int c = first; c < factor.columns(); ++c) explained += std::pow(factor.z(c, 0), 2);
  return explained;
}

}  // namespace mpm
