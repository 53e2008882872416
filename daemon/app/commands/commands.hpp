#pragma once

#include <CLI/CLI.hpp>
#include <chrono>

/// The commands of `mpm`. Each goes into `app` and leaves its exit code in `exit_code` once it has
/// run.
namespace mpm::app {

/// Exit codes: what was asked for is done; it could not be done.
inline constexpr int kDone = 0, kFailed = 2;

/// So long who publishes waits at the end for readers to have it all.
inline constexpr std::chrono::seconds kFlushTime{10};

/// `mpm detect`: the daemon's own pipeline on a file.
void add_detect(CLI::App& app, int& exit_code);
/// `mpm trend`: how a model fared over months, from data or from a journal.
void add_trend(CLI::App& app, int& exit_code);
/// `mpm diagnose`: what the simulation gets wrong in recorded data, and a model that gets it right.
void add_diagnose(CLI::App& app, int& exit_code);
/// `mpm identify`: a model of a unit from recorded data alone.
void add_identify(CLI::App& app, int& exit_code);
/// `mpm import`: a model from another tool, into a unit file.
void add_import(CLI::App& app, int& exit_code);
/// `mpm info`: what a data file holds.
void add_info(CLI::App& app, int& exit_code);
/// `mpm list`: which recordings lie in a folder.
void add_list(CLI::App& app, int& exit_code);
/// `mpm convert`: recordings and data files into each other.
void add_convert(CLI::App& app, int& exit_code);
/// `mpm recover`: mends a recording whose recorder was killed.
void add_recover(CLI::App& app, int& exit_code);
/// `mpm watch`: what the monitors say, live.
void add_watch(CLI::App& app, int& exit_code);
/// `mpm record`: what goes over the bus, into files.
void add_record(CLI::App& app, int& exit_code);
/// `mpm replay`: recordings back onto the bus.
void add_replay(CLI::App& app, int& exit_code);
/// `mpm publish`: lines on standard input become a unit's samples on DDS.
void add_publish(CLI::App& app, int& exit_code);
/// `mpm topics`: who reads and writes what on the bus.
void add_topics(CLI::App& app, int& exit_code);
/// `mpm echo`: the samples of a topic as text.
void add_echo(CLI::App& app, int& exit_code);
/// `mpm hz` and `mpm delay`: how often samples come, and how old they are.
void add_hz(CLI::App& app, int& exit_code);
void add_delay(CLI::App& app, int& exit_code);
/// `mpm doctor`: what is wrong between gateway, bus and monitor.
void add_doctor(CLI::App& app, int& exit_code);
/// `mpm status`: one line for a monitoring system.
void add_status(CLI::App& app, int& exit_code);
/// `mpm alarms`: which alarms stand; `mpm alarms stats`: how much they asked of people.
void add_alarms(CLI::App& app, int& exit_code);
/// `mpm ack`, `shelve`, `unshelve`, `suppress`, `unsuppress`, `out-of-service`, `in-service`.
void add_alarm_actions(CLI::App& app, int& exit_code);
/// `mpm journal`: what happened to alarms.
void add_journal(CLI::App& app, int& exit_code);
/// `mpm schema`: JSON Schema of unit files.
void add_schema(CLI::App& app, int& exit_code);
/// `mpm keys`: who may take part on a secured bus.
void add_keys(CLI::App& app, int& exit_code);
/// `mpm completion`: what a shell needs to complete command lines. `mpm man`: the manual page. Both
/// tell of the commands that there are when they run.
void add_completion(CLI::App& app, int& exit_code);
void add_man(CLI::App& app, int& exit_code);

}  // namespace mpm::app
