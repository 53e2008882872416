#include "core/monitor/cv_quality.hpp"

#include <catch2/catch.hpp>

namespace mpm {
namespace {

TEST_CASE("a CV whose samples are mostly unknown has bad data, and recovers") {
  CvQuality quality;
  std::int64_t k = 0;
  // 1 - (1 - 1/300)^n > 0.5 from n = 208 on.
  for (; k < 207; ++k) quality.take({.known = false}, k + 1);
  CHECK_FALSE(quality.mostly_unknown());
  quality.take({.known = false}, ++k);
  CHECK(quality.mostly_unknown());
  CHECK(quality.without_row() == 208);
  quality.take({.known = true, .took_row = true}, ++k);
  CHECK(quality.without_row() == 0);
  for (int n = 0; n < 300; ++n) quality.take({.known = true}, ++k);
  CHECK_FALSE(quality.mostly_unknown());
}

TEST_CASE("a tenth of implausible values is too much, and so are three spikes in a thousand") {
  CvQuality falsified, spiky, fine;
  std::uint64_t spikes = 0;
  for (std::int64_t k = 1; k <= 5000; ++k) {
    falsified.take({.known = true, .implausible = k % 5 == 0}, k);
    spikes += k % 200 == 0 ? 1 : 0;
    spiky.take({.known = true, .spikes = spikes}, k);
    fine.take({.known = true, .implausible = k % 20 == 0, .spikes = k >= 2500 ? 1U : 0U}, k);
  }
  CHECK(falsified.implausible());
  CHECK(spiky.implausible());
  CHECK_FALSE(fine.implausible());
}

}  // namespace
}  // namespace mpm
