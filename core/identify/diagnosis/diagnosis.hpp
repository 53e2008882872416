#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/diagnosis/channel_estimates.hpp"
#include "core/identify/diagnosis/statement.hpp"
#include "core/identify/diagnosis/validation.hpp"
#include "core/identify/evidence/unanswered_pulses.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

struct DiagnosisSettings {
  int mv_count = 0;            ///< of the model's inputs; the rest are DVs
  double fit_share = 2.0 / 3;  ///< first part of the recording that is fitted
  int max_findings = 9;
  std::uint64_t seed = 1;  ///< of the block bootstrap
  int threads = 1;         ///< >= 1; nothing of the diagnosis depends on it
  /// Called about once per fit, with the share done, 0..1, by the thread that called diagnose();
  /// returns false to give up, which then takes no more than a fit does.
  std::function<bool(double)> progress = {};
};

enum class DiagnosisVerdict { kMatch, kMismatch, kUndetermined };

/// How an input moved.
struct InputMovement {
  int input = 0;
  /// From outside the loop: set-points, measured disturbances, operators, test signals. Nothing
  /// where it stands still or the data do not suffice.
  std::optional<double> outside_share;
  bool excited = false;  ///< its gains are known well enough to tell a good model from a bad one
};

struct Diagnosis {
  DiagnosisVerdict verdict = DiagnosisVerdict::kUndetermined;
  std::string reason;  ///< why undetermined, or what the verdict leaves open; for a person
  Eigen::Index samples = 0, fit_samples = 0, validation_samples = 0;
  std::vector<Finding> findings;  ///< most important first
  std::vector<Finding> refused;   ///< found, but their repair did not carry over to unseen data
  /// Linear errors of channels that are there and too small to matter, by the monitor's limits: the
  /// others were told beside them.
  std::vector<Finding> small;
  std::vector<Unexplained> unexplained;
  /// What would explain the data best and may not be named, for the calibrated test of the channels
  /// does not reject them.
  std::optional<Finding> suspect;
  /// Channels that the calibrated test surely rejects and that nothing named or seen is about.
  std::vector<Place> rejected;
  /// Where nothing was found: those of which its nonlinear test says that no linear model fits.
  std::vector<Place> bent;
  std::vector<InputMovement> inputs;  ///< MVs, then DVs
  std::vector<Pulse> unanswered;      ///< of inputs: taken as not known, for the plant saw none
  std::vector<Pulse> validation_unanswered;  ///< the same in the second recording
  std::vector<ChannelEstimate> channels;
  ModelSpec extended;             ///< equal to the model where nothing was found
  std::vector<int> new_inputs;    ///< aux signals that `extended` takes as inputs after the model's
  std::vector<CvScore> scores;    ///< one per CV
  Eigen::MatrixXd before, after;  ///< simulated CVs on the recording, samples x CVs
  /// The same on the second recording where there is one.
  Eigen::MatrixXd validation_before, validation_after;
};

/// Too few rows for a diagnosis of this model are no diagnosis; so many are needed.
[[nodiscard]] Eigen::Index needed_samples(const ModelSpec& model);

/// The rows of a recording of so many that are worth a diagnosis: all of one of usual length, fewer
/// of a longer one, which is to be condensed to them (fit/condense.hpp).
[[nodiscard]] Eigen::Index rows_to_diagnose(Eigen::Index samples);

/// Simulates `model` freely on `recording`, names what it gets wrong, extends it and measures the
/// gain on samples that the fit has not seen: the end of `recording`, or all of `validation`.
/// Deterministic. Never throws on data. Given up: undetermined, and nothing else is filled in.
[[nodiscard]] Diagnosis diagnose(const ModelSpec& model, const Recording& recording,
                                 const Recording* validation, const DiagnosisSettings& settings);

}  // namespace mpm
