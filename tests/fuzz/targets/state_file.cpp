#include <zlib.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "daemon/live/numbered_files.hpp"
#include "daemon/live/state_files.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {
namespace {

constexpr std::string_view kMagic = "mpm state 1\n";
constexpr std::size_t kSumBytes = 9;  // eight digits and the end of their line

/// The same with its sum put right: what is behind it is to be reached.
std::string summed(std::string_view bytes) {
  std::string text(bytes);
  if (!bytes.starts_with(kMagic) || bytes.size() < kMagic.size() + kSumBytes) return text;
  const std::string_view body = bytes.substr(kMagic.size() + kSumBytes);
  char sum[kSumBytes + 1];
  std::snprintf(sum, sizeof sum, "%08lx\n",
                crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size()));
  return text.replace(kMagic.size(), kSumBytes, sum);
}

void read(const std::string& text) {
  const std::string path = live::numbered_path(folder(), "state-", 1);
  std::ofstream(path, std::ios::binary) << text;
  live::StateFiles states(folder(), "small");
  require(states.find({1}) == std::vector<std::uint64_t>{1}, "the state is not found");
  std::string why;
  const auto state = states.read(1, why);
  require(!state || state->size() < text.size(), "more was read than there is");
  std::filesystem::remove(path);
}

}  // namespace

void state_file(std::string_view bytes) {
  read(std::string(bytes));
  read(summed(bytes));
}

}  // namespace mpm::fuzz
