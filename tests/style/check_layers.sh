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

forbid core 'dds/|yaml-cpp|muParser|spdlog|CLI/|nlohmann|systemd|iostream|fstream|filesystem|chrono|ctime|thread|config/|idl/|sim/|daemon/|tests/'
forbid config 'dds/|spdlog|systemd|idl/|sim/|daemon/|tests/'
for file in config/*.?pp; do forbid "$file" 'CLI/|config/cli/'; done
forbid config/cli 'yaml-cpp|muParser|nlohmann'
forbid idl 'yaml-cpp|muParser|spdlog|CLI/|nlohmann|systemd|config/|sim/|daemon/|tests/'
forbid sim 'yaml-cpp|muParser|dds/|systemd|daemon/|tests/'
forbid daemon 'yaml-cpp|muParser|dds/|sim/|tests/'
for folder in files mcap report history; do forbid daemon/$folder 'idl/|mpm\.h|spdlog|systemd'; done

if grep -rnwE '(dds|DDS|ddsi|ddsrt)_[A-Za-z0-9_]+' core sim daemon \
  --include='*.hpp' --include='*.cpp'; then
  echo "Cyclone's names stay in idl" >&2
  status=1
fi

if grep -rnE "^ *# *include *[<\"](oneapi/)?tbb" core config idl sim daemon \
  --include='*.hpp' --include='*.cpp' | grep -v '^core/parallel/arena.cpp:'; then
  echo "oneTBB's names stay in core/parallel/arena.cpp" >&2
  status=1
fi

# floors ROOM: reads from the ground up a folder of the room, and those whose headers it may include
# besides its own. Whatever stands here may be included only further down.
floors() {
  room=$1
  known=" "
  while read -r folder below; do
    for other in $below; do
      case "$known" in *" $other "*) ;; *)
        echo "$room/$folder cannot stand on $room/$other, which is not below it" >&2
        status=1 ;;
      esac
    done
    known="$known$folder "
    allowed=$(echo "$folder $below" | tr -s ' ' '|')
    if grep -nE "^ *# *include *\"$room/" "$room/$folder"/*.[ch]pp |
      grep -vE "\"$room/(${allowed%|})/[^/]*\""; then
      echo "$room/$folder must not include the above" >&2
      status=1
    fi
    # In daemon the first name is the files' namespace.
    [ "$room" = daemon ] || continue
    if grep -L "^namespace mpm::${folder%%/*} {" "daemon/$folder"/*.[ch]pp | grep .; then
      echo "the above are not in namespace mpm::${folder%%/*}" >&2
      status=1
    fi
  done
  for folder in $(git ls-files "$room/*.hpp" "$room/*.cpp" | sed "s|^$room/||; s|/[^/]*$||" | sort -u); do
    case "$known" in *" $folder "*) ;; *) echo "$room/$folder has no place" >&2; status=1 ;; esac
  done
}

floors core <<'TABLE'
archive
parallel
text
statistics archive
signal archive statistics
regression archive
model archive
alarm archive text
mismatch archive text signal regression statistics model
nonlinear archive text regression statistics model signal mismatch
record text alarm mismatch nonlinear
monitor archive text signal statistics model alarm regression mismatch nonlinear
identify/fit parallel statistics regression model
identify/evidence statistics model signal mismatch nonlinear monitor identify/fit
performance archive signal model monitor identify/fit
identification parallel statistics model identify/fit identify/evidence
identify/causes parallel text model identify/fit
identify/valves
identify/search parallel identify/fit identify/causes
identify/diagnosis text statistics model identify/fit identify/evidence identify/causes identify/valves identify/search
TABLE

floors daemon <<'TABLE'
host
files/times
keys files/times
files files/times
files/csv files/times files
mcap/format
mcap/read mcap/format
mcap/write mcap/format
mcap mcap/format mcap/read mcap/write
report/terminal
report/condensing
report/diagnosis files/times report/condensing
report/identification files/times report/terminal report/condensing
report/page files/times report/condensing report/diagnosis report/identification
report/closed_loop files/csv report/diagnosis
report files/times files report/terminal report/condensing report/diagnosis report/identification report/page
history files/times files/csv report
history/trend files/times report/terminal report history
bus
bus/alarms files/times report/terminal report bus
bus/watch files/times report/terminal report bus
bus/doctor bus
bag files/times files files/csv mcap/format mcap/read mcap/write
bag/record host files/times files mcap/read mcap/write mcap bag
bag/replay host files/times mcap/read bag
live host keys files/times files report/diagnosis report history bus
http host files report history bus live
app/commands host keys files/times files files/csv mcap/read mcap report/terminal report/condensing report/diagnosis report/closed_loop report/identification report history history/trend bus bus/alarms bus/watch bus/doctor bag bag/record bag/replay live
app host keys live http app/commands
TABLE
exit $status
