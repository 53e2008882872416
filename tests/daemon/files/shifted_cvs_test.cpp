#include "daemon/files/shifted_cvs.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace mpm::files::shifted_cvs_test {
namespace {

const SignalCounts kCounts{1, 0, 1, 0};

/// The intervals 0 1 2 4: each row's number in its MV, ten times as much in its CV.
class Rows : public FrameSource {
 public:
  bool next(Frame& frame) override {
    if (row_ == kIntervals.size()) return false;
    frame.interval = kIntervals[row_];
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    frame[SignalKind::kMv].values(0) = static_cast<double>(row_);
    frame[SignalKind::kCv].values(0) = 10.0 * static_cast<double>(row_);
    ++row_;
    return true;
  }
  const std::vector<std::string>& notices() const override { return notices_; }

 private:
  const std::vector<std::int64_t> kIntervals{0, 1, 2, 4};
  std::size_t row_ = 0;
  std::vector<std::string> notices_;
};

/// Intervals, MVs and CVs, -1 where a CV is bad.
std::vector<std::vector<double>> all(ShiftedCvs::Way way) {
  Rows rows;
  ShiftedCvs shifted(rows, kCounts, way);
  std::vector<std::vector<double>> result;
  Frame frame(kCounts);
  while (shifted.next(frame))
    result.push_back({static_cast<double>(frame.interval), frame[SignalKind::kMv].values(0),
                      frame[SignalKind::kCv].usable(0) ? frame[SignalKind::kCv].values(0) : -1.0});
  return result;
}

TEST_CASE("CVs are those of the row after or before, bad where that is missing") {
  using Table = std::vector<std::vector<double>>;
  CHECK(all(ShiftedCvs::Way::kEarlier) == Table{{0, 0, 10}, {1, 1, 20}, {2, 2, -1}});
  CHECK(all(ShiftedCvs::Way::kLater) == Table{{1, 1, 0}, {2, 2, 10}, {4, 3, -1}});
}

}  // namespace
}  // namespace mpm::files::shifted_cvs_test
