#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"
#include "daemon/files/times/time_style.hpp"
#include "daemon/files/times/time_text.hpp"

/// The files of this folder, and what stands in them.
namespace mpm::files::test {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
inline constexpr const char* kBerlin = "Europe/Berlin";
inline constexpr const char* kAt1305 = "2026-03-26T13:05:00Z";
inline constexpr const char* kAt1306 = "2026-03-26T13:06:00Z";
inline constexpr const char* kAt1307 = "2026-03-26T13:07:00Z";

/// Of a file of this folder.
[[nodiscard]] std::string path(const std::string& file);
/// FIC101.PV is an MV, TIC102.PV a CV.
[[nodiscard]] config::UnitConfig unit(double sample_time_s);

/// What FIC101.PV and TIC102.PV are in a file. Qualities: g, u, b.
struct Export {
  std::string file;
  std::string zone;  ///< of --time-zone; empty = none is needed
  std::string first, last;
  std::vector<double> fic;
  std::string fic_qualities;
  std::vector<double> tic;
  std::string tic_qualities;
  int unusable = 0;
  double sample_time_s = 60.0;
  std::string format = {};  ///< of --time-format

  [[nodiscard]] TimeStyle times() const {
    return {zone.empty() ? nullptr : std::make_shared<TimeZone>(zone),
            format.empty() ? nullptr : std::make_shared<TimeFormat>(format)};
  }
};

/// Those that need nothing but a time zone or the form of their times.
[[nodiscard]] const std::vector<Export>& exports();

/// One signal of a file, row by row.
struct Signal {
  std::vector<double> values;
  std::string qualities;

  void add(const SignalBlock& block, int index) {
    values.push_back(block.values(index));
    qualities += "gub"[static_cast<int>(block.quality[static_cast<std::size_t>(index)])];
  }
  [[nodiscard]] int unusable() const {
    int count = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      count += qualities[i] == 'b' || !std::isfinite(values[i]) ? 1 : 0;
    return count;
  }
};

/// NaN where nothing is known.
void check(const Signal& signal, const std::vector<double>& values, const std::string& qualities);

}  // namespace mpm::files::test
