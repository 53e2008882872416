#include "daemon/live/domain.hpp"

#include <spdlog/spdlog.h>

#include "core/text/printable.hpp"

namespace mpm::live {

Domain::Domain(const idl::DomainOptions& options)
    : participant_(options),
      samples_(participant_),
      layouts_(participant_, idl::kLayoutTopic, idl::layout_qos()),
      outputs_(participant_) {}

UnitPipeline& Domain::add_unit(const config::UnitConfig& unit, Journal* journal,
                               Clock::time_point now) {
  auto pipeline = std::make_unique<UnitPipeline>(unit, outputs_, journal, now);
  return *(units_[unit.unit] = std::move(pipeline));
}

void Domain::attach_to(idl::WaitSet& wait_set) const {
  samples_.attach_to(wait_set);
  wait_set.attach(layouts_.readable());
}

void Domain::poll(Clock::time_point now) {
  layouts_.take([this](const mpm_Layout& layout) {
    if (layout.unit == nullptr || layout.kind == nullptr) return;
    if (const auto it = units_.find(std::string_view(layout.unit)); it != units_.end())
      it->second->check_layout(layout);
  });
  samples_.take([&](const idl::SampleView& sample) {
    if (const auto it = units_.find(sample.unit); it != units_.end())
      it->second->push(sample, now);
    else
      report_unknown(sample.unit, now);
  });
}

void Domain::report_unknown(std::string_view unit, Clock::time_point now) {
  ++unknown_unit_;
  if (!unknown_limit_.admit(now)) return;
  spdlog::warn("sample of unit '{}', which no unit file describes; ignored{}", printable(unit),
               unknown_limit_.held_back() == 0
                   ? ""
                   : fmt::format(" ({} more like this before)", unknown_limit_.held_back()));
}

void Domain::tick(Clock::time_point now) {
  for (const auto& [name, unit] : units_) unit->tick(now, unknown_unit_);
}

}  // namespace mpm::live
