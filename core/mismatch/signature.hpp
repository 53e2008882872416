#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "core/mismatch/calibration.hpp"

namespace mpm {

/// The regressors of one input in the mismatch detector: u(k-1..k-L) and tails s_t(k-L-1) with
/// poles r_t. Turns a pulse response into coefficients on them: exact up to lag L, beyond it the
/// step response is fitted by the tails' step responses (least squares over eight slowest time
/// constants).
class BlockBasis {
 public:
  BlockBasis(int fir_lags, std::vector<double> tail_poles);

  /// Lags beyond the first at which a response is looked at for the tails.
  [[nodiscard]] static int lags_beyond(const std::vector<double>& tail_poles);
  [[nodiscard]] int columns() const { return fir_lags_ + static_cast<int>(tail_poles_.size()); }
  [[nodiscard]] int fir_lags() const { return fir_lags_; }
  /// Values of a pulse response, from lag 0 on, that `tail_coefficients` looks at.
  [[nodiscard]] int length() const { return fir_lags_ + beyond_ + 1; }
  /// Slowest tail's time constant, samples.
  [[nodiscard]] double slowest() const { return slowest_; }
  /// Of `pulse` delayed by `shift` samples.
  [[nodiscard]] Eigen::VectorXd tail_coefficients(const Eigen::VectorXd& pulse, int shift) const;
  /// The same without allocation, to rounding: `work` takes `length` values.
  void tail_coefficients(const Eigen::VectorXd& pulse, int shift, Eigen::VectorXd& work,
                         Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  void sum_beyond(const Eigen::VectorXd& pulse, int shift, Eigen::Ref<Eigen::VectorXd> step) const;

  int fir_lags_;
  std::vector<double> tail_poles_;
  double slowest_ = 1.0;
  int beyond_ = 0;
  Eigen::HouseholderQR<Eigen::MatrixXd> tail_fit_;
  Eigen::MatrixXd projection_;  // of a step response on the tails'
};

/// What one kind of model error adds to a CV's innovation: b(q) = A(q) h(q) on a block's basis,
/// with
///
///     A(q) = 1 - a_1 q^-1 - ... - a_p q^-p - sum_t a_(p+t) q^-(p+1) (1 - q_t) / (1 - q_t q^-1)
///
/// the CV's own residual dynamics (`RegressionShape`), known only later.
class Signature {
 public:
  /// `pulse`: h(0), h(1), ... (basis.length() values). `means`: the poles q_t.
  Signature(const BlockBasis& basis, const Eigen::VectorXd& pulse, int order,
            const std::vector<double>& means = {});
  /// Takes another pulse response in place of the first; no allocation.
  void replace(const BlockBasis& basis, const Eigen::VectorXd& pulse, Eigen::VectorXd& work);
  /// `a` points at a_1..a_p and those of the means; writes basis.columns() coefficients.
  void filter(const double* a, Eigen::Ref<Eigen::VectorXd> coefficients) const;

 private:
  [[nodiscard]] Eigen::Index order() const { return tails_.cols() - 1 - means_.cols(); }

  Eigen::VectorXd pulse_;      // h(1)..h(L)
  std::vector<double> poles_;  // of the means
  Eigen::VectorXd mean_;       // h as one of them has it, basis.length() values
  Eigen::MatrixXd means_;      // L x means: its values at 1..L
  Eigen::MatrixXd tails_;      // tails x (1 + p + means), for shifts 0..p, then the means
};

/// A pulse response delayed by `by` samples (earlier where negative); as many values.
[[nodiscard]] Eigen::VectorXd shifted(const Eigen::VectorXd& pulse, int by);

/// Pulse responses of the errors a channel usually has, for its own pulse response: its gain (the
/// response itself), its time constants (derivative by their logarithm), its dead time (2 samples
/// earlier, 2 and 6 later). As many values as `pulse`. An `integrating` channel with longer time
/// constants rises as steeply in the end, only later: how steeply is its gain.
inline constexpr int kUsualErrors =
    2 + static_cast<int>(calibration::usual_errors::kDelayShifts.size());
[[nodiscard]] std::vector<Eigen::VectorXd> usual_errors(const Eigen::VectorXd& pulse,
                                                        bool integrating);

}  // namespace mpm
