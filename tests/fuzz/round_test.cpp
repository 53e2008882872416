#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/targets.hpp"

namespace mpm::fuzz::round_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongest = 8192;  // bytes

std::vector<std::string> corpus_of(const std::string& target) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(MPM_SOURCE_DIR "/tests/fuzz/corpus/" + target))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> all;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return all;
}

/// One to six slips: a byte or a bit changed, pieces removed, doubled, or taken from another input.
std::string mutated(std::string text, const std::string& other, std::mt19937_64& random) {
  const auto below = [&random](std::size_t bound) { return bound == 0 ? 0 : random() % bound; };
  for (std::size_t slips = 1 + below(6); slips > 0; --slips) {
    const std::size_t at = below(text.size());
    switch (below(6)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random());
        break;
      case 1:
        if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 2:
        text.erase(at, 1 + below(16));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(64)));
        break;
      case 4:
        text.insert(at, other.substr(below(other.size()), below(64)));
        break;
      default:
        if (below(4) == 0) text.resize(at);
    }
  }
  text.resize(std::min(text.size(), kLongest));
  return text;
}

void round(const std::string& name, int mutations) {
  const auto target = std::find_if(targets().begin(), targets().end(),
                                   [&](const Target& each) { return each.name == name; });
  REQUIRE(target != targets().end());
  const std::vector<std::string> corpus = corpus_of(name);
  REQUIRE_FALSE(corpus.empty());
  for (const std::string& input : corpus) target->exercise(input);
  constexpr std::uint64_t kSeed = 20240503;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < mutations; ++i) {
    const std::string& first = corpus[random() % corpus.size()];
    const std::string& second = corpus[random() % corpus.size()];
    const std::string input = mutated(first, second, random);
    INFO(name << ": seed " << kSeed << ", mutation " << i);
    REQUIRE_NOTHROW(target->exercise(input));
  }
}

// What each may end in is tests/fuzz/targets'; asan and ubsan see the rest (`./run sanitize`), and
// `./run fuzz` looks for what is not in the corpus yet.
TEST_CASE("unit files of any bytes are read or refused") { round("unit_file", 1000); }
TEST_CASE("data files of any bytes are read or refused") { round("csv", 1500); }
TEST_CASE("recordings of any bytes are read or refused") { round("mcap", 1000); }
TEST_CASE("payloads of any bytes are read or refused") { round("cdr", 10'000); }
TEST_CASE("lines of any bytes are read or refused") { round("json_lines", 2000); }
TEST_CASE("requests of any bytes are answered or refused") { round("http", 1000); }
TEST_CASE("samples kept, of any bytes, are taken or refused") { round("sample_log", 200); }
TEST_CASE("files of states, of any bytes, are taken or refused") { round("state_file", 1000); }
TEST_CASE("states of any bytes are taken or refused") { round("state", 200); }

}  // namespace
}  // namespace mpm::fuzz::round_test
