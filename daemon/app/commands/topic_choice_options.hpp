#pragma once

#include <CLI/CLI.hpp>

#include "daemon/bag/topic_choice.hpp"

namespace mpm::app {

/// Adds --topics, so described, --regex, --exclude-topics and --exclude-regex.
void add_topic_choice(CLI::App& command, bag::TopicChoice& choice, const std::string& description);

}  // namespace mpm::app
