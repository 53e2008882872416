#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/mismatch/regression_history.hpp"
#include "core/model/linear_model.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// How a plant's answer may depend on where it is operated: the products and cubes
///
///     g_a(k) g_b(k), a <= b,  and  g_a(k)^3,   g_i = G_ji (u_i - centre_i),
///
/// of what the model's channels give one CV j, at this sample and the one before (the residual's
/// own dynamics act on them, too). With e = sum c_ab g_a g_b + sum d_a g_a^3 the local gain of
/// channel i is
///
///     1 + sum_k c_ik (1 + [i = k]) g_k + 3 d_i g_i^2    times the model's,
///
/// a Volterra series (Schetzen 1980) whose kernels are those of the model's channels. Taken are the
/// inputs that moved the CV most, without those that integrate. The centre is the model's operating
/// point where the input has been on both sides of it, else the middle of where it has been: there
/// alone is a gain error what a linear model is blamed for.
///
/// Allocates only when it is made, from what is remembered.
class VolterraTerms {
 public:
  /// Of the last `span` samples (> 0) of the history.
  VolterraTerms(const LinearModel& model, int cv, const RegressionHistory& history, int span);

  /// Of these inputs (of the model, as `inputs()` had them), to be read from an archive.
  VolterraTerms(const LinearModel& model, int cv, std::vector<int> inputs, int depth);
  void archive(Archive& a);
  /// Whether `inputs` may be any CV's.
  [[nodiscard]] static bool possible(const std::vector<int>& inputs, const LinearModel& model);

  /// Most columns that any CV has.
  [[nodiscard]] static int most_columns();
  /// 0 where no channel of the CV moved it.
  [[nodiscard]] int columns() const;
  /// Those taken, of the model, by how much they moved the CV.
  [[nodiscard]] const std::vector<int>& inputs() const { return inputs_; }
  /// Whether a column has channel `a` (0 <= a < inputs().size()) in it.
  [[nodiscard]] bool has(int column, int a) const;
  /// The columns of g_a g_b (a <= b) and of g_a^3: this sample's and the one before's.
  [[nodiscard]] std::array<int, 2> product_columns(int a, int b) const;
  [[nodiscard]] std::array<int, 2> cube_columns(int a) const;

  /// After the history took a sample.
  void push(const RegressionHistory& history);
  /// Of the row whose response is `age` samples old: columns() values.
  void fill(int age, double* row) const;
  /// g_a, `age` samples ago, CV units.
  [[nodiscard]] double contribution(int a, int age) const {
    return windows_[static_cast<std::size_t>(a)].window()[age];
  }

 private:
  [[nodiscard]] int terms() const;  // of one sample
  void take(std::size_t channel, double input);

  std::vector<int> inputs_;
  std::vector<double> centres_;        // input units
  std::vector<LinearModel> channels_;  // in deviations from the centre
  std::vector<LagWindow> windows_;     // of their outputs
};

}  // namespace mpm
