#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/mismatch/regression_history.hpp"
#include "core/model/linear_model.hpp"
#include "core/model/static_blocks.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"
#include "core/nonlinear/channel_path.hpp"
#include "core/nonlinear/feature_map.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// The columns by which one CV's residual may depend on the inputs as no linear error makes it: of
/// each input i, standardised to x_i (and no farther out than four s.d.), with g_i = G_i x_i what
/// the model's channel makes of it,
///
///     G_i f(x_i)            functions of the input before the dynamics (Hammerstein),
///     G_i (x_i - play(x_i)) where it came from counts, as with backlash and stiction,
///     f(g_i)                functions behind the dynamics (Wiener),
///     G_i (h_i)^2           what depends on where the channel stands, fed back into it (Lur'e),
///     f(g_a, g_b)           products of the inputs that move the CV most,
///     f(sum_i g_i)          functions of all that the model gives,
///
/// each at this sample and the one before, for the residual's own dynamics act on them, too. f are
/// monomials of degree 2 and 3, or the square and features of a kernel. h_i is where the channel
/// stands as far as the residual e tells, g_i + e, standardised: a strong nonlinearity takes it far
/// from where the model has it. Linear columns are not among them: they belong to the regression
/// that takes these in.
///
/// The columns come in groups: those of one kind and the same inputs.
///
/// Allocates in the constructor and in `begin` only.
class NonlinearTerms {
 public:
  /// `pole` in (0, 1): of the mean that stands for a channel which the model lacks.
  /// `remembered` rows can be filled.
  NonlinearTerms(const LinearModel& model, int cv, double pole, NonlinearTest test, int remembered);

  [[nodiscard]] int columns() const;
  /// How many columns a CV of a unit with so many inputs has; 0 where the test is off.
  [[nodiscard]] static int columns_of(NonlinearTest test, int inputs);
  [[nodiscard]] int inputs() const { return static_cast<int>(channels_.size()); }
  [[nodiscard]] int groups() const { return static_cast<int>(groups_.size()); }
  /// Whether a group's columns depend on the input.
  [[nodiscard]] bool has(int group, int input) const;
  [[nodiscard]] NonlinearKind kind(int group) const;
  [[nodiscard]] const std::vector<int>& columns_of_group(int group) const {
    return groups_[static_cast<std::size_t>(group)];
  }
  /// The column of G_i x_i^2 of this sample.
  [[nodiscard]] int square_of(int input) const;
  /// What coefficient of it makes the local gain vary by `variation` (two s.d. of it, relative to
  /// the model's), CV units; 0 where the model has no such channel.
  [[nodiscard]] double coefficient_of(int input, double variation) const;

  /// The functions of the group of an input's curve at x s.d. from its mean, in the order of its
  /// columns: what they give before the channel's dynamics.
  void input_functions(int input, double x, double* functions) const;
  /// The input that far from its mean, in its own units.
  [[nodiscard]] double input_at(int input, double x) const {
    const Channel& channel = channels_[static_cast<std::size_t>(input)];
    return channel.centre + channel.scale * x;
  }

  /// Standardises by the last `span` (> 1) samples of the history and begins at its oldest one.
  /// Then `advance` takes all its samples, from age depth() - 1 to 0, and from then on each new
  /// one.
  void begin(const RegressionHistory& history, int span);
  void advance(const RegressionHistory& history, int age);
  /// Of the row whose response is `age` samples older than the last one taken: columns() values.
  void fill(int age, double* row) const;

  void archive(Archive& a);

 private:
  struct Channel {
    ChannelPath linear;
    // One per output of the input's map, then the play's and that of where the channel stands.
    std::vector<ChannelPath> curved;
    std::unique_ptr<FeatureMap> input_map, channel_map;
    InputElement play;
    bool modelled = false;
    double centre = 0.0, scale = 0.0;                // of the input; scale 0: it stands still
    double output_centre = 0.0, output_scale = 0.0;  // of g
    double state_centre = 0.0, state_scale = 0.0;    // of where it stands, CV units
    void archive(Archive& a);
  };
  struct Pair {
    int a = 0, b = 0;
    std::unique_ptr<FeatureMap> map;
    void archive(Archive& archive);
  };
  struct Term {
    int first = 0, second = 0;  // inputs; all of them where second < first
    NonlinearKind kind = NonlinearKind::kNone;
    [[nodiscard]] bool goes_with(const Term& other) const {
      return first == other.first && second == other.second && kind == other.kind;
    }
    void archive(Archive& a);
  };

  [[nodiscard]] const Term& term_of(int group) const;
  [[nodiscard]] int terms() const { return static_cast<int>(terms_.size()); }
  [[nodiscard]] static double standardised(double value, double centre, double scale);
  [[nodiscard]] double input_of(std::size_t channel, const RegressionHistory& history,
                                int age) const;
  [[nodiscard]] double output_of(const Channel& channel) const;
  [[nodiscard]] double state_of(const Channel& channel, double residual) const;
  [[nodiscard]] double residual_of(const RegressionHistory& history, int age) const;
  void bend(Channel& channel, double x, double residual);
  [[nodiscard]] double sum_of_outputs() const;
  void measure_inputs(const RegressionHistory& history, int span);
  void measure_outputs(const RegressionHistory& history, int span);
  void choose_pairs();
  void rest(const RegressionHistory& history);
  void push_terms();

  int cv_;
  std::vector<Channel> channels_;
  std::vector<Pair> pairs_;
  std::unique_ptr<FeatureMap> sum_map_;
  double sum_centre_ = 0.0, sum_scale_ = 0.0;
  std::vector<Term> terms_;               // of one sample
  std::vector<std::vector<int>> groups_;  // columns
  double residual_ = 0.0;                 // the last known
  std::vector<LagWindow> windows_;        // of each
  std::vector<double> values_;            // of each, of one sample
  std::vector<double> input_points_, output_points_, sum_points_;
};

}  // namespace mpm
