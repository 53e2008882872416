#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "daemon/history/alarm_store.hpp"

namespace mpm::app {

/// Where the journal of alarms is, and which of its entries are wanted, as somebody typed it.
struct JournalPlace {
  std::string file;
  std::string since, until;
  std::string unit, mv, cv;
};

/// --journal, --since, --until, --unit, --mv and --cv. The file is by default that of the service.
void add_journal_place(CLI::App& command, JournalPlace& place);
/// Throws std::runtime_error where a time is none.
[[nodiscard]] history::AlarmQuery query_of(const JournalPlace& place);

}  // namespace mpm::app
