#pragma once

#include <dds/dds.h>

#include <span>
#include <string>
#include <string_view>

#include "idl/qos.hpp"

namespace mpm::idl {

/// A topic whose type is compiled in.
struct KnownTopic {
  const char* name;                    ///< "mpm/mv" ...
  const dds_topic_descriptor_t* type;  ///< its first member is the key `string unit`
  Qos (*reader_qos)();                 ///< keeps all that comes
  Qos (*writer_qos)(WriterPace pace);  ///< the profile of the topic, for who plays its writer
  bool input;                          ///< one of those that the monitor only reads
};

/// All topics of mpm.idl, the inputs first.
[[nodiscard]] std::span<const KnownTopic> known_topics();
/// mpm/role. It is none of the above: it may be heard, but who played it would speak for a monitor.
[[nodiscard]] const KnownTopic& role_topic();
/// Null for any other topic.
[[nodiscard]] const KnownTopic* find_known_topic(std::string_view name);

/// The IDL of all our types: one text that includes nothing.
[[nodiscard]] std::string_view idl_text();

}  // namespace mpm::idl
