#pragma once

namespace mpm {

/// What a field of a record is called in JSON, and whether it is shown there.
///
/// Each record lists its fields once, in the order of JSON, in
///   template <class Visit, class Record, class... Sample>
///   static void fields(Visit&& visit, Record& record, Sample&... sample);
/// which calls `visit(key, member of record, member of sample ...)` for each. With a record alone
/// this makes its JSON (daemon/report/record_json.hpp), with a sample of its topic it is the way to
/// DDS and back (idl/output_samples.hpp). Members that belong together are tied. A row without a
/// member of the sample follows from the others: it is in JSON only.
struct FieldKey {
  // Implicit, so that a row begins with "name" or {"name", shown}.
  constexpr FieldKey(const char* key, bool in_json = true) : name(key), shown(in_json) {}

  const char* name;
  bool shown;
};

/// What lists its fields so: a record, or a part of one, which has a struct of its own on DDS and
/// an object in JSON.
template <class T>
concept HasFields = requires(T& parts) {
  T::fields([](auto&&...) {}, parts);
};

}  // namespace mpm
