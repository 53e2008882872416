#include "idl/unit_choice.hpp"

#include <utility>

#include "core/text/printable.hpp"

namespace mpm::idl {
namespace {

constexpr std::size_t kMostRemembered = 8;

}  // namespace

bool UnitChoice::takes(std::string_view unit, std::uint64_t writer) {
  if (units_.find(unit) != units_.end()) return true;
  const MutexLock lock(mutex_);
  ++refused_.samples;
  if (refused_.units.size() < kMostRemembered) refused_.units.emplace(printable(unit), writer);
  return false;
}

UnitChoice::Refused UnitChoice::refused() {
  const MutexLock lock(mutex_);
  return std::exchange(refused_, {});
}

}  // namespace mpm::idl
