#include "daemon/live/state_files.hpp"

#include <spdlog/fmt/fmt.h>
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/replacement_file.hpp"
#include "config/whole_file.hpp"
#include "core/text/netstring.hpp"
#include "daemon/host/low_priority.hpp"
#include "daemon/live/numbered_files.hpp"

namespace mpm::live {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStateMagic = "mpm state 1\n";
constexpr std::string_view kStatePrefix = "state-";
constexpr std::size_t kKept = 2;

std::string path_of(const std::string& folder, std::uint64_t number) {
  return numbered_path(folder, kStatePrefix, number);
}

void remove(const std::string& folder, std::uint64_t number) {
  std::error_code ignored;
  fs::remove(path_of(folder, number), ignored);
}

/// What a writer that was killed has left, which nobody would ever replace.
void remove_unfinished(const std::string& folder) {
  std::error_code failed;
  std::vector<fs::path> unfinished;
  for (auto entry = fs::directory_iterator(folder, failed);
       !failed && entry != fs::directory_iterator(); entry.increment(failed))
    if (entry->path().filename().string().starts_with("." + std::string(kStatePrefix)))
      unfinished.push_back(entry->path());
  for (const fs::path& path : unfinished) fs::remove(path, failed);
}

std::uint64_t oldest_in(const std::string& folder) {
  const std::vector<std::uint64_t> numbers = numbers_in(folder, kStatePrefix);
  return numbers.empty() ? 0 : numbers.front();
}

// Of fixed width, before all that it is the sum of.
std::string sum_text(std::string_view bytes) {
  const auto sum = ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return fmt::format("{:08x}\n", sum);
}

/// What stands before the bytes. The number is in it, so that no file passes for another.
std::string head_of(std::uint64_t number, std::string_view belongs) {
  std::string head;
  append_netstring(head, std::to_string(number));
  append_netstring(head, belongs);
  return head;
}

/// Why it could not be written, or nothing.
std::string write_state(const std::string& folder, const std::string& belongs, std::uint64_t number,
                        const std::vector<std::byte>& bytes) {
  host::take_low_priority("mpmd-state");
  std::string body = head_of(number, belongs);
  body.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    config::ReplacementFile file(path_of(folder, number));
    file.write(std::string(kStateMagic) + sum_text(body));
    file.write(body);
    file.commit();
  } catch (const std::exception& error) {
    return error.what();
  }
  const std::vector<std::uint64_t> all = numbers_in(folder, kStatePrefix);
  for (std::size_t i = 0; i + kKept < all.size(); ++i) remove(folder, all[i]);
  return "";
}

std::optional<std::vector<std::byte>> read_state(const std::string& folder,
                                                 const std::string& belongs, std::uint64_t number,
                                                 std::string& why) {
  const std::optional<std::string> all = config::read_whole_file(path_of(folder, number), why);
  if (!all) {
    why = "it cannot be read: " + why;
    return std::nullopt;
  }
  std::string_view rest = *all;
  const auto cut = [&rest](std::string_view expected) {
    if (!rest.starts_with(expected)) return false;
    rest.remove_prefix(expected.size());
    return true;
  };
  const std::size_t sum_size = sum_text("").size();
  why = "it is damaged";
  if (!cut(kStateMagic) || rest.size() < sum_size) return std::nullopt;
  const std::string_view sum = rest.substr(0, sum_size);
  rest.remove_prefix(sum_size);
  if (sum_text(rest) != sum) return std::nullopt;
  why = StateFiles::kBelongsElsewhere;
  if (!cut(head_of(number, belongs))) return std::nullopt;
  const auto bytes = std::as_bytes(std::span(rest));
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

}  // namespace

StateFiles::StateFiles(std::string folder, std::string belongs)
    : folder_(std::move(folder)), belongs_(std::move(belongs)) {}

std::vector<std::uint64_t> StateFiles::find(const std::vector<std::uint64_t>& files) {
  remove_unfinished(folder_);
  std::vector<std::uint64_t> found = numbers_in(folder_, kStatePrefix);
  std::erase_if(found, [&](std::uint64_t number) {
    if (std::binary_search(files.begin(), files.end(), number)) return false;
    remove(folder_, number);
    return true;
  });
  oldest_ = found.empty() ? 0 : found.front();
  std::reverse(found.begin(), found.end());
  return found;
}

std::optional<std::vector<std::byte>> StateFiles::read(std::uint64_t file, std::string& why) const {
  return read_state(folder_, belongs_, file, why);
}

std::string StateFiles::path(std::uint64_t file) const { return path_of(folder_, file); }

bool StateFiles::poll() {
  if (!writing_.valid()) return true;
  if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Written written = writing_.get();
  if (written.problem.empty()) oldest_ = written.oldest;
  problem_ = std::move(written.problem);
  bytes_ = std::move(written.bytes);
  return true;
}

bool StateFiles::keep(
    const std::function<std::optional<std::uint64_t>(std::vector<std::byte>&)>& fill) {
  if (!poll()) return false;
  bytes_.clear();
  const std::optional<std::uint64_t> file = fill(bytes_);
  if (!file) return false;
  writing_ =
      std::async(std::launch::async, [this, file = *file, bytes = std::move(bytes_)]() mutable {
        std::string problem = write_state(folder_, belongs_, file, bytes);
        return Written{oldest_in(folder_), std::move(problem), std::move(bytes)};
      });
  return true;
}

// Touched, too: a page that was never used costs as much as its copying.
void StateFiles::expect(std::size_t bytes) {
  bytes_.resize(bytes);
  bytes_.clear();
}

}  // namespace mpm::live
