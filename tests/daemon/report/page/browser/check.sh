#!/bin/sh
# check.sh BUILD SOURCE [PICTURES]: makes reports of a simulated unit and opens them in a browser, from
# files, wide and narrow, light and dark, on paper. With PICTURES it leaves pictures in that folder.
# Exit 77 (skipped) where the browser or what drives it cannot be had.
set -eu
build=$1
source=$2
pictures=${3:-}
here=$source/tests/daemon/report/page/browser
work=$build/page_browser
bin=$build/bin
skip() { printf 'SKIPPED: %s\n' "$*" >&2; exit 77; }

command -v chromium >/dev/null || skip "no chromium on this machine"
command -v node >/dev/null && command -v npm >/dev/null || skip "no node and npm on this machine"
mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$here/check.mjs" "$work/"
cd "$work"
if ! cmp -s package-lock.json node_modules/.lock-of-install; then
  npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1 ||
    skip "npm ci does not get the driver: $(tail -n 1 npm.log)"
  cp package-lock.json node_modules/.lock-of-install
fi

unit=$source/config/plants/shell3x3.yaml
"$bin/mpmsim" --config "$unit" --scenario two_causes --samples 1500 --seed 3 --csv run.csv
"$bin/mpm" diagnose --config "$unit" --data run.csv --out diagnosis --quiet
"$bin/mpm" identify --config "$unit" --data run.csv --out new.yaml --report identification --quiet
node check.mjs diagnosis/report.html identification/report.html ${pictures:+"$pictures"}
