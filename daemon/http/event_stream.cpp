#include "daemon/http/event_stream.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "daemon/http/unit_json.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::http {
namespace {

constexpr std::chrono::seconds kLongestWait{1};    // meanwhile a client may have gone
constexpr const char* kBegin = "retry: 2000\n\n";  // ms until a browser tries again

}  // namespace

EventStream::EventStream(const Board& board, std::string run, const std::string& last_id)
    : board_(board), run_(std::move(run)) {
  const std::string prefix = run_ + "-";
  if (last_id.rfind(prefix, 0) != 0) return;
  const char* end = last_id.data() + last_id.size();
  const auto [at, error] = std::from_chars(last_id.data() + prefix.size(), end, told_);
  knows_ = error == std::errc() && at == end;
}

std::string EventStream::next(bool& ended) {
  const Clock::time_point now = Clock::now();
  const Clock::time_point longest = now + kLongestWait;
  std::string text;
  std::uint64_t version = 0;
  if (!begun_) {
    text = kBegin;
    begun_ = true;
    last_ = now;
    version = board_.version();
    if (knows_ && version == told_) return text;
    knows_ = false;
  } else {
    // However many units change, a reader is told twice a second.
    (void)board_.wait_beyond(std::numeric_limits<std::uint64_t>::max(),
                             std::min(last_ + kLeastBetween, longest));
    version = board_.wait_beyond(told_, std::min(last_ + kMostBetween, longest));
  }
  ended = board_.closed();
  if (ended) return {};
  if (version != told_ || !text.empty()) {
    told_ = version;
    last_ = Clock::now();
    return text + state();
  }
  if (Clock::now() - last_ < kMostBetween) return {};
  last_ = Clock::now();
  return "event: alive\ndata: {}\n\n";
}

std::string EventStream::state() const {
  Json units = Json::object();
  for (const auto& [name, unit] : board_.units()) units[name] = unit->store.snapshot()->id;
  const std::string data =
      report::json_text(Json{{"run", run_}, {"version", told_}, {"units", units}});
  return "id: " + run_ + "-" + std::to_string(told_) + "\nevent: state\ndata: " + data + "\n\n";
}

}  // namespace mpm::http
