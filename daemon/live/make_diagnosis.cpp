#include "daemon/live/make_diagnosis.hpp"

#include <exception>
#include <memory>
#include <utility>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "daemon/files/folder_name.hpp"
#include "daemon/files/read_recording.hpp"
#include "daemon/live/named_cause.hpp"
#include "daemon/report/diagnosis/explain.hpp"
#include "daemon/report/left_out_text.hpp"
#include "daemon/report/pulses_text.hpp"
#include "idl/version.hpp"

namespace mpm::live {
namespace {

report::DiagnosisRun prepare(const DiagnosisJob& job) {
  report::DiagnosisRun run;
  run.unit = *job.unit;
  files::RecordingFile data;
  data.recording = job.samples.recording(job.unit->sample_time_s);
  files::leave_out_unusable(data);
  run.recording = std::move(data.recording);
  run.notices = report::left_out_texts(run.unit, data);
  run.program = idl::version_text("mpmd");
  run.command_line = "mpmd, because of the alarm of " + files::time_folder(job.alarm_time_ns);
  run.config_file = job.unit->unit + " as mpmd runs it";
  run.data_file = "the last " + std::to_string(job.samples.rows()) + " samples of " +
                  job.unit->unit + " in mpmd";
  run.fit_share =
      1.0 - static_cast<double>(job.unseen_rows) / static_cast<double>(job.samples.rows());
  return run;
}

std::string headline_of(const report::DiagnosisRun& run) {
  std::string text = report::verdict_headline(run);
  for (const Finding& finding : run.diagnosis.findings) text += " " + report::explain(run, finding);
  return text;
}

// A disk that was full may have room again.
DiagnosisOutcome write_again(const DiagnosisJob& job, const ReportStore& store) {
  DiagnosisOutcome outcome;
  outcome.only_wrote = true;
  outcome.file_problem = store.problem();
  if (job.unwritten == nullptr || !outcome.file_problem.empty()) return outcome;
  try {
    outcome.folder = store.write(*job.unwritten, job.alarm_time_ns);
  } catch (const std::exception& error) {
    outcome.file_problem = error.what();
  }
  return outcome;
}

}  // namespace

std::optional<DiagnosisOutcome> make_diagnosis(const DiagnosisJob& job, const ReportStore& store,
                                               const DiagnosisWorker::GoOn& go_on) {
  if (job.only_writes) return write_again(job, store);
  DiagnosisOutcome outcome;
  report::DiagnosisRun run = prepare(job);
  outcome.problem =
      files::recording_problem(run.recording, run.unit, needed_samples(run.unit.model));
  if (!outcome.problem.empty()) return outcome;
  DiagnosisSettings settings;
  settings.mv_count = run.unit.counts().mv;
  settings.fit_share = run.fit_share;
  settings.progress = [&go_on](double) { return go_on(); };
  run.seed = settings.seed;
  run.diagnosis = diagnose(run.unit.model, run.recording, nullptr, settings);
  if (!go_on()) return std::nullopt;
  if (std::string text =
          report::pulses_text(run.unit, run.recording, run.diagnosis.unanswered, nullptr);
      !text.empty())
    run.notices.push_back(std::move(text));
  outcome.headline = headline_of(run);
  outcome.causes = causes_of_channels(run);
  try {
    outcome.folder = store.write(run, job.alarm_time_ns);
  } catch (const std::exception& error) {
    outcome.file_problem = error.what();
    outcome.unwritten = std::make_shared<const report::DiagnosisRun>(std::move(run));
  }
  return outcome;
}

}  // namespace mpm::live
