#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/load_unit.hpp"
#include "daemon/files/csv/csv_reader.hpp"

/// Texts through the reader of data files, for a small unit.
namespace mpm::files::test {

inline config::UnitConfig unit(double sample_time_s = 1.0, bool with_model = true) {
  const std::string model = with_model ? "model: {channels: [{cv: y1, mv: u1, gain: 1}]}\n" : "";
  const auto result = config::load_unit_text(
      "unit: t\nsample_time: " + std::to_string(sample_time_s) +
          "\nsignals: {mv: [u1, u2], cv: [{tag: y1, prediction: p1, setpoint: s1}], aux: amb}\n" +
          model,
      "u.yaml");
  REQUIRE(result.ok());
  return result.config;
}

inline CsvReader reader(const std::string& text, const config::UnitConfig& config = unit()) {
  return CsvReader(std::make_unique<std::istringstream>(text), "d.csv", config);
}

inline std::vector<Frame> frames_of(CsvReader&& csv) {
  std::vector<Frame> frames;
  Frame frame;
  while (csv.next(frame)) frames.push_back(frame);
  return frames;
}

inline std::vector<Frame> frames_of(const std::string& text,
                                    const config::UnitConfig& config = unit()) {
  return frames_of(reader(text, config));
}

inline std::string error_of(const std::string& text, const config::UnitConfig& config = unit()) {
  try {
    (void)frames_of(text, config);
  } catch (const config::InputError& error) {
    return error.what();
  }
  return "no error";
}

inline double mv(const Frame& frame, int index) { return frame[SignalKind::kMv].values(index); }

inline bool says(const CsvReader& csv, const std::string& part) {
  return std::any_of(csv.notices().begin(), csv.notices().end(), [&](const std::string& notice) {
    return notice.find(part) != std::string::npos;
  });
}

}  // namespace mpm::files::test
