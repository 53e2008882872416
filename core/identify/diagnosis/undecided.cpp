#include "core/identify/diagnosis/undecided.hpp"

#include <cmath>

#include "core/identify/causes/cause.hpp"
#include "core/identify/diagnosis/calibration.hpp"

namespace mpm {
namespace {

/// Whether one is a part of the other: a channel of its input, or of its CV.
bool overlap(const Place& a, const Place& b) {
  const auto within = [](int x, int y) { return x < 0 || y < 0 || x == y; };
  const bool same_input = a.input >= 0 && a.input == b.input;
  const bool same_cv = a.cv >= 0 && a.cv == b.cv;
  return (same_input && within(a.cv, b.cv)) || (same_cv && within(a.input, b.input));
}

}  // namespace

bool accuses(const Subject& subject) {
  return subject.place.aux < 0 &&
         (subject.cause->acts_through_channels() || subject.cause->is_input_block());
}

double probability_of_place(const Finding& finding) {
  // Odds against its own cause's: `confidence` is 1 / (1 + all of them + what acts alike).
  double same = 0.0;
  for (const Rival& rival : finding.rivals)
    if (accuses(rival.subject) && overlap(rival.subject.place, finding.subject.place))
      same += std::exp(-0.5 * rival.worse);
  return finding.confidence * (1.0 + same);
}

bool is_guess(const Finding& finding) {
  return accuses(finding.subject) && probability_of_place(finding) < kGuess;
}

}  // namespace mpm
