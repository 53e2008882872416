#pragma once

#include "sim/loop/closed_loop.hpp"
#include "sim/options.hpp"
#include "sim/output/bad_data.hpp"

namespace mpm::sim {

/// Publishes the run on DDS as a control system would: the layout, then each frame at its time
/// (absolute deadlines on a steady clock), or as fast as reliable readers take them at speed 0.
/// Ends after --samples intervals or on SIGINT or SIGTERM, which must be blocked in every thread
/// (block_stop_signals). Returns the exit code.
[[nodiscard]] int run_dds(const LoopSetup& setup, const Options& options, BadDataFilter& filter);

/// Call before any thread starts.
void block_stop_signals();

}  // namespace mpm::sim
