#!/bin/sh
# check.sh BUILD SOURCE: records with our programs and reads with the format's own JavaScript reader.
# Every value must be the same. Exit 77 (skipped) where that reader cannot be had.
set -eu
build=$1
source=$2
here=$source/tests/daemon/mcap/js
work=$build/js
bin=$build/bin
unit=$work/unit.yaml
skip() { printf 'SKIPPED: %s\n' "$*" >&2; exit 77; }

command -v node >/dev/null && command -v npm >/dev/null || skip "no node and npm on this machine"
mkdir -p "$work"
cp "$here/package.json" "$here/package-lock.json" "$here/read.mjs" "$work/"
cd "$work"
if ! cmp -s package-lock.json node_modules/.lock-of-install; then
  npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1 ||
    skip "npm ci does not get the reader: $(tail -n 1 npm.log)"
  cp package-lock.json node_modules/.lock-of-install
fi

# A unit with every kind of signal, and data with every quality.
cat >"$unit" <<'YAML'
unit: small
sample_time: 1
signals: {mv: u, dv: d, cv: [{tag: y, prediction: yhat, setpoint: sp}, z], aux: [amb]}
model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [8]}, {cv: z, mv: d, gain: 1, time_constants: [5]}]}
YAML
{
  echo 'time,u,d,y,y.quality,yhat,sp,z,amb'
  awk 'BEGIN { srand(3); for (k = 0; k < 3000; ++k) {
    quality = k % 7 == 3 ? "uncertain" : k % 11 == 5 ? "bad" : "good"
    printf "%.3f,%.17g,%.17g,%.17g,%s,%.17g,%d,%s,%.17g\n", 1714564800 + k, rand(), rand() * 1e-300,
      rand() - 0.5, quality, rand() * 1e300, k % 3, k % 13 == 0 ? "" : rand(), -rand() } }'
} >all.csv
"$bin/mpm" convert all.csv all.mcap --config "$unit"
head -c 90000 all.mcap >torn.mcap
"$bin/mpm" recover torn.mcap --output mended.mcap
"$bin/mpmsim" --config "$source/config/plants/shell3x3.yaml" --scenario hidden_gain --samples 2000 \
  --seed 5 --csv shell.csv
"$bin/mpm" convert shell.csv shell.mcap --config "$source/config/plants/shell3x3.yaml"
for name in all mended shell; do
  "$bin/mpm" convert "$name.mcap" "$name.long.csv" --layout long --time-zone seconds
  node read.mjs "$name.mcap" "$name.long.csv"
done
