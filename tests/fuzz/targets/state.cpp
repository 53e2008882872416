#include <cstring>
#include <optional>

#include "tests/daemon/live/interrupted_unit.hpp"
#include "tests/fuzz/small_unit.hpp"
#include "tests/fuzz/targets.hpp"

namespace mpm::fuzz {
namespace {

constexpr int kBefore = 260, kAfter = 40;  // samples; the memory is full by then
constexpr std::size_t kEdit = 12;          // bytes: where, and what

struct Genuine {
  Genuine() : frames(test::frames_of(ordeal)) {
    test::OneUnit unit(ordeal.config);
    for (int k = 0; k < kBefore; ++k) unit.take(ordeal, frames, k);
    bytes = unit.put_away();
  }
  test::Ordeal ordeal{.name = "fuzz",
                      .config = small_unit(),
                      .samples = kBefore + kAfter,
                      .change_from = 150,
                      .change_until = kBefore + kAfter,
                      .troubles = true};
  std::vector<Frame> frames;
  std::vector<std::byte> bytes;
};

}  // namespace

// Edits of a genuine state: a file that is one from its first byte to its last would have to be
// learnt first.
void state(std::string_view bytes) {
  static const Genuine genuine;
  std::vector<std::byte> damaged = genuine.bytes;
  for (; bytes.size() >= kEdit; bytes.remove_prefix(kEdit)) {
    std::uint32_t place = 0;
    std::memcpy(&place, bytes.data(), sizeof place);
    place %= static_cast<std::uint32_t>(damaged.size() - sizeof(std::uint64_t));
    std::memcpy(&damaged[place], bytes.data() + sizeof place, sizeof(std::uint64_t));
  }
  test::OneUnit unit(genuine.ordeal.config);
  try {
    unit.take_back(damaged);
  } catch (const std::runtime_error&) {  // the state before, or the samples, are taken instead
    return;
  }
  // May be wrong, but not broken.
  static_cast<void>(unit.all());
  for (int k = kBefore; k < kBefore + kAfter; ++k) unit.take(genuine.ordeal, genuine.frames, k);
  static_cast<void>(unit.put_away());
}

}  // namespace mpm::fuzz
