#include "tests/cases/recordings.hpp"

#include <cstdlib>
#include <filesystem>

namespace mpm::test {

Recordings::Recordings() {
  const std::string source = MPM_SOURCE_DIR;
  const char* set = std::getenv("MPM_DATA_DIR");
  const std::string folder = set != nullptr ? set : source + "/../shared/data";
  if (!std::filesystem::is_directory(folder)) {
    problem_ = "no recordings in " + folder + "; MPM_DATA_DIR names their folder";
    return;
  }
  const std::string command = "PYTHONDONTWRITEBYTECODE=1 python3 '" + source +
                              "/docs/cases/prepare.py' '" + folder + "' '" + cut_.file("") + "'";
  if (std::system(command.c_str()) != 0) problem_ = "not to be cut: " + command;
}

std::string Recordings::find(const std::string& name) const {
  const std::string file = cut_.file(name + ".csv");
  return std::filesystem::exists(file) ? file : "";
}

std::string Recordings::skipped(const std::string& name) const {
  return "SKIPPED: " + name + ": " + (problem_.empty() ? "not in the folder" : problem_);
}

}  // namespace mpm::test
