#!/bin/sh
# check_install.sh BUILD SOURCE: what `cmake --install` puts under a prefix works from there.
set -eu
build=$1
source=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
fail() { printf '%s\n' "$*" >&2; exit 1; }

cmake --install "$build" --prefix "$prefix" >"$prefix/log"
for program in mpm mpmd mpmsim; do
  "$prefix/bin/$program" --version | grep -q "^$program " || fail "$program does not run"
done
for program in mpm mpmd mpmsim; do
  share=$prefix/share
  gzip -dc "$share/man/man1/$program.1.gz" | grep -qi "^\.TH $program 1 " || fail "no manual page of $program"
  bash -n "$share/bash-completion/completions/$program" || fail "no $program for bash"
  grep -q "^#compdef $program\$" "$share/zsh/vendor-completions/_$program" || fail "none for zsh"
  grep -q "^complete -c $program " "$share/fish/vendor_completions.d/$program.fish" ||
    fail "no $program for fish"
done
cmp "$source/idl/mpm.idl" "$prefix/share/mpm/mpm.idl"
"$prefix/bin/mpmd" --check --config "$prefix/share/mpm/units" || fail "the example is not right"
# Plants find their scenarios, and `mpm` the simulator beside it.
"$prefix/bin/mpmsim" --config "$prefix/share/mpm/plants/shell3x3.yaml" --scenario hidden_gain \
  --samples 50 --csv "$prefix/run.csv" || fail "no scenarios"
documents=$prefix/share/doc/mpm
# Every link of a page leads to something that is there.
find "$documents" -name '*.md' | while read -r page; do
  grep -o '](\([^)# ]*\)' "$page" | sed 's/^](//' | grep -v '^http' | while read -r link; do
    [ -z "$link" ] || [ -e "$(dirname "$page")/$link" ] || fail "${page#"$documents/"}: no $link"
  done
done
# The clients are built with nothing else, and there is a unit file for what their gateways play.
cmake -S "$documents/tests/hmi" -B "$prefix/hmi" -D MPM_IDL="$prefix/share/mpm/mpm.idl" >"$prefix/log" 2>&1 &&
  cmake --build "$prefix/hmi" >>"$prefix/log" 2>&1 || { cat "$prefix/log" >&2; fail "no clients"; }
rm -r "$prefix/hmi"
[ -f "$documents/tests/hmi/loopback.xml" ] || fail "no network settings"
"$prefix/bin/mpmd" --check --config "$documents/tests/hmi/toy.yaml" || fail "no unit to try"
[ "$(find "$prefix" -path "$documents" -prune -o \
  \( -name '*.cpp' -o -name '*.a' -o -name 'CMakeLists.txt' \) -print | wc -l)" -eq 0 ] ||
  fail "what nobody asked for is installed"
