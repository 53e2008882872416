#pragma once

namespace mpm {

class Archive;

/// Whether the predictions that come for one CV are those of another model than the one at hand:
/// whether they differ from what it makes of the same inputs by a fair part of what that moves by.
/// Levels do not count. Blocks of samples are asked, and three in a row have to say the same. No
/// allocation.
class ModelAgreement {
 public:
  /// A sample, CV units, finite.
  void take(double predicted, double simulated);
  /// The simulation cannot be trusted here: the block begins anew.
  void skip() { block_ = {}; }

  [[nodiscard]] bool differs() const { return differs_; }

  void archive(Archive& a);

 private:
  /// Sums over a block, about its first sample.
  struct Block {
    int samples = 0;
    double difference = 0.0, simulated = 0.0;  ///< of the first sample
    double sum_difference = 0.0, sum_simulated = 0.0;
    double square_difference = 0.0, square_simulated = 0.0;
    void archive(Archive& a);
  };
  void end_block();

  Block block_;
  double blocks_ = 0.0;  // so far
  double moves_ = 0.0;   // variance of the simulated one, mean over these
  int against_ = 0;      // blocks in a row that say otherwise
  bool differs_ = false;
};

}  // namespace mpm
