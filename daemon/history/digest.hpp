#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/record/field_key.hpp"

/// What is kept of a unit over months: a digest of each short stretch of time. The journal holds
/// digests, and a trend is made of nothing else and of the alarms, whether they come from a journal
/// or from data files; so both say the same.
namespace mpm::history {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
[[nodiscard]] inline bool known(double value) { return std::isfinite(value); }

/// One CV in a digest. Lists its fields as the records do (core/record/field_key.hpp), for JSON in
/// both directions; what is not shown there is as it is here. Numbers have six significant digits.
struct CvDigest {
  std::string cv;
  std::int64_t samples = 0;        ///< with a residual
  double residual_rms = kUnknown;  ///< measured minus predicted, CV units
  /// Samples whose residual and measurement are known, and were one horizon before.
  std::int64_t pairs = 0;
  /// Of a prediction over the horizon with the usual output-bias update: the residual's move.
  double prediction_rms = kUnknown;
  double movement_rms = kUnknown;  ///< the measurement's move over the horizon

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("cv", record.cv);
    visit("samples", record.samples);
    visit({"residual_rms", known(record.residual_rms)}, record.residual_rms);
    visit("pairs", record.pairs);
    visit({"prediction_rms", known(record.prediction_rms)}, record.prediction_rms);
    visit({"movement_rms", known(record.movement_rms)}, record.movement_rms);
  }
};

/// One channel in a digest.
struct ChannelDigest {
  std::string mv, cv;                                        ///< tags; `mv` may be a DV's
  std::int64_t match = 0, mismatch = 0;                      ///< samples with these verdicts
  std::int64_t excited = 0;                                  ///< samples
  std::string verdict = "undetermined", reason, confounder;  ///< after the last sample
  std::string alarm = "cleared";                             ///< likewise
  /// The error of the gain with its 95 % interval, after the last sample: in % of the model's gain,
  /// where the model has none in CV per input unit. NaN where undetermined or not resolved.
  double gain_error = kUnknown, low = kUnknown, high = kUnknown;
  double smallest_error = kUnknown;     ///< relative, that would have been seen
  double effective_samples = kUnknown;  ///< that these rest on

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("mv", record.mv);
    visit("cv", record.cv);
    visit("match", record.match);
    visit("mismatch", record.mismatch);
    visit("excited", record.excited);
    visit("verdict", record.verdict);
    visit({"reason", !record.reason.empty()}, record.reason);
    visit({"confounder", !record.confounder.empty()}, record.confounder);
    visit("alarm", record.alarm);
    visit({"gain_error", known(record.gain_error)}, record.gain_error);
    visit({"low", known(record.low)}, record.low);
    visit({"high", known(record.high)}, record.high);
    visit({"smallest_error", known(record.smallest_error)}, record.smallest_error);
    visit({"effective_samples", known(record.effective_samples)}, record.effective_samples);
  }
};

/// A unit from one moment of source time to another, both of them samples.
struct Digest {
  std::int64_t from_ns = 0, until_ns = 0;
  std::int64_t samples = 0;
  std::vector<CvDigest> cvs;
  std::vector<ChannelDigest> channels;  ///< inputs outermost, CVs innermost

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("time_ns", record.from_ns);
    visit("until_ns", record.until_ns);
    visit("samples", record.samples);
    visit("cvs", record.cvs);
    visit("channels", record.channels);
  }
};

struct CvHead {
  std::string cv, unit;

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("cv", record.cv);
    visit("unit", record.unit);
  }
};

struct ChannelHead {
  std::string mv, cv, mv_unit;
  bool modelled = true;      ///< the model has it: gain errors are in per cent
  double gain_limit = 0.0;   ///< relative; smaller errors do not matter
  bool disturbance = false;  ///< `mv` is a DV: nobody moves it

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("mv", record.mv);
    visit("cv", record.cv);
    visit({"mv_unit", !record.mv_unit.empty()}, record.mv_unit);
    visit("modelled", record.modelled);
    visit("gain_limit", record.gain_limit);
    visit({"disturbance", record.disturbance}, record.disturbance);
  }
};

/// What the digests of a unit are to be read with; the first line of each file of its journal.
struct UnitHead {
  static constexpr std::int64_t kFormat = 1;

  std::int64_t format = kFormat;
  std::string unit;
  std::int64_t time_ns = 0;  ///< of the first sample that follows
  double sample_time_s = 0.0;
  double digest_s = 0.0;             ///< a digest is of no more than this, aligned to 1970
  std::int64_t horizon_samples = 0;  ///< of the predictions that digests tell of
  std::vector<CvHead> cvs;
  std::vector<ChannelHead> channels;

  template <class Visit, class Record>
  static void fields(Visit&& visit, Record& record) {
    visit("format", record.format);
    visit("unit", record.unit);
    visit("time_ns", record.time_ns);
    visit("sample_time_s", record.sample_time_s);
    visit("digest_s", record.digest_s);
    visit("horizon_samples", record.horizon_samples);
    visit("cvs", record.cvs);
    visit("channels", record.channels);
  }
};

}  // namespace mpm::history
