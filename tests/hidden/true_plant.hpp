#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "core/model/model_spec.hpp"
#include "tests/hidden/element.hpp"

namespace mpm::hidden {

/// One relation of the true plant; time in samples, signals as deviations. Inputs are the model's,
/// then the measured signals that the model leaves out.
struct TrueChannel {
  int cv = 0, input = 0;
  double gain = 1.0;
  double time_constant = 1.0;
  double second_time_constant = 0.0;  ///< of another lag in series; 0 = none
  double dead_time = 0.0;
  Element element = {};  ///< of this channel alone, behind the input's own
  /// In force for from <= k < until. Such a channel runs all the time on the inputs and only its
  /// output counts or not, as where a flow meter or a heat transfer changes at once; with
  /// `switched_at_input` what has gone in goes on coming out.
  int from = 0, until = std::numeric_limits<int>::max();
  bool switched_at_input = false;
  // What no cause means.
  int modulator = -1;  ///< input whose value changes the gain: gain (1 + modulation u)
  double modulation = 0.0;
  double swing = 0.0;  ///< gain (1 + swing sin(2 pi k / swing_period))
  double swing_period = 1.0;
  double asymmetry = 0.0;  ///< T (1 + asymmetry) while the state rises, T / (1 + ..) else
};

struct TruePlantSpec {
  int input_count = 0;  ///< of the model
  int aux_count = 0;
  int cv_count = 0;
  Eigen::VectorXd input_origin;  ///< of the model's inputs and the aux signals
  Eigen::VectorXd output_origin;
  std::vector<TrueChannel> channels;
  std::vector<Element> input_elements;           ///< one per input and aux signal
  std::vector<std::optional<Limited>> clipping;  ///< one per CV, of the value measured, CV units
  Eigen::MatrixXd disturbance;                   ///< samples x CVs, adds itself to the CVs
};

/// First-order lags held by zero order, with any fraction of a sample of dead time.
class TruePlant {
 public:
  explicit TruePlant(TruePlantSpec spec);

  /// As if the aux signals had been at these values for ever.
  void rest_at(const Eigen::VectorXd& aux);
  /// What the instruments show at k with `noise` added before they clip; y(k) sees u(k-1).
  [[nodiscard]] Eigen::VectorXd measured(const Eigen::VectorXd& noise) const;
  /// Takes the model's inputs and the aux signals at k, own units.
  void advance(const Eigen::VectorXd& inputs, const Eigen::VectorXd& aux);

 private:
  struct Running {
    RunningElement element;
    std::vector<double> past;  ///< what goes in, newest first
    double first = 0.0, second = 0.0;
  };
  void advance(const TrueChannel& channel, Running& running, const Eigen::VectorXd& deviation);

  TruePlantSpec spec_;
  std::vector<RunningElement> elements_;
  std::vector<Running> running_;
  int k_ = 0;
};

/// The model's transfer functions as a plant. Throws std::invalid_argument where a channel has
/// another form than gain, one lag and dead time, as those of the plants drawn from have.
[[nodiscard]] TruePlantSpec plant_like(const ModelSpec& model);

/// Free of noise, driven by recorded inputs: samples x CVs.
[[nodiscard]] Eigen::MatrixXd simulate(const TruePlantSpec& spec, const Eigen::MatrixXd& inputs,
                                       const Eigen::MatrixXd& aux);

/// Steady-state gains at the operating point of what is in force at the end, CVs x model inputs.
[[nodiscard]] Eigen::MatrixXd steady_gain(const TruePlantSpec& spec);

}  // namespace mpm::hidden
