#pragma once

#include "idl/output_readers.hpp"

namespace mpm::bus {

/// The same with every text fit for a terminal: it comes from a bus on which anybody may write.
[[nodiscard]] idl::Output printable_output(idl::Output output);

}  // namespace mpm::bus
