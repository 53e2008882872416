#include "idl/key_limit.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/text/printable.hpp"

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace mpm::idl {
namespace {

constexpr std::size_t kMostUnits = 4096, kKindsPerUnit = 8, kMostChannels = 100'000;

/// The name, as far as it may be long and one byte more.
std::string_view name_at(const void* sample, std::size_t place) {
  const char* name = static_cast<const char* const*>(sample)[place];
  return name == nullptr ? std::string_view()
                         : std::string_view(name, strnlen(name, kLongestName + 1));
}

/// Cyclone hands the limit over to the thread that receives, under its own lock, which tsan does
/// not see: Debian's library is not instrumented.
void handed_over([[maybe_unused]] void* limit) {
#if defined(__SANITIZE_THREAD__)
  __tsan_release(limit);
#endif
}

void taken_over([[maybe_unused]] void* limit) {
#if defined(__SANITIZE_THREAD__)
  __tsan_acquire(limit);
#endif
}

}  // namespace

KeyLimit::KeyLimit(std::size_t names, UnitChoice* units)
    : names_(names), most_(most(names)), units_(units) {}

KeyLimit::~KeyLimit() { taken_over(this); }

std::size_t KeyLimit::most(std::size_t names) {
  if (names == 1) return kMostUnits;
  return names == 2 ? kMostUnits * kKindsPerUnit : kMostChannels;
}

bool KeyLimit::takes(const void* sample, const dds_sample_info_t& info) {
  if (units_ != nullptr && names_ > 0 &&
      !units_->takes(name_at(sample, 0), info.publication_handle))
    return false;
  bool fits = true;
  for (std::size_t i = 0; i < names_; ++i) fits = fits && name_at(sample, i).size() <= kLongestName;
  if (fits && info.view_state != DDS_VST_NEW) return true;
  const MutexLock lock(mutex_);
  if (fits && (taken_.size() < most_ || taken_.count(info.instance_handle) > 0)) {
    taken_.emplace(info.instance_handle, info.publication_handle);
    return true;
  }
  if (refused_.samples++ == 0 && names_ > 0) refused_.unit = printable(name_at(sample, 0));
  return false;
}

void KeyLimit::make_room(dds_entity_t reader) {
  {
    const MutexLock lock(mutex_);
    if (taken_.size() < most_) return;
  }
  dds_subscription_matched_status_t status{};
  check(dds_get_subscription_matched_status(reader, &status), "matched writers");
  const std::uint64_t left = status.total_count - status.current_count;
  if (left == writers_left_) return;
  writers_left_ = left;
  std::vector<dds_instance_handle_t> there(status.current_count + 64);
  const dds_return_t count = dds_get_matched_publications(reader, there.data(), there.size());
  there.resize(std::min(there.size(), static_cast<std::size_t>(std::max(count, 0))));
  const std::unordered_set<dds_instance_handle_t> writers(there.begin(), there.end());
  const MutexLock lock(mutex_);
  std::erase_if(taken_, [&](const auto& entry) { return writers.count(entry.second) == 0; });
}

std::size_t KeyLimit::longest_key() const {
  constexpr std::size_t kHeader = 16, kAroundName = 8;  // lengths, ends and what aligns them
  if (names_ == 0) return std::numeric_limits<std::size_t>::max();
  return kHeader + names_ * (kLongestName + kAroundName);
}

KeyLimit::Refused KeyLimit::refused() {
  const MutexLock lock(mutex_);
  return std::exchange(refused_, {});
}

Entity topic_with(KeyLimit& limit, const Participant& participant,
                  const dds_topic_descriptor_t& type, const std::string& name) {
  Entity topic(dds_create_topic(participant.get(), &type, name.c_str(), nullptr, nullptr),
               "topic " + name);
  dds_topic_filter filter{};
  filter.mode = DDS_TOPIC_FILTER_SAMPLE_SAMPLEINFO_ARG;
  filter.f.sample_sampleinfo_arg = [](const void* sample, const dds_sample_info_t* info,
                                      void* asked) {
    taken_over(asked);
    const bool takes = static_cast<KeyLimit*>(asked)->takes(sample, *info);
    handed_over(asked);
    return takes;
  };
  filter.arg = &limit;
  handed_over(&limit);
  check(dds_set_topic_filter_extended(topic.get(), &filter), "filter of a topic");
  return topic;
}

}  // namespace mpm::idl
