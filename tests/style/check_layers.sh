#!/bin/sh
# The arrows between the rooms point down only: who may include what.
set -eu
cd "$(dirname "$0")/../.."
status=0

# forbid FOLDER PATTERN: no #include in FOLDER may match PATTERN.
forbid() {
  if grep -rnE "^ *# *include *[<\"]($2)" "$1" --include='*.hpp' --include='*.cpp'; then
    echo "$1 must not include the above" >&2
    status=1
  fi
}

forbid core 'dds/|yaml-cpp|spdlog|CLI/|nlohmann|systemd|iostream|fstream|filesystem|chrono|ctime|thread|config/|idl/|sim/|daemon/|tests/'
forbid config 'dds/|spdlog|CLI/|systemd|idl/|sim/|daemon/|tests/'
forbid idl 'yaml-cpp|spdlog|CLI/|nlohmann|systemd|config/|sim/|daemon/|tests/'
forbid sim 'yaml-cpp|dds/|systemd|daemon/|tests/'
forbid daemon 'yaml-cpp|sim/|tests/'
exit $status
