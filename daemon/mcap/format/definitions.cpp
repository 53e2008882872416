#include "daemon/mcap/format/definitions.hpp"

#include "daemon/mcap/format/decode.hpp"

namespace mpm::mcap {
namespace {

// Hundreds of the largest schemas known; a packed chunk could hold far more.
constexpr std::size_t kMostDefinitionBytes = 64U << 20U;

template <class Map>
const typename Map::mapped_type* find(const Map& map, std::uint16_t id) {
  const auto found = map.find(id);
  return found == map.end() ? nullptr : &found->second;
}

}  // namespace

bool Definitions::grows_too_large(std::size_t bytes) {
  bytes_ += bytes;
  return bytes_ > kMostDefinitionBytes;
}

std::string Definitions::add_schema(ByteView content) {
  Decoder decode(content);
  Schema schema;
  schema.id = decode.u16();
  schema.name = decode.text();
  schema.encoding = decode.text();
  schema.data = decode.text();
  if (!decode.ok()) return "a malformed schema";
  if (schema.id == 0) return {};  // to be passed over, says the specification
  if (const Schema* known = this->schema(schema.id))
    return *known == schema ? "" : "schema " + std::to_string(schema.id) + " changes";
  if (grows_too_large(content.size())) return "the schemas and channels are absurdly large";
  schemas_.emplace(schema.id, std::move(schema));
  return {};
}

std::string Definitions::add_channel(ByteView content) {
  Decoder decode(content);
  Channel channel;
  channel.id = decode.u16();
  channel.schema_id = decode.u16();
  channel.topic = decode.text();
  channel.message_encoding = decode.text();
  channel.metadata = decode.map();
  if (!decode.ok()) return "a malformed channel";
  if (const Channel* known = this->channel(channel.id))
    return *known == channel ? "" : "channel " + std::to_string(channel.id) + " changes";
  if (grows_too_large(content.size())) return "the schemas and channels are absurdly large";
  channels_.emplace(channel.id, std::move(channel));
  return {};
}

const Channel* Definitions::channel(ChannelId id) const { return find(channels_, id); }
const Schema* Definitions::schema(SchemaId id) const { return find(schemas_, id); }

}  // namespace mpm::mcap
