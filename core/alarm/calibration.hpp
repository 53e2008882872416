#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The numbers of this room. Where each comes from:
///
///   quoted  from ANSI/ISA-18.2-2016 and EEMUA 191, as those who have read them publish it;
///   chosen  by hand; the user may set what a unit file has a key for.
namespace mpm::calibration {

inline constexpr double kNanoseconds = 1e9;  ///< of a second

/// Of OPC UA, 1..1000: the middle of the third that a priority has there, low to high. Chosen.
inline constexpr std::array kSeverities = {167, 500, 833};

/// s; of a controller's alarm: a shift. What comes and goes within it is one alarm. Chosen after
/// the aim of one a shift at most.
inline constexpr double kControllerOffDelay = 8 * 3600.0;
/// s; the longest that an alarm can be shelved for. Chosen: no shelf outlives a day unseen.
inline constexpr double kLongestShelf = 86400.0;
/// s; the most that a unit may allow: a longer time is another way of saying "for ever". Chosen.
inline constexpr double kMostShelf = 31.0 * 86400.0;
/// Samples in a row that must say that a question has no meaning, or has one again. Chosen: a gap
/// in the data is no event.
inline constexpr int kSettled = 10;

/// How alarms are counted. Quoted.
namespace load {
inline constexpr std::int64_t kSecond = 1'000'000'000;  ///< ns
inline constexpr std::int64_t kWindow = 600 * kSecond;
inline constexpr std::size_t kFloodBegins = 11;  ///< in a window: more than 10
inline constexpr std::size_t kFloodEnds = 4;     ///< in a window: less than 5
inline constexpr std::size_t kChatter = 3;       ///< of one alarm
inline constexpr std::int64_t kChatterWindow = 60 * kSecond;
inline constexpr std::int64_t kDay = 86'400 * kSecond;
inline constexpr std::int64_t kStale = kDay;
}  // namespace load

}  // namespace mpm::calibration
