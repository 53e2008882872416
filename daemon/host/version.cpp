#include "daemon/host/version.hpp"

#include <Eigen/Core>

#include "idl/version.hpp"

namespace mpm::host {

std::string version_text(const std::string& program) {
  return program + " " MPM_VERSION " (Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
         std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION) +
         ", Cyclone DDS " + idl::cyclone_version() + ")";
}

}  // namespace mpm::host
