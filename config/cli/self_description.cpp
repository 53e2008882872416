#include <iostream>

#include "config/cli/command_tree.hpp"

namespace mpm::cli {

void add_self_description(CLI::App& app, const std::string& version) {
  app.add_flag_callback(
      "--man",
      [&app, version] {
        std::cout << man_page(command_tree(app), version);
        throw CLI::Success();
      },
      "print the manual page, in roff");
  app.add_option_function<std::string>(
         "--completion",
         [&app](const std::string& shell) {
           std::cout << completion(command_tree(app), shell);
           throw CLI::Success();
         },
         "print what a shell needs to complete the command line: bash, zsh or fish")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
}

}  // namespace mpm::cli
