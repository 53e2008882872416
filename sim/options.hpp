#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mpm::sim {

// Exit codes of all programs of the project.
inline constexpr int kDone = 0, kFailed = 2, kBadInput = 3;

/// The command line of mpmsim.
struct Options {
  std::string config;
  std::string scenario = "none";
  std::vector<std::string> bad_data;  ///< each KIND=SHARE, as entries of a scenario
  std::string controller_model;       ///< unit file; empty = the plant's own model
  std::optional<std::int64_t> samples;
  std::uint64_t seed = 1;
  std::string csv;                       ///< empty = publish on DDS
  std::string truth;                     ///< empty = not written
  std::optional<double> limits_percent;  ///< print materiality limits instead of running
  std::string start_time;
  double speed = 1.0;
  std::optional<double> wait_readers_s;  ///< as the options say where it is left out
  int readers = 1;
  std::optional<int> domain;
  std::optional<std::string> partition;
  std::optional<std::string> security;
};

void declare(CLI::App& app, Options& options);

}  // namespace mpm::sim
