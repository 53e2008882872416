#include "core/identify/search/screening.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "core/identify/fit/triangle.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Screening::Screening(Problem& problem, const std::vector<Effect>& accepted,
                     const std::vector<CvFit>& without)
    : problem_(problem), accepted_(accepted) {
  for (const CvFit& fit : without) {
    const CvData& data = problem.data(fit.cv);
    Cv cv{&fit, WhitenedRows(data, fit), problem.simulate(accepted, fit.cv), {}, {}};
    const WhitenedRows& whiten = cv.whiten;
    const Index samples = data.measured.size(), nuisances = data.nuisances.cols();
    std::vector<std::pair<std::size_t, std::size_t>> own;  // numbers of what was accepted
    for (std::size_t e = 0; e < accepted.size(); ++e)
      if (touches(accepted[e], problem.model(), fit.cv))
        for (std::size_t c = 0; c < accepted[e].coordinates.size(); ++c) own.emplace_back(e, c);
    const Index columns = nuisances + static_cast<Index>(own.size());
    MatrixXd system = MatrixXd::Zero(samples + columns, columns);
    for (Index b = 0; b < nuisances; ++b)
      system.col(b).head(samples) = whiten(data.nuisances.col(b));
    for (std::size_t i = 0; i < own.size(); ++i)
      system.col(nuisances + static_cast<Index>(i)).head(samples) =
          whiten(problem.sensitivity(accepted, own[i].first, own[i].second, fit.cv, cv.simulated));
    system.bottomRows(columns).setIdentity();
    const MatrixXd r = triangle(system);
    cv.basis = r.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(system.topRows(samples));
    cv.residual = whiten(data.measured - cv.simulated);
    cvs_.push_back(std::move(cv));
  }
}

double Screening::score(const Effect& candidate) const {
  const auto count = static_cast<Index>(candidate.coordinates.size());
  // Small and only for ranking, so the normal equations of the projected columns will do here; the
  // columns are in prior units.
  MatrixXd information = MatrixXd::Identity(count, count);
  VectorXd right(count);
  for (Index i = 0; i < count; ++i) {
    const Coordinate& c = candidate.coordinates[static_cast<std::size_t>(i)];
    right(i) = -(c.value - c.prior_mean) / c.prior_sd;
  }
  std::vector<Effect> with = accepted_;
  with.push_back(candidate);
  double gain = 0.0;
  struct Part {
    double before, start, rows;
    MatrixXd information;
    VectorXd right;
  };
  std::vector<Part> parts;
  for (const Cv& cv : cvs_) {
    if (!touches(candidate, problem_.model(), cv.fit->cv)) continue;
    const CvData& data = problem_.data(cv.fit->cv);
    const VectorXd at = problem_.simulate(with, cv.fit->cv);
    if (!at.allFinite()) return -1e300;
    const WhitenedRows& whiten = cv.whiten;
    MatrixXd columns(at.size(), count);
    for (Index i = 0; i < count; ++i)
      columns.col(i) = whiten(
          problem_.sensitivity(with, with.size() - 1, static_cast<std::size_t>(i), cv.fit->cv, at));
    const VectorXd residual = cv.residual - whiten(at - cv.simulated);
    const MatrixXd seen = cv.basis.transpose() * columns;
    const VectorXd explained = cv.basis.transpose() * residual;
    const VectorXd explained_before = cv.basis.transpose() * cv.residual;
    Part part;
    part.rows = data.rows;
    part.before = cv.residual.squaredNorm() - explained_before.squaredNorm();
    part.start = residual.squaredNorm() - explained.squaredNorm();
    part.information = columns.transpose() * columns - seen.transpose() * seen;
    part.right = columns.transpose() * residual - seen.transpose() * explained;
    information += part.information;
    right += part.right;
    parts.push_back(std::move(part));
  }
  const Eigen::LDLT<MatrixXd> ldlt(information);
  const VectorXd step = ldlt.solve(right);
  if (!step.allFinite()) return -1e300;
  for (const Part& part : parts) {
    const double after =
        part.start - 2.0 * step.dot(part.right) + step.dot(part.information * step);
    gain += part.rows * std::log(std::max(1e-12, part.before) / std::max(1e-12, after));
  }
  for (Index i = 0; i < count; ++i) {
    const Coordinate& c = candidate.coordinates[static_cast<std::size_t>(i)];
    gain -= std::pow((c.value - c.prior_mean) / c.prior_sd + step(i), 2);
  }
  gain -= ldlt.vectorD().cwiseAbs().array().max(1e-300).log().sum();
  return std::isfinite(gain) ? gain - candidate.search_cost : -1e300;
}

}  // namespace mpm
