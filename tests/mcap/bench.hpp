#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
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
                             bag::ConvertOptions options = {}) {
    return bag::convert(folder.file(from), folder.file(to), options);
  }
  bag::ConvertOptions with_unit() const {
    bag::ConvertOptions options;
    options.unit = unit;
    return options;
  }
  std::string text(const std::string& name) const { return read_file(folder.file(name)); }
  std::string error(const std::string& from, const std::string& to, bag::ConvertOptions options) {
    try {
      static_cast<void>(convert(from, to, std::move(options)));
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

}  // namespace mpm::test
