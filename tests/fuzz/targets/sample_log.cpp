#include "daemon/live/sample_log.hpp"

#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "daemon/files/aligning.hpp"
#include "daemon/files/calculator.hpp"
#include "daemon/live/numbered_files.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

constexpr std::string_view kMagic = "mpm samples 1\n";
constexpr const char* kMeaning = "small";

/// The same with the sum of each record put right, as far as their lengths lead: what is behind the
/// sums is to be reached.
std::string summed(std::string_view bytes) {
  std::string text(bytes);
  if (!bytes.starts_with(kMagic)) return text;
  for (std::size_t at = kMagic.size(); at + 8 <= text.size();) {
    std::uint32_t size = 0;
    std::memcpy(&size, &text[at], sizeof size);
    if (size > text.size() - at - 8) break;
    const auto sum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(&text[at + 8]), static_cast<uInt>(size)));
    std::memcpy(&text[at + 4], &sum, sizeof sum);
    at += 8 + size;
  }
  return text;
}

// As a unit takes its samples back (UnitPipeline::recall).
void recall() {
  const config::UnitConfig& unit = small_unit();
  report::UnitMonitor monitor(unit);
  files::Calculator calculator(unit);
  Frame calculated(unit.counts());
  Aligner aligner(
      unit.counts(), files::needed_kinds(unit),
      [&](const Frame& frame) {
        calculated = frame;
        calculator.fill(calculated);
        monitor.push(calculated);
      },
      files::aligner_settings(unit));
  live::SampleLog log(folder(), kMeaning, 100);
  static_cast<void>(log.recall(
      [&](const BlockView* block) { block != nullptr ? aligner.push(*block) : aligner.expire(); }));
  static_cast<void>(monitor.channels());
}

}  // namespace

void sample_log(std::string_view bytes) {
  const std::string path = live::numbered_path(folder(), "samples-", 1);
  const std::string mended = summed(bytes);
  std::ofstream(path, std::ios::binary) << bytes;
  recall();
  if (mended != bytes) {
    std::ofstream(path, std::ios::binary) << mended;
    recall();
  }
  std::filesystem::remove(path);
}

}  // namespace mpm::fuzz
