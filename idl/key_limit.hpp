#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "core/parallel/mutex.hpp"
#include "idl/entity.hpp"
#include "idl/participant.hpp"
#include "idl/unit_choice.hpp"

namespace mpm::idl {

/// Of how many instances a reader keeps the keys, and how long the names in these may be. Cyclone
/// keeps the key of every instance that anybody writes until its writers have left, and a limit of
/// its own would have reliable writers wait. So what is beyond is counted and gone before it is
/// kept. Asked by Cyclone's threads, hence locked.
class KeyLimit {
 public:
  /// Samples that were not taken.
  struct Refused {
    std::uint64_t samples = 0;
    std::string unit;  ///< printable, of the first one
  };

  /// `names`: so many members the type begins with, all strings, and these are its key.
  /// `units`: of which samples are taken; null: of all.
  KeyLimit(std::size_t names, UnitChoice* units);
  ~KeyLimit();
  KeyLimit(const KeyLimit&) = delete;
  KeyLimit& operator=(const KeyLimit&) = delete;
  KeyLimit(KeyLimit&&) = delete;
  KeyLimit& operator=(KeyLimit&&) = delete;
  /// As many instances as no plant has, given how many names make one.
  [[nodiscard]] static std::size_t most(std::size_t names);

  /// False, and remembered, where the sample is of an instance too many or has too long a name.
  [[nodiscard]] bool takes(const void* sample, const dds_sample_info_t& info);
  /// Makes room, where there is none left, of what writers had that have left `reader`.
  void make_room(dds_entity_t reader);
  /// Bytes that the key of an instance may have as CDR.
  [[nodiscard]] std::size_t longest_key() const;
  /// What was refused since the last call.
  [[nodiscard]] Refused refused();

 private:
  const std::size_t names_, most_;
  UnitChoice* const units_;
  std::uint64_t writers_left_ = 0;  // of the thread that takes
  Mutex mutex_;
  // Instance to the writer that it came from first.
  std::unordered_map<dds_instance_handle_t, dds_instance_handle_t> taken_ MPM_GUARDED_BY(mutex_);
  Refused refused_ MPM_GUARDED_BY(mutex_);
};

/// A topic whose readers ask `limit`, which must outlive them.
[[nodiscard]] Entity topic_with(KeyLimit& limit, const Participant& participant,
                                const dds_topic_descriptor_t& type, const std::string& name);

}  // namespace mpm::idl
