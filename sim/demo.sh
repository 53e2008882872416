#!/bin/sh
# ./run demo: a simulated unit (mpmsim), its monitor (mpmd) and a third process that reads nothing
# but the alarm topic, all on DDS over loopback. A gain error is hidden in one channel, drawn from
# the seed; the three must end up naming that channel.
set -eu
bin=$1
shift
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
unit=$here/../config/plants/shell3x3.yaml
seed=$(od -An -N2 -tu2 /dev/urandom | tr -d ' ')
scenario=hidden_gain
samples=6000
rate= # samples per second
page=no

while [ $# -gt 0 ]; do
  case "$1" in
    --seed) seed=$2; shift 2 ;;
    --nothing-hidden) scenario=none; samples=3000; shift ;;
    --rate) rate=$2; shift 2 ;;
    --page) page=yes; shift ;;
    *) echo "usage: ./run demo [--seed N] [--nothing-hidden] [--page] [--rate SAMPLES_PER_SECOND]" >&2; exit 3 ;;
  esac
done
# With the page slower, for a person to see it happen: an alarm after some fifteen seconds.
if [ "$page" = yes ]; then : "${rate:=60}"; else : "${rate:=200}"; fi
start_time="--start-time 0" # the same numbers each time
[ "$page" = no ] || start_time=""

work=$(mktemp -d)
tag=mpm-demo-$$ # keeps this demo apart from any other on the machine
children=""
clean_up() {
  for child in $children; do kill "$child" 2>/dev/null || :; done
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 2' INT TERM

if [ "$page" = yes ]; then
  token=$(od -An -N16 -tx1 /dev/urandom | tr -d ' \n')
  (umask 077; echo "$token" >"$work/token")
  set -- --log-level info --http 0 --state-dir "$work/state" --token-file "$work/token"
else
  set -- --log-level warning
fi
"$bin/mpmd" --config "$unit" --partition "$tag" "$@" 2>"$work/mpmd.log" &
daemon=$!
children=$daemon
if [ "$page" = yes ]; then
  address=
  while [ -z "$address" ]; do
    kill -0 "$daemon" 2>/dev/null || { cat "$work/mpmd.log" >&2; exit 2; }
    sleep 0.1
    address=$(sed -n 's/.*operator page at //p' "$work/mpmd.log")
  done
  echo "The operator page: $address"
  echo "Token to acknowledge and shelve with: $token"
  if [ -t 0 ]; then
    printf 'Open it in a browser, then press Enter: '
    read -r _ || :
  fi
fi
"$bin/mpm" watch --partition "$tag" --alarms-only --json --until-alarm --for 300 \
  >"$work/alarms" 2>"$work/watch.log" &
reader=$!
children="$children $reader"
start=$(date +%s%N)
# shellcheck disable=SC2086  # none or two words
"$bin/mpmsim" --config "$unit" --scenario "$scenario" --seed "$seed" --samples "$samples" \
  --speed "$rate" $start_time --wait-readers 10 --partition "$tag" \
  --truth "$work/truth.json" 2>"$work/mpmsim.log" &
simulator=$!
children="$children $simulator"

# The live table, until the simulation ends or the alarm is there.
"$bin/mpm" watch --partition "$tag" --for 300 &
table=$!
children="$children $table"
while kill -0 "$simulator" 2>/dev/null && kill -0 "$reader" 2>/dev/null; do sleep 0.2; done
seconds=$(awk -v a="$start" -v b="$(date +%s%N)" 'BEGIN { printf "%.1f", (b - a) / 1e9 }')
sleep 1 # for the table to show it
kill "$table" 2>/dev/null || :
wait "$table" 2>/dev/null || :
if [ "$page" = yes ] && kill -0 "$simulator" 2>/dev/null; then
  echo
  echo "The page goes on until the run is over; $address"
  while kill -0 "$simulator" 2>/dev/null; do sleep 0.5; done
  if [ -t 0 ]; then
    printf 'The run is over; press Enter to end: '
    read -r _ || :
  fi
else
  kill "$simulator" 2>/dev/null || :
fi
if wait "$simulator"; then status=0; else status=$?; fi
if [ "$status" -ne 0 ] && [ "$status" -ne 143 ]; then
  cat "$work/mpmsim.log" >&2
  exit 2
fi

field() { sed -n "s/.*\"$1\": *\"\{0,1\}\([^\",]*\)\"\{0,1\}.*/\1/p" "$2" | head -n 1; }
alarm=$work/alarm
grep '"to":"active"' "$work/alarms" | head -n 1 >"$alarm" || :
echo
if [ -s "$alarm" ]; then
  found="$(field mv "$alarm") -> $(field cv "$alarm")"
  delay="after $(field interval "$alarm") samples, $seconds s"
else
  found=nothing
  delay="in $samples samples, $seconds s"
fi
hidden=nothing
if [ "$scenario" != none ]; then
  hidden="$(field mv "$work/truth.json") -> $(field cv "$work/truth.json")"
  ratio=$(field gain_ratio "$work/truth.json")
fi
echo "seed    $seed"
echo "hidden  $hidden${ratio:+ (plant gain x $ratio)}"
echo "found   $found $delay"
if [ "$found" = "$hidden" ]; then
  echo "They agree."
else
  echo "They do not agree."
  cat "$work/mpmd.log" >&2
  exit 1
fi
