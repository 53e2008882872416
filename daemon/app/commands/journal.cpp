#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/journal_place.hpp"
#include "daemon/history/entry_text.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::app {
namespace {

constexpr int kFound = 1;

struct JournalOptions {
  JournalPlace place;
  std::string form;
  bool verify = false;
};

int verify(const history::AlarmStore& store, const std::string& file) {
  const history::StoreCheck check = store.verify();
  if (check.problem.empty()) {
    std::cout << file << ": " << check.entries << " entries, whole and as they were written\n";
    return kDone;
  }
  std::cout << file << ": " << check.problem << '\n';
  return kFound;
}

int journal(const JournalOptions& options) {
  try {
    const history::AlarmStore store(options.place.file, history::AlarmStore::Access::kRead);
    if (options.verify) return verify(store, options.place.file);
    if (options.form == "csv") std::cout << history::entry_csv_head() << '\n';
    store.each(query_of(options.place), [&](const history::AlarmEntry& entry) {
      if (options.form == "csv")
        std::cout << history::entry_csv(entry) << '\n';
      else if (options.form == "json")
        std::cout << report::json_text(history::entry_json(entry)) << '\n';
      else
        std::cout << history::entry_text(entry) << '\n';
    });
    return kDone;
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace

void add_journal(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("journal", "what happened to alarms, and what people did about them");
  const auto options = std::make_shared<JournalOptions>();
  add_journal_place(*command, options->place);
  CLI::Option* form =
      command->add_option("--export", options->form, "csv, or json: one object a line")
          ->check(CLI::IsMember({"csv", "json"}));
  command
      ->add_flag("--verify", options->verify,
                 "look for damage, and for entries that were changed or taken out")
      ->excludes(form);
  command->footer(
      "Examples:\n  mpm journal --since 8h\n"
      "  mpm journal --journal /var/lib/mpm/alarms.sqlite --cv TIC-101 --export csv > shift.csv\n"
      "Exit codes: 0 done, 1 --verify found something, 2 failed, 3 bad usage");
  command->callback([options, &exit_code] { exit_code = journal(*options); });
}

}  // namespace mpm::app
