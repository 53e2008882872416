#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identification/channel_hint.hpp"
#include "core/identification/channel_shape.hpp"
#include "core/identification/high_order.hpp"

namespace mpm {

/// First-order channels of one CV, near enough for Gauss-Newton to end at the right minimum: the
/// regression of high order is asked which lags and dead times on a grid explain most of it. What
/// the CV's own past explains stays as the regression says.
class StartSearch {
 public:
  /// `hints`: one per input, of this CV. The model and the hints must outlive the search.
  StartSearch(const HighOrderModel& model, const std::vector<ChannelHint>& hints,
              double sample_time_s);

  /// The best sets of channels, best first (BIC of the regression): sets grow by one input at a
  /// time, a few of each size are kept, and whenever one grew all its numbers are fitted anew.
  /// Where inputs move alike, the right ones may show only together.
  [[nodiscard]] std::vector<std::vector<ChannelShape>> best_sets() const;
  /// With the input more that explains most, all numbers fitted anew; nothing where none is worth
  /// it.
  [[nodiscard]] std::optional<std::vector<ChannelShape>> enlarged(
      const std::vector<ChannelShape>& channels) const;
  /// Channels, and how far they are from the regression: -2 ln likelihood, but for a constant.
  struct Start {
    std::vector<ChannelShape> channels;
    double cost = 0.0;
  };
  /// The channels, all numbers fitted anew; and with one of `input` that is about as fast as they
  /// are: not what explains most of the rest, but what may take the place of some of them.
  [[nodiscard]] Start beside(const std::vector<ChannelShape>& channels, int input) const;
  [[nodiscard]] Start alone(const std::vector<ChannelShape>& channels) const;
  /// The same inputs with two lags that all of them share, and a lead each: what levels, or
  /// temperatures, that act on one another have in common. Given the lags and dead times it is
  /// linear, so the best of a grid is the best there is, however far first-order channels are from
  /// it. Nothing where none fits, or a sign that the user gave.
  [[nodiscard]] std::optional<std::vector<ChannelShape>> with_shared_lags(
      const std::vector<ChannelShape>& channels) const;

 private:
  /// First-order channels of gain 1 of two speeds, by their places in `Choices`: the same dead
  /// time.
  struct Pair {
    Eigen::Index slow = 0, fast = 0;
  };
  struct Shared {
    std::vector<Pair> pairs;  ///< one per channel
    Eigen::VectorXd parts;    ///< gains: slow and fast of each channel
    double left = 0.0;        ///< squared error
  };
  [[nodiscard]] Shared solved(const std::vector<ChannelShape>& channels,
                              std::vector<Pair> pairs) const;

  struct Choices {
    std::vector<ChannelShape> shapes;  ///< of gain 1
    Eigen::MatrixXd columns;           ///< of the factor, one per shape
    Eigen::Index dead_times = 1;       ///< so many shapes in a row have one time constant
  };
  struct Found {
    Eigen::Index which = 0;
    double gain = 0.0;
    double explained = -1.0;  ///< fall of the squared error; < 0: none fits
  };
  struct Set {
    std::vector<ChannelShape> channels;
    double left = 0.0;  ///< squared error
  };

  [[nodiscard]] Found best(std::size_t input, const Eigen::MatrixXd& others) const;
  [[nodiscard]] ChannelShape best_shape(std::size_t input, const Found& found) const;
  /// What a channel of gain 1 gives.
  [[nodiscard]] Eigen::VectorXd column(const ChannelShape& shape) const;
  [[nodiscard]] Eigen::MatrixXd columns(const std::vector<ChannelShape>& channels) const;
  [[nodiscard]] Set fitted(std::vector<ChannelShape> channels) const;
  /// The same from gains that are best for the times given.
  [[nodiscard]] Set fitted_from_gains(std::vector<ChannelShape> channels) const;
  [[nodiscard]] double bic(const Set& set) const;
  [[nodiscard]] bool better(const Set& a, const Set& b) const { return bic(a) < bic(b); }
  [[nodiscard]] Set full(double time_constant, double dead_time) const;
  [[nodiscard]] std::vector<bool> inputs_of(const Set& set) const;
  void grow(std::vector<Set>& sets) const;
  void shrink(std::vector<Set>& sets) const;

  const HighOrderModel& model_;
  const std::vector<ChannelHint>& hints_;
  std::vector<Choices> choices_;  ///< one per input; none where there is no relation
  Eigen::VectorXd right_;
};

/// How much (relative to 0) the gain of an input would have to be to show at all, all other inputs
/// free: s.d. of the gain of a first-order channel of the given speed (samples). Infinite where the
/// others' past, or the CV's own, explains the input.
[[nodiscard]] double gain_sd(const HighOrderModel& model, int input, double time_constant);

}  // namespace mpm
