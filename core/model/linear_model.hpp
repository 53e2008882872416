#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/model/model_spec.hpp"

namespace mpm {

class Archive;

/// Free-running simulation of a `ModelSpec` on its sample grid: exact zero-order-hold
/// discretisation (matrix exponential; a fractional dead time splits the hold in two, Astrom and
/// Wittenmark 1997, section 2.6), driven by measured inputs, no feedback from measured outputs.
/// Around the linear part: static blocks of the inputs, of single channels and of the CVs; tanks in
/// series, integrated within the sample; state terms, which see the channel's y(k); disturbances,
/// which a CV's output block sees as it sees the process (a sensor clips everything).
///
/// One step of the loop: `output()` is y(k), a function of u(k-1), u(k-2), ...; then
/// `advance(u(k))`. Whatever feeds through (D of a state space, a first step response value, a lead
/// over one lag) acts on the input just before the sampling instant, that is on u(k-1). An input
/// that is not finite counts as unchanged. No allocation after construction.
class LinearModel {
 public:
  explicit LinearModel(const ModelSpec& spec);
  LinearModel(LinearModel&&) noexcept;
  LinearModel& operator=(LinearModel&&) noexcept;
  LinearModel(const LinearModel&);
  LinearModel& operator=(const LinearModel&);
  ~LinearModel();

  [[nodiscard]] int input_count() const;
  [[nodiscard]] int cv_count() const;

  /// At rest at the operating point (all past inputs at the origin).
  void reset();
  /// As if `input` (input_count, own units) had been held for ever; integrating parts at rest.
  void reset_steady(const Eigen::Ref<const Eigen::VectorXd>& input);

  /// Time of the present output on the clock of the disturbances; every `advance` adds a sample
  /// time, a reset goes back to the time last set. 0 unless set.
  void set_time_s(double time_s);

  /// y(k), cv_count values in CV units, from the inputs given so far.
  [[nodiscard]] const Eigen::VectorXd& output() const;
  /// Takes u(k) (input_count, own units), which acts from k to k+1.
  void advance(const Eigen::Ref<const Eigen::VectorXd>& input);

  /// The linear part of one channel as a model of its own, in deviations, at rest.
  [[nodiscard]] LinearModel channel(int cv, int input) const;
  /// Of the inputs, input_count, own units: about which the model is linear.
  [[nodiscard]] const Eigen::VectorXd& operating_input() const;

  /// Response of one channel's linear part (of tanks: around the operating point) to a unit pulse
  /// at u(0): h(0) = 0, h(1), ... h(length-1). Zero where the channel does not exist.
  [[nodiscard]] Eigen::VectorXd impulse_response(int cv, int input, int length) const;
  /// Steady-state gains of the linear part, cv_count x input_count; an integrating channel's entry
  /// is its slope per sample.
  [[nodiscard]] Eigen::MatrixXd steady_gain() const;
  /// cv_count x input_count; true where a channel integrates.
  [[nodiscard]] Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating() const;
  /// Samples after which every non-integrating channel's step response stays within `tolerance`
  /// (a fraction of its final value); at most `limit`.
  [[nodiscard]] int settling_samples(double tolerance = 0.01, int limit = 100000) const;
  /// Slowest time constant of one channel, samples (>= 1); 1 where there is none.
  [[nodiscard]] double time_constant_samples(int cv, int input) const;
  /// Slowest time constant of any channel in samples (>= 1), and longest dead time in samples.
  [[nodiscard]] double slowest_time_constant_samples() const;
  [[nodiscard]] double longest_dead_time_samples() const;

  /// Where the simulation stands.
  void archive(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mpm
