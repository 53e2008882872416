#include "idl/discovery.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <tuple>

#include "core/text/printable.hpp"
#include "idl/qos_match.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::idl {
namespace {

constexpr std::uint32_t kMost = 16384;  // endpoints; Cyclone itself ends there
constexpr dds_duration_t kPatience = DDS_SECS(1);

/// What a builtin reader holds, lent and given back.
template <class Sample>
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
  void for_each(Callback&& on_sample) const {
    for (std::size_t i = 0; static_cast<dds_return_t>(i) < count_; ++i)
      if (infos_[i].valid_data && infos_[i].instance_state == DDS_IST_ALIVE)
        on_sample(*static_cast<const Sample*>(samples_[i]), infos_[i].instance_handle);
  }

 private:
  dds_entity_t reader_;
  std::vector<void*> samples_;
  std::vector<dds_sample_info_t> infos_;
  dds_return_t count_;
};

using EndpointLoan = Loan<dds_builtintopic_endpoint_t>;
using Guid = std::array<std::uint8_t, sizeof(dds_guid_t)>;

Guid bytes_of(const dds_guid_t& guid) {
  Guid bytes{};
  std::memcpy(bytes.data(), &guid, sizeof guid);
  return bytes;
}

std::string property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value) || value == nullptr) return "";
  std::string text = value;
  dds_free(value);
  return text;
}

std::string user_data_of(const dds_qos_t* qos) {
  void* value = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &value, &size) || value == nullptr) return "";
  std::string data(static_cast<const char*>(value), size);
  dds_free(value);
  return data;
}

Process process_of(const dds_builtintopic_participant_t& participant) {
  return {property(participant.qos, "__Hostname"), property(participant.qos, "__ProcessName"),
          property(participant.qos, "__Pid")};
}

std::vector<std::string> mismatch_of(const dds_builtintopic_endpoint_t& endpoint, bool writer) {
  const KnownTopic* topic = find_known_topic(endpoint.topic_name);
  if (topic == nullptr) return {};
  if (std::strcmp(endpoint.type_name, topic->type->m_typename) != 0)
    return {"type " + printable(endpoint.type_name) + " where the topic has " +
            topic->type->m_typename};
  if (writer) return incompatible_policies(endpoint.qos, topic->reader_qos().get());
  // Nobody knows what the writer of an input offers.
  if (topic->input) return {};
  return incompatible_policies(topic->writer_qos(WriterPace::kRealTime).get(), endpoint.qos);
}

}  // namespace

std::string name_of(const Process& process) {
  if (process.program.empty() && process.pid.empty() && process.host.empty())
    return "a process that does not give its name";
  std::string text = process.program.empty() ? "a program" : printable(process.program);
  text += process.pid.empty() ? " (" : " (process " + printable(process.pid) + " ";
  return text + (process.host.empty() ? "on an unknown host)"
                                      : "on host " + printable(process.host) + ")");
}

Discovery::Discovery(const Participant& participant)
    : participant_(participant.get()),
      participants_(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
          "reader of participants"),
      publications_(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
          "reader of publications"),
      subscriptions_(
          dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr),
          "reader of subscriptions") {}

std::vector<Endpoint> Discovery::endpoints() const {
  std::map<Guid, Process> processes;
  Loan<dds_builtintopic_participant_t>(participants_.get())
      .for_each([&](const dds_builtintopic_participant_t& participant, std::uint64_t) {
        processes[bytes_of(participant.key)] = process_of(participant);
      });
  dds_guid_t own{};
  check(dds_get_guid(participant_, &own), "own identity");
  std::vector<Endpoint> endpoints;
  const auto add = [&](const Entity& reader, bool writers) {
    EndpointLoan(reader.get())
        .for_each([&](const dds_builtintopic_endpoint_t& endpoint, std::uint64_t handle) {
          if (std::memcmp(&endpoint.participant_key, &own, sizeof own) == 0) return;
          // Of a process that leaves, its topics go one after the other.
          const auto process = processes.find(bytes_of(endpoint.participant_key));
          if (process == processes.end()) return;
          endpoints.push_back({endpoint.topic_name, endpoint.type_name, writers, handle,
                               process->second, mismatch_of(endpoint, writers),
                               user_data_of(endpoint.qos)});
        });
  };
  add(publications_, true);
  add(subscriptions_, false);
  std::sort(endpoints.begin(), endpoints.end(), [](const Endpoint& a, const Endpoint& b) {
    return std::tie(a.topic, a.type, b.writer) < std::tie(b.topic, b.type, a.writer);
  });
  return endpoints;
}

Process Discovery::own() const {
  dds_guid_t own{};
  check(dds_get_guid(participant_, &own), "own identity");
  Process process;
  Loan<dds_builtintopic_participant_t>(participants_.get())
      .for_each([&](const dds_builtintopic_participant_t& participant, std::uint64_t) {
        if (bytes_of(participant.key) == bytes_of(own)) process = process_of(participant);
      });
  return process;
}

DiscoveredType Discovery::type_of(const std::string& topic) const {
  DiscoveredType type;
  const EndpointLoan publications(publications_.get());
  publications.for_each([&](const dds_builtintopic_endpoint_t& endpoint, std::uint64_t) {
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
