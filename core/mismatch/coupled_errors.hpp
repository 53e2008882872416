#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/mismatch/channel_signatures.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/input_errors.hpp"
#include "core/mismatch/input_estimates.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/regression/givens_qr.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// Usual errors of the channels of some CVs at once, whose noise goes together.
///
/// What disturbs one CV often disturbs others, or reaches them through it; then the regression of
/// a CV's residual rests on those of others as well,
///
///     e_j = sum_l a_jl(q) e_l + sum_i b_ji(q) u_i + w_j,
///     b_ji = h_ji - sum_l a_jl(q) h_li,
///
/// with h the errors of the pulse responses, and a wrong channel (l, i) shows in the coefficients
/// of (j, i), be that right or wrong as well: all CVs' regressions together tell which h is not
/// zero (Ljung 1999, section 4.2, for the vector form). Gauss-Newton on the noise's dynamics a and
/// on the usual errors h of all channels. Of each CV the factor of its own regression is all that
/// is read: a change of variables makes of the residuals' lags those of the noise. That the
/// innovations w of several CVs go together is left out, at the price of some precision. No
/// allocation after construction.
class CoupledErrors {
 public:
  explicit CoupledErrors(const RegressionShape& shape);

  /// CVs that are judged together at most; 1 where a turn of even two takes too long
  /// (`calibration::coupled_errors::kMostWork`).
  [[nodiscard]] static int most_cvs(const RegressionShape& shape);
  /// Multiplications of a turn of Gauss-Newton for so many CVs; and numbers that one of these keeps
  /// for a unit.
  [[nodiscard]] static double work_of(const RegressionShape& shape, int cvs);
  [[nodiscard]] static double numbers_of(const RegressionShape& shape);

  /// The CVs, the one that is asked for first; no more than `most_cvs`.
  void clear() { members_ = 0; }
  void add(int cv, const GivensQr& factor, const EstimateNoise& noise);

  /// `signatures`: of all channels, input-major; `estimates`: of the first CV. Whether usual errors
  /// explain all that the inputs do to each of the CVs.
  [[nodiscard]] bool fit(const std::vector<ChannelSignatures>& signatures,
                         const InputEstimates& estimates);

  /// The same fit, of the same CVs, with one of the first CV's channels held right.
  void fit_without(int input, const CoupledErrors& all, const InputEstimates& estimates);
  /// What the errors leave of all that the inputs do to the CVs, in squares of the first CV's
  /// noise.
  [[nodiscard]] double left_square() const;

  /// After a `fit` that may stand, of the first CV. A channel's errors: valid until the next call.
  [[nodiscard]] const InputErrors::Channel& channel(int input) {
    return single_.read(all_, input * kUsualErrors, 1 + input * InputErrors::kShifts);
  }
  /// The factor of [all other errors | the block of the input | response], columns scaled as in
  /// `estimates`: `first` is the column where the block begins. Valid until the next call.
  struct Freed {
    const GivensQr& factor;
    int first;
  };
  [[nodiscard]] Freed freed(int input, const InputEstimates& estimates);
  /// a_jj, as `InputEstimates::own_past` has it.
  void own_past(Eigen::VectorXd& past) const {
    shape_.own_past(member_.front().cv, member_.front().lead_in, past);
  }

 private:
  struct Member {
    int cv = 0;
    const GivensQr* factor = nullptr;
    EstimateNoise noise;
    Eigen::VectorXd lead_in;  // coefficients
    GivensQr row;  // [lead-in | errors of all | response, shifts of the first's channels]
    Member(int columns, int responses) : row(columns, responses) {}
  };

  /// Of the errors of one CV's channels.
  [[nodiscard]] int own_columns() const { return shape_.inputs * kUsualErrors; }
  [[nodiscard]] int lead_in_of(const Member& member) const {
    return member.factor->columns() - shape_.inputs * shape_.block();
  }
  [[nodiscard]] const ChannelSignatures& signatures_of(const Member& member, int input) const {
    return (*signatures_)[static_cast<std::size_t>(input * shape_.cvs + member.cv)];
  }
  [[nodiscard]] double scale_of(const Member& member) const;
  [[nodiscard]] std::span<Member> members() {
    return std::span(member_).first(static_cast<std::size_t>(members_));
  }
  /// Gauss-Newton; false where it does not settle.
  bool descend(const InputEstimates& estimates);
  void begin(Member& member);
  void delay_errors(std::size_t at, const InputEstimates& estimates);
  void linearise(const Member& member, const InputEstimates& estimates);
  void act(const Signature& error, bool own, Eigen::Ref<Eigen::VectorXd> out);
  /// `mixed_`: what row r of a member's factor becomes.
  void mix_row(const Member& member, int r);
  void write_lead_in(const Member& member, double* out) const;
  void take_rows(Member& member);
  double solve();
  void learn_lead_in(Member& member) const;
  [[nodiscard]] double left_square(const Member& member) const;
  [[nodiscard]] bool adequate(const Member& member, const InputEstimates& estimates) const;

  RegressionShape shape_;
  int lead_in_;  // the most columns
  int errors_;   // columns of all members'
  std::vector<Member> member_;
  int members_ = 0;
  int held_ = -1;  // input of the first CV's channel that is taken for right
  const std::vector<ChannelSignatures>* signatures_ = nullptr;
  Eigen::VectorXd sizes_, next_;          // of all errors
  Eigen::VectorXd past_, one_, none_;     // a, of one CV on another
  Eigen::VectorXd error_, not_delayed_;   // block
  std::vector<Eigen::MatrixXd> delayed_;  // per member: columns of all inputs x delays, then means
  Eigen::MatrixXd columns_;               // columns of all inputs x what rows become
  Eigen::VectorXd factor_row_, mixed_;
  Eigen::VectorXd coefficients_, norms_;
  RowFeed feed_;
  GivensQr all_;    // [errors of all | response, shifts]
  GivensQr open_;   // [lead-in | errors but of one channel | its block | response]
  GivensQr freed_;  // [errors but of one channel | this in other CVs | its block | response]
  InputErrors single_;
};

}  // namespace mpm
