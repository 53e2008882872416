#include "idl/version.hpp"

#include <dds/version.h>

#include <Eigen/Core>

namespace mpm::idl {

std::string version_text(const std::string& program) {
  return program + " " MPM_VERSION " (Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
         std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION) +
         ", Cyclone DDS " DDS_VERSION ")";
}

}  // namespace mpm::idl
