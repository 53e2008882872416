#include "idl/qos_match.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/text/printable.hpp"

namespace mpm::idl {
namespace {

std::string seconds(dds_duration_t duration) {
  if (duration == DDS_INFINITY) return "none";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g s", 1e-9 * static_cast<double>(duration));
  return text.data();
}

std::string policy(const char* name, const std::string& offered, const std::string& requested) {
  return std::string(name) + " (" + printable(offered) + " offered, " + printable(requested) +
         " requested)";
}

// Each returns DDS's default where the policy is not set.
dds_reliability_kind_t reliability_of(const dds_qos_t* qos) {
  dds_reliability_kind_t kind = DDS_RELIABILITY_BEST_EFFORT;
  dds_duration_t ignored = 0;
  dds_qget_reliability(qos, &kind, &ignored);
  return kind;
}

dds_durability_kind_t durability_of(const dds_qos_t* qos) {
  dds_durability_kind_t kind = DDS_DURABILITY_VOLATILE;
  dds_qget_durability(qos, &kind);
  return kind;
}

dds_duration_t deadline_of(const dds_qos_t* qos) {
  dds_duration_t deadline = DDS_INFINITY;
  dds_qget_deadline(qos, &deadline);
  return deadline;
}

dds_duration_t latency_budget_of(const dds_qos_t* qos) {
  dds_duration_t budget = 0;
  dds_qget_latency_budget(qos, &budget);
  return budget;
}

dds_ownership_kind_t ownership_of(const dds_qos_t* qos) {
  dds_ownership_kind_t kind = DDS_OWNERSHIP_SHARED;
  dds_qget_ownership(qos, &kind);
  return kind;
}

dds_destination_order_kind_t order_of(const dds_qos_t* qos) {
  dds_destination_order_kind_t kind = DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP;
  dds_qget_destination_order(qos, &kind);
  return kind;
}

struct Liveliness {
  dds_liveliness_kind_t kind = DDS_LIVELINESS_AUTOMATIC;
  dds_duration_t lease = DDS_INFINITY;
};
Liveliness liveliness_of(const dds_qos_t* qos) {
  Liveliness liveliness;
  dds_qget_liveliness(qos, &liveliness.kind, &liveliness.lease);
  return liveliness;
}

struct Presentation {
  dds_presentation_access_scope_kind_t scope = DDS_PRESENTATION_INSTANCE;
  bool coherent = false, ordered = false;
};
Presentation presentation_of(const dds_qos_t* qos) {
  Presentation presentation;
  dds_qget_presentation(qos, &presentation.scope, &presentation.coherent, &presentation.ordered);
  return presentation;
}

std::vector<std::string> partitions_of(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  std::vector<std::string> partitions;
  if (dds_qget_partition(qos, &count, &names)) {
    for (std::uint32_t i = 0; i < count; ++i) {
      partitions.emplace_back(names[i]);
      dds_free(names[i]);
    }
    dds_free(names);
  }
  if (partitions.empty()) partitions.emplace_back();
  return partitions;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

bool any_in_common(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const auto match = [](const std::string& x, const std::string& y) {
    return x == y || fnmatch(x.c_str(), y.c_str(), 0) == 0 || fnmatch(y.c_str(), x.c_str(), 0) == 0;
  };
  return std::any_of(a.begin(), a.end(), [&](const std::string& x) {
    return std::any_of(b.begin(), b.end(), [&](const std::string& y) { return match(x, y); });
  });
}

constexpr std::array kDurability = {"volatile", "transient local", "transient", "persistent"};
constexpr std::array kLiveliness = {"automatic", "manual by participant", "manual by topic"};

const char* ownership_name(dds_ownership_kind_t kind) {
  return kind == DDS_OWNERSHIP_SHARED ? "shared" : "exclusive";
}

}  // namespace

std::vector<std::string> incompatible_policies(const dds_qos_t* offered,
                                               const dds_qos_t* requested) {
  std::vector<std::string> found;
  if (reliability_of(offered) < reliability_of(requested))
    found.push_back(policy("RELIABILITY", "best effort", "reliable"));
  if (const auto o = durability_of(offered), r = durability_of(requested); o < r)
    found.push_back(policy("DURABILITY", kDurability.at(o), kDurability.at(r)));
  if (const auto o = partitions_of(offered), r = partitions_of(requested); !any_in_common(o, r))
    found.push_back(policy("PARTITION", joined(o), joined(r)));
  if (const auto o = deadline_of(offered), r = deadline_of(requested); o > r)
    found.push_back(policy("DEADLINE", seconds(o), seconds(r)));
  if (const auto o = latency_budget_of(offered), r = latency_budget_of(requested); o > r)
    found.push_back(policy("LATENCY_BUDGET", seconds(o), seconds(r)));
  if (const auto o = ownership_of(offered), r = ownership_of(requested); o != r)
    found.push_back(policy("OWNERSHIP", ownership_name(o), ownership_name(r)));
  if (const auto o = liveliness_of(offered), r = liveliness_of(requested);
      o.kind < r.kind || o.lease > r.lease)
    found.push_back(policy("LIVELINESS",
                           kLiveliness.at(o.kind) + std::string(", lease ") + seconds(o.lease),
                           kLiveliness.at(r.kind) + std::string(", lease ") + seconds(r.lease)));
  if (order_of(offered) < order_of(requested))
    found.push_back(policy("DESTINATION_ORDER", "by reception", "by source time"));
  if (const auto o = presentation_of(offered), r = presentation_of(requested);
      o.scope < r.scope || (r.coherent && !o.coherent) || (r.ordered && !o.ordered))
    found.push_back(policy("PRESENTATION", "less", "more"));
  return found;
}

}  // namespace mpm::idl
