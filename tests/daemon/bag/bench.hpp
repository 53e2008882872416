#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "config/finding.hpp"
#include "config/load_unit.hpp"
#include "daemon/bag/convert.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

inline const std::string kSmall =
    "unit: small\nsample_time: 60\n"
    "signals: {mv: u, dv: 'd,1', cv: [{tag: y, prediction: yhat, setpoint: sp}, z], aux: "
    "['#amb']}\n"
    "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [480]}]}\n";

/// A folder with the file of a small unit, and what converts in it.
struct Bench {
  TemporaryFolder folder;
  config::UnitConfig unit;

  Bench() {
    write_file(folder.file("small.yaml"), kSmall);
    unit = config::load_unit(folder.file("small.yaml")).config;
  }
  bag::ConvertReport convert(const std::string& from, const std::string& to,
                             const bag::ConvertOptions& options = {}) {
    return bag::convert(folder.file(from), folder.file(to), options);
  }
  bag::ConvertOptions with_unit() const {
    bag::ConvertOptions options;
    options.unit = unit;
    return options;
  }
  std::string text(const std::string& name) const { return read_file(folder.file(name)); }
  std::string error(const std::string& from, const std::string& to,
                    const bag::ConvertOptions& options) {
    try {
      static_cast<void>(convert(from, to, options));
    } catch (const config::InputError& error) {
      CHECK_FALSE(std::filesystem::exists(folder.file(to)));
      return error.what();
    }
    return {};
  }
};

inline std::vector<files::Column> all_columns() {
  return {{"u", SignalKind::kMv, 0},
          {"d,1", SignalKind::kDv, 0},
          {"y", SignalKind::kCv, 0},
          {"z", SignalKind::kCv, 1},
          {"yhat", SignalKind::kPrediction, 0},
          {"sp", SignalKind::kSetpoint, 0},
          {"#amb", SignalKind::kAux, 0}};
}

/// Any bits that are a finite double.
inline double any_double(std::mt19937_64& random) {
  double value = std::numeric_limits<double>::quiet_NaN();
  while (!std::isfinite(value)) {
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
  }
  return value;
}

/// Every kind of value and quality; times to the nanosecond.
inline std::vector<Frame> any_frames(const config::UnitConfig& unit, int count) {
  std::mt19937_64 random(11);
  std::vector<Frame> frames;
  for (int k = 0; k < count; ++k) {
    Frame frame(unit.counts());
    frame.interval = k + (k > count / 2 ? 5 : 0);  // a gap
    frame.source_time_ns = 1'714'564'800'000'000'000 + frame.interval * 60'000'000'000 +
                           static_cast<std::int64_t>(random() % 1'000'000'000);
    for (SignalBlock& block : frame.blocks) {
      for (int i = 0; i < block.size(); ++i) {
        const std::uint64_t pick = random() % 10;
        const bool missing = pick == 0;
        block.values(i) = missing ? std::numeric_limits<double>::quiet_NaN() : any_double(random);
        block.quality[static_cast<std::size_t>(i)] =
            missing || pick == 1 ? Quality::kBad
                                 : (pick == 2 ? Quality::kUncertain : Quality::kGood);
      }
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace mpm::test
