#!/bin/sh
# check.sh BUILD SOURCE [PICTURES]: makes reports of a simulated unit and opens them in a browser, from
# files, wide and narrow, light and dark, on paper. With PICTURES it leaves pictures in that folder.
set -eu
build=$1
source=$2
pictures=${3:-}
bin=$build/bin
. "$source/tests/daemon/report/page/browser/driver.sh"

unit=$source/config/plants/shell3x3.yaml
"$bin/mpmsim" --config "$unit" --scenario two_causes --samples 1500 --seed 3 \
  --start-time 2026-03-01T00:00:00Z --csv run.csv
"$bin/mpm" diagnose --config "$unit" --data run.csv --out diagnosis --quiet
"$bin/mpm" identify --config "$unit" --data run.csv --out new.yaml --report identification --quiet
node check.mjs diagnosis/report.html identification/report.html ${pictures:+"$pictures"}
