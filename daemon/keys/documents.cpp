#include "daemon/keys/documents.hpp"

#include <array>

namespace mpm::keys {
namespace {

// All that there are on UDP. A narrower choice would mean nothing here: each of our participants
// has a Cyclone domain with a number of its own, which is the one that Cyclone asks for.
constexpr const char* kAllDomains =
    "<domains><id_range><min>0</min><max>230</max></id_range></domains>";

constexpr const char* kHead =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
    "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n";

std::string date(std::time_t time) {
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::array<char, 32> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::string grant(const char* verb, const std::vector<std::string_view>& topics) {
  if (topics.empty()) return "";
  std::string xml = std::string("    <") + verb + "><topics>\n";
  for (const std::string_view topic : topics)
    xml += "      <topic>" + std::string(topic) + "</topic>\n";
  return xml + "    </topics><partitions><partition>*</partition></partitions></" + verb + ">\n";
}

}  // namespace

std::string governance_xml() {
  return std::string(kHead) + "<domain_access_rules><domain_rule>\n  " + kAllDomains + R"(
  <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
  <enable_join_access_control>true</enable_join_access_control>
  <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
  <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
  <rtps_protection_kind>SIGN</rtps_protection_kind>
  <topic_access_rules><topic_rule>
    <topic_expression>*</topic_expression>
    <enable_discovery_protection>true</enable_discovery_protection>
    <enable_liveliness_protection>true</enable_liveliness_protection>
    <enable_read_access_control>true</enable_read_access_control>
    <enable_write_access_control>true</enable_write_access_control>
    <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
    <data_protection_kind>NONE</data_protection_kind>
  </topic_rule></topic_access_rules>
</domain_rule></domain_access_rules>
</dds>
)";
}

std::string permissions_xml(const Permissions& role, const std::string& subject,
                            const Validity& validity) {
  return std::string(kHead) + "<permissions><grant name=\"" + subject + "\">\n  <subject_name>" +
         subject + "</subject_name>\n  <validity><not_before>" + date(validity.from) +
         "</not_before><not_after>" + date(validity.until) +
         "</not_after></validity>\n  <allow_rule>\n    " + kAllDomains + "\n" +
         grant("publish", role.writes) + grant("subscribe", role.reads) +
         "  </allow_rule>\n  <default>DENY</default>\n</grant></permissions>\n</dds>\n";
}

}  // namespace mpm::keys
