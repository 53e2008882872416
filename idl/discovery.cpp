#include "idl/discovery.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

namespace mpm::idl {
namespace {

constexpr std::uint32_t kMost = 16384;  // endpoints; Cyclone itself ends there
constexpr dds_duration_t kPatience = DDS_SECS(1);

/// What a builtin reader holds, lent and given back.
class Loan {
 public:
  explicit Loan(dds_entity_t reader) : reader_(reader), samples_(kMost), infos_(kMost) {
    count_ = dds_read(reader_, samples_.data(), infos_.data(), kMost, kMost);
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;
  ~Loan() {
    if (count_ > 0) dds_return_loan(reader_, samples_.data(), count_);
  }
  template <class Callback>
  void for_each(Callback&& on_endpoint) const {
    for (std::size_t i = 0; static_cast<dds_return_t>(i) < count_; ++i)
      if (infos_[i].valid_data && infos_[i].instance_state == DDS_IST_ALIVE)
        on_endpoint(*static_cast<const dds_builtintopic_endpoint_t*>(samples_[i]));
  }

 private:
  dds_entity_t reader_;
  std::vector<void*> samples_;
  std::vector<dds_sample_info_t> infos_;
  dds_return_t count_;
};

}  // namespace

Discovery::Discovery(const Participant& participant)
    : participant_(participant.get()),
      publications_(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
          "reader of publications"),
      subscriptions_(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr),
          "reader of subscriptions") {}

void Discovery::add(const Entity& reader, bool writers, std::vector<Endpoint>& endpoints) const {
  dds_guid_t own{};
  check(dds_get_guid(participant_, &own), "own identity");
  Loan(reader.get()).for_each([&](const dds_builtintopic_endpoint_t& endpoint) {
    if (std::memcmp(&endpoint.participant_key, &own, sizeof own) != 0)
      endpoints.push_back({endpoint.topic_name, endpoint.type_name, writers});
  });
}

std::vector<Endpoint> Discovery::endpoints() const {
  std::vector<Endpoint> endpoints;
  add(publications_, true, endpoints);
  add(subscriptions_, false, endpoints);
  std::sort(endpoints.begin(), endpoints.end(), [](const Endpoint& a, const Endpoint& b) {
    return std::tie(a.topic, a.type, b.writer) < std::tie(b.topic, b.type, a.writer);
  });
  return endpoints;
}

DiscoveredType Discovery::type_of(const std::string& topic) const {
  DiscoveredType type;
  Loan(publications_.get()).for_each([&](const dds_builtintopic_endpoint_t& endpoint) {
    if (type || topic != endpoint.topic_name) return;
    // Cyclone's calls are not const here.
    auto* lent = const_cast<dds_builtintopic_endpoint_t*>(&endpoint);
    const dds_typeinfo_t* info = nullptr;
    if (dds_builtintopic_get_endpoint_type_info(lent, &info) != DDS_RETCODE_OK || info == nullptr)
      return;
    dds_topic_descriptor_t* found = nullptr;
    // Where it fails, `found` may point to what is freed already.
    if (dds_create_topic_descriptor(DDS_FIND_SCOPE_GLOBAL, participant_, info, kPatience, &found) ==
        DDS_RETCODE_OK)
      type.reset(found);
  });
  return type;
}

}  // namespace mpm::idl
