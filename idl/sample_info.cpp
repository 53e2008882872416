#include "idl/sample_info.hpp"

namespace mpm::idl {
namespace {

InstanceState state_of(const dds_sample_info_t& info) {
  switch (info.instance_state) {
    case DDS_IST_NOT_ALIVE_DISPOSED:
      return InstanceState::kDisposed;
    case DDS_IST_NOT_ALIVE_NO_WRITERS:
      return InstanceState::kNoWriters;
    default:
      return InstanceState::kAlive;
  }
}

}  // namespace

SampleInfo info_of(const dds_sample_info_t& info) {
  return {info.source_timestamp, state_of(info), info.valid_data, info.publication_handle};
}

}  // namespace mpm::idl
