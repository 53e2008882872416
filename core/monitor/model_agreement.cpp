#include "core/monitor/model_agreement.hpp"

#include <algorithm>

#include "core/archive/archive.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {

namespace model_agreement = calibration::model_agreement;

void ModelAgreement::take(double predicted, double simulated) {
  const double difference = predicted - simulated;
  if (block_.samples == 0) {
    block_.difference = difference;
    block_.simulated = simulated;
  }
  const double d = difference - block_.difference, s = simulated - block_.simulated;
  block_.sum_difference += d;
  block_.sum_simulated += s;
  block_.square_difference += d * d;
  block_.square_simulated += s * s;
  if (++block_.samples == model_agreement::kBlock) end_block();
}

// A quiet block is held to what the simulation usually moves by.
void ModelAgreement::end_block() {
  const auto variance = [](double sum, double square) {
    const double mean = sum / model_agreement::kBlock;
    return std::max(0.0, square / model_agreement::kBlock - mean * mean);
  };
  const double moved = variance(block_.sum_simulated, block_.square_simulated);
  const double differed = variance(block_.sum_difference, block_.square_difference);
  blocks_ += 1.0;
  moves_ += (moved - moves_) / blocks_;
  const double limit = differs_ ? model_agreement::kSame : model_agreement::kOther;
  const bool other = differed > limit * limit * std::max(moved, moves_);
  against_ = other == differs_ ? 0 : against_ + 1;
  if (against_ == model_agreement::kBlocks) {
    differs_ = !differs_;
    against_ = 0;
  }
  block_ = {};
}

void ModelAgreement::Block::archive(Archive& a) {
  a.within(samples, 0, model_agreement::kBlock - 1);
  a(difference, simulated, sum_difference, sum_simulated, square_difference, square_simulated);
}

void ModelAgreement::archive(Archive& a) {
  a(block_, blocks_, moves_, differs_);
  a.within(against_, 0, model_agreement::kBlocks - 1);
}

}  // namespace mpm
