#include "sim/output/result_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace mpm::sim {
namespace {
namespace fs = std::filesystem;

/// Links too, but to what the process has open already, whatever that is.
bool names_descriptor(const std::string& path) {
  constexpr const char* kNames[] = {"/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/self/fd/"};
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [&](const char* name) { return path.starts_with(name); });
}

bool is_device(const std::string& path) {
  std::error_code ignored;
  return names_descriptor(path) || fs::is_other(path, ignored);
}

}  // namespace

ResultFile::ResultFile(const std::string& path) : path_(path) {
  if (path == "-") {
    path_ = "standard output";
    out_ = &std::cout;
  } else if (is_device(path)) {
    device_.open(path, std::ios::binary);
    if (!device_)
      throw std::runtime_error(path + ": cannot be written to: " + std::strerror(errno));
    out_ = &device_;
  } else {
    out_ = &file_.emplace(path).stream();
  }
}

void ResultFile::commit() {
  if (!out_->flush())
    throw std::runtime_error(path_ + ": cannot be written to: " + std::strerror(errno));
  if (file_) file_->commit();
}

}  // namespace mpm::sim
