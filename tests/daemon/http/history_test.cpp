#include "daemon/http/history.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::http {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::array kFirst{0};

void push(History& history, std::int64_t second, float value) {
  const std::array row{value};
  history.push(second * kSecond, row);
}

float least(const Drawing& drawing) {
  float low = std::numeric_limits<float>::infinity();
  for (const Reach& reach : drawing.reaches[0])
    if (!std::isnan(reach.low)) low = std::min(low, reach.low);
  return low;
}

float greatest(const Drawing& drawing) {
  float high = -std::numeric_limits<float>::infinity();
  for (const Reach& reach : drawing.reaches[0])
    if (!std::isnan(reach.high)) high = std::max(high, reach.high);
  return high;
}

TEST_CASE("few samples are drawn as they came") {
  History history(1, 1.0);
  for (int k = 0; k < 100; ++k) push(history, k, static_cast<float>(k));
  const Drawing drawing = history.draw(10 * kSecond, 19 * kSecond, 600, kFirst);
  REQUIRE(drawing.times_s.size() == 10);
  CHECK(drawing.times_s.front() == Approx(10.0));
  CHECK(drawing.reaches[0].back().mean == 19.0F);
  CHECK(drawing.reaches[0].back().low == 19.0F);
}

TEST_CASE("a ramp keeps its ends and its mean however coarsely it is drawn") {
  // Of 0 ... n-1 the least is 0, the greatest n-1, the mean (n-1)/2.
  const int samples = GENERATE(1000, 10'000, 100'000);
  History history(1, 1.0);
  for (int k = 0; k < samples; ++k) push(history, k, static_cast<float>(k));
  const Drawing drawing = history.draw(0, samples * kSecond, 50, kFirst);
  CHECK(drawing.times_s.size() <= 51);
  CHECK(drawing.times_s.size() >= 40);
  CHECK(least(drawing) == 0.0F);
  CHECK(greatest(drawing) == static_cast<float>(samples - 1));
  double sum = 0.0;
  for (const Reach& reach : drawing.reaches[0]) sum += static_cast<double>(reach.mean);
  CHECK(sum / static_cast<double>(drawing.times_s.size()) ==
        Approx(0.5 * (samples - 1)).epsilon(0.02));
  CHECK(std::is_sorted(drawing.times_s.begin(), drawing.times_s.end()));
}

TEST_CASE("a single spike of months ago is still there") {
  History history(1, 1.0);
  const int samples = 3'000'000;  // a month of seconds
  for (int k = 0; k < samples; ++k) push(history, k, k == 1'234'567 ? 50.0F : 1.0F);
  const Drawing all = history.draw(0, samples * kSecond, 300, kFirst);
  CHECK(greatest(all) == 50.0F);
  CHECK(least(all) == 1.0F);
  CHECK(all.times_s.front() < 20'000.0);
  const Drawing last = history.draw((samples - 100) * kSecond, samples * kSecond, 300, kFirst);
  CHECK(last.times_s.size() == 100);
  CHECK(last.step_s == Approx(1.0));
}

TEST_CASE("memory is bounded") {
  History history(3, 1.0);
  const std::array row{1.0F, 2.0F, 3.0F};
  for (int k = 0; k < 400'000; ++k) history.push(k * 100 * kSecond, row);
  CHECK(history.bytes() <= History::most_bytes(3));
  CHECK(History::most_bytes(3) < 2'000'000);
}

TEST_CASE("where nothing came the line is broken, and what is not known counts nowhere") {
  History history(1, 1.0);
  for (int k = 0; k < 20; ++k) push(history, k, 1.0F);
  push(history, 20, std::numeric_limits<float>::quiet_NaN());
  for (int k = 100; k < 120; ++k) push(history, k, 3.0F);
  const Drawing drawing = history.draw(0, 200 * kSecond, 1000, kFirst);
  const auto gaps = std::count_if(drawing.reaches[0].begin(), drawing.reaches[0].end(),
                                  [](const Reach& reach) { return std::isnan(reach.mean); });
  CHECK(gaps == 2);
  CHECK(least(drawing) == 1.0F);
  CHECK(greatest(drawing) == 3.0F);
}

TEST_CASE("a clock that goes back takes what lay beyond with it") {
  History history(1, 1.0);
  for (int k = 0; k < 10'000; ++k) push(history, k, 1.0F);
  for (int k = 5000; k < 5010; ++k) push(history, k, 2.0F);
  CHECK(history.last_ns() == 5009 * kSecond);
  const Drawing drawing = history.draw(0, 20'000 * kSecond, 2000, kFirst);
  CHECK(std::is_sorted(drawing.times_s.begin(), drawing.times_s.end()));
  CHECK(drawing.times_s.back() < 5010.0);
  CHECK(greatest(drawing) == 2.0F);
}

TEST_CASE("the last rows may be amended before they are put into buckets") {
  History history(1, 1.0, 16);
  for (int k = 0; k < 5000; ++k) {
    push(history, k, 0.0F);
    history.amend(3, 0, 7.0F);
    history.amend(16, 0, 99.0F);  // too late
  }
  CHECK(history.value(3, 0) == 7.0F);
  CHECK(history.value(2, 0) == 0.0F);
  const Drawing drawing = history.draw(0, 4000 * kSecond, 100, kFirst);
  CHECK(greatest(drawing) == 7.0F);
  CHECK(drawing.reaches[0][10].low == 7.0F);
}

TEST_CASE("nothing is drawn of nothing") {
  const History history(1, 1.0);
  CHECK(history.draw(0, kSecond, 10, kFirst).times_s.empty());
  CHECK(std::isnan(history.value(0, 0)));
}

TEST_CASE("a unit however slow has buckets of whole nanoseconds") {
  for (const double step_s : {1e6, 1e9, 1e300}) {
    History history(1, step_s);
    for (int k = 0; k < 20; ++k) push(history, k * 1'000'000, static_cast<float>(k));
    CHECK(history.draw(0, history.last_ns(), 600, kFirst).times_s.size() == 20);
  }
}

}  // namespace
}  // namespace mpm::http
