#!/bin/sh
# A test stands where its source does, under its name: tests/core/model/filter_channel_test.cpp is of
# core/model/filter_channel.cpp. Lists the sources without one; there may only come to be fewer.
set -eu
cd "$(dirname "$0")/../.."
most=190

status=0
for test in $(git ls-files 'tests/core/*_test.cpp' 'tests/config/*_test.cpp' 'tests/idl/*_test.cpp' \
  'tests/sim/*_test.cpp' 'tests/daemon/*_test.cpp'); do
  folder=${test#tests/}
  folder=${folder%/*}
  [ -d "$folder" ] || { echo "$test: there is no folder $folder" >&2; status=1; }
done

without=$(git ls-files 'core/*.cpp' 'config/*.cpp' 'idl/*.cpp' 'sim/*.cpp' 'daemon/*.cpp' |
  while read -r source; do
    [ -e "tests/${source%.cpp}_test.cpp" ] || echo "$source"
  done)
count=$(echo "$without" | wc -l)
echo "$without"
echo "$count sources have no test of their name, $most are allowed"
[ "$count" -le "$most" ] || { echo "write tests for what is new" >&2; status=1; }
exit $status
