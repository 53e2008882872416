#pragma once

#include <array>
#include <cstddef>

#include "core/text/words.hpp"

namespace mpm {

/// What an alarm is to the one who watches: whether its cause is there, and whether somebody has
/// seen it. The states of ANSI/ISA-18.2-2016 (IEC 62682) without the silenced ones, which are told
/// apart from these: an alarm that is shelved goes on being one or the other.
enum class Annunciation : unsigned char {
  kNormal,
  kUnacknowledged,
  kAcknowledged,
  kReturned,  ///< its cause has gone before anybody has seen it
};
[[nodiscard]] constexpr auto words_of(Annunciation) {
  return std::array{"normal", "unacknowledged", "acknowledged", "returned_unacknowledged"};
}

/// What may happen to it.
enum class Stimulus : unsigned char {
  kRises,
  kReturns,  ///< to normal, of an alarm that somebody must have seen
  kFades,    ///< to normal, of one that goes without
  kAcknowledge,
  kReannounce,  ///< acknowledged too long ago for what is still there
};
constexpr std::size_t kAnnunciations = 4, kStimuli = 5;

/// The transitions of ANSI/ISA-18.2-2016, figure 3; what means nothing in a state leaves it.
[[nodiscard]] constexpr Annunciation next(Annunciation state, Stimulus stimulus) {
  using enum Annunciation;
  constexpr std::array<std::array<Annunciation, kStimuli>, kAnnunciations> kTable = {{
      // rises          returns        fades    acknowledge    reannounce
      {kUnacknowledged, kNormal, kNormal, kNormal, kNormal},                  // normal
      {kUnacknowledged, kReturned, kNormal, kAcknowledged, kUnacknowledged},  // unacknowledged
      {kAcknowledged, kNormal, kNormal, kAcknowledged, kUnacknowledged},      // acknowledged
      {kUnacknowledged, kReturned, kNormal, kNormal, kReturned},              // returned
  }};
  return kTable[static_cast<std::size_t>(state)][static_cast<std::size_t>(stimulus)];
}

}  // namespace mpm
