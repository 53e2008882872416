#pragma once

#include <cstdint>
#include <vector>

#include "core/identify/fit/simulator.hpp"

namespace mpm {

/// The samples that no fit has seen, and free runs on them.
class Unseen {
 public:
  /// The last `rows` of a recording, which must outlive it. `model` says how long what happened is
  /// remembered; `seed` of the bootstrap.
  Unseen(const Recording& recording, Eigen::Index rows, const ModelSpec& model, std::uint64_t seed);

  [[nodiscard]] Eigen::VectorXd measured(int cv) const;
  [[nodiscard]] Eigen::VectorXd simulated(const ModelSpec& model, int cv);
  /// All CVs on the whole recording, samples x CVs.
  [[nodiscard]] Eigen::MatrixXd free_runs(const ModelSpec& model);
  /// Measured minus simulated on the unseen rows; NaN where unknown.
  [[nodiscard]] Eigen::VectorXd residual(const ModelSpec& model, int cv) {
    return measured(cv) - simulated(model, cv);
  }
  /// The same on all rows of the recording.
  [[nodiscard]] Eigen::VectorXd residual_throughout(const ModelSpec& model, int cv);
  /// Squared prediction errors at a horizon (horizons.hpp), none across a border of runs.
  [[nodiscard]] Eigen::VectorXd prediction_errors(const Eigen::Ref<const Eigen::VectorXd>& residual,
                                                  Eigen::Index horizon) const;
  /// Squared one-step errors on the unseen rows, of the autoregression that fits such a residual on
  /// all rows best, about its level; NaN where they are unknown. They do not feel what an input
  /// does because the controller saw the residual, as longer predictions and free runs do (Ljung
  /// 1999, 13.4).
  [[nodiscard]] Eigen::VectorXd innovations(
      const Eigen::Ref<const Eigen::VectorXd>& residual) const;
  /// At which predictions are judged, samples; ascending.
  [[nodiscard]] const std::vector<Eigen::Index>& horizons() const { return horizons_; }
  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  /// Rows of a block of the bootstrap.
  [[nodiscard]] Eigen::Index block() const { return block_; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

 private:
  Simulator simulator_;
  Eigen::Index rows_, block_;
  std::vector<Eigen::Index> horizons_;
  std::uint64_t seed_;
};

}  // namespace mpm
