#include "daemon/mcap/format/encode.hpp"

namespace mpm::mcap {

// Not inline: GCC 12 then follows lengths it knows into branches never taken, and warns of them.
void Encoder::bytes(ByteView bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }

}  // namespace mpm::mcap
