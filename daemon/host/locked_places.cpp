#include "daemon/host/locked_places.hpp"

#include <filesystem>
#include <system_error>
#include <utility>

namespace mpm::host {

LockedPlaces::LockedPlaces(const std::set<std::string>& files) {
  for (const std::string& file : files) places_.push_back({LockFile(file)});
}

std::vector<std::string> LockedPlaces::problems() const {
  std::vector<std::string> all;
  for (const Place& place : places_)
    if (!place.lock.problem().empty()) all.push_back(place.lock.problem());
  return all;
}

std::vector<std::string> LockedPlaces::look() {
  namespace fs = std::filesystem;
  std::vector<std::string> lines;
  for (Place& place : places_) {
    if (place.lock.in_place()) continue;
    const std::string path = place.lock.path();
    std::error_code ignored;  // the lock tells
    fs::create_directories(fs::path(path).parent_path(), ignored);
    LockFile anew(path);
    const bool held = anew.problem().empty();
    if (!place.lost)
      lines.push_back(path +
                      " was removed while this process held it, and what else was removed "
                      "there is lost; " +
                      (held ? "it is made and held anew" : "it cannot be made: " + anew.problem()));
    else if (held)
      lines.push_back(path + " is made and held anew");
    place.lost = !held;
    if (held) place.lock = std::move(anew);
  }
  return lines;
}

}  // namespace mpm::host
