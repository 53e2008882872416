#include "core/identify/causes/catalog.hpp"

#include <algorithm>

namespace mpm::causes {

const std::vector<const Cause*>& all() {
#define MPM_ADDRESS(cause) &cause(),
  static const std::vector<const Cause*> list = {MPM_CAUSES(MPM_ADDRESS)};
#undef MPM_ADDRESS
  return list;
}

const Cause* find(std::string_view name, std::string_view kind) {
  const auto found = std::find_if(all().begin(), all().end(), [&](const Cause* cause) {
    return cause->name().text == name && (kind.empty() || cause->kind() == kind);
  });
  return found == all().end() ? nullptr : *found;
}

bool is_unnamed(const Cause& cause) { return &cause.name() == &unnamed_swing().name(); }

bool is_from_outside(const Subject& subject) {
  const Place& place = subject.place;
  return place.input < 0 && place.aux < 0 &&
         (subject.cause == &noise() || !subject.cause->acts_through_channels());
}

}  // namespace mpm::causes
