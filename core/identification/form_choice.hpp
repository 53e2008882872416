#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identification/channel_hint.hpp"
#include "core/identification/cross_noise.hpp"
#include "core/identification/high_order.hpp"
#include "core/identification/identification_data.hpp"
#include "core/identification/prediction_error.hpp"

namespace mpm {

/// What all CVs are fitted on.
struct Material {
  const Recording& recording;
  IdentificationData all, first, unseen;  ///< first: what forms are chosen on
  Eigen::VectorXd input_spread;
  std::vector<std::optional<double>> outside;
  std::vector<bool> test_signals;  ///< inputs that no controller moves
  double feedback_p_value = 1.0;
  bool open_loop = false;  ///< as far as anything shows
  CrossNoise cross = {};   ///< taken off the CVs; empty: nothing is
};

/// `open_loop`: the user says so; else the data do.
[[nodiscard]] Material material(const Recording& recording, bool open_loop);

/// With what was taken off a CV, samples, again.
[[nodiscard]] Eigen::VectorXd as_measured(const Material& material, int cv,
                                          const Eigen::Ref<const Eigen::VectorXd>& values);

/// An autoregression of an order that the rows of a mean run bear.
[[nodiscard]] NoiseAssumption noise_model(const IdentificationData& data, int cv);

/// Channels of a CV, how its noise is taken, and what the samples say that were left out.
struct Choice {
  std::vector<ChannelShape> channels;
  NoiseAssumption noise;
  bool output_error = false;
  bool confirmed = false;      ///< predictions are better with the channels
  double unseen_square = 0.0;  ///< mean, of the free run
};

/// A choice, and its channels fitted to all rows.
struct Chosen {
  Choice choice;
  PredictionErrorFit fit;
};

/// Which inputs act on a CV and in which form, chosen on one part of the rows and confirmed on the
/// rest; with the signs that the user gives, unless the data are far better without: then they
/// contradict them. `hints`: one per input. `model`: sound.
[[nodiscard]] Chosen choose_form(const Material& material, const std::vector<ChannelHint>& hints,
                                 const HighOrderModel& model, int cv);

}  // namespace mpm
