#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace mpm {

class Archive;

/// Spearman's rank coefficient (1904) of several signals over the last `length` samples, and rank
/// partial correlations: those of the ranks (Kendall 1942). Ties share their mean rank.
///
/// Exact: all ranks are kept, doubled, as whole numbers. A new sample moves the ranks of those
/// above it by one: one pass over the window, which the compiler makes vector code of.
///
/// No allocation after construction.
class RankWindow {
 public:
  /// `signals` >= 2, `length` >= 3 samples.
  RankWindow(int signals, int length);

  /// Takes one sample: signals() finite values. The oldest one goes where the window is full.
  void push(const Eigen::Ref<const Eigen::VectorXd>& values);

  [[nodiscard]] int signals() const { return signals_; }
  [[nodiscard]] int count() const { return count_; }  ///< samples in the window
  /// Mean rank (1..count) of a signal's value `age` samples ago, 0 <= age < count().
  [[nodiscard]] double rank(int signal, int age) const;
  /// -1..1; 0 where either signal has one value only.
  [[nodiscard]] double coefficient(int a, int b) const;
  /// Of two signals, the ranks of the `held` ones (all different, none of the two) held: -1..1, 0
  /// where they leave nothing. By Cholesky's factor of the coefficients.
  [[nodiscard]] double partial_coefficient(int a, int b, std::span<const int> held);
  /// Two-sided p-value of one of these were it 0, `held` signals being held and samples independent
  /// of each other: t with count - held - 2 degrees of freedom (Kendall and Gibbons 1990, section
  /// 8.11). 1 where there are none.
  [[nodiscard]] double p_value(double partial_coefficient, int held) const;

  void archive(Archive& a);

 private:
  [[nodiscard]] std::size_t first(int signal) const {
    return static_cast<std::size_t>(signal) * length_;
  }
  void replace(int signal, std::size_t slot, double value);

  int signals_;
  std::size_t length_;
  int count_ = 0;
  std::size_t next_ = 0;  // slot
  std::vector<double> values_;
  std::vector<std::int32_t> doubled_;  // 2 rank, per slot
  Eigen::MatrixXd factor_;
  std::vector<int> order_;
};

}  // namespace mpm
