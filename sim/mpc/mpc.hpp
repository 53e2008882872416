#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "config/unit_config.hpp"
#include "core/model/linear_model.hpp"
#include "sim/mpc/dense_qp.hpp"

namespace mpm::sim {

/// Model predictive controller (Carlsson 2010, eq. 2.4-2.8; Maciejowski 2002).
///
/// Moves du at the starts of B blocks, the last one held to the horizon P. With the free response
/// f (inputs held, from the internal model), the output disturbance d = feedback (y - y_model),
/// held constant, and the matrix S of step responses,
///   y^ = f + d + S du,   min (r - y^)' W (r - y^) + du' Wd du + 2 (weight s + 0.0005 weight s^2)
///   |du| <= max_move, low <= u <= high (hard),   low - s <= y^ <= high + s, s >= 0 (soft, one s
///   per CV that has limits).
/// The set-point is not previewed; measured disturbances are held at their present value. The
/// closed-form optimum without limits is taken where it keeps all of them; else the quadratic
/// program decides; where that has no solution the MVs stay where they are.
///
/// What is not linear in the model, and its disturbances, shape the free response; S is that of the
/// linear part around the operating point.
///
/// feedback = 1 is integral action (no steady offset); below 1 the loop keeps an offset.
/// No allocation after construction.
class Mpc {
 public:
  /// `model` has the MVs first among its inputs. Throws std::invalid_argument on settings that
  /// define no controller.
  Mpc(const ModelSpec& model, int mv_count, const config::SimulationSettings& settings,
      double disturbance_feedback);

  /// Time of the present prediction on the clock of the data; see `LinearModel::set_time_s`.
  void set_time_s(double time_s) { model_.set_time_s(time_s); }

  /// y_model(k): the internal model, driven by the inputs given so far and never corrected.
  [[nodiscard]] const Eigen::VectorXd& prediction() const { return model_.output(); }

  /// u(k) from y(k), the set-points and the measured disturbances at k; acts until k+1.
  [[nodiscard]] const Eigen::VectorXd& control(
      const Eigen::Ref<const Eigen::VectorXd>& measured,
      const Eigen::Ref<const Eigen::VectorXd>& setpoint,
      const Eigen::Ref<const Eigen::VectorXd>& disturbance);

  /// u(k) = u(k-1): the controller is off and only follows. It comes back without a bump.
  [[nodiscard]] const Eigen::VectorXd& hold(const Eigen::Ref<const Eigen::VectorXd>& disturbance);
  /// u(k) is what somebody else gives the MVs.
  [[nodiscard]] const Eigen::VectorXd& follow(const Eigen::Ref<const Eigen::VectorXd>& mvs,
                                              const Eigen::Ref<const Eigen::VectorXd>& disturbance);

  /// Intervals in which some limit shaped the moves, and in which no solution was found.
  [[nodiscard]] std::int64_t limited_count() const { return limited_count_; }
  [[nodiscard]] std::int64_t held_count() const { return held_count_; }

 private:
  void build_step_matrix(const ModelSpec& model);
  void build_program();
  void compute_free_response(const Eigen::Ref<const Eigen::VectorXd>& measured);
  [[nodiscard]] bool within_limits();
  [[nodiscard]] bool solve_with_limits();
  void apply_moves();
  [[nodiscard]] Eigen::Index move_count() const {
    return static_cast<Eigen::Index>(block_starts_.size()) * mv_count_;
  }

  int mv_count_;
  int horizon_;
  double disturbance_feedback_;
  config::SimulationSettings settings_;
  std::vector<int> block_starts_;  ///< samples from now
  std::vector<int> soft_cvs_;      ///< CVs with limits, one slack each
  LinearModel model_;              ///< follows the true inputs
  LinearModel forecast_;           ///< its copy that runs ahead

  Eigen::MatrixXd step_matrix_;  ///< S, rows cv * P + l - 1, columns block * mv_count + mv
  Eigen::MatrixXd weighted_;     ///< S' W
  Eigen::MatrixXd hessian_;      ///< S' W S + Wd
  Eigen::MatrixXd feedback_;     ///< hessian^-1 S' W
  std::unique_ptr<DenseQp> program_;

  Eigen::VectorXd input_;         ///< u(k-1), then u(k); disturbances behind
  Eigen::VectorXd mv_;            ///< the MVs of input_
  Eigen::VectorXd free_, error_;  ///< f + d and r - f - d, as the rows of S
  Eigen::VectorXd moves_, forced_, level_;
  Eigen::VectorXd gradient_, lower_, upper_;
  std::int64_t limited_count_ = 0;
  std::int64_t held_count_ = 0;
};

}  // namespace mpm::sim
