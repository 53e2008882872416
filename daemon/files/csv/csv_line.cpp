#include "daemon/files/csv/csv_line.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include "config/failure_text.hpp"
#include "config/finding.hpp"
#include "core/text/utf8.hpp"

namespace mpm::files {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kLongestLine = std::size_t{4} << 20U;  // names of some 100 000 signals

constexpr int kMostLinesOfCell = 20;  // else a quote stands there by mistake

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// Where a cell begins with a quote that nothing closes, whatever parts the cells; npos if none
/// does.
std::size_t open_quote(std::string_view line) {
  constexpr std::string_view kDelimiters = ",;\t|";
  if (line.find('"') == std::string_view::npos) return std::string_view::npos;
  bool begins = true;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (begins && line[i] == '"') {
      const std::size_t open = i;
      do {
        i = line.find('"', i + 1);
        if (i == std::string_view::npos) return open;
      } while (i + 1 < line.size() && line[i + 1] == '"' && ++i != 0);
      begins = false;
    } else {
      begins = kDelimiters.find(line[i]) != std::string_view::npos || (begins && is_blank(line[i]));
    }
  }
  return std::string_view::npos;
}

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw config::InputError({path, 0, 0, config::Severity::kError, "", message});
}

}  // namespace

std::unique_ptr<std::istream> open_file(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) fail(path, "no such file");
  if (std::filesystem::is_directory(status)) fail(path, "is a folder, not a file");
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*file) fail(path, "cannot be read: " + config::failure_text(errno));
  return file;
}

std::unique_ptr<std::istream> open_regular_file(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_other(path, failure)) fail(path, "is no regular file");
  return open_file(path);
}

LineReader::LineReader(std::unique_ptr<std::istream> input, std::string name)
    : input_(std::move(input)), name_(std::move(name)) {}

bool LineReader::read_line() {
  if (std::exchange(too_long_, false))
    input_->ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  ++lines_read_;
  line_.clear();
  while (true) {
    input_->getline(piece_.data(), piece_.size());
    // Else the rest of the file would be missing without a word.
    if (input_->bad()) fail(lines_read_, 1, "cannot be read: " + config::failure_text(errno));
    const auto count = static_cast<std::size_t>(input_->gcount());
    complete_ = !input_->eof();
    bytes_read_ += count;
    const bool goes_on = complete_ && input_->fail() && count + 1 == piece_.size();
    line_.append(piece_.data(), complete_ && !goes_on && count > 0 ? count - 1 : count);
    if (!goes_on) return complete_ ? !input_->fail() : !line_.empty();
    input_->clear();
    too_long_ = line_.size() > kLongestLine;
    if (too_long_) fail(lines_read_, 1, "a line of more than 4 MiB");
  }
}

bool LineReader::next() {
  while (read_line()) {
    number_ = lines_read_;
    if (number_ == 1) {
      if (line_.size() > 1 &&
          (line_.substr(0, 2) == "\xFF\xFE" || line_.substr(0, 2) == "\xFE\xFF"))
        fail(1, "is UTF-16 text; save it as UTF-8");
      if (line_.find('\r') + 1 < line_.size() && line_.find('\r') != std::string::npos)
        fail(1, "its lines end with a carriage return alone; save it with line feeds");
      if (line_.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0)
        line_.erase(0, kByteOrderMark.size());
    }
    check_text();
    std::size_t first = 0;
    while (first < line_.size() && is_blank(line_[first])) ++first;
    if (first < line_.size() && line_[first] != '#') {
      if (joins_) close_quote();
      return true;
    }
  }
  number_ = lines_read_;
  return false;
}

void LineReader::check_text() {
  if (line_.find('\0') != std::string::npos) fail(1, "is no text file: it holds a zero byte");
  latin1_ = latin1_ || find_invalid_utf8(line_) != std::string::npos;
  if (latin1_) line_ = utf8_from_latin1(line_);
  make_blanks_plain(line_);
}

void LineReader::close_quote() {
  std::size_t open = open_quote(line_);
  if (open == std::string::npos) return;
  std::string whole = std::exchange(line_, {});
  for (int more = 0; open != std::string::npos; ++more) {
    if (more == kMostLinesOfCell || !read_line())
      fail(static_cast<int>(open) + 1, "a quote is not closed");
    check_text();
    while (!whole.empty() && whole.back() == '\r') whole.pop_back();
    whole.append(" ").append(line_);
    open = open_quote(whole);
  }
  line_ = std::move(whole);
}

void LineReader::split(char delimiter, std::vector<Cell>& cells) {
  cells.clear();
  while (!line_.empty() && line_.back() == '\r') line_.pop_back();
  std::size_t at = 0;
  while (true) {
    const auto skip = [&] {
      while (at < line_.size() && is_blank(line_[at]) && line_[at] != delimiter) ++at;
    };
    skip();
    const std::size_t begin = at;
    std::size_t end;  // set either way below
    if (at < line_.size() && line_[at] == '"') {
      end = ++at;  // doubled quotes shrink to one in place
      while (true) {
        if (at >= line_.size()) fail(static_cast<int>(begin) + 1, "a quote is not closed");
        if (line_[at] == '"' && !(at + 1 < line_.size() && line_[at + 1] == '"')) break;
        if (line_[at] == '"') ++at;
        line_[end++] = line_[at++];
      }
      ++at;
      skip();
      if (at < line_.size() && line_[at] != delimiter)
        fail(static_cast<int>(at) + 1, "text after a closing quote");
      cells.push_back({std::string_view(line_).substr(begin + 1, end - begin - 1),
                       static_cast<int>(begin) + 1});
    } else {
      while (at < line_.size() && line_[at] != delimiter) ++at;
      end = at;
      while (end > begin && is_blank(line_[end - 1])) --end;
      cells.push_back(
          {std::string_view(line_).substr(begin, end - begin), static_cast<int>(begin) + 1});
    }
    if (at >= line_.size()) return;
    ++at;
  }
}

void LineReader::rewind() {
  input_->clear();
  input_->seekg(0);
  number_ = lines_read_ = 0;
  bytes_read_ = 0;
  too_long_ = false;
}

std::optional<std::string> LineReader::take_notice() {
  if (!latin1_ || std::exchange(told_, true)) return std::nullopt;
  return "is no UTF-8; it is read as ISO 8859-1";
}

void LineReader::fail(int column, const std::string& message) const {
  fail(number_, column, message);
}

void LineReader::fail(int line, int column, const std::string& message) const {
  throw config::InputError({name_, line, column, config::Severity::kError, "", message});
}

char find_delimiter(std::string_view header) {
  char best = header.find('|') == std::string_view::npos ? ',' : '|';
  std::size_t most = 0;
  for (const char candidate : {',', ';', '\t'}) {
    std::size_t count = 0;
    bool quoted = false;
    for (const char c : header) {
      quoted ^= c == '"';
      count += !quoted && c == candidate;
    }
    if (count > most) {
      most = count;
      best = candidate;
    }
  }
  return best;
}

}  // namespace mpm::files
