#include "daemon/report/identification/reasons.hpp"

#include <cmath>

#include "core/text/number_text.hpp"

namespace mpm::report {

std::string reason_word(LeftOut left_out) {
  switch (left_out) {
    case LeftOut::kIdentified:
      return "identified";
    case LeftOut::kGivenNone:
      return "given_none";
    case LeftOut::kStill:
      return "input_still";
    case LeftOut::kUnknownCv:
      return "cv_unknown";
    case LeftOut::kReadSeldom:
      return "read_seldom";
    case LeftOut::kTooFewRows:
      return "too_few_samples";
    case LeftOut::kOnlyFeedback:
      return "only_feedback";
    case LeftOut::kHidden:
      return "too_little_movement";
    case LeftOut::kNoRelation:
      return "no_relation";
    case LeftOut::kTooSmall:
      return "too_small";
    case LeftOut::kVague:
      return "gain_uncertain";
    case LeftOut::kWrongSign:
      return "wrong_sign";
    case LeftOut::kNotConfirmed:
      return "not_confirmed";
  }
  return {};
}

std::string reason_text(const IdentificationRun& run, const ChannelAnswer& answer) {
  const std::string& input = run.unit.input_tag(answer.input);
  const std::string& cv = run.unit.cv[static_cast<std::size_t>(answer.cv)].tag;
  switch (answer.left_out) {
    case LeftOut::kIdentified:
      return {};
    case LeftOut::kGivenNone:
      return "the unit file says that there is no relation";
    case LeftOut::kStill:
      return input + " does not move";
    case LeftOut::kUnknownCv:
      return cv + " is not known, or does not move";
    case LeftOut::kReadSeldom: {
      const auto every = run.identification.cvs.at(static_cast<std::size_t>(answer.cv)).read_every;
      return cv + " is read every " + std::to_string(every) +
             " samples, in no cycle that holds, or too few times: " +
             std::to_string(needed_rows(run.recording.inputs.cols())) + " readings are needed";
    }
    case LeftOut::kTooFewRows:
      return "too few samples for so many inputs: " +
             std::to_string(needed_rows(run.recording.inputs.cols())) + " are needed";
    case LeftOut::kOnlyFeedback:
      return "only feedback moves " + input +
             ": what is seen is the controller as much as the process; move it, or a set-point, "
             "from outside";
    case LeftOut::kHidden:
      if (!std::isfinite(answer.visible_gain))
        return "the movements of " + input + " follow from the other signals";
      return input + " moves too little by itself: a gain below " +
             number_text(answer.visible_gain) + " would not have shown";
    case LeftOut::kNoRelation:
      return "no relation seen; a gain of " + number_text(answer.visible_gain) +
             " would have shown";
    case LeftOut::kTooSmall:
      return "there is a relation, but it gives " + percent_text(answer.contribution) +
             " of what " + cv + " does";
    case LeftOut::kVague:
      return "there is a relation, but its gain is not known: " +
             interval_text(answer.gain.low, answer.gain.high) +
             (answer.entangled_with >= 0
                  ? "; it cannot be told from that of " + run.unit.input_tag(answer.entangled_with)
                  : (answer.input < static_cast<int>(run.unit.mv.size())
                         ? "; move " + input
                         : "; wait until " + input + " moves") +
                        " more");
    case LeftOut::kWrongSign:
      return "the data contradict the sign that the unit file gives";
    case LeftOut::kNotConfirmed:
      return "on samples that were not fitted, predictions of " + cv +
             " are no better with the inputs than without";
  }
  return {};
}

std::vector<std::string> doubts_of_model(const IdentificationRun& run) {
  std::vector<std::string> doubts;
  if (run.identification.within_row)
    doubts.emplace_back(
        "CVs answer inputs of their own row: values are averages, or the inputs' time stamps are "
        "late. No model here can do that; move the inputs up by a row");
  std::string worse;
  for (const CvAnswer& answer : run.identification.cvs) {
    const auto& channels = run.identification.model.channels;
    const bool modelled = std::any_of(channels.begin(), channels.end(),
                                      [&](const auto& each) { return each.cv == answer.cv; });
    if (modelled && answer.unseen_rmse > answer.unseen_spread)
      worse +=
          (worse.empty() ? "" : ", ") + run.unit.cv.at(static_cast<std::size_t>(answer.cv)).tag;
  }
  if (!worse.empty())
    doubts.push_back("On the last quarter the free run is off by more than the CV moves: " + worse +
                     ". Either a disturbance is as large as that, or these channels are wrong");
  return doubts;
}

}  // namespace mpm::report
