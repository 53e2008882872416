#include "daemon/files/read_recording.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "config/load_unit.hpp"

namespace mpm::files::read_recording_test {
namespace {

constexpr std::int64_t kRows = 200;

config::UnitConfig toy() {
  config::LoadResult loaded = config::load_unit_text(
      "unit: toy\nsample_time: 1\nsignals: {mv: [u], dv: [d], cv: [y]}\n"
      "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [5]},\n"
      "                   {cv: y, mv: d, gain: 1, time_constants: [5]}]}\n",
      "toy.yaml");
  REQUIRE(loaded.ok());
  return std::move(loaded.config);
}

/// u, d and y wave; a value of y is wild, and d is missing in the last rows.
class Waves : public FrameSource {
 public:
  Waves(const SignalCounts& counts, std::int64_t with_d) : counts_(counts), with_d_(with_d) {}
  bool next(Frame& frame) override {
    if (k_ == kRows) return false;
    frame = Frame(counts_);
    frame.interval = k_;
    frame.source_time_ns = k_ * 1'000'000'000;
    const auto set = [&](SignalKind kind, double value) {
      frame[kind].values(0) = value;
      frame[kind].quality[0] = Quality::kGood;
    };
    set(SignalKind::kMv, std::sin(0.1 * static_cast<double>(k_)));
    set(SignalKind::kDv, k_ < with_d_ ? std::sin(0.3 * static_cast<double>(k_))
                                      : std::numeric_limits<double>::quiet_NaN());
    set(SignalKind::kCv, k_ == 150 ? 500.0 : std::cos(0.1 * static_cast<double>(k_)));
    ++k_;
    return true;
  }
  [[nodiscard]] const std::vector<std::string>& notices() const override { return notices_; }

 private:
  SignalCounts counts_;
  std::int64_t with_d_;
  std::int64_t k_ = 0;
  std::vector<std::string> notices_;
};

RecordingFile read(std::int64_t with_d) {
  const config::UnitConfig unit = toy();
  Waves waves(unit.counts(), with_d);
  return read_recording(waves, unit, "waves.csv");
}

}  // namespace

TEST_CASE("what no process gives is left out of a recording, and told") {
  const RecordingFile file = read(kRows);
  CHECK(file.recording.samples() == kRows);
  CHECK(std::isnan(file.recording.cvs(150, 0)));
  CHECK(file.recording.cvs.array().isFinite().count() == kRows - 1);
  CHECK(file.jumps.cvs == std::vector<Eigen::Index>{1});
  CHECK(file.jumps.total() == 1);
  CHECK(file.bad_values == 0);
}

TEST_CASE("a model is not diagnosed without the values of one of its inputs") {
  const config::UnitConfig unit = toy();
  CHECK(recording_problem(read(kRows).recording, unit, 100).empty());
  CHECK(recording_problem(read(kRows / 2).recording, unit, 100).empty());
  CHECK(recording_problem(read(kRows / 4).recording, unit, 100) ==
        "d has no usable value in 75 % of the samples: without it the model cannot be simulated");
  config::UnitConfig without = unit;
  without.model.channels.pop_back();
  CHECK(recording_problem(read(kRows / 4).recording, without, 100).empty());
  CHECK(recording_problem(read(kRows).recording, unit, 201).find("too short") == 0);
}

}  // namespace mpm::files::read_recording_test
