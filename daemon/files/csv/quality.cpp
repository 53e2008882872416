#include "daemon/files/csv/quality.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/column_names.hpp"

namespace mpm::files {
namespace {

struct Named {
  std::string_view name;
  QualityKind kind;
};

/// As `plain_name` gives them.
constexpr std::array<Named, 33> kColumns = {{
    {"opcquality", QualityKind::kCode},
    {"opcqualitycode", QualityKind::kCode},
    {"quality", QualityKind::kCode},
    {"dataquality", QualityKind::kCode},
    {"qualitycode", QualityKind::kCode},
    {"q", QualityKind::kCode},
    {"qc", QualityKind::kCode},
    {"qual", QualityKind::kCode},
    {"qualit\xC3\xA4t", QualityKind::kCode},
    {"qualitaet", QualityKind::kCode},
    {"qualit\xC3\xA4tscode", QualityKind::kCode},
    {"dataintegrity", QualityKind::kCode},
    {"iptrendqstatus", QualityKind::kCode},
    {"iptrendqlevel", QualityKind::kCode},
    {"qstatus", QualityKind::kCode},
    {"status", QualityKind::kCode},
    {"statuscode", QualityKind::kCode},
    {"parameterstatus", QualityKind::kCode},
    {"collectionstatus", QualityKind::kCode},
    {"qualitydetail", QualityKind::kCode},
    {"good", QualityKind::kGoodFlag},
    {"isgood", QualityKind::kGoodFlag},
    {"validity", QualityKind::kGoodFlag},
    {"valid", QualityKind::kGoodFlag},
    {"isvalid", QualityKind::kGoodFlag},
    {"g\xC3\xBCltig", QualityKind::kGoodFlag},
    {"questionable", QualityKind::kDoubtFlag},
    {"isquestionable", QualityKind::kDoubtFlag},
    {"substituted", QualityKind::kDoubtFlag},
    {"issubstituted", QualityKind::kDoubtFlag},
    {"confidence", QualityKind::kConfidence},
    {"percentgood", QualityKind::kConfidence},
    {"conf", QualityKind::kConfidence},
}};

/// Words that a quality begins with.
constexpr std::array<std::pair<std::string_view, Quality>, 37> kWords = {{
    {"good", Quality::kGood},
    {"ok", Quality::kGood},
    {"true", Quality::kGood},
    {"valid", Quality::kGood},
    {"normal", Quality::kGood},
    {"tag good", Quality::kGood},
    {"gut", Quality::kGood},
    {"g\xC3\xBCltig", Quality::kGood},
    {"uncertain", Quality::kUncertain},
    {"questionable", Quality::kUncertain},
    {"doubtful", Quality::kUncertain},
    {"suspect", Quality::kUncertain},
    {"substitut", Quality::kUncertain},
    {"estimat", Quality::kUncertain},
    {"initial", Quality::kUncertain},
    {"interpolated", Quality::kUncertain},
    {"unsicher", Quality::kUncertain},
    {"fraglich", Quality::kUncertain},
    {"bad", Quality::kBad},
    {"false", Quality::kBad},
    {"invalid", Quality::kBad},
    {"not ", Quality::kBad},
    {"no ", Quality::kBad},
    {"none", Quality::kBad},
    {"null", Quality::kBad},
    {"error", Quality::kBad},
    {"fail", Quality::kBad},
    {"stale", Quality::kBad},
    {"disconnect", Quality::kBad},
    {"comm", Quality::kBad},
    {"i/o timeout", Quality::kBad},
    {"timeout", Quality::kBad},
    {"scan", Quality::kBad},
    {"shutdown", Quality::kBad},
    {"schlecht", Quality::kBad},
    {"ung\xC3\xBCltig", Quality::kBad},
    {"fehler", Quality::kBad},
}};

// AVEVA Historian's.
constexpr std::int64_t kZeroGood = 0, kZeroBad = 1, kZeroDoubtful = 16, kZeroFirst = 133;

constexpr int kHexadecimal = 16;
constexpr double kLargestCode = 4294967295.0;  // 32 bits

constexpr std::int64_t kFullConfidence = 100, kHalfConfidence = 50;

/// OPC DA has bits 6 and 7 of 8 (OPC HDA and vendors put more above them), OPC UA the top two of
/// 32, Ignition 256 and on for uncertain, 300 and on for bad.
Quality quality_of_code(std::int64_t code) {
  if (code < 0) code += std::int64_t{1} << 32;
  if (code < 0) return Quality::kBad;
  if (code >= 0x80000000) return Quality::kBad;
  if (code >= 0x40000000) return Quality::kUncertain;
  if (code >= 300 && code < 1024) return Quality::kBad;
  if (code >= 256 && code < 300) return Quality::kUncertain;
  switch (code & 0xC0) {
    case 0xC0:
      return Quality::kGood;
    case 0x40:
      return Quality::kUncertain;
    default:
      return Quality::kBad;
  }
}

Quality quality_where_zero_is_good(std::int64_t code) {
  if (code == kZeroGood) return Quality::kGood;
  return code == kZeroDoubtful || code == kZeroFirst ? Quality::kUncertain : Quality::kBad;
}

std::optional<Quality> quality_of_word(std::string_view text) {
  for (const auto& [word, quality] : kWords)
    if (same_word(text.substr(0, word.size()), word)) return quality;
  return std::nullopt;
}

std::optional<Quality> quality_of_confidence(std::string_view text) {
  const std::optional<double> percent = parse_value(text, true);
  if (!percent) return std::nullopt;
  if (*percent >= kFullConfidence) return Quality::kGood;
  return *percent >= kHalfConfidence ? Quality::kUncertain : Quality::kBad;
}

}  // namespace

std::optional<QualityKind> quality_kind(std::string_view name) {
  const std::string plain = plain_name(name);
  for (const Named& column : kColumns)
    if (plain == column.name) return column.kind;
  return std::nullopt;
}

int quality_rank(std::string_view name) {
  const std::string plain = plain_name(name);
  const auto found = std::find_if(kColumns.begin(), kColumns.end(),
                                  [&](const Named& column) { return column.name == plain; });
  return static_cast<int>(found - kColumns.begin());
}

std::optional<std::int64_t> quality_code(std::string_view text) {
  std::int64_t code = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), code);
  if (status == std::errc() && end == text.data() + text.size()) return code;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
    const char* const last = text.data() + text.size();
    const auto hex = std::from_chars(text.data() + 2, last, code, kHexadecimal);
    return hex.ec == std::errc() && hex.ptr == last ? std::optional(code) : std::nullopt;
  }
  const std::optional<double> value = parse_value(text, false);  // 192.0
  if (!value || *value != std::floor(*value) || std::abs(*value) > kLargestCode)
    return std::nullopt;
  return static_cast<std::int64_t>(*value);
}

bool fits_zero_is_good(std::int64_t code) {
  return code == kZeroGood || code == kZeroBad || code == kZeroDoubtful || code == kZeroFirst;
}

std::optional<Quality> parse_quality(std::string_view text, QualityKind kind, bool zero_is_good) {
  if (text.empty()) return Quality::kGood;
  if (kind == QualityKind::kConfidence) return quality_of_confidence(text);
  if (const std::optional<std::int64_t> code = quality_code(text)) {
    if (kind == QualityKind::kGoodFlag) return *code == 1 ? Quality::kGood : Quality::kBad;
    if (kind == QualityKind::kDoubtFlag) return *code == 0 ? Quality::kGood : Quality::kUncertain;
    return zero_is_good ? quality_where_zero_is_good(*code) : quality_of_code(*code);
  }
  const std::optional<Quality> word = quality_of_word(text);
  if (!word || kind != QualityKind::kDoubtFlag) return word;
  return same_word(text, "false") ? Quality::kGood : Quality::kUncertain;
}

}  // namespace mpm::files
