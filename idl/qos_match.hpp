#pragma once

#include <dds/dds.h>

#include <string>
#include <vector>

namespace mpm::idl {

/// The policies for which a reader that asks for `requested` never meets a writer that offers
/// `offered`, each in words: "RELIABILITY (best effort offered, reliable requested)". Empty where
/// they match. What a QoS does not set counts as DDS's default.
[[nodiscard]] std::vector<std::string> incompatible_policies(const dds_qos_t* offered,
                                                             const dds_qos_t* requested);

}  // namespace mpm::idl
