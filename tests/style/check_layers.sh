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
for folder in files mcap report; do forbid daemon/$folder 'idl/|mpm\.h|spdlog|systemd'; done

# Inside daemon, from the ground up: a folder, and those whose headers it may include besides its own.
# Whatever stands here may be included only further down. Its first name is the files' namespace.
known=" "
while read -r folder below; do
  for other in $below; do
    case "$known" in *" $other "*) ;; *)
      echo "daemon/$folder cannot stand on daemon/$other, which is not below it" >&2
      status=1 ;;
    esac
  done
  known="$known$folder "
  allowed=$(echo "$folder $below" | tr -s ' ' '|')
  if grep -nE '^ *# *include *"daemon/' "daemon/$folder"/*.[ch]pp |
    grep -vE "\"daemon/(${allowed%|})/[^/]*\""; then
    echo "daemon/$folder must not include the above" >&2
    status=1
  fi
  if grep -L "^namespace mpm::${folder%%/*} {" "daemon/$folder"/*.[ch]pp | grep .; then
    echo "the above are not in namespace mpm::${folder%%/*}" >&2
    status=1
  fi
done <<'TABLE'
host
files/times
files
files/csv files/times files
mcap
report/diagnosis
report/page report/diagnosis
report/closed_loop files/csv report/diagnosis
report files report/diagnosis report/page
bus report
bus/watch bus
bag files/times files files/csv mcap
bag/record host mcap bag
bag/replay host mcap bag
live host files report/diagnosis report bus
app/commands host files/times files files/csv mcap report/diagnosis report/closed_loop report bus bus/watch bag bag/record bag/replay live
app host live app/commands
TABLE
for folder in $(git ls-files 'daemon/*.hpp' 'daemon/*.cpp' | sed 's|^daemon/||; s|/[^/]*$||' | sort -u); do
  case "$known" in *" $folder "*) ;; *) echo "daemon/$folder has no place" >&2; status=1 ;; esac
done
exit $status
