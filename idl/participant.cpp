#include "idl/participant.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "idl/narrow_bind.hpp"

namespace mpm::idl {
namespace {

constexpr dds_domainid_t kHighestDomain = 230;  // of UDP

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
std::vector<in_addr> own_addresses(const std::string& interface) {
  std::vector<in_addr> addresses;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return addresses;
  for (const ifaddrs* it = list; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != AF_INET) continue;
    if (!interface.empty() && interface != it->ifa_name) continue;
    addresses.push_back(reinterpret_cast<const sockaddr_in*>(it->ifa_addr)->sin_addr);
  }
  freeifaddrs(list);
  return addresses;
}

std::string text_of(in_addr address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &address, text.data(), text.size()) == nullptr ? "" : text.data();
}

// Where an interface has several addresses Cyclone takes the first, and so may the socket; without
// an interface it is Cyclone's choice which one it tells the others.
in_addr address_to_listen_on(const std::string& interface) {
  const std::vector<in_addr> addresses = own_addresses(interface);
  return interface.empty() || addresses.empty() ? in_addr{INADDR_ANY} : addresses.front();
}

const char* xml_bool(bool value) { return value ? "true" : "false"; }

// DDS Security with the plugins of Cyclone, and the files of one folder.
std::string security_xml(const std::string& folder) {
  const auto file = [&folder](const char* element, const char* name) {
    return std::string("<") + element + ">file:" + escaped(folder) + "/" + name + "</" + element +
           ">";
  };
  const auto library = [](const char* name, const char* function) {
    return std::string("<Library path=\"dds_security_") + name + "\" initFunction=\"init_" +
           function + "\" finalizeFunction=\"finalize_" + function + "\"/>";
  };
  return "<Security><Authentication>" + library("auth", "authentication") +
         file("IdentityCA", "ca.pem") + file("IdentityCertificate", "certificate.pem") +
         file("PrivateKey", "key.pem") + "</Authentication><Cryptographic>" +
         library("crypto", "crypto") + "</Cryptographic><AccessControl>" +
         library("ac", "access_control") + file("PermissionsCA", "ca.pem") +
         file("Governance", "governance.p7s") + file("Permissions", "permissions.p7s") +
         "</AccessControl></Security>";
}

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
  for (const in_addr address : own_addresses(options.interface)) xml += peer(text_of(address));
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
  if (!options.security.empty()) xml += security_xml(options.security + "/" + options.role);
  return xml;
}

bool ignores_environment(const DomainOptions& options) {
  return !options.use_environment && std::getenv("CYCLONEDDS_URI") != nullptr;
}

namespace {

// Cyclone's own message names no file.
void check_keys(const DomainOptions& options) {
  for (const char* name :
       {"ca.pem", "certificate.pem", "key.pem", "governance.p7s", "permissions.p7s"}) {
    const std::string path = options.security + "/" + options.role + "/" + name;
    if (access(path.c_str(), R_OK) != 0)
      throw std::runtime_error("keys of the " + options.role + ": " + path + ": " +
                               std::strerror(errno));
  }
}

}  // namespace

Participant::Participant(const DomainOptions& options) {
  const std::string name = "domain " + std::to_string(options.domain);
  if (options.use_environment && std::getenv("CYCLONEDDS_URI") != nullptr) {
    participant_ = Entity(
        dds_create_participant(static_cast<dds_domainid_t>(options.domain), nullptr, nullptr),
        name + " with CYCLONEDDS_URI");
    return;
  }
  // The id is a handle inside this process only; others see the ExternalDomainId. Permissions know
  // none beyond these. From above, not to meet a domain that was created the ordinary way.
  if (!options.security.empty()) check_keys(options);
  const std::string xml = domain_xml(options);
  const NarrowBind narrow(address_to_listen_on(options.interface));
  dds_domainid_t id = kHighestDomain;
  dds_entity_t domain = dds_create_domain(id, xml.c_str());
  while (domain == DDS_RETCODE_PRECONDITION_NOT_MET && id > 0)  // taken
    domain = dds_create_domain(--id, xml.c_str());
  domain_ = Entity(domain, "settings of " + name);
  participant_ = Entity(dds_create_participant(id, nullptr, nullptr), "participant in " + name);
}

}  // namespace mpm::idl
