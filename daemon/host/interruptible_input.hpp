#pragma once

#include <array>
#include <functional>
#include <streambuf>

namespace mpm::host {

/// A file descriptor as a stream buffer that ends when told to, even where nothing comes: the
/// signals that stop us are blocked and interrupt no read.
class InterruptibleInput : public std::streambuf {
 public:
  /// `stop` is asked a few times a second while nothing comes.
  InterruptibleInput(int descriptor, std::function<bool()> stop);

 protected:
  int_type underflow() override;

 private:
  int descriptor_;
  std::function<bool()> stop_;
  std::array<char, 65536> bytes_;
};

}  // namespace mpm::host
