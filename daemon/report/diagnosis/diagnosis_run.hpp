#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/record/performance_record.hpp"
#include "daemon/files/times/time_zone.hpp"
#include "daemon/report/diagnosis/other_row.hpp"

/// All that the reports of `mpm diagnose` are made from.
namespace mpm::report {

/// How well the MPC controls with the unit file's model and with the extended one, on the same
/// simulated plant, over all seeds together.
struct ClosedLoop {
  struct Cv {
    int cv = 0;
    double variance_before = 0.0, variance_after = 0.0;  ///< of set-point minus CV, CV units^2
  };
  struct Mv {
    int mv = 0;
    double at_limit_before = 0.0, at_limit_after = 0.0;  ///< share of the samples, 0..1
  };
  std::string scenario;
  std::vector<std::uint64_t> seeds;
  int samples = 0;  ///< of each run
  /// Tags that the extended model takes and that the simulated controller does without.
  std::vector<std::string> inputs_left_out;
  std::vector<Cv> cvs;
  std::vector<Mv> mvs;
};

struct DiagnosisRun {
  /// As its file says it; the model at the recording's sample time.
  config::UnitConfig unit;
  Recording recording;
  std::optional<Recording> validation;
  Diagnosis diagnosis;
  std::optional<ClosedLoop> closed_loop;
  /// Over the whole recording; none where only its values are left.
  std::optional<PerformanceRecord> performance = {};

  std::string program;  ///< with its version
  std::string command_line;
  std::string config_file, data_file, validation_file;
  /// Of each run of the recording and of the validation; may be empty where that is one run.
  std::vector<std::string> run_files, validation_run_files;
  bool time_chosen = false;  ///< not all of the data file was wanted
  double fit_share = 0.0;
  std::uint64_t seed = 0;
  std::vector<std::string> notices;                  ///< on the data
  std::shared_ptr<const files::TimeZone> zone = {};  ///< of the data's times; null = UTC
  OtherRow other_row = OtherRow::kNone;              ///< of each data file
  Condensing condensing = {};                        ///< of the data files' recording
};

}  // namespace mpm::report
