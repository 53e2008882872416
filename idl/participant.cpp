#include "idl/participant.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>

#include <array>
#include <atomic>
#include <cstdlib>

namespace mpm::idl {
namespace {

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '>':
        xml += "&gt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
}

std::string peer(const std::string& address) {
  return "<Peer address=\"" + escaped(address) + "\"/>";
}

// Processes on this host are reached at the address of the interface they are bound to.
std::vector<std::string> own_addresses(const std::string& interface) {
  std::vector<std::string> addresses;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return addresses;
  for (const ifaddrs* it = list; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != AF_INET) continue;
    if (!interface.empty() && interface != it->ifa_name) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(it->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr)
      addresses.emplace_back(text.data());
  }
  freeifaddrs(list);
  return addresses;
}

const char* xml_bool(bool value) { return value ? "true" : "false"; }

}  // namespace

std::string domain_xml(const DomainOptions& options) {
  std::string xml = "<General>";
  if (!options.interface.empty())
    xml += "<Interfaces><NetworkInterface name=\"" + escaped(options.interface) +
           "\" multicast=\"" + xml_bool(options.multicast) + "\"/></Interfaces>";
  xml += std::string("<AllowMulticast>") + xml_bool(options.multicast) + "</AllowMulticast>";
  xml += "</General><Discovery>";
  // Without an index there are no known ports, and unicast peers never find each other.
  xml += "<ParticipantIndex>auto</ParticipantIndex>";
  xml += "<MaxAutoParticipantIndex>" + std::to_string(options.max_participants) +
         "</MaxAutoParticipantIndex>";
  xml += "<Peers>";
  for (const std::string& address : own_addresses(options.interface)) xml += peer(address);
  for (const std::string& address : options.peers) xml += peer(address);
  xml += "</Peers>";
  if (!options.partition.empty()) xml += "<Tag>" + escaped(options.partition) + "</Tag>";
  xml += "<LeaseDuration>5s</LeaseDuration>";
  xml += "<ExternalDomainId>" + std::to_string(options.domain) + "</ExternalDomainId>";
  // Heartbeats ask for acknowledgements only in a pause of writing this long. By default that is
  // 100 ms: a writer that writes more often keeps its whole history and repairs nothing.
  xml += "</Discovery><Internal>";
  xml += R"(<HeartbeatInterval min="1 ms" minsched="1 ms">1 ms</HeartbeatInterval>)";
  xml += "<Watermarks><WhcHigh>" + std::to_string(options.max_unacknowledged_kb) +
         " kB</WhcHigh></Watermarks>";
  if (options.max_sample_kb > 0)
    xml += "<MaxSampleSize>" + std::to_string(options.max_sample_kb) + " kB</MaxSampleSize>";
  xml += "</Internal>";
  return xml;
}

bool ignores_environment(const DomainOptions& options) {
  return !options.use_environment && std::getenv("CYCLONEDDS_URI") != nullptr;
}

Participant::Participant(const DomainOptions& options) {
  const std::string name = "domain " + std::to_string(options.domain);
  if (options.use_environment && std::getenv("CYCLONEDDS_URI") != nullptr) {
    participant_ = Entity(
        dds_create_participant(static_cast<dds_domainid_t>(options.domain), nullptr, nullptr),
        name + " with CYCLONEDDS_URI");
    return;
  }
  // The id is a handle inside this process only; others see the ExternalDomainId. High enough not
  // to meet a domain that was created the ordinary way.
  static std::atomic<dds_domainid_t> next_id{1000};
  const dds_domainid_t id = next_id++;
  domain_ = Entity(dds_create_domain(id, domain_xml(options).c_str()), "settings of " + name);
  participant_ = Entity(dds_create_participant(id, nullptr, nullptr), "participant in " + name);
}

}  // namespace mpm::idl
