#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/finding.hpp"
#include "config/place.hpp"
#include "config/range.hpp"

/// Reading YAML with places: every value knows where it stands, whoever reads it writes what is
/// wrong into one list, and reading goes on. Private to this room.
namespace mpm::config {

/// The findings of one file.
class Report {
 public:
  explicit Report(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  /// The file's content, for places within a scalar.
  void set_text(std::string text) { text_ = std::move(text); }
  /// Where byte `offset` of the scalar that begins at `start` stands in the file: quotes, escapes
  /// and folds are stepped over.
  [[nodiscard]] YAML::Mark mark_in(const YAML::Mark& start, std::string_view scalar,
                                   std::size_t offset) const;
  void add(Severity severity, const YAML::Mark& mark, std::string key, std::string message);
  [[nodiscard]] bool has_error() const;
  /// Sorted by place, one per place and message.
  [[nodiscard]] std::vector<Finding> take();

 private:
  std::string file_;
  std::string text_;
  std::vector<Finding> findings_;
};

class Map;

/// A number with an optional unit behind it, such as `3 samples`.
struct Quantity {
  double number = 0.0;
  std::string unit;  ///< empty = none given
};

/// A node of the document with its path. Methods that return optional have reported what is wrong
/// when they return nothing.
class Value {
 public:
  Value(const YAML::Node& node, YAML::Mark mark, std::string path, Report& report)
      : node_(node), mark_(mark), path_(std::move(path)), report_(&report) {}

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& file() const { return report_->file(); }
  /// Line and column of the file, from 1.
  [[nodiscard]] int line() const { return mark_.line + 1; }
  [[nodiscard]] int column() const { return mark_.column + 1; }
  [[nodiscard]] Place where() const { return {file(), line(), column(), path_}; }
  [[nodiscard]] bool is_null() const { return node_.IsNull(); }
  [[nodiscard]] bool is_scalar() const { return node_.IsScalar(); }
  [[nodiscard]] bool is_map() const { return node_.IsMap(); }
  /// True for a map in which one of `keys` occurs.
  [[nodiscard]] bool has_any_key(const std::vector<std::string>& keys) const;

  [[nodiscard]] std::optional<double> number(const Range& range = kAny) const;
  [[nodiscard]] std::optional<int> integer(const Range& range = kAny) const;
  /// A number, or one followed by one of `units`.
  [[nodiscard]] std::optional<Quantity> quantity(const std::vector<std::string>& units,
                                                 const Range& range = kAny) const;
  [[nodiscard]] std::optional<bool> boolean() const;
  /// Not empty, printable, at most `longest` bytes.
  [[nodiscard]] std::optional<std::string> text(std::size_t longest = 1000) const;
  /// As `text`, but may be empty.
  [[nodiscard]] std::optional<std::string> free_text() const;
  /// The items of a list; anything else counts as a list of one.
  [[nodiscard]] std::vector<Value> items() const;
  [[nodiscard]] std::vector<double> numbers(const Range& range = kAny) const;
  /// A map in which only `known` keys may occur; empty where the value is none. `noun` says in
  /// messages what a key is.
  [[nodiscard]] Map map(const std::vector<std::string>& known, std::string_view noun = "key") const;
  /// A map whose keys are the user's own words.
  [[nodiscard]] Map map_of_any() const;

  void error(std::string message) const;
  /// Of a text: at one of its bytes.
  void error_at(std::size_t offset, std::string message) const;
  void warning(std::string message) const;

 private:
  [[nodiscard]] std::string kind() const;
  /// `known` null: any key.
  [[nodiscard]] Map read_map(const std::vector<std::string>* known, std::string_view noun) const;

  YAML::Node node_;
  YAML::Mark mark_;
  std::string path_;
  Report* report_;
};

/// Keys of a map in file order; unknown and repeated ones are reported and left out.
class Map {
 public:
  struct Entry {
    std::string key;
    Value key_at;  ///< the key's own place
    Value value;
  };

  Map(const Value& place, std::vector<Entry> entries)
      : place_(place), entries_(std::move(entries)) {}

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] const Value* find(std::string_view key) const;
  /// As `find`, and reports a key that is not there.
  [[nodiscard]] const Value* require(std::string_view key) const;
  [[nodiscard]] const Entry* entry(std::string_view key) const;
  [[nodiscard]] const Value& place() const { return place_; }

 private:
  Value place_;
  std::vector<Entry> entries_;
};

/// The document's root, or nothing where the text is no YAML; what is wrong goes to the report.
[[nodiscard]] std::optional<Value> parse_yaml(const std::string& text, Report& report);

/// Content of a file; reports why it cannot be read.
[[nodiscard]] std::optional<std::string> read_text_file(const std::string& path, Report& report);

}  // namespace mpm::config
