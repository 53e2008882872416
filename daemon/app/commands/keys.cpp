#include <ctime>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "daemon/app/commands/commands.hpp"
#include "daemon/files/times/time_text.hpp"
#include "daemon/keys/key_folder.hpp"

namespace mpm::app {
namespace {

constexpr int kBadInput = 3;
constexpr int kMostDays = 3650;

struct KeysOptions {
  std::string folder;
  std::optional<std::string> authority;
  int days = 1095;
};

int run_keys(const KeysOptions& options) {
  try {
    const std::time_t until =
        keys::make_keys(options.folder, options.authority, options.days, std::time(nullptr));
    std::cout << options.folder << ":";
    for (const keys::Role role : keys::kRoles) std::cout << ' ' << to_string(role);
    std::cout << "\nvalid until " << files::formatted_utc(until, "%Y-%m-%dT%H:%M:%SZ") << '\n';
    const std::string authority =
        options.authority.value_or(options.folder + '/' + keys::kAuthorityFolder);
    std::cout << "Who has " << authority
              << "/key.pem may let in anybody: keep that folder off the network.\n"
                 "New ones before these have expired: mpm keys --out NEW --authority "
              << authority << '\n';
    return kDone;
  } catch (const std::invalid_argument& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace

void add_keys(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<KeysOptions>();
  CLI::App* command = app.add_subcommand(
      "keys", "make keys, certificates and permissions for a bus that keeps strangers out");
  command->add_option("-o,--out", options->folder, "folder to make, which must not be there")
      ->required();
  command->add_option("--authority", options->authority,
                      "folder of the authority that vouches for them, as an earlier run made it in "
                      "FOLDER/ca (default: a new one)");
  command
      ->add_option("--days", options->days,
                   "how long they are valid, yet no longer than their authority, ten years")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostDays));
  command->footer(
      "Makes a folder for each part that a program plays: monitor (mpmd), gateway (mpmsim, mpm\n"
      "publish, mpm replay), operator (mpm ack, shelve ...), viewer (all others). A host needs\n"
      "those of its programs only. Programs take them with --security FOLDER or dds: security in\n"
      "the unit file.\n"
      "Examples:\n"
      "  mpm keys --out keys\n"
      "  mpm keys --out keys-2029 --authority keys/ca\n"
      "Exit codes: 0 done, 2 failed, 3 bad usage, or the folder is there");
  command->callback([options, &exit_code] { exit_code = run_keys(*options); });
}

}  // namespace mpm::app
