#include "tests/fuzz/exercise_mcap.hpp"

#include <filesystem>
#include <stdexcept>

#include "daemon/bag/info_text.hpp"
#include "daemon/mcap/read/ordered_reader.hpp"
#include "daemon/mcap/read/reader.hpp"
#include "daemon/mcap/recover.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::test {
namespace {

using fuzz::tolerate;

std::uint64_t drain(mcap::MessageSource& source) {
  mcap::Message message;
  std::uint64_t count = 0;
  std::byte touched{0};
  while (source.next(message)) {
    ++count;
    for (const std::byte byte : message.data) touched ^= byte;
  }
  asm volatile("" : : "r"(touched));  // what was read counts as used
  return count;
}

}  // namespace

void exercise_mcap(const std::string& path, const std::string& scratch) {
  std::uint64_t in_file_order = 0, in_time_order = 0;
  const bool whole = tolerate([&] {
    mcap::Reader reader(path);
    in_file_order = drain(reader);
  });
  const bool ordered = tolerate([&] { in_time_order = drain(*mcap::open_messages(path)); });
  if (whole && ordered && in_file_order != in_time_order)
    throw std::logic_error("the readers differ: " + std::to_string(in_file_order) + " and " +
                           std::to_string(in_time_order));
  tolerate([&] { drain(*mcap::open_messages(path, {1'000, 2'000'000'000})); });
  tolerate([&] {
    const bag::FileInfo info = bag::inspect(path);
    static_cast<void>(to_text(info));
    static_cast<void>(to_json(info).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  });
  tolerate([&] {
    const mcap::RecoverReport report = mcap::recover(path, scratch);
    if (whole && report.whole && report.messages != in_file_order)
      throw std::logic_error("mending lost messages");
    mcap::Reader mended(scratch);
    if (drain(mended) != report.messages) throw std::logic_error("the mended file is not whole");
  });
  std::filesystem::remove(scratch);
}

}  // namespace mpm::test
