#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mpm::report {

/// The simulator could not be run; what() is for the user.
class SimulatorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The `mpmsim` that lies beside this program; a program of its own, so that no simulated plant
/// gets into what runs at a real one. Throws SimulatorError where there is none.
[[nodiscard]] std::string find_mpmsim();

/// Runs it to its end and throws SimulatorError if it fails, takes longer than `limit`, or
/// `stopped` says so meanwhile.
void run_mpmsim(const std::string& program, const std::vector<std::string>& arguments,
                std::chrono::seconds limit, const std::function<bool()>& stopped);

}  // namespace mpm::report
