#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// One number of an effect: what it is before anything is known, and how to move it.
struct Coordinate {
  std::string name;
  double value = 0.0;
  double prior_mean = 0.0;  ///< value that means "no effect", or the middle of what is likely
  double prior_sd = 1.0;    ///< Gaussian
  double step = 1e-3;       ///< of a finite difference
  double low = -1e30, high = 1e30;
};

/// A cause with numbers: an edit of the model. The same list of effects says what the fit tries,
/// what the findings are and what the extended model holds.
struct Effect {
  Subject subject;
  std::vector<Coordinate> coordinates;
  /// Acts from this row on (0 = throughout): before it the CV is what it would be without.
  Eigen::Index onset = 0;
  /// 2 ln of how many equal alternatives (rows to begin at, shapes, ...) it was picked from.
  double search_cost = 0.0;
  /// Of a valve: it slips once and sticks again.
  bool slips_once = false;
  /// Seen in the data themselves, whatever the model: not weighed against others.
  bool certain = false;
  /// Of an unnamed one, samples x coordinates: what the CV does per unit of each.
  std::shared_ptr<const Eigen::MatrixXd> shape = {};

  [[nodiscard]] const Coordinate* find(const std::string& name) const;
  [[nodiscard]] double value(const std::string& name, double otherwise) const;
};

/// 2 ln of so many equal alternatives; 0 counts as 1.
[[nodiscard]] double cost_of(std::size_t alternatives);

/// What an effect may touch.
struct Surroundings {
  double sample_time_s = 1.0;
  double start_s = 0.0;  ///< clock of the data at row 0
  int model_inputs = 0;  ///< the aux signals are numbered after these
};

/// Edits `model` (aux signals are inputs after the model's own).
void apply(const Effect& effect, const Surroundings& surroundings, ModelSpec& model);

/// Whether the effect's own form knows its onset; all others are mixed from with and without it.
[[nodiscard]] bool knows_onset(const Effect& effect);

/// Whether it changes what this CV does in `model`.
[[nodiscard]] bool touches(const Effect& effect, const ModelSpec& model, int cv);

}  // namespace mpm
