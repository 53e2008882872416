#include "tests/core/identify/proposals.hpp"

#include <stdexcept>

#include "core/identify/diagnosis/statement.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::test {

Problem& open_problem() {
  static const Recording recording = [] {
    constexpr Eigen::Index kRows = 240;
    Eigen::MatrixXd inputs(kRows, 2), cvs(kRows, 2);
    inputs << telegraph(1, kRows, 12) + 0.1 * white(2, kRows),
        telegraph(3, kRows, 9) + 0.1 * white(4, kRows);
    cvs << first_order(inputs.col(0), 2.0, 10.0) - first_order(inputs.col(1), 1.0, 5.0),
        first_order(inputs.col(0), 0.5, 4.0);
    cvs.col(0) += 0.2 * white(5, kRows);
    cvs.col(1) += 0.2 * white(6, kRows);
    Recording measured = recording_of(inputs, cvs);
    measured.start_s = 1000.0;
    measured.aux = telegraph(7, kRows, 15);
    return measured;
  }();
  static Problem problem = [] {
    const ChannelSpec tanks{0, 0, TransferFunction{2.0, {10.0, 5.0}, 0.0, 4.0, false}, {}};
    const ChannelSpec spring{1, 0, DiscreteFilter{{0.05}, {1.0, -1.6, 0.7}, 3}, {}};
    const ModelSpec model = model_of({tanks, lag(0, 1, -1.0, 5.0, 3.0), spring}, 2, 2);
    return Problem(with_aux_inputs(model, recording), 2, recording, Tolerances{}, NoiseModel{});
  }();
  return problem;
}

std::vector<Effect> proposals_of(const Cause& cause) {
  static const std::vector<Effect> kNone;
  static const std::vector<CvFit> without = open_problem().fit(kNone, 0, {0, 1}).cvs;
  std::vector<Effect> found;
  cause.propose({open_problem(), kNone, without}, found);
  return found;
}

std::vector<Finding> findings_of(const Cause& cause) {
  std::vector<Finding> findings;
  for (const Effect& effect : proposals_of(cause)) {
    SearchResult found;
    found.named = {{effect, 50.0, 0.99, {}}};
    found.fit.effects = {effect};
    const auto count = static_cast<Eigen::Index>(effect.coordinates.size());
    found.fit.covariance = Eigen::MatrixXd::Zero(count, count);
    findings.push_back(to_finding(found, 0, open_problem()));
  }
  const Eigen::Index rows = open_problem().samples();
  Fit louder;
  louder.cvs.resize(1);
  louder.cvs[0].innovations = Eigen::VectorXd::NullaryExpr(
      rows, [&](Eigen::Index k) { return (k % 2 == 0 ? 1.0 : -1.0) * (2 * k < rows ? 1.0 : 3.0); });
  for (const Finding& finding : cause.left_in(open_problem(), louder)) findings.push_back(finding);
  return findings;
}

const Quantity& quantity_of(const Cause& cause, const std::string& name) {
  for (const Effect& effect : proposals_of(cause))
    for (const Coordinate& coordinate : effect.coordinates)
      if (coordinate.quantity->name == name) return *coordinate.quantity;
  for (const Finding& finding : findings_of(cause))
    for (const Parameter& parameter : finding.parameters)
      if (parameter.quantity->name == name) return *parameter.quantity;
  throw std::out_of_range(std::string(cause.name().text) + " has no " + name);
}

}  // namespace mpm::test
