#include "core/alarm/annunciation.hpp"

#include <array>
#include <catch2/catch.hpp>

namespace mpm {
namespace {

// ISA-18.2-2016, figure 3, read off by hand: each arrow of the figure, and that there are no
// others.
struct Arrow {
  Annunciation from;
  Stimulus stimulus;
  Annunciation to;
};
using enum Annunciation;
constexpr std::array kArrows = {
    Arrow{kNormal, Stimulus::kRises, kUnacknowledged},              // A -> B
    Arrow{kUnacknowledged, Stimulus::kAcknowledge, kAcknowledged},  // B -> C
    Arrow{kUnacknowledged, Stimulus::kReturns, kReturned},          // B -> D
    Arrow{kUnacknowledged, Stimulus::kFades, kNormal},              // B -> A, auto-reset
    Arrow{kAcknowledged, Stimulus::kReturns, kNormal},              // C -> A
    Arrow{kAcknowledged, Stimulus::kFades, kNormal},                // C -> A
    Arrow{kAcknowledged, Stimulus::kReannounce, kUnacknowledged},   // C -> B, re-alarm
    Arrow{kReturned, Stimulus::kAcknowledge, kNormal},              // D -> A
    Arrow{kReturned, Stimulus::kRises, kUnacknowledged},            // D -> B
    Arrow{kReturned, Stimulus::kFades, kNormal},                    // D -> A, auto-reset
};

TEST_CASE("an alarm goes along the arrows of ISA-18.2, and along no others") {
  for (std::size_t s = 0; s < kAnnunciations; ++s)
    for (std::size_t t = 0; t < kStimuli; ++t) {
      const auto state = static_cast<Annunciation>(s);
      const auto stimulus = static_cast<Stimulus>(t);
      Annunciation expected = state;
      for (const Arrow& arrow : kArrows)
        if (arrow.from == state && arrow.stimulus == stimulus) expected = arrow.to;
      INFO(to_string(state) << " at stimulus " << t);
      CHECK(next(state, stimulus) == expected);
    }
}

TEST_CASE("to acknowledge does not clear, and to clear does not acknowledge, in either order") {
  const auto after = [](std::initializer_list<Stimulus> stimuli) {
    Annunciation state = kNormal;
    for (const Stimulus stimulus : stimuli) state = next(state, stimulus);
    return state;
  };
  CHECK(after({Stimulus::kRises, Stimulus::kAcknowledge}) == kAcknowledged);
  CHECK(after({Stimulus::kRises, Stimulus::kReturns}) == kReturned);
  CHECK(after({Stimulus::kRises, Stimulus::kAcknowledge, Stimulus::kReturns}) == kNormal);
  CHECK(after({Stimulus::kRises, Stimulus::kReturns, Stimulus::kAcknowledge}) == kNormal);
}

}  // namespace
}  // namespace mpm
