#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/identify/fit/quantity.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// One number of an effect: what it is before anything is known, and how to move it.
struct Coordinate {
  const Quantity* quantity = nullptr;  ///< outlives it; its form says what `value` is
  double value = 0.0;
  double prior_mean = 0.0;  ///< value that means "no effect", or the middle of what is likely
  double prior_sd = 1.0;    ///< Gaussian
  double step = 1e-3;       ///< of a finite difference
  double low = -1e30, high = 1e30;
  int number = 0;  ///< from 1 where an effect has several of its quantity
};

/// Where an effect acts; -1 where a kind of signal plays no part.
struct Place {
  int cv = -1;     ///< -1: all CVs that the input acts on
  int input = -1;  ///< MV or DV
  int aux = -1;    ///< a measured signal that the model leaves out

  [[nodiscard]] bool operator==(const Place&) const = default;
};

class Edit;

/// An edit of the model with a few numbers. The same list of effects says what a fit tries, what
/// the findings are and what the extended model holds.
struct Effect {
  const Edit* edit = nullptr;  ///< outlives it
  Place place = {};
  std::vector<Coordinate> coordinates;
  /// Acts from this row on (0 = throughout): before it the CV is what it would be without.
  Eigen::Index onset = 0;
  /// 2 ln of how many equal alternatives (rows to begin at, shapes, ...) it was picked from.
  double search_cost = 0.0;
  /// Which of the forms that its edit knows; 0 is the usual one.
  int variant = 0;
  /// Seen in the data themselves, whatever the model: not weighed against others.
  bool certain = false;
  int other_input = -1;  ///< that it depends on too; -1: on none
  /// Of what edits no model, samples x coordinates: what the CV does per unit of each.
  std::shared_ptr<const Eigen::MatrixXd> shape = {};

  [[nodiscard]] const Coordinate* find(const Quantity& quantity, int number = 0) const;
  [[nodiscard]] double value(const Quantity& quantity, double otherwise, int number = 0) const;
};

/// What an effect may touch.
struct Surroundings {
  double sample_time_s = 1.0;
  double start_s = 0.0;  ///< clock of the data at row 0
  int model_inputs = 0;  ///< the aux signals are numbered after these
};

/// What an effect's numbers do to a model. The causes are such edits; a fit needs to know no more
/// of them.
class Edit {
 public:
  Edit() = default;
  Edit(const Edit&) = delete;
  Edit& operator=(const Edit&) = delete;
  virtual ~Edit() = default;

  /// Edits `model` (aux signals are inputs after the model's own).
  virtual void apply(const Effect& effect, const Surroundings& surroundings,
                     ModelSpec& model) const = 0;
  /// Whether the edited model knows the effect's onset; all others are mixed from with and without.
  [[nodiscard]] virtual bool knows_onset() const { return false; }
  /// Whether the CV jumps at the onset, as it does at a shock of the noise.
  [[nodiscard]] virtual bool jumps() const { return false; }
};

void apply(const Effect& effect, const Surroundings& surroundings, ModelSpec& model);

/// Whether it changes what this CV does in `model`.
[[nodiscard]] bool touches(const Effect& effect, const ModelSpec& model, int cv);

}  // namespace mpm
