#include "idl/layout_sample.hpp"

#include <algorithm>

namespace mpm::idl {
namespace {

// The C type has no const; writing does not touch what it points to.
char* borrowed(const char* text) { return const_cast<char*>(text); }

dds_sequence_string borrowed(const std::vector<std::string>& texts, std::size_t count,
                             std::vector<char*>& pointers) {
  pointers.assign(count, borrowed(""));
  for (std::size_t i = 0; i < texts.size() && i < count; ++i)
    pointers[i] = borrowed(texts[i].c_str());
  const auto length = static_cast<std::uint32_t>(count);
  return {length, length, pointers.data(), false};
}

bool all_there(const dds_sequence_string& sequence) {
  return std::all_of(sequence._buffer, sequence._buffer + sequence._length,
                     [](const char* text) { return text != nullptr; });
}

}  // namespace

LayoutSample::LayoutSample(const std::string& unit, const char* kind, double sample_time_s,
                           const SignalLayout& signals) {
  sample_.unit = borrowed(unit.c_str());
  sample_.kind = borrowed(kind);
  sample_.sample_time_s = sample_time_s;
  sample_.tags = borrowed(signals.tags, signals.tags.size(), tags_);
  sample_.engineering_units =
      borrowed(signals.engineering_units, signals.tags.size(), engineering_units_);
}

bool complete(const mpm_Layout& layout) {
  return layout.unit != nullptr && layout.kind != nullptr && all_there(layout.tags) &&
         all_there(layout.engineering_units);
}

std::vector<std::string> texts_of(const dds_sequence_string& sequence) {
  std::vector<std::string> texts;
  texts.reserve(sequence._length);
  for (std::uint32_t i = 0; i < sequence._length; ++i)
    texts.emplace_back(sequence._buffer[i] == nullptr ? "" : sequence._buffer[i]);
  return texts;
}

}  // namespace mpm::idl
