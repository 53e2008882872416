#include <iostream>
#include <memory>
#include <string>

#include "config/cli/command_tree.hpp"
#include "daemon/app/commands/commands.hpp"
#include "idl/version.hpp"

namespace mpm::app {

void add_completion(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("completion", "print what a shell needs to complete command lines");
  const auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "Examples:\n"
      "  source <(mpm completion bash)\n"
      "  mpm completion bash > /usr/share/bash-completion/completions/mpm\n"
      "  mpm completion zsh > /usr/share/zsh/vendor-completions/_mpm\n"
      "  mpm completion fish > ~/.config/fish/completions/mpm.fish");
  command->callback([&app, shell, &exit_code] {
    std::cout << cli::completion(cli::command_tree(app), *shell);
    exit_code = 0;
  });
}

void add_man(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("man", "print the manual page, in roff");
  command->footer(
      "Examples:\n"
      "  mpm man | man -l -\n"
      "  mpm man > /usr/share/man/man1/mpm.1");
  command->callback([&app, &exit_code] {
    std::cout << cli::man_page(cli::command_tree(app), idl::version_text("mpm"));
    exit_code = 0;
  });
}

}  // namespace mpm::app
