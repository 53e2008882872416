#include "tests/system/disk_image.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPage = 4096;  // bytes, of a file system's cache

ino_t inode_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw std::runtime_error("no " + path.string());
  return status.st_ino;
}

class Cutter {
 public:
  Cutter(std::string disk, Cut cut, std::mt19937_64& random)
      : disk_(std::move(disk)), cut_(cut), random_(random) {}

  void folder(const fs::path& live, const fs::path& image) {
    fs::create_directory(image);
    for (const auto& [name, inode] : names_left(live)) {
      // A folder is the same one as long as it is there at all: none is ever renamed.
      if (fs::is_directory(live / name))
        folder(live / name, image / name);
      else
        write_file((image / name).string(), left_of(inode));
    }
  }

 private:
  using Names = std::map<std::string, ino_t>;

  [[nodiscard]] bool flip() { return random_() % 2 == 0; }
  [[nodiscard]] std::string kept(const char* what, ino_t inode) const {
    return disk_ + "/" + what + "/" + std::to_string(inode);
  }

  [[nodiscard]] Names names_left(const fs::path& live) {
    Names names;
    std::ifstream list(kept("names", inode_of(live)));
    ino_t inode = 0;
    for (std::string name; list >> inode && std::getline(list.ignore(1), name);)
      names[name] = inode;
    if (cut_ == Cut::kNothingMore) return names;
    Names now;
    for (const auto& entry : fs::directory_iterator(live))
      now[entry.path().filename().string()] = inode_of(entry.path());
    for (auto name = names.begin(); name != names.end();)
      name = !now.contains(name->first) && flip() ? names.erase(name) : std::next(name);
    for (const auto& [name, number] : now)
      if (flip()) names[name] = number;
    return names;
  }

  [[nodiscard]] std::string left_of(ino_t inode) {
    const bool synced = fs::exists(kept("synced", inode));
    std::string before = synced ? read_file(kept("synced", inode)) : "";
    if (cut_ == Cut::kNothingMore) return before;
    const std::string now =
        fs::exists(kept("held", inode)) ? read_file(kept("held", inode)) : before;
    const std::size_t least = std::min(before.size(), now.size());
    const std::size_t most = std::max(before.size(), now.size());
    std::string left = before;
    left.resize(least + (most == least ? 0 : random_() % (most - least + 1)), '\0');
    for (std::size_t at = 0; at < left.size(); at += kPage) {
      const std::size_t size = std::min(kPage, left.size() - at);
      if (at < now.size() && flip()) {
        const std::string page = now.substr(at, size);
        left.replace(at, page.size(), page);
      }
    }
    return left;
  }

  std::string disk_;
  Cut cut_;
  std::mt19937_64& random_;
};

}  // namespace

void cut_power(const std::string& folder, const std::string& disk, const std::string& image,
               Cut cut, std::mt19937_64& random) {
  if (fs::exists(image)) throw std::runtime_error(image + " is there already");
  Cutter(disk, cut, random).folder(folder, image);
}

}  // namespace mpm::test
