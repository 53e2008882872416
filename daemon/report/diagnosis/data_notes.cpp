#include "daemon/report/diagnosis/data_notes.hpp"

#include "core/statistics/historian.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/diagnosis/names_of.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

/// Up to the sample time that goes with it.
const char* reading_advice(bool judged) {
  return judged
             ? ", and judged at its readings, apart from what is measured at every sample: as a "
               "unit with a sample_time of "
             : ". Beside what is measured at every sample it cannot be judged, and by itself only "
               "in a regular cycle, by enough readings, with a model in seconds: give it a unit of "
               "its own with a sample_time of ";
}

std::string advice(const HistorianTraits& traits, const std::string& unit, double sample_time_s,
                   bool judged) {
  const auto with_unit = [&unit](double value) {
    return number_text(value, 3) + (unit.empty() ? "" : " " + unit);
  };
  std::string text;
  if (traits.interpolated)
    text =
        "Straight lines between archived points. Export the values as they were archived, and "
        "turn the tag's compression off.";
  else if (traits.deadband > 0.0)
    text = "Held until it had moved by " + with_unit(traits.deadband) +
           ". Turn the tag's exception and compression deadbands off, or set them well below its "
           "noise.";
  else if (traits.read_every > 0)
    text = "Read every " + std::to_string(traits.read_every) + " samples" + reading_advice(judged) +
           number_text(static_cast<double>(traits.read_every) * sample_time_s, 6) + " s.";
  else
    text = "Moves in steps of " + with_unit(traits.quantum) +
           ", which is coarse beside what it moves by from row to row. Record more digits, or use "
           "the narrower range of the transmitter.";
  if (beyond_use(traits)) text += " As it is, no cause can be told from it.";
  return text;
}

/// `judged`: a CV that was.
void look(const Eigen::Ref<const Eigen::VectorXd>& values, const SignalName& signal, bool is_cv,
          double sample_time_s, bool judged, Json& notes) {
  HistorianTraits traits = historian_traits(values);
  if (!is_cv) traits.read_every = 0;  // it acts at every sample
  if (!traits.compressed() && !(traits.quantum > 0.0) && traits.read_every == 0) return;
  notes.push_back({{"tag", signal.tag},
                   {"compressed", traits.compressed()},
                   {"interpolated", traits.interpolated},
                   {"deadband", traits.deadband},
                   {"quantum", traits.quantum},
                   {"held_share", traits.held_share},
                   {"read_every", traits.read_every},
                   {"beyond_use", beyond_use(traits)},
                   {"advice", advice(traits, signal.unit, sample_time_s, judged)}});
}

}  // namespace

Json data_notes(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
  Json notes = Json::array();
  const std::vector<CvScore>& scores = run.diagnosis.scores;
  for (Eigen::Index cv = 0; cv < run.recording.cvs.cols(); ++cv) {
    const auto at = static_cast<std::size_t>(cv);
    look(run.recording.cvs.col(cv), names.cv(static_cast<int>(cv)), true,
         run.recording.sample_time_s, at < scores.size() && scores[at].judged, notes);
  }
  for (Eigen::Index input = 0; input < run.recording.inputs.cols(); ++input)
    look(run.recording.inputs.col(input), names.input(static_cast<int>(input)), false,
         run.recording.sample_time_s, false, notes);
  return notes;
}

}  // namespace mpm::report
