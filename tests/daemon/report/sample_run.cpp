#include "tests/daemon/report/sample_run.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "config/load_unit.hpp"
#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/model/linear_model.hpp"
#include "tests/core/identify/proposals.hpp"

namespace mpm::test {
namespace {

constexpr double kOnset = 2100.0;
constexpr double kShift = 0.6;

config::UnitConfig unit() {
  config::LoadResult loaded = config::load_unit(MPM_SOURCE_DIR "/config/plants/shell3x3.yaml");
  REQUIRE(loaded.ok());
  for (config::CvSignal& cv : loaded.config.cv) cv.unit = "degC";
  for (config::InputSignal& mv : loaded.config.mv) mv.unit = "m3/h";
  loaded.config.aux = {{"p_feed", "bar", "feed pressure"}, {"t_amb", "K", "ambient temperature"}};
  loaded.config.simulation.aux_movement.resize(2);
  return loaded.config;
}

Recording inputs(const config::UnitConfig& unit, int samples) {
  std::mt19937 random(7);  // the same numbers on every machine
  const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  Recording recording;
  recording.sample_time_s = unit.sample_time_s;
  recording.inputs.setZero(samples, unit.counts().inputs());
  recording.cvs.setZero(samples, unit.counts().cv);
  recording.aux.setZero(samples, unit.counts().aux);
  Eigen::RowVectorXd level = Eigen::RowVectorXd::Zero(recording.inputs.cols());
  double weather = 0.0;
  for (int row = 0; row < samples; ++row) {
    if (row % 40 == 0)
      for (double& value : level) value = 0.6 * uniform();
    weather = 0.995 * weather + 0.1 * uniform();
    recording.inputs.row(row) = level + 0.02 * Eigen::RowVectorXd::NullaryExpr(3, uniform);
    recording.aux(row, 0) = 3.0 + 0.1 * uniform();
    recording.aux(row, 1) = 288.0 + weather;
  }
  return recording;
}

ModelSpec extended(const ModelSpec& model) {
  ModelSpec spec = model;
  for (ChannelSpec& channel : spec.channels)
    if (channel.cv == 2 && channel.input == 2)
      std::get<TransferFunction>(channel.dynamics).gain *= 1.4;
  spec.input_count += 1;
  spec.channels.push_back({0, 3, TransferFunction{1.5, {20.0}, 0.0, 4.0}});
  spec.input_blocks.resize(4);
  spec.input_origin.conservativeResize(4);
  spec.input_origin(3) = 288.0;
  return spec;
}

Eigen::MatrixXd simulate(const ModelSpec& spec, const Recording& recording) {
  LinearModel model(spec);
  Eigen::MatrixXd cvs(recording.samples(), spec.cv_count);
  Eigen::VectorXd input(spec.input_count);
  for (Eigen::Index row = 0; row < recording.samples(); ++row) {
    cvs.row(row) = model.output().transpose();
    input.head(3) = recording.inputs.row(row).transpose();
    if (spec.input_count > 3) input(3) = recording.aux(row, 1);
    model.advance(input);
  }
  return cvs;
}

Finding gain_finding() {
  Finding finding;
  finding.subject = {&causes::gain(), {2, 2}};
  finding.parameters = {{&kGainRatio, 1.402, 1.381, 1.424}};
  finding.confidence = 0.991;
  finding.evidence = 812.0;
  finding.rivals = {{{&causes::output_scale(), {2}}, 14.2, false},
                    {{&causes::input_scale(), {-1, 2}}, 91.0, false}};
  return finding;
}

Finding input_finding() {
  Finding finding;
  const Cause& cause = causes::unmodelled_input();
  finding.subject = {&cause, {0, -1, 1}};
  finding.parameters = {{&quantity_of(cause, "gain"), 1.49, 1.41, 1.58},
                        {&quantity_of(cause, "time_constant"), 20.6, 17.9, 23.8},
                        {&quantity_of(cause, "dead_time"), 3.9, 2.8, 5.1}};
  finding.confidence = 0.97;
  finding.evidence = 403.0;
  return finding;
}

Finding step_finding() {
  Finding finding;
  finding.subject = {&causes::step_disturbance(), {1}};
  finding.parameters = {{&kSize, 0.61, 0.55, 0.66}};
  finding.confidence = 0.94;
  finding.evidence = 230.0;
  finding.onset_s = kOnset;
  finding.rivals = {{{&causes::drift_disturbance(), {1}}, 1.2, true}};
  return finding;
}

double rmse(const Eigen::VectorXd& error) {
  return std::sqrt(error.squaredNorm() / static_cast<double>(error.size()));
}

CvScore score(const Eigen::VectorXd& measured, const Eigen::VectorXd& before,
              const Eigen::VectorXd& after) {
  CvScore result;
  const double spread = rmse(measured.array() - measured.mean());
  result.rmse_before = rmse(measured - before);
  result.rmse_after = rmse(measured - after);
  result.fit_before = 100.0 * (1.0 - result.rmse_before / spread);
  result.fit_after = 100.0 * (1.0 - result.rmse_after / spread);
  const double gain = 1.0 - result.rmse_after / result.rmse_before;
  result.gain_low = gain - 0.04;
  result.gain_high = gain + 0.03;
  return result;
}

void add_noise(Eigen::MatrixXd& cvs) {
  std::mt19937 random(11);
  Eigen::RowVectorXd noise = Eigen::RowVectorXd::Zero(cvs.cols());
  for (Eigen::Index row = 0; row < cvs.rows(); ++row) {
    for (double& value : noise)
      value = 0.95 * value + 0.1 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
    cvs.row(row) += noise;
  }
}

}  // namespace

report::DiagnosisRun sample_run(int samples) {
  report::DiagnosisRun run;
  run.unit = unit();
  run.recording = inputs(run.unit, samples);
  Diagnosis& diagnosis = run.diagnosis;
  diagnosis.extended = extended(run.unit.model);
  diagnosis.new_inputs = {1};
  diagnosis.before = simulate(run.unit.model, run.recording);
  diagnosis.after = simulate(diagnosis.extended, run.recording);
  run.recording.cvs = diagnosis.after;
  add_noise(run.recording.cvs);
  const auto onset = static_cast<Eigen::Index>(kOnset);
  if (samples > onset) {
    run.recording.cvs.col(1).tail(samples - onset).array() += kShift;
    diagnosis.after.col(1).tail(samples - onset).array() += kShift;
    diagnosis.extended.disturbances = {{1, DisturbanceShape::kStep, kOnset, kShift}};
  }
  run.recording.cvs.col(0).segment(500, 30).setConstant(std::nan(""));

  diagnosis.verdict = DiagnosisVerdict::kMismatch;
  diagnosis.samples = samples;
  diagnosis.fit_samples = samples * 2 / 3;
  diagnosis.validation_samples = samples - diagnosis.fit_samples;
  diagnosis.findings = {gain_finding(), input_finding(), step_finding()};
  Finding refused;
  refused.subject = {&causes::stiction(), {-1, 1}};
  refused.parameters = {{&quantity_of(causes::stiction(), "band"), 0.02, 0.0, 0.05},
                        {&quantity_of(causes::stiction(), "jump"), 0.01, 0.0, 0.03}};
  refused.confidence = 0.61;
  refused.evidence = 9.5;
  diagnosis.refused = {refused};
  diagnosis.unexplained = {{{&causes::unnamed_swing(), {1, 0}}, 0.003, 0.08}};
  for (int cv = 0; cv < 3; ++cv)
    for (int input = 0; input < 3; ++input) {
      const double gain = cv == 2 && input == 2 ? 1.4 : 1.0;
      diagnosis.channels.push_back({cv,
                                    input,
                                    {&kGainRatio, gain, gain - 0.03, gain + 0.03},
                                    {&kTimeConstantRatio, 1.0, 0.96, 1.05},
                                    {&kDeadTimeError, 0.1, -0.6, 0.8}});
    }
  const Eigen::Index unseen = diagnosis.validation_samples;
  for (int cv = 0; cv < 3; ++cv)
    diagnosis.scores.push_back(score(run.recording.cvs.col(cv).tail(unseen),
                                     diagnosis.before.col(cv).tail(unseen),
                                     diagnosis.after.col(cv).tail(unseen)));
  diagnosis.scores[1].refused = true;
  run.closed_loop = report::ClosedLoop{"hidden_gain",
                                       {101, 102, 103},
                                       3000,
                                       {"t_amb"},
                                       {{0, 0.021, 0.02}, {1, 0.03, 0.028}, {2, 0.041, 0.018}},
                                       {{0, 0.0, 0.0}, {1, 0.01, 0.0}, {2, 0.034, 0.002}}};
  run.program = "mpm 0.1.0";
  run.command_line = "mpm diagnose --config shell3x3.yaml --data run.csv --out report";
  run.config_file = "shell3x3.yaml";
  run.data_file = "run.csv";
  run.fit_share = 2.0 / 3;
  run.seed = 1;
  run.notices = {"run.csv: 30 values of inputs and CVs missing or bad"};
  return run;
}

report::DiagnosisRun matching_run() {
  report::DiagnosisRun run = sample_run(1000);
  run.recording.cvs = run.diagnosis.before;
  add_noise(run.recording.cvs);
  run.diagnosis.after = run.diagnosis.before;
  run.diagnosis.extended = run.unit.model;
  run.diagnosis.new_inputs.clear();
  run.diagnosis.verdict = DiagnosisVerdict::kMatch;
  run.diagnosis.findings.clear();
  run.diagnosis.refused.clear();
  run.diagnosis.unexplained.clear();
  run.closed_loop.reset();
  for (CvScore& each : run.diagnosis.scores)
    each = {.rmse_before = 0.1,
            .rmse_after = 0.1,
            .fit_before = 80.0,
            .fit_after = 80.0,
            .horizons = {}};
  return run;
}

}  // namespace mpm::test
