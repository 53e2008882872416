#include "sim/scenario/stability.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "core/model/eigenvalues.hpp"
#include "core/text/number_text.hpp"
#include "sim/mpc/linear_gain.hpp"

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of a moment, so that it can be found in the file.
constexpr int kMomentDigits = 9;

}  // namespace

GainAgreement compare_gains(const MatrixXd& model, const MatrixXd& plant,
                            const std::vector<double>& cv_weights) {
  GainAgreement result;
  if (model.rows() == model.cols() && model.rows() > 0) {
    result.model_determinant = model.determinant();
    result.plant_determinant = plant.determinant();
  }
  VectorXd scale = VectorXd::Ones(model.rows());
  for (Index i = 0; i < scale.size() && static_cast<std::size_t>(i) < cv_weights.size(); ++i)
    scale(i) = std::sqrt(cv_weights[static_cast<std::size_t>(i)]);

  // With the thin decomposition U S V' of rank r of the model, the reachable part of
  // K_plant pinv(K_model) is the r x r matrix U' K_plant V / S.
  const Eigen::JacobiSVD<MatrixXd> svd(scale.asDiagonal() * model,
                                       Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& sizes = svd.singularValues();
  constexpr double kRankTolerance = 1e-10;
  Index rank = 0;
  while (rank < sizes.size() && sizes(rank) > kRankTolerance * sizes(0)) ++rank;
  if (rank == 0 || !plant.allFinite()) return result;
  const MatrixXd reachable = svd.matrixU().leftCols(rank).transpose() * scale.asDiagonal() * plant *
                             svd.matrixV().leftCols(rank) *
                             sizes.head(rank).cwiseInverse().asDiagonal();
  result.smallest_real_part = reachable.eigenvalues().real().minCoeff();
  return result;
}

std::optional<std::string> why_not_stabilisable(const ModelSpec& controller_model,
                                                const std::vector<PlantStage>& stages, int mv_count,
                                                const std::vector<double>& cv_weights) {
  const MatrixXd model = operating_gain(controller_model, mv_count);
  for (const PlantStage& stage : stages) {
    const GainAgreement gains =
        compare_gains(model, operating_gain(stage.model, mv_count), cv_weights);
    if (gains.stabilisable()) continue;
    std::string reason = "no offset-free controller with this model can hold this plant";
    if (stage.from_s > 0.0) reason += " from " + number_text(stage.from_s, kMomentDigits) + " s on";
    if (gains.model_determinant)
      reason += ": the determinant of the gains is " + number_text(*gains.model_determinant) +
                " in the model and " + number_text(*gains.plant_determinant) + " in the plant";
    reason += gains.model_determinant ? ", and" : ":";
    reason += " the smallest real part of the eigenvalues of K_plant K_model^-1 is " +
              number_text(gains.smallest_real_part) +
              " (must be positive). Take smaller changes, or a controller without integral action.";
    return reason;
  }
  return std::nullopt;
}

}  // namespace mpm::sim
