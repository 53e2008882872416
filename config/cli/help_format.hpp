#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace mpm::cli {

/// Help whose descriptions fit a terminal of 80 columns. For an app before its subcommands are
/// added.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;

 private:
  [[nodiscard]] std::string wrapped(const std::string& text) const;
};

}  // namespace mpm::cli
