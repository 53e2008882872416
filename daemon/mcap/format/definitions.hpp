#pragma once

#include <map>
#include <string>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// The schemas and channels of a file as far as it was read. Their addresses stay.
class Definitions {
 public:
  /// Takes up the content of a schema or channel record. Returns what is wrong with it, in words:
  /// it is malformed, differs from one with the same id, or all are absurdly large together.
  [[nodiscard]] std::string add_schema(ByteView content);
  [[nodiscard]] std::string add_channel(ByteView content);

  /// Null where there is none.
  [[nodiscard]] const Channel* channel(ChannelId id) const;
  [[nodiscard]] const Schema* schema(SchemaId id) const;
  [[nodiscard]] const std::map<SchemaId, Schema>& schemas() const { return schemas_; }
  [[nodiscard]] const std::map<ChannelId, Channel>& channels() const { return channels_; }

 private:
  [[nodiscard]] bool grows_too_large(std::size_t bytes);

  std::map<SchemaId, Schema> schemas_;
  std::map<ChannelId, Channel> channels_;
  std::size_t bytes_ = 0;
};

}  // namespace mpm::mcap
