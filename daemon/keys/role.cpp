#include "daemon/keys/role.hpp"

#include "idl/topics.hpp"

namespace mpm::keys {
namespace {

std::vector<std::string_view> inputs_and(std::vector<std::string_view> topics) {
  for (const SignalKind kind : idl::kTopicKinds) topics.emplace_back(idl::sample_topic(kind));
  return topics;
}

}  // namespace

Permissions permissions_of(Role role) {
  switch (role) {
    case Role::kMonitor:
      return {{"mpm/*"},
              {idl::kChannelStatusTopic, idl::kAlarmTopic, idl::kAlarmEventTopic,
               idl::kControllerAlarmTopic, idl::kHealthTopic, idl::kPerformanceTopic,
               idl::kCommandReplyTopic, idl::kRoleTopic}};
    case Role::kGateway:
      // mpm replay writes what it reads itself once: so it has the type of a topic.
      return {inputs_and({idl::kLayoutTopic, idl::kHealthTopic}), inputs_and({idl::kLayoutTopic})};
    case Role::kOperator:
      return {{"mpm/*"}, {idl::kCommandTopic}};
    case Role::kViewer:
      break;
  }
  return {{"mpm/*"}, {}};
}

}  // namespace mpm::keys
