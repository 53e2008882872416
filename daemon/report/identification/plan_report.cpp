#include "daemon/report/identification/plan_report.hpp"

#include "core/text/number_text.hpp"
#include "daemon/files/times/time_unit.hpp"
#include "daemon/report/identification/reasons.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::report {
namespace {

/// "18.1 min": three digits, in the unit that reads best.
std::string duration(double seconds) {
  const files::TimeUnit unit = files::time_unit_of(seconds);
  return number_text(seconds / unit.seconds) + " " + unit.name;
}

std::string cv_list(const IdentificationRun& run, const PlannedTest& test) {
  std::string list;
  for (const int cv : test.cvs)
    list += (list.empty() ? "" : ", ") + run.unit.cv[static_cast<std::size_t>(cv)].tag;
  return list;
}

std::string sentence(const IdentificationRun& run, const PlannedTest& test) {
  const std::string& tag = run.unit.input_tag(test.input);
  const std::string& unit = run.unit.mv[static_cast<std::size_t>(test.input)].unit;
  std::string text = tag + " (for " + cv_list(run, test) + "): ";
  if (!test.amplitude) {
    text += "how far it may be moved is not known; give it limits under `simulation`, and ";
  } else {
    text += "by +-" + number_text(*test.amplitude) + (unit.empty() ? "" : " " + unit) + ", ";
  }
  if (test.signal == TestSignal::kSteps)
    text += "steps up, down, up and back, each held for " + duration(test.hold_s);
  else
    text += "two levels at random, " + duration(test.hold_s) + " each on average, for " +
            duration(test.duration_s);
  return text;
}

}  // namespace

nlohmann::ordered_json plan_json(const IdentificationRun& run) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const PlannedTest& test : *run.plan) {
    nlohmann::ordered_json cvs = nlohmann::ordered_json::array();
    for (const int cv : test.cvs) cvs.push_back(run.unit.cv[static_cast<std::size_t>(cv)].tag);
    json.push_back({{"mv", run.unit.input_tag(test.input)},
                    {"cvs", cvs},
                    {"signal", test.signal == TestSignal::kSteps ? "steps" : "binary"},
                    {"amplitude", test.amplitude ? nlohmann::ordered_json(*test.amplitude)
                                                 : nlohmann::ordered_json(nullptr)},
                    {"hold", test.hold_s},
                    {"duration", test.duration_s},
                    {"settling", test.settling_s},
                    {"text", sentence(run, test)}});
  }
  return json;
}

std::string plan_text(const IdentificationRun& run) {
  if (run.plan->empty()) return "test plan: every MV has moved enough\n";
  std::string text = "test plan, one MV after the other or together with independent signals:\n";
  double together_s = 0.0;
  for (const PlannedTest& test : *run.plan) {
    text += wrapped(sentence(run, test), 2, kReasonWidth);
    together_s += test.duration_s;
  }
  return text + "  one after the other: " + duration(together_s) + "\n";
}

TestLimits test_limits(const config::UnitConfig& unit) {
  TestLimits limits;
  for (std::size_t i = 0; i < unit.mv.size(); ++i) {
    const SignalLimits own = unit.mv_limits(i);
    limits.inputs.push_back({own.low, own.high});
  }
  limits.inputs.resize(static_cast<std::size_t>(unit.counts().inputs()));
  for (std::size_t j = 0; j < unit.cv.size(); ++j) {
    const SignalLimits own = unit.cv_limits(j);
    limits.cvs.push_back({own.low, own.high});
  }
  return limits;
}

}  // namespace mpm::report
